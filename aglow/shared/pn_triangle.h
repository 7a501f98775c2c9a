// SPDX-License-Identifier: Apache-2.0
// Curved PN triangles: cubic Bezier triangles over the faces of a mesh, from positions and normals.
//
// Everything on an edge follows from data of the edge alone, taken in one direction: from the end
// `a`, the vertex with the lower number, to `b`. Faces that meet there have the same points.
//
// Source: Vlachos, Peters, Boyd & Mitchell, "Curved PN Triangles", I3D 2001. Creases: the tangent
// of an edge whose faces have normals of their own lies in both of their tangent planes.
#ifndef AGLOW_SHARED_PN_TRIANGLE_H
#define AGLOW_SHARED_PN_TRIANGLE_H
#include "aglow/shared/buffers.h"
AG_NAMESPACE_BEGIN

// 1 - cos of the angle between the normals on both sides of an edge: below the first (5 degrees)
// it is smooth, above the second (20 degrees) a crease, and between them a blend of both.
AG_CONST float kSmoothEdge = 0.0038f;
AG_CONST float kCreasedEdge = 0.0603f;

// What an edge is curved by. Unit normals at both ends, of the face to the left of the way from a
// to b and of that to its right: the same where the edge is smooth or only one face is there.
struct PatchEdge {
    vec3 a, b;
    vec3 left_a, left_b;
    vec3 right_a, right_b;
};

// The inner control points of the edge's cubic: the first belongs to a, the second to b.
struct EdgePoints {
    vec3 first, second;
};
AG_BUFFER_OF(EdgePoints);

// Control points of a cubic triangle: corners 0, 1, 2; the points of edges 0-1, 1-2 and 2-0, each
// in this direction; the centre.
struct PatchPoints {
    vec3 p[10];
};

// Normals at the corners, then in the middle of edges 0-1, 1-2, 2-0.
struct PatchNormals {
    vec3 n[6];
};

// `d` without its part along the normals of both sides; a vector of any length may stand for a
// normal. Where the sides differ, what of it lies in both tangent planes.
AG_FN vec3 edge_tangent(vec3 d, vec3 left, vec3 right) {
    vec3 normal = left + right;
    float normal_square = dot(normal, normal);
    vec3 smooth_part = normal_square > 0.0f ? d - normal * (dot(d, normal) / normal_square) : d;
    vec3 axis = cross(left, right);
    float axis_square = dot(axis, axis);
    float crease = (1.0f - dot(left, right) - kSmoothEdge) / (kCreasedEdge - kSmoothEdge);
    if (!(crease > 0.0f)) return smooth_part;
    vec3 crease_part = axis_square > 1e-8f ? axis * (dot(d, axis) / axis_square) : d;
    return mix(smooth_part, crease_part, min(crease, 1.0f));
}

// Tangents of the edge, from either end to the other, that its cubic would have with handles of a
// third of their lengths.
AG_FN EdgePoints edge_tangents(PatchEdge e) {
    EdgePoints t;
    t.first = edge_tangent(e.b - e.a, e.left_a, e.right_a);
    t.second = edge_tangent(e.a - e.b, e.left_b, e.right_b);
    return t;
}

AG_FN EdgePoints pn_edge_points(PatchEdge e) {
    EdgePoints t = edge_tangents(e);
    EdgePoints r;
    r.first = e.a + t.first / 3.0f;
    r.second = e.b + t.second / 3.0f;
    return r;
}

// The centre for which the triangle reproduces every quadratic one: of PN triangles and all others
// here.
AG_FN vec3 patch_center(vec3 corner_sum, vec3 edge_point_sum) {
    return edge_point_sum * 0.25f - corner_sum / 6.0f;
}

AG_FN vec3 edge_position(vec3 a, EdgePoints e, vec3 b, float t) {
    float s = 1.0f - t;
    return a * (s * s * s) + e.first * (3.0f * s * s * t) + e.second * (3.0f * s * t * t) +
           b * (t * t * t);
}

// Derivative by t.
AG_FN vec3 edge_derivative(vec3 a, EdgePoints e, vec3 b, float t) {
    float s = 1.0f - t;
    return (e.first - a) * (3.0f * s * s) + (e.second - e.first) * (6.0f * s * t) +
           (b - e.second) * (3.0f * t * t);
}

// At barycentrics (u, v, w) of corners 0, 1, 2.
AG_FN vec3 patch_position(PatchPoints c, float u, float v, float w) {
    vec3 corners = c.p[0] * (u * u * u) + c.p[1] * (v * v * v) + c.p[2] * (w * w * w);
    vec3 edge_0 = c.p[3] * (u * u * v) + c.p[4] * (u * v * v);
    vec3 edge_1 = c.p[5] * (v * v * w) + c.p[6] * (v * w * w);
    vec3 edge_2 = c.p[7] * (w * w * u) + c.p[8] * (w * u * u);
    return corners + (edge_0 + edge_1 + edge_2) * 3.0f + c.p[9] * (6.0f * u * v * w);
}

// Derivative by v at constant w, u giving way: along edge 0-1.
AG_FN vec3 patch_derivative_v(PatchPoints c, float u, float v, float w) {
    vec3 r =
        (c.p[3] - c.p[0]) * (u * u) + (c.p[1] - c.p[4]) * (v * v) + (c.p[6] - c.p[7]) * (w * w);
    r = r + (c.p[4] - c.p[3]) * (2.0f * u * v) + (c.p[5] - c.p[9]) * (2.0f * v * w) +
        (c.p[9] - c.p[8]) * (2.0f * w * u);
    return r * 3.0f;
}

// Derivative by w at constant v, u giving way: along edge 0-2.
AG_FN vec3 patch_derivative_w(PatchPoints c, float u, float v, float w) {
    vec3 r =
        (c.p[8] - c.p[0]) * (u * u) + (c.p[5] - c.p[4]) * (v * v) + (c.p[2] - c.p[7]) * (w * w);
    r = r + (c.p[9] - c.p[3]) * (2.0f * u * v) + (c.p[6] - c.p[9]) * (2.0f * v * w) +
        (c.p[7] - c.p[8]) * (2.0f * w * u);
    return r * 3.0f;
}

// A vector of length 1, or the fallback where there is no direction.
AG_FN vec3 unit_or(vec3 v, vec3 fallback) {
    float square = dot(v, v);
    return square > 0.0f ? v / sqrt(square) : fallback;
}

// The normal in the middle of an edge whose ends are `d` apart, for quadratic normals: the mean of
// its ends', mirrored at the plane across the edge, so that it sees an inflection between them.
AG_FN vec3 quadratic_middle(vec3 d, vec3 normal_a, vec3 normal_b) {
    vec3 sum = normal_a + normal_b;
    float square = dot(d, d);
    if (!(square > 0.0f)) return unit_or(sum, normal_a);
    return unit_or(sum - d * (2.0f * dot(d, sum) / square), normal_a);
}

// The same for linear normals.
AG_FN vec3 linear_middle(vec3 normal_a, vec3 normal_b) { return normal_a + normal_b; }

AG_FN vec3 edge_normal(vec3 normal_a, vec3 middle, vec3 normal_b, float t) {
    float s = 1.0f - t;
    vec3 n = normal_a * (s * s) + middle * (s * t) + normal_b * (t * t);
    return unit_or(n, normal_a);
}

AG_FN vec3 patch_normal(PatchNormals c, float u, float v, float w) {
    vec3 n = c.n[0] * (u * u) + c.n[1] * (v * v) + c.n[2] * (w * w) + c.n[3] * (u * v) +
             c.n[4] * (v * w) + c.n[5] * (w * u);
    return unit_or(n, c.n[0]);
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::PatchEdge) == 72);
static_assert(sizeof(aglow::shared::EdgePoints) == 24);
static_assert(sizeof(aglow::shared::PatchPoints) == 120);
static_assert(sizeof(aglow::shared::PatchNormals) == 72);
#endif
#endif
