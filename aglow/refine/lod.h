// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/mesh/topology.h"
#include "aglow/refine/patches.h"
#include "aglow/refine/tessellation.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aglow {

/// Who looks at a mesh, in the space that the mesh is in.
struct Viewpoint {
    bool perspective = true;
    vec3 position = {0, 0, 0};    ///< of the eye (perspective)
    vec3 direction = {0, 0, -1};  ///< unit, in which it looks (orthographic)
    /// How many pixels a metre takes up, at a metre from the eye (perspective) or anywhere.
    float pixels_per_metre = 1000;
    float nearest = 0.01f;  ///< m; what is nearer counts as if it were here
};

struct LodOptions {
    float tolerance = 0.5f;  ///< pixels that the refined edges may be away from the smooth ones
    uint64_t budget = 0;     ///< triangles at most, 0: as many as the tolerance takes
    /// An edge gets coarser only when it could by this much more than it has to: small movements
    /// to and fro change nothing.
    float hysteresis = 0.25f;
    /// Edges at the outline get an error so many times smaller, those that face away so many times
    /// larger. 1: all alike.
    float silhouette = 2;
    Tessellation::Levels levels = Tessellation::Levels::discrete;
};

/// How far a displaced surface is from what 2^k segments of an edge of it make, m, by k.
using EdgeDetail = std::array<float, 8>;

/// What is known of edges beside their curves.
struct EdgeFacts {
    std::span<const uint8_t> hidden = {};  ///< [edge] 1: coarse will do, none of its faces shows
    std::span<const EdgeDetail> details = {};  ///< [edge]; empty: nothing is displaced
};

/// Chooses how finely each edge of a mesh of curved patches is refined, from frame to frame.
///
/// An edge is a cubic whose second derivative is bounded by its control points: cut into n
/// segments it is away from them by at most M / (8 n^2). The level is the n for which that, seen
/// from the nearest place of the edge, is the tolerance. It follows from the edge and its ends
/// alone. Where the surface is displaced, the level is also that at which what it misses is the
/// tolerance. With a budget the tolerance is raised until the triangles fit.
///
/// Source  de Boor, "A Practical Guide to Splines", 1978 (II.6, the bound); Lindstrom et al.,
///         "Real-Time, Continuous Level of Detail Rendering of Height Fields", SIGGRAPH 1996
///         (error in pixels).
class LevelOfDetail {
public:
    explicit LevelOfDetail(const LodOptions& options) : options_(options) {}

    struct Choice {
        std::vector<float> levels;  ///< [edge] 1..kMostAdaptiveSegments, for Tessellation::adaptive
        uint64_t triangles = 0;     ///< of all faces then; above the budget if all levels are 1
        float tolerance = 0;        ///< pixels, as the budget made it
    };
    /// Shapes  `topology` the same in each call, its faces triangles or quads; `control` of it, of
    ///         which positions, edges and directions are looked at.
    /// Cost    O(edges), with a budget O(edges and faces) twenty times
    /// Repeat  same bits for the same calls in the same order.
    Choice choose(const Topology& topology, const PatchControl& control, const Viewpoint& view,
                  const EdgeFacts& facts = {});

private:
    struct EdgeError;
    float fit_budget(const Topology& topology, std::span<const EdgeError> errors,
                     const EdgeFacts& facts) const;

    LodOptions options_;
    std::vector<float> last_levels_;
    float last_coarseness_ = 1;  // by which the budget multiplied the tolerance
};

/// Triangles of Tessellation::adaptive() with these levels.
/// Shapes  levels [edge_count]
uint64_t triangle_count(const Topology& topology, std::span<const float> levels,
                        Tessellation::Levels kind);

/// The level of a uniform refinement, of which all edges have 2^level segments, that is as fine
/// everywhere as these levels are; at most `most`.
int uniform_level(std::span<const float> levels, int most);

}  // namespace aglow
