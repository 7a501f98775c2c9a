// SPDX-License-Identifier: Apache-2.0
// How a group walks over one block of values: each subgroup takes a run of its own, row by row.
#ifndef AGLOW_VK_SCAN_GLSL
#define AGLOW_VK_SCAN_GLSL
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/scan.h"

layout(local_size_x = kScanGroup) in;

shared uint subgroup_sums[kScanGroup];

// Place in the block of this invocation's value in `row`.
uint scan_index(uint row) {
    uint width = kScanGroup / gl_NumSubgroups;
    return (gl_SubgroupID * kScanRows + row) * width + gl_SubgroupInvocationID;
}

// The sum of `sum` over all earlier subgroups, given the sum of each. Holds one barrier.
uint sum_of_earlier_subgroups(uint sum) {
    if (subgroupElect()) subgroup_sums[gl_SubgroupID] = sum;
    barrier();
    uint earlier = 0u;
    uint width = kScanGroup / gl_NumSubgroups;
    for (uint s = gl_SubgroupInvocationID; s < gl_SubgroupID; s += width)
        earlier += subgroup_sums[s];
    return subgroupAdd(earlier);
}
#endif
