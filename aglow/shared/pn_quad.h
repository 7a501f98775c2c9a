// SPDX-License-Identifier: Apache-2.0
// Quads with the curved edges of PN triangles: Coons patches, which follow all four edges.
//
// Source: Coons, "Surfaces for Computer-Aided Design of Space Forms", MIT, 1967 (the bilinearly
// blended patch).
#ifndef AGLOW_SHARED_PN_QUAD_H
#define AGLOW_SHARED_PN_QUAD_H
#include "aglow/shared/pn_triangle.h"
AG_NAMESPACE_BEGIN

// Corners 0 .. 3, then the inner control points of edges 0-1, 1-2, 2-3, 3-0, each in this
// direction.
struct QuadPoints {
    vec3 p[12];
};

// Normals at the corners, then in the middle of the edges.
struct QuadNormals {
    vec3 n[8];
};

AG_FN vec3 quad_edge(QuadPoints c, int edge, float t) {
    EdgePoints e;
    e.first = c.p[4 + 2 * edge];
    e.second = c.p[5 + 2 * edge];
    return edge_position(c.p[edge], e, c.p[(edge + 1) & 3], t);
}

AG_FN vec3 quad_edge_slope(QuadPoints c, int edge, float t) {
    EdgePoints e;
    e.first = c.p[4 + 2 * edge];
    e.second = c.p[5 + 2 * edge];
    return edge_derivative(c.p[edge], e, c.p[(edge + 1) & 3], t);
}

// x runs from corner 0 to 1, y from 0 to 3.
AG_FN vec3 quad_position(QuadPoints c, float x, float y) {
    vec3 between_0_and_2 = mix(quad_edge(c, 0, x), quad_edge(c, 2, 1.0f - x), y);
    vec3 between_3_and_1 = mix(quad_edge(c, 3, 1.0f - y), quad_edge(c, 1, y), x);
    vec3 corners = mix(mix(c.p[0], c.p[1], x), mix(c.p[3], c.p[2], x), y);
    return between_0_and_2 + (between_3_and_1 - corners);
}

AG_FN vec3 quad_derivative_x(QuadPoints c, float x, float y) {
    vec3 along = mix(quad_edge_slope(c, 0, x), -quad_edge_slope(c, 2, 1.0f - x), y);
    vec3 across = quad_edge(c, 1, y) - quad_edge(c, 3, 1.0f - y);
    return along + (across - mix(c.p[1] - c.p[0], c.p[2] - c.p[3], y));
}

AG_FN vec3 quad_derivative_y(QuadPoints c, float x, float y) {
    vec3 along = mix(-quad_edge_slope(c, 3, 1.0f - y), quad_edge_slope(c, 1, y), x);
    vec3 across = quad_edge(c, 2, 1.0f - x) - quad_edge(c, 0, x);
    return along + (across - mix(c.p[3] - c.p[0], c.p[2] - c.p[1], x));
}

AG_FN vec3 quad_edge_normal(QuadNormals c, int edge, float t) {
    float s = 1.0f - t;
    return c.n[edge] * (s * s) + c.n[4 + edge] * (s * t) + c.n[(edge + 1) & 3] * (t * t);
}

AG_FN vec3 quad_normal(QuadNormals c, float x, float y) {
    vec3 between_0_and_2 = mix(quad_edge_normal(c, 0, x), quad_edge_normal(c, 2, 1.0f - x), y);
    vec3 between_3_and_1 = mix(quad_edge_normal(c, 3, 1.0f - y), quad_edge_normal(c, 1, y), x);
    vec3 corners = mix(mix(c.n[0], c.n[1], x), mix(c.n[3], c.n[2], x), y);
    return unit_or(between_0_and_2 + (between_3_and_1 - corners), c.n[0]);
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::QuadPoints) == 144);
static_assert(sizeof(aglow::shared::QuadNormals) == 96);
#endif
#endif
