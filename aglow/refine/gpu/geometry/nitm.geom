// SPDX-License-Identifier: Apache-2.0
// NITM: what is not of the triangle itself is fetched from memory.
#version 460
#extension GL_GOOGLE_include_directive : require
const uint kInputStep = 1u;
layout(triangles) in;
#include "aglow/refine/gpu/geometry/loop.glsl"

vec3 neighbour(uint corner, uint start, uint k) {
    if (k == start) return corner_point((corner + 1u) % 3u);
    if (k == start + 1u || k + valence(corner) == start + 1u)
        return corner_point((corner + 2u) % 3u);
    return stored_neighbour(corner, k);
}

void main() { refine_triangle(); }
