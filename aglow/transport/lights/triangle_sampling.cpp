// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/lights/triangle_sampling.h"

#include <algorithm>
#include <cmath>

namespace aglow::transport {
namespace {

/// Is the triangle so far away, for its size, that points even over its area are as good as
/// directions even over its solid angle? Beyond twice its longest edge the density of one in
/// terms of the other varies by about a half; nearer, double precision carries the spherical
/// construction.
bool is_far(vec3 a, vec3 b, vec3 c) {
    constexpr float kFar2 = 2 * 2;
    const vec3 centroid = (a + b + c) / 3;
    const vec3 e1 = b - a, e2 = c - b, e3 = a - c;
    const float edge2 = std::max(
        {aglow::shared::dot(e1, e1), aglow::shared::dot(e2, e2), aglow::shared::dot(e3, e3)});
    return aglow::shared::dot(centroid, centroid) > kFar2 * edge2;
}

/// Steradians below which even double precision leaves the spherical construction.
constexpr float kSmallestSolidAngle = 1e-6f;

struct DVec {
    double x, y, z;
};
DVec to_double(vec3 v) { return {v.x, v.y, v.z}; }
DVec operator*(DVec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
DVec operator+(DVec a, DVec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
DVec operator-(DVec a, DVec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(DVec a, DVec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
DVec cross(DVec a, DVec b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
DVec normalize(DVec a) { return a * (1 / std::sqrt(dot(a, a))); }

/// Barycentrics (of b and c) where the ray from the origin along `d` meets the triangle's plane,
/// kept inside the triangle.
vec2 project(vec3 a, vec3 b, vec3 c, DVec d) {
    const DVec e1 = to_double(b) - to_double(a), e2 = to_double(c) - to_double(a);
    const DVec s1 = cross(d, e2);
    const double divisor = dot(s1, e1);
    if (divisor == 0) return {1 / 3.0f, 1 / 3.0f};
    const DVec s = to_double(a) * -1.0;
    const double v = std::clamp(dot(s, s1) / divisor, 0.0, 1.0);
    const double w = std::clamp(dot(d, cross(s, e1)) / divisor, 0.0, 1.0);
    const double sum = std::max(1.0, v + w);
    return {static_cast<float>(v / sum), static_cast<float>(w / sum)};
}

/// 1/sr of a point drawn evenly over the triangle's area; 0 where it is degenerate or edge-on.
float area_pdf(vec3 a, vec3 b, vec3 c, vec2 at) {
    const vec3 p = a * (1 - at.x - at.y) + b * at.x + c * at.y;
    const vec3 twice_area = aglow::shared::cross(b - a, c - a);
    const float projected = std::abs(aglow::shared::dot(twice_area, p)) / 2;
    const float distance2 = aglow::shared::dot(p, p);
    return projected > 0 ? distance2 * std::sqrt(distance2) / projected : 0;
}

TriangleSample sample_area(vec3 a, vec3 b, vec3 c, vec2 u) {
    const float root = std::sqrt(u.x);
    const vec2 at{root * (1 - u.y), root * u.y};
    return {at, area_pdf(a, b, c, at)};
}

}  // namespace

float solid_angle(vec3 a, vec3 b, vec3 c) {
    const DVec p = normalize(to_double(a)), q = normalize(to_double(b)),
               r = normalize(to_double(c));
    const double numerator = std::abs(dot(p, cross(q, r)));
    const double denominator = 1 + dot(p, q) + dot(q, r) + dot(r, p);
    return static_cast<float>(2 * std::atan2(numerator, denominator));
}

float triangle_pdf(vec3 a, vec3 b, vec3 c, vec2 barycentrics) {
    if (is_far(a, b, c)) return area_pdf(a, b, c, barycentrics);
    const float omega = solid_angle(a, b, c);
    return omega > kSmallestSolidAngle ? 1 / omega : area_pdf(a, b, c, barycentrics);
}

// The area of the sub-triangle (A, B, C') is u.x of the whole, which fixes C' on the arc from A to
// C; u.y then picks a point on the arc from B to C'.
TriangleSample sample_triangle(vec3 a, vec3 b, vec3 c, vec2 u) {
    if (is_far(a, b, c)) return sample_area(a, b, c, u);
    const float omega = solid_angle(a, b, c);
    if (!(omega > kSmallestSolidAngle)) return sample_area(a, b, c, u);

    const DVec p = normalize(to_double(a)), q = normalize(to_double(b)),
               r = normalize(to_double(c));
    const DVec pq = cross(p, q), rp = cross(r, p);
    const double cos_alpha = -dot(pq, rp) / std::sqrt(std::max(dot(pq, pq) * dot(rp, rp), 1e-300));
    const double alpha = std::acos(std::clamp(cos_alpha, -1.0, 1.0));
    const double sin_alpha = std::sin(alpha);
    const double cos_c = dot(p, q);

    const double area = static_cast<double>(u.x) * static_cast<double>(omega);
    const double s = std::sin(area - alpha), t = std::cos(area - alpha);
    const double uu = t - std::cos(alpha);
    const double vv = s + sin_alpha * cos_c;
    const double divisor = (vv * s + uu * t) * sin_alpha;
    const double cos_b =
        divisor == 0 ? 1
                     : std::clamp(((vv * t - uu * s) * std::cos(alpha) - vv) / divisor, -1.0, 1.0);
    const DVec r_orthogonal = r - p * dot(r, p);
    const double r_length = std::sqrt(dot(r_orthogonal, r_orthogonal));
    if (r_length == 0) return sample_area(a, b, c, u);
    const DVec c_new =
        p * cos_b + r_orthogonal * (std::sqrt(std::max(0.0, 1 - cos_b * cos_b)) / r_length);

    const double z = 1 - static_cast<double>(u.y) * (1 - dot(c_new, q));
    const DVec o = c_new - q * dot(c_new, q);
    const double o_length = std::sqrt(dot(o, o));
    const DVec direction =
        o_length == 0 ? q : q * z + o * (std::sqrt(std::max(0.0, 1 - z * z)) / o_length);
    return {project(a, b, c, direction), 1 / omega};
}

}  // namespace aglow::transport
