// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu/geometry/fans.h"

#include <cmath>
#include <numbers>

namespace aglow::refine::gpu {
namespace {

/// cf(n): how far an averaged vertex of valence n is moved on.
float correction(uint32_t n) {
    const double beta = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n);
    return static_cast<float>(5.0 / 3 - 8.0 / 3 * beta * beta);
}

/// Appends the fan of v, and tells its corners where in it they start.
void add_fan(const Topology& mesh, std::span<const uint32_t> points, uint32_t v, LoopFans& to) {
    const uint32_t first = mesh.vertex_half[v];
    uint32_t h = first, place = 0;
    do {
        to.fans.push_back(points[mesh.end(h)]);
        to.starts[h] = place++;
        const uint32_t previous = mesh.previous(h);
        h = mesh.twin[previous];
        if (h == kNone) to.fans.push_back(points[mesh.vertex[previous]]);
    } while (h != kNone && h != first);
}

}  // namespace

LoopFans loop_fans(const Topology& mesh, std::span<const uint32_t> points) {
    LoopFans result;
    result.vertices.resize(mesh.vertex_count());
    result.starts.resize(mesh.half_edge_count());
    for (uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        if (mesh.vertex_half[v] == kNone) continue;
        shared::LoopVertex& vertex = result.vertices[v];
        vertex.point = points[v];
        vertex.first = static_cast<uint32_t>(result.fans.size());
        add_fan(mesh, points, v, result);
        vertex.count = static_cast<uint32_t>(result.fans.size()) - vertex.first;
        vertex.kind = mesh.on_boundary(v) ? shared::kLoopBoundary : shared::kLoopSmooth;
        if (mesh.vertex_sharpness[v] >= kSharp) vertex.kind |= shared::kLoopCorner;
        vertex.correction = correction(vertex.count);
    }
    return result;
}

std::vector<uint32_t> loop_indices(const Topology& mesh, bool adjacency) {
    if (!adjacency) return mesh.vertex;
    std::vector<uint32_t> indices;
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h) {
        const uint32_t twin = mesh.twin[h];
        indices.push_back(mesh.vertex[h]);
        indices.push_back(mesh.vertex[twin == kNone ? h : mesh.previous(twin)]);
    }
    return indices;
}

}  // namespace aglow::refine::gpu
