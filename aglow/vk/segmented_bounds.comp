// SPDX-License-Identifier: Apache-2.0
// Each invocation combines its run of boxes segment by segment, then the lanes of a subgroup hand
// on the segments that they share; what a subgroup shares with others is combined by atomics.
// Source: Sengupta, Harris, Zhang & Owens, "Scan Primitives for GPU Computing", Graphics Hardware
// 2007 (segmented scan); work is divided by boxes alone, so that no segment is too long.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/segmented_bounds.h"

layout(local_size_x = kBoundsGroup) in;
layout(push_constant, scalar) uniform Push { SegmentedBoundsArgs args; };

const uint kNoSegment = 0xffffffffu;
const Minima kNothing = Minima(uvec3(kNoMinimum), uvec3(kNoMinimum));

uvec3 ordered(vec3 v) {
    uvec3 bits = floatBitsToUint(v);
    return mix(bits | 0x80000000u, ~bits, notEqual(bits >> 31, uvec3(0u)));
}

Minima combine(Minima a, Minima b) {
    return Minima(min(a.lower, b.lower), min(a.upper, b.upper));
}

Minima shuffle(Minima m, uint lane) {
    return Minima(subgroupShuffle(m.lower, lane), subgroupShuffle(m.upper, lane));
}

// The last segment that starts at or before box i: the one that holds it. Looks near `first`, which
// starts at or before i, then farther and farther, and last between two bounds.
uint segment_of(uint i, uint first) {
    uint step = 1u;
    while (step < args.segment_count - first && args.starts.at[first + step] <= i) {
        first += step;
        step *= 2u;
    }
    uint end = first + min(step, args.segment_count - first);
    while (end - first > 1u) {
        uint middle = first + (end - first) / 2u;
        if (args.starts.at[middle] <= i) first = middle;
        else end = middle;
    }
    return first;
}

// Adds to a segment of which the subgroup, with boxes begin to end, may hold only a part.
void add(uint segment, Minima m, uint begin, uint end) {
    if (args.starts.at[segment] >= begin && args.starts.at[segment + 1u] <= end) {
        args.minima.at[segment] = m;
        return;
    }
    atomicMin(args.minima.at[segment].lower.x, m.lower.x);
    atomicMin(args.minima.at[segment].lower.y, m.lower.y);
    atomicMin(args.minima.at[segment].lower.z, m.lower.z);
    atomicMin(args.minima.at[segment].upper.x, m.upper.x);
    atomicMin(args.minima.at[segment].upper.y, m.upper.y);
    atomicMin(args.minima.at[segment].upper.z, m.upper.z);
}

void main() {
    uint width = kBoundsGroup / gl_NumSubgroups;
    uint begin = group_index() * kBoundsGroup * kBoundsRun + gl_SubgroupID * width * kBoundsRun;
    uint end = begin + width * kBoundsRun;
    uint i = begin + gl_SubgroupInvocationID * kBoundsRun;
    uint run_end = min(i + kBoundsRun, args.count);

    uint segment = i < run_end ? segment_of(i, 0u) : kNoSegment;
    uint segment_end = i < run_end ? args.starts.at[segment + 1u] : 0u;
    uint first_segment = segment;
    Minima first = kNothing;
    Minima last = kNothing;
    for (; i < run_end; ++i) {
        if (i == segment_end) {
            if (segment == first_segment) first = last;
            else add(segment, last, begin, end);
            segment = segment_of(i, segment + 1u);
            segment_end = args.starts.at[segment + 1u];
            last = kNothing;
        }
        Bounds box = args.boxes.at[i];
        last = combine(last, Minima(ordered(box.lower), ~ordered(box.upper)));
    }

    // Lanes that end in the same segment.
    uint lane = gl_SubgroupInvocationID;
    for (uint step = 1u; step < width; step *= 2u) {
        uint source = max(lane, step) - step;
        uint below = subgroupShuffle(segment, source);
        Minima carried = shuffle(last, source);
        if (below == segment) last = combine(last, carried);
    }
    // Lanes that finish the segment which the lane below ends in, or one of their own.
    uint source = max(lane, 1u) - 1u;
    uint below = subgroupShuffle(segment, source);
    Minima carried = shuffle(last, source);
    if (lane > 0u && below == first_segment) first = combine(first, carried);
    if (first_segment != segment) add(first_segment, first, begin, end);
    // Segments that end with a lane, or with the subgroup.
    uint above = subgroupShuffle(first_segment, min(lane + 1u, width - 1u));
    bool handed_on = lane + 1u < width && above == segment;
    if (segment != kNoSegment && !handed_on) add(segment, last, begin, end);
}
