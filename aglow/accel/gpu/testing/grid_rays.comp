// SPDX-License-Identifier: Apache-2.0
// Traces rays through one grid, and counts cells and triangle tests of each.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "aglow/vk/kernel.glsl"

#include "aglow/shared/ray.h"
#include "aglow/shared/triangle.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kTwoLevels = 0u;
layout(constant_id = 1) const uint kAny = 0u;

struct GridRaysArgs {
    uint first_group;
    uint count;
    uvec2 header;
    RayQueryPtr rays;
    RayHitPtr hits;
    uvec2Ptr counts;
};
layout(push_constant, scalar) uniform Push { GridRaysArgs args; };

uvec2 counts = uvec2(0u);
#define AG_ACCEPT_HIT(triangle, barycentrics, t) true
#define AG_COUNT_STEPS ++counts.x
#define AG_COUNT_TRIANGLES ++counts.y
#include "aglow/accel/gpu/grid/grid.glsl"
#include "aglow/accel/gpu/grid/grid2.glsl"

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    RayQuery ray = args.rays.at[i];
    RayHit hit = RayHit(ray.far, kNoTriangle, vec2(0.0f));
    if (kTwoLevels != 0u) {
        trace_grid2(args.header, 0u, ray, kAny != 0u, hit);
    } else {
        trace_grid(args.header, 0u, ray, kAny != 0u, hit);
    }
    args.hits.at[i] = hit;
    args.counts.at[i] = counts;
}
