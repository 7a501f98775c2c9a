// SPDX-License-Identifier: Apache-2.0
// Rays through a tree of quantised boxes: see shared/bvh.h. Included by accel/gpu/trace.glsl.
//
// One turn of the loop visits a node and tests the triangles it holds on the way of the ray. The
// children to visit later are one entry on the stack, so the stack is as long as the tree is deep.
#ifndef AGLOW_ACCEL_GPU_BVH_GLSL
#define AGLOW_ACCEL_GPU_BVH_GLSL
#extension GL_EXT_buffer_reference_uvec2 : require
#include "aglow/accel/gpu/bvh/bvh_rows.glsl"
#include "aglow/shared/bvh.h"
#include "aglow/shared/triangle.h"

// A ray made ready for boxes. `t` of a box counts in lengths of the direction's largest component.
struct BvhRay {
    vec3 origin;
    vec3 inverse;   // of the direction, whose largest component is 1; finite
    vec3 margin;    // that boxes are grown by, in t
    float scale;    // t of a box for t = 1 of the ray
    uint octant;    // bit k: runs towards smaller coordinates on axis k
};

// Boxes are grown by 2^-19 of the greatest distance between the origin and a point of the tree, 32
// units of rounding in relation to it. That covers the rounding of the box test (the distance to
// the grid's corner, the reciprocal, the products and their sum: 9 units), and the 8 units by which
// the sheared corners of shared/triangle.h may lie off, so that a ray which the triangle test takes
// to hit is never kept from it. A component below 2^-40 of the largest counts as that: over the
// size of the tree it moves the ray by far less than the margin.
BvhRay bvh_ray(RayQuery ray, Bounds box) {
    BvhRay r;
    r.origin = ray.origin;
    vec3 size = abs(ray.direction);
    r.scale = max(size.x, max(size.y, size.z));
    vec3 direction = ray.direction / r.scale;
    const float kTiny = 9.094947e-13f;  // 2^-40
    bvec3 negative = lessThan(direction, vec3(0.0f));
    vec3 speed = max(abs(direction), vec3(kTiny));
    r.inverse = mix(vec3(1.0f), vec3(-1.0f), negative) / speed;
    r.octant = (negative.x ? 1u : 0u) | (negative.y ? 2u : 0u) | (negative.z ? 4u : 0u);
    vec3 reach = max(abs(box.lower - ray.origin), abs(box.upper - ray.origin));
    r.margin = abs(r.inverse) * (max(reach.x, max(reach.y, reach.z)) * 1.9073486e-6f);
    return r;
}

// Which of four children the ray meets, bit k for the k-th. The arguments named after axes have
// their near and far planes.
uint met_boxes(uint near_x, uint far_x, uint near_y, uint far_y, uint near_z, uint far_z,
               vec3 step, vec3 start, vec3 end, float near, float far) {
    uint met = 0u;
    // Bytes become floats by way of int, for which processors have an instruction.
#define AG_MEET(k)                                                                           \
    {                                                                                        \
        vec3 a = vec3(ivec3((uvec3(near_x, near_y, near_z) >> (8 * k)) & 255u)) * step + start; \
        vec3 b = vec3(ivec3((uvec3(far_x, far_y, far_z) >> (8 * k)) & 255u)) * step + end;      \
        bool meets = max(max(a.x, a.y), max(a.z, near)) <= min(min(b.x, b.y), min(b.z, far)); \
        met |= meets ? 1u << k : 0u;                                                         \
    }
    AG_MEET(0)
    AG_MEET(1)
    AG_MEET(2)
    AG_MEET(3)
#undef AG_MEET
    return met;
}

// Bit s of the low eight becomes bits 3 s to 3 s + 2.
uint tripled_bits(uint slots) {
    uint r = slots & 255u;
    r = (r | (r << 8u)) & 0x00f00fu;
    r = (r | (r << 4u)) & 0x0c30c3u;
    r = (r | (r << 2u)) & 0x249249u;
    return r | (r << 1u) | (r << 2u);
}

// Moves bit s of the low eight to bit s ^ octant: slots in the order in which the ray meets them.
uint octant_order(uint slots, uint octant) {
    uint r = slots;
    r = (octant & 1u) != 0u ? ((r & 0x55u) << 1u) | ((r >> 1u) & 0x55u) : r;
    r = (octant & 2u) != 0u ? ((r & 0x33u) << 2u) | ((r >> 2u) & 0x33u) : r;
    return (octant & 4u) != 0u ? ((r & 0x0fu) << 4u) | ((r >> 4u) & 0x0fu) : r;
}

void trace_bvh(uvec2 header_address, uint first_triangle, RayQuery query, bool any,
               inout RayHit hit) {
    BvhHeader header = BvhHeaderPtr(header_address).at[0];
    if (header.node_count == 0u) return;
    BvhRowPtr nodes = BvhRowPtr(header.nodes);
    BvhRowPtr triangles = BvhRowPtr(header.triangles);

    BvhRay ray = bvh_ray(query, header.box);
    ShearedRay sheared = sheared_ray(query.origin, query.direction);
    float near = query.near * ray.scale;

    // Nodes yet to visit: .x is the first child of their parent, .y has the parent's slots that are
    // nodes (low byte) and, in the ray's order, those to visit (next byte).
    uvec2 stack[kBvhMaxDepth];
    uint height = 0u;
    uvec2 group = uvec2(0u, 1u | (0x100u << ray.octant));  // slot 0: the root

    while (true) {
        if (group.y < 0x100u) {
            if (height == 0u) break;
            --height;
            group = stack[height];
        }
        uint place = uint(findLSB(group.y >> 8u));
        group.y &= ~(0x100u << place);
        uint slot = place ^ ray.octant;
        uint index = group.x + uint(bitCount(group.y & ((1u << slot) - 1u) & 0xffu));
        if (group.y >= 0x100u) {
            stack[height] = group;
            ++height;
        }

        AG_COUNT_STEPS;
        uint row = index * 5u;
        uvec4 head = row_words(nodes.at[row]);
        uvec4 tail = row_words(nodes.at[row + 1u]);
        uvec4 planes_x = row_words(nodes.at[row + 2u]);
        uvec4 planes_y = row_words(nodes.at[row + 3u]);
        uvec4 planes_z = row_words(nodes.at[row + 4u]);
        vec3 cell = uintBitsToFloat((uvec3(head.w, head.w >> 8u, head.w >> 16u) & 255u) << 23u);
        vec3 step = cell * ray.inverse;
        vec3 corner = (uintBitsToFloat(head.xyz) - ray.origin) * ray.inverse;
        vec3 start = corner - ray.margin;
        vec3 end = corner + ray.margin;
        float far = hit.t * ray.scale;
        bvec3 negative = lessThan(ray.inverse, vec3(0.0f));
        uvec4 x = negative.x ? planes_x.zwxy : planes_x;
        uvec4 y = negative.y ? planes_y.zwxy : planes_y;
        uvec4 z = negative.z ? planes_z.zwxy : planes_z;
        uint met = met_boxes(x.x, x.z, y.x, y.z, z.x, z.z, step, start, end, near, far) |
                   met_boxes(x.y, x.w, y.y, y.w, z.y, z.w, step, start, end, near, far) << 4u;

        uint inner = tail.z >> 24u;
        group = uvec2(tail.x, inner | (octant_order(met & inner, ray.octant) << 8u));
        // Triangles to test: .x is the first of the node, .y has a bit for each, .z for all that the
        // node has.
        uvec3 leaves = uvec3(tail.y, tail.z & tripled_bits(met), tail.z);

        while (leaves.y != 0u) {
            uint k = uint(findLSB(leaves.y));
            leaves.y &= leaves.y - 1u;
            AG_COUNT_TRIANGLES;
            uint row = (leaves.x + uint(bitCount(leaves.z & ((1u << k) - 1u)))) * 3u;
            uvec4 u = row_words(triangles.at[row]);
            uvec4 v = row_words(triangles.at[row + 1u]);
            uvec2 w = unpackUint2x32(triangles.at[row + 2u].x);
            Triangle triangle;
            triangle.a = uintBitsToFloat(u.xyz);
            triangle.b = uintBitsToFloat(uvec3(u.w, v.xy));
            triangle.c = uintBitsToFloat(uvec3(v.zw, w.x));
            uint index = first_triangle + w.y;
            TriangleHit found = intersect_triangle(sheared, triangle, query.near, hit.t);
            if (found.hit != 0u &&
                AG_ACCEPT_HIT(index, found.barycentrics, found.t)) {
                hit.t = found.t;
                hit.triangle = index;
                hit.barycentrics = found.barycentrics;
                if (any) return;
            }
        }
    }
}

#endif
