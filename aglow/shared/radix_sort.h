// SPDX-License-Identifier: Apache-2.0
// What one pass of the radix sort reads and writes: vk/radix_count.comp, vk/radix_scatter.comp.
#ifndef AGLOW_SHARED_RADIX_SORT_H
#define AGLOW_SHARED_RADIX_SORT_H
#include "aglow/shared/buffers.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kRadixDigitBits = 8u;  // of the widest digit
AG_CONST uint kRadixDigits = 256u;
AG_CONST uint kRadixRuns = 8u;     // subgroups in a group, whatever their size
AG_CONST uint kRadixRun = 512u;    // pairs of a subgroup
AG_CONST uint kRadixTile = 4096u;  // pairs of a group

struct RadixArgs {
    uint first_group;
    uint count;
    uint tile_count;
    uint shift;           // of the digit in the key
    uint digit_bits;      // its width
    uintPtr keys;         // [count]
    uintPtr values;       // [count]
    uintPtr tile_counts;  // [digits][tile_count] radix_count.comp: out, pairs of a digit in a tile;
                          // radix_scatter.comp: where the first of them belongs
    uintPtr run_counts;   // [tile_count][runs][digits] pairs of a digit in earlier runs of a tile
    uintPtr sorted_keys;  // [count] out
    uintPtr sorted_values;  // [count] out
};

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::RadixArgs) == 72);
#endif
#endif
