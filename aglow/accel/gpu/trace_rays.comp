// SPDX-License-Identifier: Apache-2.0
// Rays from a buffer, one invocation each: nearest hits, or whether anything is hit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

layout(constant_id = 0) const uint kKinds = 7u;
layout(constant_id = 1) const uint kAnyHit = 0u;
layout(constant_id = 2) const uint kCounting = 0u;

uint steps = 0u;
uint tests = 0u;

#define AG_KINDS kKinds
#define AG_COUNT_STEPS \
    if (kCounting != 0u) ++steps
#define AG_COUNT_TRIANGLES \
    if (kCounting != 0u) ++tests
#include "aglow/accel/gpu/trace.glsl"

layout(local_size_x = kTraceGroupSize) in;
layout(push_constant, scalar) uniform Push { TraceRaysArgs args; };

void main() {
    uint i = global_index();
    if (i < args.ray_count) {
        RayHit hit = trace(args.scene, args.rays.at[i], kAnyHit != 0u);
        if (kAnyHit != 0u)
            args.blocked.at[i] = hit.triangle != kNoTriangle ? 1u : 0u;
        else
            args.hits.at[i] = hit;
    }
    if (kCounting != 0u) {
        uint step_sum = subgroupAdd(steps);
        uint test_sum = subgroupAdd(tests);
        if (subgroupElect()) {
            atomicAdd(args.counts.at[0].steps, step_sum);
            atomicAdd(args.counts.at[0].triangles, test_sum);
        }
    }
}
