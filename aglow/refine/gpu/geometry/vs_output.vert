// SPDX-License-Identifier: Apache-2.0
// A vertex, what is known of it, and the first of its neighbours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/refine/gpu/geometry/vertex.glsl"

layout(location = 0) out uvec3 fan;  // first, count, kind
layout(location = 1) out float correction;
layout(location = 2) out vec3 neighbours[kNeighboursPerVertex];

void main() {
    LoopVertex vertex = args.vertices.at[gl_VertexIndex];
    gl_Position = vec4(args.points.at[vertex.point], 1.0f);
    fan = uvec3(vertex.first, vertex.count, vertex.kind);
    correction = vertex.correction;
    for (uint k = 0u; k < kNeighboursPerVertex; ++k) {
        uint place = vertex.first + min(k, vertex.count - 1u);
        neighbours[k] = args.points.at[args.fans.at[place]];
    }
}
