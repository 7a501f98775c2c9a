// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/scene.h"

namespace aglow::testing {

/// Adds a flat quad, corners counter-clockwise seen from its front.
inline void add_quad(Primitive& primitive, vec3 a, vec3 b, vec3 c, vec3 d) {
    const auto first = static_cast<uint32_t>(primitive.positions.size());
    const vec3 normal = normalize(cross(b - a, c - a));
    for (const vec3 p : {a, b, c, d}) {
        primitive.positions.push_back(p);
        primitive.normals.push_back(normal);
    }
    primitive.triangles.push_back({first, first + 1, first + 2});
    primitive.triangles.push_back({first, first + 2, first + 3});
}

}  // namespace aglow::testing
