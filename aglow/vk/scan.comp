// SPDX-License-Identifier: Apache-2.0
// Exclusive prefix sums of each block, on top of the sum of all blocks before it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/scan.glsl"

layout(push_constant, scalar) uniform Push { ScanArgs args; };

void main() {
    uint block = group_index();
    uint prefix[kScanRows];
    uint sum = 0u;  // of the subgroup's rows
    for (uint row = 0u; row < kScanRows; ++row) {
        uint i = scan_index(row);
        uint value = block * kScanBlock + i < args.count ? args.values.at[block].at[i] : 0u;
        prefix[row] = sum + subgroupExclusiveAdd(value);
        sum += subgroupAdd(value);
    }
    uint before = sum_of_earlier_subgroups(sum);
    if (args.count > kScanBlock) before += args.carries.at[block];
    for (uint row = 0u; row < kScanRows; ++row) {
        uint i = scan_index(row);
        if (block * kScanBlock + i < args.count) args.sums.at[block].at[i] = before + prefix[row];
    }
    bool last_block = block == (args.count - min(args.count, 1u)) / kScanBlock;
    if (last_block && gl_SubgroupID == gl_NumSubgroups - 1u && subgroupElect())
        args.total.at[0] = before + sum;
}
