// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::refine {

/// Finds a face's ring, all vertices of the faces that touch its corners, and what its refinement
/// depends on: two faces with the same key are refined by the same sums of their rings.
class FaceRing {
public:
    explicit FaceRing(const Topology& mesh)
        : mesh_(mesh), places_(mesh.vertex_count()), last_face_(mesh.vertex_count(), kNone) {}

    void find(uint32_t face);
    /// The corners of the face first, then the others as they are met turning round each corner.
    std::span<const uint32_t> vertices() const { return vertices_; }
    /// Faces and edges round each corner by places in the ring, and what is sharp.
    const std::vector<uint32_t>& key() const { return key_; }

private:
    void turn(uint32_t h);
    uint32_t place(uint32_t v);

    const Topology& mesh_;
    uint32_t face_ = kNone;
    std::vector<uint32_t> vertices_, key_;
    std::vector<uint32_t> places_;     ///< [vertex] in the ring of last_face_
    std::vector<uint32_t> last_face_;  ///< [vertex] whose ring it was found in
};

/// A part of a mesh round some faces of it, the inside: all faces that touch one of its vertices.
/// Only vertices of the inside have all of their faces here.
struct Patch {
    Topology mesh;
    std::vector<uint32_t> inside;  ///< faces
    std::vector<uint32_t> source;  ///< [vertex] of the mesh it was cut from
};

/// Cuts patches out of a mesh. Of one face, the vertices come in the order of its ring.
/// Cost  O(mesh) to make, O(patch) for each patch.
class PatchCutter {
public:
    explicit PatchCutter(const Topology& mesh);
    Patch cut(std::span<const uint32_t> inside);

private:
    void add_corners(uint32_t f, Patch& patch);
    void add_vertex(uint32_t v, Patch& patch);
    void add_fan(uint32_t start, Patch& patch);
    uint32_t new_half(uint32_t h, const Topology& cut) const;
    void link(Patch& patch);
    void add_half(uint32_t h, Topology& cut);
    void forget(const Patch& patch);

    const Topology& mesh_;
    std::vector<uint32_t> faces_;  ///< [face of the patch] of the mesh
    std::vector<uint32_t> new_face_, new_vertex_, new_edge_;
    std::vector<bool> turned_;  ///< [vertex of the inside]
};

}  // namespace aglow::refine
