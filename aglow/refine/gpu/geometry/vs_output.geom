// SPDX-License-Identifier: Apache-2.0
// VS_OUTPUT: every corner brings its neighbours along; those that are too many are fetched.
#version 460
#extension GL_GOOGLE_include_directive : require
const uint kInputStep = 1u;
layout(triangles) in;
#include "aglow/refine/gpu/geometry/loop.glsl"

layout(location = 2) in vec3 neighbours[][kNeighboursPerVertex];

vec3 neighbour(uint corner, uint start, uint k) {
    if (k < kNeighboursPerVertex) return neighbours[corner][k];
    return stored_neighbour(corner, k);
}

void main() { refine_triangle(); }
