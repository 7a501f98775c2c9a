// SPDX-License-Identifier: Apache-2.0
#version 460
layout(vertices = 3) out;
layout(location = 0) in float brightness[];
layout(location = 0) out float control_brightness[];

void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    control_brightness[gl_InvocationID] = brightness[gl_InvocationID];
    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 4.0f;
    gl_TessLevelInner[0] = 4.0f;
}
