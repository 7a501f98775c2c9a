// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/testing/drawn.glsl"

layout(location = 0) out float brightness;

void main() {
    vec4 corner = args.corners.at[gl_VertexIndex];
    gl_Position = vec4(corner.xy + args.step * gl_InstanceIndex, corner.z, 1.0f);
    brightness = corner.w;
}
