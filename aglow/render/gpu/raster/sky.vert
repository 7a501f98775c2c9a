// SPDX-License-Identifier: Apache-2.0
// One triangle over all of the picture, infinitely far away.
#version 460

void main() {
    vec2 place = vec2(gl_VertexIndex == 1 ? 3.0f : -1.0f, gl_VertexIndex == 2 ? 3.0f : -1.0f);
    gl_Position = vec4(place, 0.0f, 1.0f);
}
