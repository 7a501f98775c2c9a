// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/creases.h"

#include "aglow/refine/scene/cut_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace aglow {
namespace {

// A boundary that turns by more than this (75 degrees) has a corner there. Faces do not tell: a
// square of two triangles has corners of one and of two.
constexpr float kTurn = 75 * kPi / 180;

/// By how much the boundary turns at a vertex of it, radians.
float boundary_turn(const Topology& mesh, std::span<const vec3> positions, uint32_t v) {
    uint32_t h = mesh.vertex_half[v];
    const vec3 out = positions[mesh.end(h)] - positions[v];
    while (mesh.twin[mesh.previous(h)] != kNone) h = mesh.twin[mesh.previous(h)];
    const vec3 in = positions[v] - positions[mesh.vertex[mesh.previous(h)]];
    return std::atan2(length(cross(in, out)), dot(in, out));
}

/// How sharp a vertex is by the edges that meet there: while a third of them is sharp it stays.
std::vector<float> sharpness_by_edges(const Topology& t) {
    std::vector<std::array<float, 3>> sharpest(t.vertex_count(), {0, 0, 0});
    const auto add = [&](uint32_t vertex, float sharpness) {
        std::array<float, 3>& three = sharpest[vertex];
        for (float& s : three)
            if (sharpness > s) std::swap(s, sharpness);
    };
    for (uint32_t e = 0; e < t.edge_count(); ++e) {
        const uint32_t h = t.edge_half[e];
        const float sharpness = t.twin[h] == kNone ? kSharp : t.edge_sharpness[e];
        add(t.vertex[h], sharpness);
        add(t.end(h), sharpness);
    }
    std::vector<float> third;
    for (const auto& three : sharpest) third.push_back(three[2]);
    return third;
}

}  // namespace

Topology with_corners(Topology mesh, std::span<const vec3> positions, Corners corners) {
    for (uint32_t v = 0; v < mesh.vertex_count() && corners == Corners::sharp; ++v)
        if (mesh.on_boundary(v) && boundary_turn(mesh, positions, v) > kTurn)
            mesh.vertex_sharpness[v] = kSharp;
    return mesh;
}

Result<CreaseSides> crease_sides(const Topology& topology) {
    CreaseSides sides;
    if (std::ranges::none_of(topology.edge_sharpness, [](float s) { return s >= kSharp; }))
        return sides;
    const std::vector<uint32_t> groups = refine::corner_groups(topology, [&](uint32_t h, uint32_t) {
        return topology.edge_sharpness[topology.edge[h]] < kSharp;
    });
    AG_TRY(sides.mesh, refine::cut_by(topology, topology.vertex, groups));
    const std::vector<float> third = sharpness_by_edges(topology);
    std::vector<uint32_t> copies(topology.vertex_count(), 0);
    for (uint32_t v = 0; v < sides.mesh.vertex_count(); ++v) {
        const uint32_t of = topology.vertex[sides.mesh.vertex_half[v]];
        sides.mesh.vertex_sharpness[v] = std::max(sides.mesh.vertex_sharpness[v], third[of]);
        ++copies[of];
    }
    for (const uint32_t count : copies) sides.parted.push_back(count > 1);
    return sides;
}

}  // namespace aglow
