// SPDX-License-Identifier: Apache-2.0
// Sort keys: where the middle of each triangle's box lies along the Morton curve.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_build.glsl"

layout(local_size_x = kBvhGroupSize) in;

void main() {
    uint i = global_index();
    if (i >= args.triangle_count) return;

    uvec3 low = args.counters.at[0].lower;
    uvec3 high = args.counters.at[0].upper;
    vec3 lower = vec3(ordered_float(low.x), ordered_float(low.y), ordered_float(low.z));
    vec3 upper = vec3(ordered_float(high.x), ordered_float(high.y), ordered_float(high.z));
    vec3 extent = upper - lower;

    Bounds box = triangle_bounds(args.triangles.at[i]);
    vec3 middle = box.lower * 0.5f + box.upper * 0.5f;
    bool usable = box.lower.x <= box.upper.x;
    args.keys.at[i] =
        usable ? morton_code(middle, lower, max(extent.x, max(extent.y, extent.z))) : kUnusableKey;
    args.order.at[i] = i;
}
