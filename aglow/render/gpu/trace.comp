// SPDX-License-Identifier: Apache-2.0
// What the rays of the paths in the queue hit first.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

#include "aglow/render/gpu/alpha_test.glsl"

// A blended surface is hit with a probability of its alpha.
bool accepts(uint triangle, vec2 barycentrics) {
    float alpha = opacity_at(triangle, barycentrics);
    return alpha >= 1.0f ||
           ray_hash(args.scene.at[0].source_of.at[triangle], floatBitsToUint(traced.origin),
                    floatBitsToUint(traced.direction)) < alpha;
}
#define AG_ACCEPT_HIT(triangle, barycentrics, t) (kAlpha == 0u || accepts(triangle, barycentrics))
#define AG_KINDS kKinds
#include "aglow/accel/gpu/trace.glsl"

void main() {
    uint i = global_index();
    if (i >= args.wavefront.at[0].queued.at[0]) return;
    uint path = args.wavefront.at[0].queue.at[i];
    traced = args.wavefront.at[0].rays.at[path];
    args.wavefront.at[0].hits.at[path] = intersect(args.structure, traced);
}
