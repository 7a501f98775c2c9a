// SPDX-License-Identifier: Apache-2.0
// Nodes and triangles in rows of 16 bytes, for wide loads; of two integers each, because lavapipe
// loads and stores component by component, one invocation after the other, and spends most of its
// time there.
#ifndef AGLOW_ACCEL_GPU_BVH_ROWS_GLSL
#define AGLOW_ACCEL_GPU_BVH_ROWS_GLSL
#extension GL_ARB_gpu_shader_int64 : require
#include "aglow/shared/bvh_build.h"

layout(buffer_reference, buffer_reference_align = 16, scalar) readonly buffer BvhRowPtr {
    u64vec2 at[];
};
layout(buffer_reference, buffer_reference_align = 16, scalar) writeonly buffer BvhRowOut {
    u64vec2 at[];
};

uvec4 row_words(u64vec2 row) { return uvec4(unpackUint2x32(row.x), unpackUint2x32(row.y)); }
u64vec2 row_of(uvec4 words) { return u64vec2(packUint2x32(words.xy), packUint2x32(words.zw)); }

Bounds box_of_rows(uvec4 a, uvec2 b) {
    Bounds box;
    box.lower = uintBitsToFloat(a.xyz);
    box.upper = uintBitsToFloat(uvec3(a.w, b));
    return box;
}

// Of a binary node: its box, and its children.
Bounds box_of(BinaryNodePtr nodes, uint i) {
    BvhRowPtr rows = BvhRowPtr(nodes);
    return box_of_rows(row_words(rows.at[2u * i]), unpackUint2x32(rows.at[2u * i + 1u].x));
}
uvec2 children_of(BinaryNodePtr nodes, uint i) {
    return unpackUint2x32(BvhRowPtr(nodes).at[2u * i + 1u].y);
}

#endif
