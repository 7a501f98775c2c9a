// SPDX-License-Identifier: Apache-2.0
// TA: the vertices opposite the triangle's edges come with it, the rest is fetched from memory.
#version 460
#extension GL_GOOGLE_include_directive : require
const uint kInputStep = 2u;
layout(triangles_adjacency) in;
#include "aglow/refine/gpu/geometry/loop.glsl"

vec3 across(uint edge) { return gl_in[2u * edge + 1u].gl_Position.xyz; }

vec3 neighbour(uint corner, uint start, uint k) {
    uint n = valence(corner), steps = k >= start ? k - start : k + n - start;
    bool wraps = !is_open(corner);
    if (steps == 0u) return corner_point((corner + 1u) % 3u);
    if (steps == 1u) return corner_point((corner + 2u) % 3u);
    if (steps == 2u && (wraps || k > start)) return across((corner + 2u) % 3u);
    if (steps + 1u == n && (wraps || k < start)) return across(corner);
    return stored_neighbour(corner, k);
}

void main() { refine_triangle(); }
