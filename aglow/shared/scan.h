// SPDX-License-Identifier: Apache-2.0
// What the reduction and the prefix sum read and write: vk/reduce.comp, vk/scan.comp,
// vk/compact.comp.
#ifndef AGLOW_SHARED_SCAN_H
#define AGLOW_SHARED_SCAN_H
#include "aglow/shared/buffers.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kScanGroup = 256u;   // invocations
AG_CONST uint kScanRows = 8u;      // values of each
AG_CONST uint kScanBlock = 2048u;  // values of a group

// An array is reached block by block: SPIR-V takes an index as signed, which ends at 2^31.
struct ScanBlock {
    uint at[kScanBlock];
};
AG_BUFFER_OF(ScanBlock);

// What reduce.comp combines, and how.
AG_CONST uint kReduceSum = 0u;
AG_CONST uint kReduceMax = 1u;
AG_CONST uint kReduceMinFloat = 2u;
AG_CONST uint kReduceMaxFloat = 3u;

struct ReduceArgs {
    uint first_group;
    uint count;
    ScanBlockPtr values;  // [count]
    uintPtr results;      // [blocks] one of each block
};

struct ScanArgs {
    uint first_group;
    uint count;
    ScanBlockPtr values;  // [count]
    ScanBlockPtr sums;    // [count] out
    uintPtr carries;      // [blocks] sum of all blocks before; unused with one block
    uintPtr total;        // [1] out: sum of all
};

struct CompactArgs {
    uint first_group;
    uint count;
    ScanBlockPtr flags;  // [count]
    uintPtr kept;        // [blocks] compact_count.comp: out, how many of each block are set;
                         // compact.comp: how many are set before each block
    uintPtr indices;     // [all that are set] out
};

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::ReduceArgs) == 24);
static_assert(sizeof(aglow::shared::ScanArgs) == 40);
static_assert(sizeof(aglow::shared::CompactArgs) == 32);
#endif
#endif
