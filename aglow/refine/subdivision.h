// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/mesh/topology.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace aglow {

enum class Scheme : uint8_t { loop, catmull_clark };

/// What a mesh's boundary does where it turns.
enum class Corners : uint8_t {
    smooth,  ///< it is one smooth curve
    sharp,   ///< a vertex of only one face stays where it is
};

struct SubdivisionOptions {
    Scheme scheme = Scheme::loop;
    int level = 1;  ///< every edge has 2^level segments
    Corners corners = Corners::smooth;
};

inline constexpr int kDeepestLevel = 10;

/// A mesh subdivided `level` times: which vertices there are, and how each is a weighted mean of
/// those of the control mesh. Built once for a topology; positions are evaluated from it for every
/// frame of an animation.
///
/// Refined vertices come in this order: those of the control mesh; 2^level - 1 on every edge, from
/// the start of edge_half to its end; then those inside each face. A vertex is computed once, from
/// one sum, so that faces that meet there meet exactly.
///
/// Rules  OpenSubdiv's. Loop: masks of the factored form, which are Loop's own; Catmull-Clark for
///        polygons of any size. Boundaries and creases are cubic B-splines of their own vertices,
///        1/8, 3/4, 1/8 and 1/2, 1/2, whatever the valence; semi-sharp ones lose 1 of their
///        sharpness at each level, and the last fraction blends the rules of both levels; a sharp
///        vertex, or one where more than two creases meet, stays.
///        The normal of a point on a crease is that of one side: counter-clockwise from its
///        vertex_half, or from the direction in which edge_half runs.
/// Thread safety  all const members, from any thread.
/// Source Loop, "Smooth Subdivision Surfaces Based on Triangles", 1987; Warren & Schaefer, "A
///        Factored Approach to Subdivision Surfaces", IEEE CG&A 2004; Catmull & Clark, "Recursively
///        Generated B-spline Surfaces on Arbitrary Topological Meshes", CAD 1978; DeRose, Kass &
///        Truong, "Subdivision Surfaces in Character Animation", SIGGRAPH 1998.
class Subdivision {
public:
    /// Errors  bad_argument  level outside 0..kDeepestLevel, a face of Loop's that is no triangle,
    ///                       more than 2^31 refined vertices
    ///         out_of_memory
    /// Cost    O(faces), and subdividing a ring for every combination of valences, boundaries and
    ///         sharp edges at a face's corners, which are few. Rings, and what it costs to
    ///         evaluate, grow with valences: the faces round a vertex with the square of theirs.
    static Result<Subdivision> create(const Topology& topology, const SubdivisionOptions& options);
    Subdivision(Subdivision&&) noexcept;
    Subdivision& operator=(Subdivision&&) noexcept;
    ~Subdivision();

    uint32_t control_count() const;
    uint32_t vertex_count() const;
    /// Triangles for Loop, quads for Catmull-Clark; 0 at level 0 of the latter, where faces are
    /// those of the control mesh.
    uint32_t face_count() const;
    /// Refined faces, those of one control face after each other, in the same order for every
    /// face. Loop: triangles; Catmull-Clark: quads. The other is empty.
    /// Cost  made by every call; bound by memory.
    std::vector<uvec3> triangles() const;
    std::vector<std::array<uint32_t, 4>> quads() const;

    /// Shapes  control [control_count() * width], refined [vertex_count() * width], both row by
    ///         row.
    /// Errors  out_of_memory (Catmull-Clark, and Loop beyond level 5, keep some points aside)
    /// Cost    O(refined), bound by memory: no level between is stored.
    /// Repeat  same bits for any number of threads.
    Status evaluate(std::span<const float> control, int width, std::span<float> refined) const;
    Status evaluate(std::span<const vec3> control, std::span<vec3> refined) const;
    /// Where the vertices go in the limit, and unit normals there. A vertex that no face touches
    /// has the normal 0.
    Status evaluate_limit(std::span<const vec3> control, std::span<vec3> positions,
                          std::span<vec3> normals) const;

    struct State;
    const State& state() const { return *state_; }  ///< for the stage's own folders

private:
    explicit Subdivision(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace aglow
