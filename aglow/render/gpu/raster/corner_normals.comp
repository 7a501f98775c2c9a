// SPDX-License-Identifier: Apache-2.0
// Normals at the corners of coarse faces: the file's where it has any, else means of those of the
// faces round the vertex, weighted by angle, as corner_normals() of refine/patches.h makes them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/mesh/gpu/triangle_normal.glsl"

struct CornerNormalArgs {
    uint first_group;
    uint count;
    vec3Ptr positions;  // of the surfaces
    vec3Ptr normals;    // likewise
    uintPtr source;     // [count] vertex of the surfaces that has the normal
    uintPtr begin;      // [count + 1] in `wedges`; none: the file has a normal
    uvec3Ptr wedges;    // vertices of the surfaces: of a corner, of the next and of the one before
    vec3Ptr to;         // [count]
};
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CornerNormalArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    uint begin = args.begin.at[i];
    uint end = args.begin.at[i + 1u];
    vec3 normal = args.normals.at[args.source.at[i]];
    vec3 sum = vec3(0.0f);
    for (uint w = begin; w < end; ++w) {
        uvec3 wedge = args.wedges.at[w];
        Triangle t;
        t.a = args.positions.at[wedge.x];
        t.b = args.positions.at[wedge.y];
        t.c = args.positions.at[wedge.z];
        vec3 next = t.b - t.a;
        vec3 before = t.c - t.a;
        sum += triangle_normal(t) * atan(length(cross(next, before)), dot(next, before));
    }
    float norm = length(sum);
    args.to.at[i] = norm > 0.0f ? sum / norm : normal;
}
