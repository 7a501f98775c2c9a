// SPDX-License-Identifier: Apache-2.0
// Which share of light passes along the shadow rays in the queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

#include "aglow/render/gpu/alpha_test.glsl"

#define AG_ACCEPT_HIT(triangle, barycentrics, t) \
    (kAlpha == 0u || opacity_at(triangle, barycentrics) > 0.0f)
#define AG_KINDS kKinds
#include "aglow/accel/gpu/trace.glsl"

// Blended surfaces one behind the other let the product of their shares pass. They are met nearest
// first, because structures may test a triangle more than once.
float passing_share(RayQuery ray) {
    if (kAlpha == 0u) return occluded(args.structure, ray) ? 0.0f : 1.0f;
    float share = 1.0f;
    while (share > 0.0f) {
        RayHit hit = intersect(args.structure, ray);
        if (hit.triangle == kNoTriangle) return share;
        share *= 1.0f - opacity_at(hit.triangle, hit.barycentrics);
        ray.near = hit.t;
    }
    return share;
}

void main() {
    uint i = global_index();
    if (i >= args.wavefront.at[0].shadow_queued.at[0]) return;
    uint shadow = args.wavefront.at[0].shadow_queue.at[i];
    args.wavefront.at[0].visibility.at[shadow] =
        passing_share(args.wavefront.at[0].shadow_rays.at[shadow]);
}
