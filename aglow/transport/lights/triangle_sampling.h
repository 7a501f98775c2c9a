// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"

namespace aglow::transport {

/// A vector in double precision: the sides of a small spherical triangle differ by little.
struct DVec {
    double x, y, z;
};

/// A direction towards a triangle, drawn in proportion to solid angle, or a point on it drawn in
/// proportion to area where it is so far away that this is as even.
struct TriangleSample {
    vec2 barycentrics = {0, 0};
    float pdf = 0;  ///< 1/sr as seen from the receiver; 0: the triangle is degenerate or edge-on
};

/// Samples triangle (a, b, c), corners relative to the receiver. Made once for a receiver and a
/// triangle: what all samples share, all but one of the inverse trigonometric functions, is in it.
/// Source  Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995; solid angle by
///         Van Oosterom & Strackee, "The Solid Angle of a Plane Triangle", 1983.
class TriangleSampler {
public:
    TriangleSampler(vec3 a, vec3 b, vec3 c);

    /// The point that two uniform numbers pick.
    TriangleSample sample(vec2 u) const;

    /// The density (1/sr) with which sample() picks the point at `barycentrics`.
    float pdf(vec2 barycentrics) const;

private:
    float area_pdf(vec2 at) const;
    TriangleSample sample_area(vec2 u) const;
    vec2 project(DVec direction) const;
    void prepare_directions();

    vec3 a_, b_, c_;
    bool by_area_;
    float volume_ = 0;       // by area: three times that of the pyramid up to the receiver
    float solid_angle_ = 0;  // else
    // The spherical triangle (p, q, r) with angle alpha at p.
    DVec p_{}, q_{}, r_orthogonal_{};  // the last: unit, across p in the plane of p and r
    double alpha_ = 0, sin_alpha_ = 0, cos_alpha_ = 0, cos_pq_ = 0;
};

/// Solid angle of a triangle seen from the origin, sr.
float solid_angle(vec3 a, vec3 b, vec3 c);

}  // namespace aglow::transport
