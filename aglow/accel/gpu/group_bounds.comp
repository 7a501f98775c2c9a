// SPDX-License-Identifier: Apache-2.0
// Bounding box of a run of triangles per workgroup. Triangles that are not finite count for
// nothing: no ray hits them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

#include "aglow/shared/structure.h"

layout(local_size_x = kBoundsGroupSize) in;
layout(push_constant, scalar) uniform Push { GroupBoundsArgs args; };

shared vec3 lowers[kBoundsGroupSize];
shared vec3 uppers[kBoundsGroupSize];

bool is_finite(vec3 p) { return !any(isnan(p)) && !any(isinf(p)); }

void main() {
    uint group = group_index();
    uvec2 run = args.runs.at[group];
    uint lane = gl_LocalInvocationID.x;
    vec3 lower = vec3(uintBitsToFloat(0x7f800000u));
    vec3 upper = -lower;
    for (uint i = lane; i < run.y; i += kBoundsGroupSize) {
        Triangle t = args.triangles.at[run.x + i];
        if (!is_finite(t.a) || !is_finite(t.b) || !is_finite(t.c)) continue;
        lower = min(lower, min(t.a, min(t.b, t.c)));
        upper = max(upper, max(t.a, max(t.b, t.c)));
    }
    lowers[lane] = lower;
    uppers[lane] = upper;
    for (uint half_size = kBoundsGroupSize / 2u; half_size > 0u; half_size /= 2u) {
        barrier();
        if (lane < half_size) {
            lowers[lane] = min(lowers[lane], lowers[lane + half_size]);
            uppers[lane] = max(uppers[lane], uppers[lane + half_size]);
        }
    }
    if (lane == 0u) args.boxes.at[group] = Bounds(lowers[0], uppers[0]);
}
