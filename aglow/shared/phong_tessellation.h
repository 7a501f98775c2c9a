// SPDX-License-Identifier: Apache-2.0
// Phong tessellation: points of a flat triangle projected onto the tangent planes of its corners,
// these blended as Phong shading blends normals. It is a quadratic triangle; raised to a cubic one
// it needs the edges' points alone.
//
// Source: Boubekeur & Alexa, "Phong Tessellation", SIGGRAPH Asia 2008.
#ifndef AGLOW_SHARED_PHONG_TESSELLATION_H
#define AGLOW_SHARED_PHONG_TESSELLATION_H
#include "aglow/shared/pn_triangle.h"
AG_NAMESPACE_BEGIN

// shape: 0 flat .. 1 fully curved; the paper's pictures have 3/4.
AG_FN EdgePoints phong_edge_points(PatchEdge e, float shape) {
    EdgePoints t = edge_tangents(e);
    vec3 curved = (t.first + t.second) * (0.5f * shape);
    vec3 middle = (e.a + e.b) * 0.5f + curved;
    EdgePoints r;
    r.first = (e.a + middle * 2.0f) / 3.0f;
    r.second = (e.b + middle * 2.0f) / 3.0f;
    return r;
}

AG_NAMESPACE_END
#endif
