// SPDX-License-Identifier: Apache-2.0
// What the tests draw: corners in clip space, three for each triangle.
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/drawing.glsl"

struct DrawnArgs {
    vec4Ptr corners;  // x, y, depth, brightness
    vec4 color;       // multiplied by its alpha
    vec2 step;        // that each instance is further on
};
layout(push_constant, scalar) uniform Push { DrawnArgs args; };
