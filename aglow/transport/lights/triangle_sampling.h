// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"

namespace aglow::transport {

/// A direction towards a triangle, drawn in proportion to solid angle, or a point on it drawn in
/// proportion to area where it is so far away that this is as even.
struct TriangleSample {
    vec2 barycentrics = {0, 0};
    float pdf = 0;  ///< 1/sr as seen from the receiver; 0: the triangle is degenerate or edge-on
};

/// Samples triangle (a, b, c), corners relative to the receiver, from two uniform numbers.
/// Source  Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995; solid angle by
///         Van Oosterom & Strackee, "The Solid Angle of a Plane Triangle", 1983.
TriangleSample sample_triangle(vec3 a, vec3 b, vec3 c, vec2 u);

/// The density (1/sr) with which sample_triangle() picks the point at `barycentrics`.
float triangle_pdf(vec3 a, vec3 b, vec3 c, vec2 barycentrics);

/// Solid angle of a triangle seen from the origin, sr.
float solid_angle(vec3 a, vec3 b, vec3 c);

}  // namespace aglow::transport
