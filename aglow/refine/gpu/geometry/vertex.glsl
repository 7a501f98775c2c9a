// SPDX-License-Identifier: Apache-2.0
// What vertices bring to the geometry stage.
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/drawing.glsl"
#include "aglow/shared/geometry_loop.h"

layout(push_constant, scalar) uniform Push { LoopArgs args; };
