// SPDX-License-Identifier: Apache-2.0
// Combines each block of values to one. Floats are compared as unsigned integers of the same
// order, so that -0 < +0 and denormals count on every device alike.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/scan.h"

layout(constant_id = 0) const uint kReduction = kReduceSum;
const bool kFloats = kReduction >= kReduceMinFloat;
const uint kIdentity = kReduction == kReduceMinFloat ? 0xff800000u    // +inf in the order of floats
                       : kReduction == kReduceMaxFloat ? 0x007fffffu  // -inf
                                                       : 0u;

layout(local_size_x = kScanGroup) in;
layout(push_constant, scalar) uniform Push { ReduceArgs args; };

shared uint partial[kScanGroup];  // one of each subgroup

uint ordered(uint bits) { return (bits >> 31) != 0u ? ~bits : bits | 0x80000000u; }
uint from_ordered(uint key) { return (key >> 31) != 0u ? key & 0x7fffffffu : ~key; }

uint combine(uint a, uint b) {
    return kReduction == kReduceSum ? a + b : kReduction == kReduceMinFloat ? min(a, b) : max(a, b);
}

uint combine_subgroup(uint value) {
    return kReduction == kReduceSum        ? subgroupAdd(value)
           : kReduction == kReduceMinFloat ? subgroupMin(value)
                                           : subgroupMax(value);
}

void main() {
    uint block = group_index();
    uint value = kIdentity;
    for (uint row = 0u; row < kScanRows; ++row) {
        uint i = row * kScanGroup + gl_LocalInvocationID.x;
        if (block * kScanBlock + i >= args.count) break;
        uint bits = args.values.at[block].at[i];
        value = combine(value, kFloats ? ordered(bits) : bits);
    }
    value = combine_subgroup(value);
    if (subgroupElect()) partial[gl_SubgroupID] = value;
    barrier();
    if (gl_SubgroupID != 0u) return;
    uint width = kScanGroup / gl_NumSubgroups;
    value = kIdentity;
    for (uint s = gl_SubgroupInvocationID; s < gl_NumSubgroups; s += width)
        value = combine(value, partial[s]);
    value = combine_subgroup(value);
    if (subgroupElect()) args.results.at[block] = kFloats ? from_ordered(value) : value;
}
