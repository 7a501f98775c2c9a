// SPDX-License-Identifier: Apache-2.0
// A tree of boxes, eight children to a node, as rays read it.
//
// Source: Ylitie, Karras & Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
// Wide BVHs", HPG 2017. The boxes of a node's children are eight-bit offsets on a grid of its own
// whose cells are powers of two; the children that are nodes lie in a row, and so do the triangles
// of those that are leaves. A child's place in the node says where it lies as seen from the middle,
// so that a ray visits them by its octant without sorting.
#ifndef AGLOW_SHARED_BVH_H
#define AGLOW_SHARED_BVH_H
#include "aglow/shared/ray.h"
#ifdef __cplusplus
#include <bit>
#endif
AG_NAMESPACE_BEGIN

AG_CONST uint kBvhWidth = 8u;
AG_CONST uint kBvhLeafSize = 3u;  // triangles in a leaf at most
// Nodes on the longest way from the root at most, which bounds a ray's stack. The builder falls
// back on trees of less and less quality to keep it: see bvh_collapse.h.
AG_CONST uint kBvhMaxDepth = 24u;

// 80 bytes. Planes have one byte for each child: that of slot i < 4 is byte i of .x, the others of
// .y.
struct BvhNode {
    vec3 origin;         // lower corner of the grid
    uint exponents;      // cell edge of axis k is 2^(byte k - 127)
    uint child_base;     // the i-th slot that is a node is node child_base + i
    uint triangle_base;  // the i-th triangle in a leaf is triangle triangle_base + i
    uint slots;          // bit 3 i + k: slot i is a leaf with a triangle k; 24 + i: it is a node
    uint unused;         // rows of 16 bytes make wide loads
    uvec2 lower_x, upper_x, lower_y, upper_y, lower_z, upper_z;
};

// 48 bytes, of which a ray reads the first 40; multiples of 16 make wide loads.
struct BvhTriangle {
    vec3 a, b, c;
    uint triangle;  // among those the structure was built over
    uint absent;    // 1: not usable, and moved to one point, which nothing hits
    uint unused;
};

AG_BUFFER_OF(BvhNode);
AG_BUFFER_OF(BvhTriangle);

struct BvhHeader {
    BvhNodePtr nodes;  // node 0 is the root
    BvhTrianglePtr triangles;
    Bounds box;  // of all
    uint node_count;
    uint triangle_count;
};
AG_BUFFER_OF(BvhHeader);

// The bits of a float and back.
#ifdef __cplusplus
inline uint float_bits(float v) { return std::bit_cast<uint>(v); }
inline float bits_float(uint v) { return std::bit_cast<float>(v); }
#else
uint float_bits(float v) { return floatBitsToUint(v); }
float bits_float(uint v) { return uintBitsToFloat(v); }
#endif

AG_FN Bounds empty_bounds() {
    Bounds box;
    box.lower.x = box.lower.y = box.lower.z = bits_float(0x7f800000u);
    box.upper.x = box.upper.y = box.upper.z = bits_float(0xff800000u);
    return box;
}

AG_FN Bounds united(Bounds a, Bounds b) {
    Bounds box;
    box.lower = min(a.lower, b.lower);
    box.upper = max(a.upper, b.upper);
    return box;
}

// Whether a corner can be part of a tree: finite, and small enough that the products of a triangle
// test do not overflow.
AG_FN bool usable_corner(vec3 p) {
    float limit = 1.152921504606846976e18f;  // 2^60
    return abs(p.x) <= limit && abs(p.y) <= limit && abs(p.z) <= limit;
}

AG_FN bool usable_triangle(Triangle t) {
    return usable_corner(t.a) && usable_corner(t.b) && usable_corner(t.c);
}

// Holds nothing where the triangle is not usable.
AG_FN Bounds triangle_bounds(Triangle t) {
    Bounds box = empty_bounds();
    if (!usable_triangle(t)) return box;
    box.lower = min(min(t.a, t.b), t.c);
    box.upper = max(max(t.a, t.b), t.c);
    return box;
}

// Half the surface of a box that holds something.
AG_FN float half_area(Bounds box) {
    vec3 d = box.upper - box.lower;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

// Biased exponent of the smallest power of two whose 255-fold is at least `extent`, with some
// units in the last place to spare for the rounding of the offsets.
AG_FN uint grid_exponent(float extent) {
    uint bits = float_bits(extent * (1.00001f / 255.0f));
    uint exponent = (bits >> 23u) + ((bits & 0x7fffffu) != 0u ? 1u : 0u);
    return max(exponent, 27u);  // 2^-100: its inverse and its products stay normal numbers
}

AG_FN float grid_cell(uint exponent) { return bits_float(exponent << 23u); }

// Offsets, in cells, of the planes that enclose a child; 2^-21 of the distance makes up for its
// rounding.
AG_FN uint grid_lower(float plane, float origin, float cell) {
    float cells = (plane - origin) / cell;
    return uint(clamp(floor(cells * 0.9999995f), 0.0f, 255.0f));
}

AG_FN uint grid_upper(float plane, float origin, float cell) {
    float cells = (plane - origin) / cell;
    return uint(clamp(-floor(-cells * 1.0000005f), 0.0f, 255.0f));
}

// The triangles of the leaf in a slot, one bit each.
AG_FN uint leaf_triangles(uint slots, uint slot) { return (slots >> (3u * slot)) & 7u; }

// Whether the slot holds a node.
AG_FN bool is_node_slot(uint slots, uint slot) { return ((slots >> (24u + slot)) & 1u) != 0u; }

// Byte `slot` of the eight in `bytes`.
AG_FN uint slot_byte(uvec2 bytes, uint slot) {
    return ((slot < 4u ? bytes.x : bytes.y) >> (8u * (slot & 3u))) & 255u;
}

AG_FN uvec2 with_slot_byte(uvec2 bytes, uint slot, uint value) {
    uvec2 r = bytes;
    uint shifted = value << (8u * (slot & 3u));
    if (slot < 4u) {
        r.x = r.x | shifted;
    } else {
        r.y = r.y | shifted;
    }
    return r;
}

// The node with its grid laid over `box` and no child in it.
AG_FN BvhNode gridded(BvhNode node, Bounds box) {
    BvhNode r = node;
    bool empty = !(box.lower.x <= box.upper.x);
    r.origin.x = empty ? 0.0f : box.lower.x;
    r.origin.y = empty ? 0.0f : box.lower.y;
    r.origin.z = empty ? 0.0f : box.lower.z;
    uint x = empty ? 27u : grid_exponent(box.upper.x - box.lower.x);
    uint y = empty ? 27u : grid_exponent(box.upper.y - box.lower.y);
    uint z = empty ? 27u : grid_exponent(box.upper.z - box.lower.z);
    r.exponents = x | (y << 8u) | (z << 16u);
    r.lower_x.x = r.lower_x.y = r.lower_y.x = r.lower_y.y = r.lower_z.x = r.lower_z.y = 0u;
    r.upper_x = r.lower_x;
    r.upper_y = r.lower_x;
    r.upper_z = r.lower_x;
    return r;
}

// The node with the box of one more child. One that holds nothing becomes a point.
AG_FN BvhNode with_child_box(BvhNode node, uint slot, Bounds box) {
    BvhNode r = node;
    if (!(box.lower.x <= box.upper.x)) return r;
    float x = grid_cell(node.exponents & 255u);
    float y = grid_cell((node.exponents >> 8u) & 255u);
    float z = grid_cell((node.exponents >> 16u) & 255u);
    r.lower_x = with_slot_byte(r.lower_x, slot, grid_lower(box.lower.x, r.origin.x, x));
    r.lower_y = with_slot_byte(r.lower_y, slot, grid_lower(box.lower.y, r.origin.y, y));
    r.lower_z = with_slot_byte(r.lower_z, slot, grid_lower(box.lower.z, r.origin.z, z));
    r.upper_x = with_slot_byte(r.upper_x, slot, grid_upper(box.upper.x, r.origin.x, x));
    r.upper_y = with_slot_byte(r.upper_y, slot, grid_upper(box.upper.y, r.origin.y, y));
    r.upper_z = with_slot_byte(r.upper_z, slot, grid_upper(box.upper.z, r.origin.z, z));
    return r;
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::BvhNode) == 80);
static_assert(sizeof(aglow::shared::BvhTriangle) == 48);
static_assert(sizeof(aglow::shared::BvhHeader) == 48);
#endif
#endif
