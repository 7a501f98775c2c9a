// SPDX-License-Identifier: Apache-2.0
// How groups of a mesh shader share the pattern of n segments that is drawn on each face. A pattern
// is cut into tiles of up to 8 segments: the triangles of a coarser pattern, each of which is a
// pattern again. A group makes a tile, or small patterns of several faces.
#ifndef AGLOW_SHARED_PATTERN_GROUP_H
#define AGLOW_SHARED_PATTERN_GROUP_H
#include "aglow/shared/glsl.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kPatternGroup = 64u;    // invocations
AG_CONST uint kGroupTriangles = 64u;  // at most
AG_CONST uint kGroupVertices = 192u;  // at most: 64 faces of one segment
AG_CONST uint kTileSegments = 8u;     // at most

struct PatternGroups {
    uint sides;     // tiles along an edge; sides^2 on a face
    uint segments;  // of a tile; sides * segments may be more than n, what is beyond is folded
    uint tiles;     // of a group
};

AG_FN PatternGroups pattern_groups(uint n) {
    PatternGroups r;
    r.sides = (n + kTileSegments - 1u) / kTileSegments;
    r.segments = (n + r.sides - 1u) / r.sides;
    r.tiles = kGroupTriangles / (r.segments * r.segments);
    return r;
}

// Steps i + (j << 16) of a tile's point, by those of the tile's corners in the coarser pattern.
AG_FN uint tile_steps(uint corner_0, uint corner_1, uint corner_2, uint within, uint segments) {
    // Both halves of a word at once: no sum of theirs is negative or needs more than 16 bits.
    uint i = within & 0xffffu;
    uint j = within >> 16u;
    return corner_0 * (segments - i - j) + corner_1 * i + corner_2 * j;
}

AG_NAMESPACE_END
#endif
