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

DVec to_double(vec3 v) { return {v.x, v.y, v.z}; }
DVec operator*(DVec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
DVec operator+(DVec a, DVec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
DVec operator-(DVec a, DVec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(DVec a, DVec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
DVec cross(DVec a, DVec b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
DVec normalize(DVec a) { return a * (1 / std::sqrt(dot(a, a))); }

}  // namespace

float solid_angle(vec3 a, vec3 b, vec3 c) {
    const DVec p = normalize(to_double(a)), q = normalize(to_double(b)),
               r = normalize(to_double(c));
    const double numerator = std::abs(dot(p, cross(q, r)));
    const double denominator = 1 + dot(p, q) + dot(q, r) + dot(r, p);
    return static_cast<float>(2 * std::atan2(numerator, denominator));
}

TriangleSampler::TriangleSampler(vec3 a, vec3 b, vec3 c)
    : a_(a), b_(b), c_(c), by_area_(is_far(a, b, c)) {
    if (!by_area_) {
        solid_angle_ = solid_angle(a, b, c);
        by_area_ = !(solid_angle_ > kSmallestSolidAngle);
    }
    if (!by_area_) prepare_directions();
    if (by_area_) volume_ = std::abs(aglow::shared::dot(aglow::shared::cross(b - a, c - a), a)) / 2;
}

void TriangleSampler::prepare_directions() {
    p_ = normalize(to_double(a_));
    q_ = normalize(to_double(b_));
    const DVec r = normalize(to_double(c_));
    r_orthogonal_ = r - p_ * dot(r, p_);
    const double length = std::sqrt(dot(r_orthogonal_, r_orthogonal_));
    if (length == 0) {
        by_area_ = true;
        return;
    }
    r_orthogonal_ = r_orthogonal_ * (1 / length);
    const DVec pq = cross(p_, q_), rp = cross(r, p_);
    const double lengths = std::sqrt(std::max(dot(pq, pq) * dot(rp, rp), 1e-300));
    alpha_ = std::acos(std::clamp(-dot(pq, rp) / lengths, -1.0, 1.0));
    sin_alpha_ = std::sin(alpha_);
    cos_alpha_ = std::cos(alpha_);
    cos_pq_ = dot(p_, q_);
}

float TriangleSampler::pdf(vec2 barycentrics) const {
    return by_area_ ? area_pdf(barycentrics) : 1 / solid_angle_;
}

// The area of the sub-triangle (p, q, r') is u.x of the whole, which fixes r' on the arc from p to
// r; u.y then picks a point on the arc from q to r'.
TriangleSample TriangleSampler::sample(vec2 u) const {
    if (by_area_) return sample_area(u);
    const double turn = static_cast<double>(u.x) * static_cast<double>(solid_angle_) - alpha_;
    const double s = std::sin(turn), t = std::cos(turn);
    const double uu = t - cos_alpha_;
    const double vv = s + sin_alpha_ * cos_pq_;
    const double divisor = (vv * s + uu * t) * sin_alpha_;
    const double cos_arc =
        divisor == 0 ? 1 : std::clamp(((vv * t - uu * s) * cos_alpha_ - vv) / divisor, -1.0, 1.0);
    const DVec r = p_ * cos_arc + r_orthogonal_ * std::sqrt(std::max(0.0, 1 - cos_arc * cos_arc));

    const double cos_qr = dot(r, q_);
    const double z = 1 - static_cast<double>(u.y) * (1 - cos_qr);
    const DVec o = r - q_ * cos_qr;
    const double o_length = std::sqrt(dot(o, o));
    const DVec direction =
        o_length == 0 ? q_ : q_ * z + o * (std::sqrt(std::max(0.0, 1 - z * z)) / o_length);
    return {project(direction), 1 / solid_angle_};
}

/// Barycentrics (of b and c) where the ray from the receiver along `direction` meets the
/// triangle's plane, kept inside the triangle.
vec2 TriangleSampler::project(DVec direction) const {
    const DVec a = to_double(a_), e1 = to_double(b_) - a, e2 = to_double(c_) - a;
    const DVec s1 = cross(direction, e2);
    const double divisor = dot(s1, e1);
    if (divisor == 0) return {1 / 3.0f, 1 / 3.0f};
    const DVec s = a * -1.0;
    const double v = std::clamp(dot(s, s1) / divisor, 0.0, 1.0);
    const double w = std::clamp(dot(direction, cross(s, e1)) / divisor, 0.0, 1.0);
    const double sum = std::max(1.0, v + w);
    return {static_cast<float>(v / sum), static_cast<float>(w / sum)};
}

/// 1/sr of a point drawn evenly over the triangle's area; 0 where it is degenerate or edge-on. The
/// area times the cosine that it is seen under is the volume below over the distance.
float TriangleSampler::area_pdf(vec2 at) const {
    const vec3 p = a_ * (1 - at.x - at.y) + b_ * at.x + c_ * at.y;
    const float distance2 = aglow::shared::dot(p, p);
    return volume_ > 0 ? distance2 * std::sqrt(distance2) / volume_ : 0;
}

TriangleSample TriangleSampler::sample_area(vec2 u) const {
    const float root = std::sqrt(u.x);
    const vec2 at{root * (1 - u.y), root * u.y};
    return {at, area_pdf(at)};
}

}  // namespace aglow::transport
