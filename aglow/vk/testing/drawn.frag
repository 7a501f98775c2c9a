// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/testing/drawn.glsl"

layout(constant_id = 0) const uint kGain = 1u;
layout(location = 0) in float brightness;
layout(location = 0) out vec4 color;

void main() { color = args.color * (brightness * kGain); }
