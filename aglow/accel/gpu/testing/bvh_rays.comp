// SPDX-License-Identifier: Apache-2.0
// Rays from a buffer against one tree, counting the work they cause; or against every triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/structure.h"

layout(constant_id = 0) const uint kAnyHit = 0u;
layout(constant_id = 1) const uint kCounting = 0u;
layout(constant_id = 2) const uint kEveryTriangle = 0u;

uint steps = 0u;
uint tests = 0u;
#define AG_ACCEPT_HIT(triangle, barycentrics, t) true
#define AG_COUNT_STEPS \
    if (kCounting != 0u) ++steps
#define AG_COUNT_TRIANGLES \
    if (kCounting != 0u) ++tests
#include "aglow/accel/gpu/bvh/bvh.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    uint first_group;
    uint ray_count;
    uvec2 header;
    RayQueryPtr rays;
    RayHitPtr hits;
    TraceCountsPtr counts;
}
args;

void try_every_triangle(RayQuery ray, inout RayHit hit) {
    BvhHeader header = BvhHeaderPtr(args.header).at[0];
    ShearedRay sheared = sheared_ray(ray.origin, ray.direction);
    for (uint k = 0u; k < header.triangle_count; ++k) {
        BvhTriangle t = header.triangles.at[k];
        TriangleHit found = intersect_triangle(sheared, Triangle(t.a, t.b, t.c), ray.near, hit.t);
        if (found.hit != 0u) hit = RayHit(found.t, t.triangle, found.barycentrics);
    }
}

void main() {
    uint i = global_index();
    if (i < args.ray_count) {
        RayQuery ray = args.rays.at[i];
        RayHit hit = RayHit(ray.far, kNoTriangle, vec2(0.0f));
        if (kEveryTriangle != 0u) {
            try_every_triangle(ray, hit);
        } else {
            trace_bvh(args.header, 0u, ray, kAnyHit != 0u, hit);
        }
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
