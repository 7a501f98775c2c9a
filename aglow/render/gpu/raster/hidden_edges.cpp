// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/hidden_edges.h"

#include "aglow/core/parallel.h"

#include <algorithm>

namespace aglow::render::gpu {
namespace {

constexpr size_t kGrain = 2048;
constexpr float kAway = -0.35f;  // sine of 20 degrees

/// The planes through the sides of a picture.
class Sides {
public:
    explicit Sides(const Projection& projection) : eye_(projection.eye) {
        for (size_t i = 0; i < 4; ++i) {
            const vec4 across = projection.rows[i / 2] * (i % 2 == 0 ? -1.0f : 1.0f);
            const vec4 plane = projection.rows[3] + across;
            planes_[i] = plane * (1 / length(vec3{plane.x, plane.y, plane.z}));
        }
    }
    /// Bit i: the point is farther than `reach` beyond side i.
    uint32_t beyond(vec3 p, float reach) const {
        const vec3 d = p - eye_;
        uint32_t bits = 0;
        for (size_t i = 0; i < 4; ++i)
            bits |= dot(planes_[i], vec4{d.x, d.y, d.z, 1}) < -reach ? 1u << i : 0u;
        return bits;
    }

private:
    vec3 eye_;
    std::array<vec4, 4> planes_;
};

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
                                  std::span<const uint8_t> one_sided, std::span<const float> reach,
                                  const Projection& projection) {
    const Sides sides(projection);
    std::vector<uint8_t> hidden_face(topology.face_count());
    parallel_for(hidden_face.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const uint32_t first = topology.face_begin[f];
            const float moved = reach.empty() ? 0 : reach[f];
            uint32_t beyond = 15;
            bool away = one_sided[f] != 0 && moved == 0;
            vec3 corner[3], corners = {0, 0, 0}, points = {0, 0, 0};
            for (uint32_t i = 0; i < 3; ++i) {
                const uint32_t v = topology.vertex[first + i];
                const shared::EdgePoints& edge = control.edges[topology.edge[first + i]];
                corner[i] = control.positions[v];
                corners += corner[i];
                points += edge.first + edge.second;
                beyond &= sides.beyond(corner[i], moved);
                if (beyond != 0)
                    beyond &= sides.beyond(edge.first, moved) & sides.beyond(edge.second, moved);
                away = away && towards(projection, corner[i], control.directions[v]) < kAway;
            }
            const vec3 middle = shared::patch_center(corners, points);
            if (beyond != 0) beyond &= sides.beyond(middle, moved);
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
