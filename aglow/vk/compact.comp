// SPDX-License-Identifier: Apache-2.0
// Writes the indices of the flags that are set behind those of all blocks before.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/scan.glsl"

layout(push_constant, scalar) uniform Push { CompactArgs args; };

const uint kDropped = 0xffffffffu;

void main() {
    uint block = group_index();
    uint place[kScanRows];  // among those the subgroup keeps
    uint kept = 0u;
    for (uint row = 0u; row < kScanRows; ++row) {
        uint i = scan_index(row);
        bool keep = block * kScanBlock + i < args.count && args.flags.at[block].at[i] != 0u;
        uvec4 votes = subgroupBallot(keep);
        place[row] = keep ? kept + subgroupBallotExclusiveBitCount(votes) : kDropped;
        kept += subgroupBallotBitCount(votes);
    }
    uint before = args.kept.at[block] + sum_of_earlier_subgroups(kept);
    for (uint row = 0u; row < kScanRows; ++row)
        if (place[row] != kDropped)
            args.indices.at[before + place[row]] = block * kScanBlock + scan_index(row);
}
