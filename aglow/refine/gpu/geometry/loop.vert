// SPDX-License-Identifier: Apache-2.0
// A vertex and what is known of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/refine/gpu/geometry/vertex.glsl"

layout(location = 0) out uvec3 fan;  // first, count, kind
layout(location = 1) out float correction;

void main() {
    LoopVertex vertex = args.vertices.at[gl_VertexIndex];
    gl_Position = vec4(args.points.at[vertex.point], 1.0f);
    fan = uvec3(vertex.first, vertex.count, vertex.kind);
    correction = vertex.correction;
}
