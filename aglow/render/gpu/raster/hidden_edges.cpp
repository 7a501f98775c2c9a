// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/hidden_edges.h"

#include "aglow/core/parallel.h"

#include <algorithm>

namespace aglow::render::gpu {
namespace {

constexpr size_t kGrain = 2048;
constexpr float kAway = -0.35f;  // sine of 20 degrees

/// Bit i: the point is beyond side i of the picture.
uint32_t sides_beyond(const Projection& projection, vec3 p) {
    const vec4 q = projection.clip(p);
    return (q.x > q.w ? 1u : 0u) | (q.x < -q.w ? 2u : 0u) | (q.y > q.w ? 4u : 0u) |
           (q.y < -q.w ? 8u : 0u);
}

/// Sine of the angle by which a surface at `p` turns to the viewer.
float towards(const Projection& projection, vec3 p, vec3 normal) {
    const vec4 forward = projection.rows[3];
    const bool perspective = forward.x != 0 || forward.y != 0 || forward.z != 0;
    const vec4 depth = projection.rows[2];
    const vec3 eye = perspective ? projection.eye - p : vec3{depth.x, depth.y, depth.z};
    const float size = length(eye) * length(normal);
    return size > 0 ? dot(eye, normal) / size : 0;
}

}  // namespace

std::vector<uint8_t> hidden_edges(const Topology& topology, const PatchControl& control,
                                  std::span<const uint8_t> one_sided,
                                  const Projection& projection) {
    std::vector<uint8_t> at_vertex(topology.vertex_count()), at_edge(topology.edge_count());
    parallel_for(at_vertex.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t v = begin; v < end; ++v)
            at_vertex[v] = static_cast<uint8_t>(sides_beyond(projection, control.positions[v]));
    });
    parallel_for(at_edge.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e)
            at_edge[e] = static_cast<uint8_t>(sides_beyond(projection, control.edges[e].first) &
                                              sides_beyond(projection, control.edges[e].second));
    });
    std::vector<uint8_t> hidden_face(topology.face_count());
    parallel_for(hidden_face.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const uint32_t first = topology.face_begin[f];
            uint32_t beyond = 15;
            bool away = one_sided[f] != 0;
            vec3 corner[3], corners = {0, 0, 0}, points = {0, 0, 0};
            for (uint32_t i = 0; i < 3; ++i) {
                const uint32_t v = topology.vertex[first + i], e = topology.edge[first + i];
                corner[i] = control.positions[v];
                corners += corner[i];
                points += control.edges[e].first + control.edges[e].second;
                beyond &= at_vertex[v] & at_edge[e];
                away = away && towards(projection, corner[i], control.directions[v]) < kAway;
            }
            const vec3 middle = shared::patch_center(corners, points);
            beyond &= sides_beyond(projection, middle);
            away = away && towards(projection, middle,
                                   cross(corner[1] - corner[0], corner[2] - corner[0])) < kAway;
            hidden_face[f] = beyond != 0 || away ? 1 : 0;
        }
    });
    std::vector<uint8_t> hidden(topology.edge_count());
    parallel_for(hidden.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e) {
            const uint32_t h = topology.edge_half[e], twin = topology.twin[h];
            hidden[e] = hidden_face[topology.face[h]] &
                        (twin == kNone ? uint8_t{1} : hidden_face[topology.face[twin]]);
        }
    });
    return hidden;
}

}  // namespace aglow::render::gpu
