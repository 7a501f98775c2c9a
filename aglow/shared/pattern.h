// SPDX-License-Identifier: Apache-2.0
// Where the vertices of a refinement pattern are, on faces whose edges have levels of their own.
//
// A pattern has `segments` along each edge. Vertices on an edge snap to those that the edge's own
// level gives it, inner ones stay, so that every edge is refined alike from both of its sides and
// triangles between vertices that snap to one place vanish.
//
// Levels are discrete (whole numbers of segments) or continuous. Continuous ones refine by powers
// of two: of level 5 an edge has 8 segments, whose vertices are a quarter of the way from where 4
// would have them; patterns and edges alike, so that all places are continuous in the levels.
#ifndef AGLOW_SHARED_PATTERN_H
#define AGLOW_SHARED_PATTERN_H
#include "aglow/shared/buffers.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kInsidePattern = 4u;  // edge of a vertex that is on none

// Of PatchLevels::continuous: all edges have the pattern's segments, whatever `edge` says.
AG_CONST uint kUniformLevels = 2u;

// Of one face. 24 bytes.
struct PatchLevels {
    float edge[4];    // segments, 1 .. those of the pattern; edge i leaves corner i
    float inner;      // 0: inner vertices are where half the pattern's segments have them .. 1
    uint continuous;  // 1: as said above; or kUniformLevels
};
AG_BUFFER_OF(PatchLevels);

// A place on a polygon: on an edge at parameter t, in the direction that all of the edge's faces
// take; and the coordinates there.
struct PatternPoint {
    uint edge;  // leaves the corner of this number; kInsidePattern: inside
    float t;
    float x, y;  // as in Pattern::coordinates
};

// Segments of an edge of this level.
AG_FN uint edge_segments(float level, uint continuous) {
    uint whole = uint(level);
    uint needed = float(whole) < level ? whole + 1u : whole;
    if (continuous == 0u) return needed;
    uint power = 1u;
    for (int i = 0; i < 8; ++i) power = power < needed ? power * 2u : power;
    return power;
}

// How far vertices of a continuous level have come, from 0, half the segments, to 1, all of them.
AG_FN float level_weight(float level, uint segments) {
    return segments > 1u ? 2.0f * level / float(segments) - 1.0f : 1.0f;
}

// The vertex of an edge of `to` segments for vertex k of `from`, to <= from: the nearest, and of
// two that towards the nearer end. Of continuous levels, both powers of two, the next towards the
// nearer end, which is the same in one step as in several.
AG_FN uint snapped(uint k, uint from, uint to, uint continuous) {
    uint twice = 2u * k * to;
    bool near_start = 2u * k < from;
    if (continuous != 0u) return (near_start ? twice : twice + 2u * from - 1u) / (2u * from);
    return (near_start ? twice + from - 1u : twice + from) / (2u * from);
}

// Where vertex i of the edge's own segments lies. 0 and 1 at the ends, exactly.
AG_FN float edge_parameter(uint i, float level, uint continuous) {
    uint segments = edge_segments(level, continuous);
    float t = float(i) / float(segments);
    if (i == 0u || i >= segments || continuous == 0u) return t;
    uint coarse = segments / 2u;
    float from = float(snapped(i, segments, coarse, 1u)) / float(coarse);
    return mix(from, t, level_weight(level, segments));
}

AG_FN bool inside_triangle(uint i, uint j, uint segments) {
    return i > 0u && j > 0u && i + j < segments;
}

AG_FN bool inside_quad(uint i, uint j, uint segments) {
    return i > 0u && j > 0u && i < segments && j < segments;
}

AG_FN uvec2 pattern_steps(uint i, uint j) {
    uvec2 r;
    r.x = i;
    r.y = j;
    return r;
}

// Where inner vertex (i, j) of a pattern of even `segments` comes from: a vertex of the pattern
// with half as many, in steps of the finer. Those that it has stay; the others lie between two of
// them and come from one, inside if there is one inside.
AG_FN uvec2 coarser_triangle_vertex(uint i, uint j, uint segments) {
    uint k = segments - i - j;
    bool odd_i = (i & 1u) == 1u;
    bool odd_j = (j & 1u) == 1u;
    bool odd_k = (k & 1u) == 1u;
    if (odd_i && odd_j)
        return inside_triangle(i - 1u, j + 1u, segments) ? pattern_steps(i - 1u, j + 1u)
                                                         : pattern_steps(i + 1u, j - 1u);
    if (odd_j && odd_k)
        return inside_triangle(i, j - 1u, segments) ? pattern_steps(i, j - 1u)
                                                    : pattern_steps(i, j + 1u);
    if (odd_k && odd_i)
        return inside_triangle(i + 1u, j, segments) ? pattern_steps(i + 1u, j)
                                                    : pattern_steps(i - 1u, j);
    return pattern_steps(i, j);
}

AG_FN uvec2 coarser_quad_vertex(uint i, uint j, uint segments) {
    uint up_i = i == 1u && segments > 2u ? 2u : i - (i & 1u);
    uint up_j = j == 1u && segments > 2u ? 2u : j - (j & 1u);
    return pattern_steps(up_i, up_j);
}

// t of a pattern's vertex k along an edge; bit `edge` of `reversed` says that the edge's direction
// is against the polygon's.
AG_FN float pattern_edge_parameter(uint k, uint segments, PatchLevels levels, uint edge,
                                   uint reversed) {
    uint along = ((reversed >> edge) & 1u) != 0u ? segments - k : k;
    if (levels.continuous == kUniformLevels) return float(along) / float(segments);
    float level = levels.edge[edge];
    uint own = edge_segments(level, levels.continuous);
    return edge_parameter(snapped(along, segments, own, levels.continuous), level,
                          levels.continuous);
}

// A vertex inside a pattern, on its way from `coarser`, that of half the segments.
AG_FN PatternPoint inner_pattern_point(uint i, uint j, uint segments, vec2 coarser, float inner) {
    PatternPoint r;
    r.edge = kInsidePattern;
    r.t = 0.0f;
    r.x = mix(coarser.x, float(i) / float(segments), inner);
    r.y = mix(coarser.y, float(j) / float(segments), inner);
    return r;
}

// Vertex (i, j) on an edge of a triangle's pattern.
AG_FN PatternPoint triangle_edge_point(uint i, uint j, uint segments, PatchLevels levels,
                                       uint reversed) {
    PatternPoint r;
    r.edge = j == 0u ? 0u : i == 0u ? 2u : 1u;
    uint k = r.edge == 0u ? i : r.edge == 1u ? j : segments - j;
    r.t = pattern_edge_parameter(k, segments, levels, r.edge, reversed);
    float along = ((reversed >> r.edge) & 1u) != 0u ? 1.0f - r.t : r.t;
    r.x = r.edge == 0u ? along : r.edge == 1u ? 1.0f - along : 0.0f;
    r.y = r.edge == 0u ? 0.0f : r.edge == 1u ? along : 1.0f - along;
    return r;
}

// Vertex (i, j) of a triangle's pattern: i steps towards corner 1, j towards corner 2.
AG_FN PatternPoint triangle_pattern_point(uint i, uint j, uint segments, PatchLevels levels,
                                          uint reversed) {
    if (!inside_triangle(i, j, segments))
        return triangle_edge_point(i, j, segments, levels, reversed);
    vec2 coarser;
    coarser.x = 0.0f;
    coarser.y = 0.0f;
    if (levels.inner < 1.0f) {
        uvec2 steps = coarser_triangle_vertex(i, j, segments);
        coarser.x = float(steps.x) / float(segments);
        coarser.y = float(steps.y) / float(segments);
        if (!inside_triangle(steps.x, steps.y, segments)) {
            PatternPoint on_edge =
                triangle_edge_point(steps.x / 2u, steps.y / 2u, segments / 2u, levels, reversed);
            coarser.x = on_edge.x;
            coarser.y = on_edge.y;
        }
    }
    return inner_pattern_point(i, j, segments, coarser, levels.inner);
}

// Vertex (i, j) on an edge of a quad's pattern.
AG_FN PatternPoint quad_edge_point(uint i, uint j, uint segments, PatchLevels levels,
                                   uint reversed) {
    PatternPoint r;
    r.edge = j == 0u ? 0u : i == segments ? 1u : j == segments ? 2u : 3u;
    uint k = r.edge == 0u ? i : r.edge == 1u ? j : r.edge == 2u ? segments - i : segments - j;
    r.t = pattern_edge_parameter(k, segments, levels, r.edge, reversed);
    float along = ((reversed >> r.edge) & 1u) != 0u ? 1.0f - r.t : r.t;
    r.x = r.edge == 0u ? along : r.edge == 1u ? 1.0f : r.edge == 2u ? 1.0f - along : 0.0f;
    r.y = r.edge == 0u ? 0.0f : r.edge == 1u ? along : r.edge == 2u ? 1.0f : 1.0f - along;
    return r;
}

// Vertex (i, j) of a quad's pattern: i steps from corner 0 towards 1, j towards 3.
AG_FN PatternPoint quad_pattern_point(uint i, uint j, uint segments, PatchLevels levels,
                                      uint reversed) {
    if (!inside_quad(i, j, segments)) return quad_edge_point(i, j, segments, levels, reversed);
    uvec2 steps = coarser_quad_vertex(i, j, segments);
    vec2 coarser;
    coarser.x = float(steps.x) / float(segments);
    coarser.y = float(steps.y) / float(segments);
    if (levels.inner < 1.0f && !inside_quad(steps.x, steps.y, segments)) {
        PatternPoint on_edge =
            quad_edge_point(steps.x / 2u, steps.y / 2u, segments / 2u, levels, reversed);
        coarser.x = on_edge.x;
        coarser.y = on_edge.y;
    }
    return inner_pattern_point(i, j, segments, coarser, levels.inner);
}

// A parameter of an edge drawn towards the end with the greater density. 0 and 1 stay.
AG_FN float dense_parameter(float t, float density_a, float density_b) {
    float s = (1.0f - t) * density_a;
    float r = t * density_b;
    return r / (s + r);
}

// Coordinates on a triangle likewise, by the densities at its corners: on its edges what
// dense_parameter() says. Straight lines stay straight, so that nothing folds.
AG_FN vec2 dense_coordinates(vec2 at, vec3 densities) {
    float u = (1.0f - at.x - at.y) * densities.x;
    float v = at.x * densities.y;
    float w = at.y * densities.z;
    vec2 r;
    float sum = u + v + w;
    r.x = v / sum;
    r.y = w / sum;
    return r;
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::PatchLevels) == 24);
#endif
#endif
