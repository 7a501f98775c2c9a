// SPDX-License-Identifier: Apache-2.0
// What the shaders of engine `raster` start with.
#include "aglow/vk/drawing.glsl"
#include "aglow/shared/raster.h"

layout(push_constant, scalar) uniform Push { RasterArgs args; };

// The face that is drawn as number `place`.
uint face_at(uint place) { return args.ordered != 0u ? args.order.at[place] : place; }

vec4 clip_position(vec3 p) {
    RasterFramePtr frame = args.frame;
    vec4 q = vec4(p - frame.at[0].view.to_world.t, 1.0f);
    return vec4(dot(frame.at[0].clip_x, q), dot(frame.at[0].clip_y, q),
                dot(frame.at[0].clip_z, q), dot(frame.at[0].clip_w, q));
}
