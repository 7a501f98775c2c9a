// SPDX-License-Identifier: Apache-2.0
// What vk/segmented_bounds.comp and its two helpers read and write.
#ifndef AGLOW_SHARED_SEGMENTED_BOUNDS_H
#define AGLOW_SHARED_SEGMENTED_BOUNDS_H
#include "aglow/shared/ray.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kBoundsGroup = 256u;  // invocations
AG_CONST uint kBoundsRun = 16u;     // boxes of each

// A box as six minima, of `lower` and of -`upper`, in unsigned integers of the same order as the
// floats: atomics combine them, and in any order to the same bits.
struct Minima {
    uvec3 lower, upper;
};
AG_BUFFER_OF(Minima);

// The minima of nothing: +inf in that order.
AG_CONST uint kNoMinimum = 0xff800000u;

struct SegmentedBoundsArgs {
    uint first_group;
    uint count;
    uint segment_count;
    BoundsPtr boxes;   // [count]
    uintPtr starts;    // [segment_count + 1]
    MinimaPtr minima;  // [segment_count] the boxes of the segments are made here ...
    BoundsPtr bounds;  // [segment_count] ... and decoded in the same place
};

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::Minima) == sizeof(aglow::shared::Bounds));
static_assert(offsetof(aglow::shared::SegmentedBoundsArgs, boxes) == 16);
#endif
#endif
