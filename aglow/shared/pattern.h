// SPDX-License-Identifier: Apache-2.0
// Where the vertices of a refinement pattern are, on faces whose edges have levels of their own.
//
// A pattern has `segments` along each edge. Vertices on an edge snap to those that the edge's own
// level gives it, inner ones stay, so that every edge is refined alike from both of its sides and
// triangles between vertices that snap to one place vanish. A level is a real number: between two
// whole ones vertices are on their way from the coarser places to the finer.
#ifndef AGLOW_SHARED_PATTERN_H
#define AGLOW_SHARED_PATTERN_H
#include "aglow/shared/buffers.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kInsidePattern = 4u;  // edge of a vertex that is on none

// Of one face. 20 bytes.
struct PatchLevels {
    float edge[4];  // segments, 1 .. those of the pattern; edge i leaves corner i
    float inner;    // 0: inner vertices have half the pattern's segments .. 1: all of them
};
AG_BUFFER_OF(PatchLevels);

// A place on a polygon: on an edge at parameter t, in the direction that all of the edge's faces
// take; and the coordinates there.
struct PatternPoint {
    uint edge;  // leaves the corner of this number; kInsidePattern: inside
    float t;
    float x, y;  // as in Pattern::coordinates
};

// The nearest of 0 .. to for k of `from`, to <= from; between two, that towards the nearer end.
AG_FN uint snapped(uint k, uint from, uint to) {
    uint tie = 2u * k < from ? from - 1u : from;
    return (2u * k * to + tie) / (2u * from);
}

// Segments of an edge of this level.
AG_FN uint edge_segments(float level) {
    uint whole = uint(level);
    return float(whole) < level ? whole + 1u : whole;
}

// Where vertex i of the edge's own segments lies. 0 and 1 at the ends, exactly.
AG_FN float edge_parameter(uint i, float level) {
    uint fine = edge_segments(level);
    float t = float(i) / float(fine);
    if (i == 0u || i >= fine || float(fine) == level) return t;
    uint coarse = fine - 1u;
    float from = float(snapped(i, fine, coarse)) / float(coarse);
    return mix(from, t, level - float(coarse));
}

// Where inner vertex (i, j) of a pattern of even `segments` comes from: a vertex of the pattern
// with half as many, in steps of the finer. Even ones stay; the others lie between two and go to
// one.
AG_FN uvec2 coarser_triangle_vertex(uint i, uint j, uint segments) {
    uint k = segments - i - j;
    uint odd_i = i & 1u;
    uint odd_j = j & 1u;
    uint odd_k = k & 1u;
    uvec2 r;
    r.x = i;
    r.y = j;
    if (odd_i == 1u && odd_j == 1u) {
        r.x = i - 1u;
        r.y = j + 1u;
    } else if (odd_j == 1u && odd_k == 1u) {
        r.y = j - 1u;
    } else if (odd_k == 1u && odd_i == 1u) {
        r.x = i + 1u;
    }
    return r;
}

AG_FN PatternPoint inner_pattern_point(uint i, uint j, uvec2 coarser, uint segments, float inner) {
    float n = float(segments);
    PatternPoint r;
    r.edge = kInsidePattern;
    r.t = 0.0f;
    r.x = float(i) / n;
    r.y = float(j) / n;
    if (inner < 1.0f) {
        r.x = mix(float(coarser.x) / n, r.x, inner);
        r.y = mix(float(coarser.y) / n, r.y, inner);
    }
    return r;
}

// t of a pattern's vertex k along an edge; bit `edge` of `reversed` says that the edge's direction
// is against the polygon's.
AG_FN float pattern_edge_parameter(uint k, uint segments, float level, uint edge, uint reversed) {
    uint along = ((reversed >> edge) & 1u) != 0u ? segments - k : k;
    return edge_parameter(snapped(along, segments, edge_segments(level)), level);
}

// Vertex (i, j) of a triangle's pattern: i steps towards corner 1, j towards corner 2.
AG_FN PatternPoint triangle_pattern_point(uint i, uint j, uint segments, PatchLevels levels,
                                          uint reversed) {
    if (i > 0u && j > 0u && i + j < segments)
        return inner_pattern_point(i, j, coarser_triangle_vertex(i, j, segments), segments,
                                   levels.inner);
    PatternPoint r;
    r.edge = j == 0u ? 0u : i == 0u ? 2u : 1u;
    uint k = r.edge == 0u ? i : r.edge == 1u ? j : segments - j;
    float level = levels.edge[r.edge];
    r.t = pattern_edge_parameter(k, segments, level, r.edge, reversed);
    float along = ((reversed >> r.edge) & 1u) != 0u ? 1.0f - r.t : r.t;
    r.x = r.edge == 0u ? along : r.edge == 1u ? 1.0f - along : 0.0f;
    r.y = r.edge == 0u ? 0.0f : r.edge == 1u ? along : 1.0f - along;
    return r;
}

// Vertex (i, j) of a quad's pattern: i steps from corner 0 towards 1, j towards 3.
AG_FN PatternPoint quad_pattern_point(uint i, uint j, uint segments, PatchLevels levels,
                                      uint reversed) {
    if (i > 0u && j > 0u && i < segments && j < segments) {
        uvec2 coarser;
        coarser.x = i - (i & 1u);
        coarser.y = j - (j & 1u);
        return inner_pattern_point(i, j, coarser, segments, levels.inner);
    }
    PatternPoint r;
    r.edge = j == 0u ? 0u : i == segments ? 1u : j == segments ? 2u : 3u;
    uint k = r.edge == 0u ? i : r.edge == 1u ? j : r.edge == 2u ? segments - i : segments - j;
    float level = levels.edge[r.edge];
    r.t = pattern_edge_parameter(k, segments, level, r.edge, reversed);
    float along = ((reversed >> r.edge) & 1u) != 0u ? 1.0f - r.t : r.t;
    r.x = r.edge == 0u ? along : r.edge == 1u ? 1.0f : r.edge == 2u ? 1.0f - along : 0.0f;
    r.y = r.edge == 0u ? 0.0f : r.edge == 1u ? along : r.edge == 2u ? 1.0f : 1.0f - along;
    return r;
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::PatchLevels) == 20);
#endif
#endif
