// SPDX-License-Identifier: Apache-2.0
// How many flags of each block are set.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/scan.glsl"

layout(push_constant, scalar) uniform Push { CompactArgs args; };

void main() {
    uint block = group_index();
    uint kept = 0u;
    for (uint row = 0u; row < kScanRows; ++row) {
        uint i = scan_index(row);
        bool keep = block * kScanBlock + i < args.count && args.flags.at[block].at[i] != 0u;
        kept += keep ? 1u : 0u;
    }
    kept = subgroupAdd(kept);
    uint earlier = sum_of_earlier_subgroups(kept);
    if (gl_SubgroupID == gl_NumSubgroups - 1u && subgroupElect())
        args.kept.at[block] = earlier + kept;
}
