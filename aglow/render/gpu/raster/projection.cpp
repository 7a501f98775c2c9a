// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/projection.h"

#include <algorithm>

namespace aglow::render::gpu {
namespace {

// Of the size of what is drawn. Floating-point depths that fall from 1 are as fine as positions
// are at any distance, so that it may be small.
constexpr float kNear = 1e-5f;
constexpr float kFar = 4;  // likewise, for what moves out of its bounds

vec3 corner(const Box& box, int i) {
    return {i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z};
}

vec4 row(vec3 direction, float offset) { return {direction.x, direction.y, direction.z, offset}; }

}  // namespace

vec4 Projection::clip(vec3 p) const {
    const vec3 d = p - eye;
    const vec4 place{d.x, d.y, d.z, 1};
    return {dot(rows[0], place), dot(rows[1], place), dot(rows[2], place), dot(rows[3], place)};
}

bool Projection::may_see(const Box& box) const {
    std::array<int, 6> outside{};
    for (int i = 0; i < 8; ++i) {
        const vec4 p = clip(corner(box, i));
        outside[0] += p.x > p.w;
        outside[1] += p.x < -p.w;
        outside[2] += p.y > p.w;
        outside[3] += p.y < -p.w;
        outside[4] += p.z > p.w;
        outside[5] += p.z < 0;
    }
    return std::none_of(outside.begin(), outside.end(), [](int count) { return count == 8; });
}

Projection projection_of(const View& view, const Box& bounds) {
    const shared::CameraView camera = view.shared_view();
    const shared::Affine& to_world = camera.to_world;
    Projection projection{to_world.t, {}};
    projection.rows[0] = row(to_world.x * (1 / view.half_width), 0);
    projection.rows[1] = row(to_world.y * (1 / view.half_height), 0);
    const float size =
        bounds.empty() ? 1 : std::max(length(bounds.size()), length(bounds.center()) * 1e-6f);
    if (view.perspective) {
        projection.rows[2] = {0, 0, 0, size * kNear};
        projection.rows[3] = row(-to_world.z, 0);
    } else {
        const float far =
            kFar * (size + (bounds.empty() ? 0 : length(bounds.center() - to_world.t)));
        projection.rows[2] = row(to_world.z * (1 / far), 1);
        projection.rows[3] = {0, 0, 0, 1};
    }
    return projection;
}

Box transformed(const mat4& to_world, const Box& box) {
    Box result;
    if (box.empty()) return result;
    for (int i = 0; i < 8; ++i) result.add(transform_point(to_world, corner(box, i)));
    return result;
}

}  // namespace aglow::render::gpu
