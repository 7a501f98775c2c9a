// SPDX-License-Identifier: Apache-2.0
// PN triangles whose shape follows scalars at the vertices: docs/derivations/tagged-pn.md.
//
// Source: after Boubekeur, Reuter & Schlick, "Scalar Tagged PN Triangles", Eurographics 2005.
#ifndef AGLOW_SHARED_TAGGED_TRIANGLE_H
#define AGLOW_SHARED_TAGGED_TRIANGLE_H
#include "aglow/shared/pn_triangle.h"
AG_NAMESPACE_BEGIN

// All 0: as PN triangles are.
struct ShapeTags {
    float sharpness;  // 0 smooth .. 1 a corner: tangents along the edges
    float tension;    // -1 handles twice as long .. 1 handles of no length
    float bias;       // -1 .. 1: of an edge, longer handles at the end with more of it
};
AG_BUFFER_OF(ShapeTags);

AG_FN ShapeTags bounded_tags(ShapeTags tags) {
    ShapeTags r;
    r.sharpness = clamp(tags.sharpness, 0.0f, 1.0f);
    r.tension = clamp(tags.tension, -1.0f, 1.0f);
    r.bias = clamp(tags.bias, -1.0f, 1.0f);
    return r;
}

// Tags within their bounds.
AG_FN EdgePoints tagged_edge_points(PatchEdge e, ShapeTags tags_a, ShapeTags tags_b) {
    EdgePoints t = edge_tangents(e);
    vec3 d = e.b - e.a;
    float shift = 0.5f * (tags_a.bias - tags_b.bias);
    float length_a = (1.0f - tags_a.tension) * (1.0f + shift);
    float length_b = (1.0f - tags_b.tension) * (1.0f - shift);
    EdgePoints r;
    r.first = e.a + mix(t.first, d, tags_a.sharpness) * (length_a / 3.0f);
    r.second = e.b + mix(t.second, -d, tags_b.sharpness) * (length_b / 3.0f);
    return r;
}

// The normal that a face has at a corner with this sharpness.
AG_FN vec3 tagged_normal(vec3 normal, vec3 face_normal, float sharpness) {
    if (!(sharpness > 0.0f)) return normal;
    return unit_or(mix(normal, face_normal, sharpness), normal);
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::ShapeTags) == 12);
#endif
#endif
