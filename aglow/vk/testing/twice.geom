// SPDX-License-Identifier: Apache-2.0
// Every triangle, and the same with its brightness doubled; both are captured.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/testing/drawn.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 6) out;
layout(location = 0) in float brightness[];
layout(location = 0, xfb_buffer = 0, xfb_stride = 16, xfb_offset = 0) out vec4 corner;

void main() {
    for (int copy = 0; copy < 2; ++copy) {
        for (int i = 0; i < 3; ++i) {
            corner = vec4(gl_in[i].gl_Position.xyz, brightness[i] * (copy + 1));
            gl_Position = gl_in[i].gl_Position;
            EmitVertex();
        }
        EndPrimitive();
    }
}
