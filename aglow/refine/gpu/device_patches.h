// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/refine/patches.h"
#include "aglow/refine/pattern.h"
#include "aglow/shared/device_patch.h"
#include "aglow/vk/buffer.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace aglow::refine::gpu {

/// A pattern on the device: stored once, instanced on every face.
struct DevicePattern {
    int segments = 0;
    uint32_t corners = 3;  ///< of its polygon
    uint32_t vertex_count = 0, triangle_count = 0;
    vk::Buffer steps;      ///< uint[vertex_count] Pattern::steps
    vk::Buffer triangles;  ///< uvec3[triangle_count]
};

/// Ready once a barrier() follows. Errors: out_of_memory.
Result<DevicePattern> upload_triangle_pattern(vk::Stream& stream, int segments);
Result<DevicePattern> upload_quad_pattern(vk::Stream& stream, int segments);
Result<DevicePattern> upload_nested_pattern(vk::Stream& stream, int segments);

/// What the faces of a part of a mesh have in common.
struct PatchKind {
    PatchShape shape = PatchShape::pn;
    NormalField normals = NormalField::quadratic;
    shared::Displacement displacement = {};
    const HeightMap* map = nullptr;  ///< where it is kHeightMapDisplacement
};

/// What stays the same of a coarse mesh, beside its topology.
struct DevicePatchInput {
    /// [vertex] Where in the array of positions a vertex finds its own; empty: it has its number.
    std::span<const uint32_t> vertex_source = {};
    /// [half-edge] Likewise, of normals; empty: a corner has its half-edge's number.
    std::span<const uint32_t> corner_normal = {};
    std::span<const shared::ShapeTags> tags = {};   ///< [vertex]; empty: none
    const DisplacementMap* displacement = nullptr;  ///< of all faces; null: none
    /// Where parts of the mesh differ, in place of `displacement` and of the options' shape and
    /// normals: all kinds, and that of each vertex, which is the kind of all its faces.
    std::span<const PatchKind> kinds = {};
    std::span<const uint32_t> kind_of = {};  ///< [vertex]
    std::span<const vec2> uvs = {};          ///< [half-edge] in the height maps of `kinds`
};

/// Curved patches over an animated coarse mesh, on the device: what Patches does on the host. In
/// each frame control points are made there from the mesh's positions and normals; then patterns
/// are evaluated into buffers by evaluate(), or in vertex shaders by patch_surface.glsl.
/// Result         differs from Patches by the rounding of fused products; faces meet bitwise within
///                one shader, whatever their levels.
/// Thread safety  one thread at a time.
class DevicePatches {
public:
    /// Waits until all is on the device.
    /// Errors  bad_argument (a face that is neither triangle nor quad), out_of_memory, device_lost,
    ///         unsupported
    static Result<DevicePatches> create(vk::Stream& stream, const Topology& topology,
                                        const PatchOptions& options,
                                        const DevicePatchInput& input = {});
    DevicePatches(DevicePatches&&) noexcept;
    DevicePatches& operator=(DevicePatches&&) noexcept;
    ~DevicePatches();

    /// Control points from positions and normals at these addresses (vec3 arrays).
    /// Synchronisation  Starts and ends without barrier.
    void update(vk::Stream& stream, uint64_t positions, uint64_t normals) const;

    /// What update() made of positions, edges and directions; the rest of it stays empty.
    /// Synchronisation  Waits for all that was recorded.
    /// Errors           device_lost, out_of_memory
    Result<PatchControl> download_control(vk::Stream& stream) const;

    /// Levels of faces, [face_count]; see shared::PatchLevels. Starts and ends without barrier.
    void set_levels(vk::Stream& stream, std::span<const shared::PatchLevels> levels) const;

    /// Other displacements than those of before, by kind, with the same height maps.
    /// Synchronisation  Starts and ends without barrier; update() goes by them.
    void set_displacements(vk::Stream& stream, std::span<const shared::Displacement> by_kind);

    /// Mip levels of height maps, in place of those of the displacements.
    /// Shapes           vertices [vertex_count], faces [face_count]
    /// Synchronisation  Follows update() and a barrier; ends without one.
    void set_mips(vk::Stream& stream, std::span<const float> vertices,
                  std::span<const shared::PatchMips> faces) const;

    /// A pattern's vertices on `face_count` faces from `first_face` on, all of them triangles or
    /// all quads as the pattern is: `positions` and `normals` are the addresses of
    /// vec3[face_count][pattern.vertex_count].
    /// Levels  uniform: all edges have the pattern's segments; adaptive: those of set_levels(),
    ///         at most as many
    /// Synchronisation  Starts and ends without barrier.
    enum class Levels : uint8_t { uniform, adaptive };
    void evaluate(vk::Stream& stream, const DevicePattern& pattern, Levels levels,
                  uint32_t first_face, uint32_t face_count, uint64_t positions,
                  uint64_t normals) const;

    uint64_t mesh() const;    ///< address of the shared::PatchMesh for patch_vertex()
    uint64_t levels() const;  ///< address of shared::PatchLevels[face_count]
    uint32_t face_count() const;
    uint32_t displacement() const;  ///< what kPatchDisplacement must be

private:
    struct State;
    explicit DevicePatches(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// Bit i: edge i of the face runs from the vertex of the higher number.
uint32_t reversed_edges(const Topology& topology, uint32_t face);

}  // namespace aglow::refine::gpu
