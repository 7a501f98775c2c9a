// SPDX-License-Identifier: Apache-2.0
// Adds the length of a queue to the rays traced so far.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(constant_id = 0) const uint kShadowRays = 0u;

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

uvec2 sum_of(uvec2 total, uint more) {
    uint low = total.x + more;
    return uvec2(low, total.y + (low < more ? 1u : 0u));
}

void main() {
    RayCountsPtr counts = args.frame.at[0].counts;
    if (kShadowRays != 0u)
        counts.at[0].shadow =
            sum_of(counts.at[0].shadow, args.wavefront.at[0].shadow_queued.at[0]);
    else if (args.depth > 0u)
        counts.at[0].mirror = sum_of(counts.at[0].mirror, args.wavefront.at[0].queued.at[0]);
    else
        counts.at[0].camera = sum_of(counts.at[0].camera, args.wavefront.at[0].queued.at[0]);
}
