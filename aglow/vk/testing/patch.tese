// SPDX-License-Identifier: Apache-2.0
#version 460
layout(triangles, equal_spacing, ccw) in;
layout(location = 0) in float control_brightness[];
layout(location = 0) out float brightness;

void main() {
    vec3 w = gl_TessCoord;
    gl_Position = gl_in[0].gl_Position * w.x + gl_in[1].gl_Position * w.y +
                  gl_in[2].gl_Position * w.z;
    brightness = control_brightness[0] * w.x + control_brightness[1] * w.y +
                 control_brightness[2] * w.z;
}
