// SPDX-License-Identifier: Apache-2.0
// Rays against everything in a TraceScene, whatever structures it is made of.
//
//   RayHit intersect(TraceScenePtr scene, RayQuery ray)   the nearest hit
//   bool occluded(TraceScenePtr scene, RayQuery ray)      whether anything is hit
//
// Before it includes this file, a shader may define
//   #define AG_ACCEPT_HIT(triangle, barycentrics, t) ...  a bool: false lets the ray pass, for
//                                                         triangles whose texture has holes
//   #define AG_KINDS k                                    which kinds may occur, a constant with
//                                                         bit 1 << kStructure... set for each
//   #define AG_COUNT_STEPS / AG_COUNT_TRIANGLES           statements that count work
// Each kind brings, in accel/gpu/<family>/<kind>.glsl, with the ray in the structure's space,
//   void trace_<kind>(uvec2 header, uint first_triangle, RayQuery ray, bool any, inout RayHit hit)
// which lowers hit to the nearest accepted triangle with ray.near < t < hit.t, or returns at the
// first one where `any` is true.
#ifndef AGLOW_ACCEL_GPU_TRACE_GLSL
#define AGLOW_ACCEL_GPU_TRACE_GLSL
#extension GL_EXT_buffer_reference_uvec2 : require
#include "aglow/shared/structure.h"
#include "aglow/shared/triangle.h"

#ifndef AG_KINDS
#define AG_KINDS ((1u << kStructureKindCount) - 1u)
#endif
#ifndef AG_ACCEPT_HIT
#define AG_ACCEPT_HIT(triangle, barycentrics, t) true
#endif
#ifndef AG_COUNT_STEPS
#define AG_COUNT_STEPS
#endif
#ifndef AG_COUNT_TRIANGLES
#define AG_COUNT_TRIANGLES
#endif

#include "aglow/accel/gpu/bvh/bvh.glsl"
#include "aglow/accel/gpu/grid/grid.glsl"
#include "aglow/accel/gpu/grid/grid2.glsl"

// Whether an instance is of kind k; a constant where AG_KINDS leaves no choice.
#define AG_IS_KIND(instance, k) \
    ((AG_KINDS & (1u << k)) != 0u && (AG_KINDS == (1u << k) || instance.kind == k))

// The direction keeps the length that the transform gives it, so that t means the same in every
// space.
void trace_instance(Instance instance, RayQuery ray, bool any, inout RayHit hit) {
    RayQuery local = ray;
    local.origin = transform_point(instance.to_local, ray.origin);
    local.direction = transform_direction(instance.to_local, ray.direction);
    if (AG_IS_KIND(instance, kStructureGrid))
        trace_grid(instance.header, instance.first_triangle, local, any, hit);
    if (AG_IS_KIND(instance, kStructureGrid2))
        trace_grid2(instance.header, instance.first_triangle, local, any, hit);
    if (AG_IS_KIND(instance, kStructureBvh))
        trace_bvh(instance.header, instance.first_triangle, local, any, hit);
}

// One over each component; a zero becomes so small a number that a slab it is parallel to is
// crossed far outside of any scene, and 0 * inf = NaN cannot come up.
vec3 top_inverse(vec3 direction) {
    const float kTiny = 1e-30f;
    vec3 d = mix(direction, vec3(kTiny), lessThan(abs(direction), vec3(kTiny)));
    return 1.0f / d;
}

// Where the ray enters the box; above `far` where it misses it. The exit is widened by twice the
// rounding of the three products: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013.
float top_entry(Bounds box, vec3 origin, vec3 inverse, float near, float far) {
    vec3 a = (box.lower - origin) * inverse;
    vec3 b = (box.upper - origin) * inverse;
    vec3 low = min(a, b);
    vec3 high = max(a, b);
    float entry = max(max(low.x, low.y), max(low.z, near));
    float leave = min(min(high.x, high.y), high.z) * (1.0f + 1e-6f);
    return entry <= min(leave, far) ? entry : uintBitsToFloat(0x7f800000u);
}

RayHit trace(TraceScenePtr scene, RayQuery ray, bool any) {
    const float kMiss = uintBitsToFloat(0x7f800000u);
    TraceScene world = scene.at[0];
    RayHit hit = RayHit(ray.far, kNoTriangle, vec2(0.0f));
    uint instance = 0u;
    uint nodes[kTopDepth + 1u];  // that wait, nearest on top
    float entries[kTopDepth + 1u];
    uint waiting = 0u;
    vec3 inverse = top_inverse(ray.direction);
    if (world.instance_count > 1u) {
        nodes[0] = 0u;
        entries[0] = ray.near;
        waiting = 1u;
    }

    bool walking = world.instance_count > 0u;
    while (walking) {
        bool found = world.instance_count == 1u;
        while (!found && waiting > 0u) {
            --waiting;
            if (entries[waiting] > hit.t) continue;
            TopNode node = world.nodes.at[nodes[waiting]];
            AG_COUNT_STEPS;
            if (node.count != 0u) {
                instance = node.child;
                found = true;
                break;
            }
            uint near_child = node.child;
            uint far_child = node.child + 1u;
            float near_entry = top_entry(world.nodes.at[near_child].box, ray.origin, inverse,
                                         ray.near, hit.t);
            float far_entry = top_entry(world.nodes.at[far_child].box, ray.origin, inverse,
                                        ray.near, hit.t);
            if (far_entry < near_entry) {
                uint child = near_child;
                near_child = far_child;
                far_child = child;
                float entry = near_entry;
                near_entry = far_entry;
                far_entry = entry;
            }
            if (far_entry != kMiss) {
                nodes[waiting] = far_child;
                entries[waiting] = far_entry;
                ++waiting;
            }
            if (near_entry != kMiss) {
                nodes[waiting] = near_child;
                entries[waiting] = near_entry;
                ++waiting;
            }
        }
        if (found) trace_instance(world.instances.at[instance], ray, any, hit);
        walking = found && waiting > 0u && !(any && hit.triangle != kNoTriangle);
    }
    return hit;
}

RayHit intersect(TraceScenePtr scene, RayQuery ray) { return trace(scene, ray, false); }

bool occluded(TraceScenePtr scene, RayQuery ray) {
    return trace(scene, ray, true).triangle != kNoTriangle;
}

#endif
