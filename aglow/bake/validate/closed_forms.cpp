// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/validate/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace aglow::validation {

double dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point cross(Point a, Point b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(Point a) { return std::sqrt(dot(a, a)); }
Point unit(Point a) { return a * (1 / length(a)); }

namespace {

/// The part of a polygon above the plane through the origin with normal n (Sutherland-Hodgman).
std::vector<Point> above_horizon(Point at, Point n, std::span<const Point> corners) {
    std::vector<Point> kept;
    for (size_t i = 0; i < corners.size(); ++i) {
        const Point p = corners[i] - at;
        const Point q = corners[(i + 1) % corners.size()] - at;
        const double hp = dot(n, p), hq = dot(n, q);
        if (hp >= 0) kept.push_back(p);
        if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0))
            kept.push_back(p + (q - p) * (hp / (hp - hq)));
    }
    return kept;
}

}  // namespace

double polygon_factor(Point at, Point n, std::span<const Point> corners) {
    const std::vector<Point> seen = above_horizon(at, n, corners);
    double sum = 0;
    for (size_t i = 0; i < seen.size(); ++i) {
        const Point p = seen[i], q = seen[(i + 1) % seen.size()];
        const Point axis = cross(p, q);
        const double sine = length(axis);
        if (sine > 0) sum += std::atan2(sine, dot(p, q)) * dot(n, axis) / sine;
    }
    return sum / (2 * kPi);
}

double rectangle_factor(Point at, Point n, Point corner, Point u, Point v) {
    const std::array<Point, 4> corners = {corner, corner + u, corner + u + v, corner + v};
    return std::fabs(polygon_factor(at, n, corners));
}

double corner_parallel(double w, double d, double h) {
    const double a = w / h, b = d / h;
    const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
    return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * kPi);
}

double corner_perpendicular(double width, double height, double distance) {
    const double x = height / width, y = distance / width;
    const double r = std::sqrt(x * x + y * y);
    return (std::atan(1 / y) - y / r * std::atan(1 / r)) / (2 * kPi);
}

double facing_rectangles(double a, double b, double c) {
    const double x = a / c, y = b / c;
    const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    const double sum = 0.5 * std::log(rx * rx * ry * ry / (1 + x * x + y * y)) +
                       x * ry * std::atan(x / ry) + y * rx * std::atan(y / rx) - x * std::atan(x) -
                       y * std::atan(y);
    return 2 / (kPi * x * y) * sum;
}

double adjoining_rectangles(double height, double width, double edge) {
    const double h = height / edge, w = width / edge;
    const double hh = h * h, ww = w * w, r = std::sqrt(hh + ww);
    const double logs = std::log((1 + ww) * (1 + hh) / (1 + ww + hh)) +
                        ww * std::log(ww * (1 + ww + hh) / ((1 + ww) * (ww + hh))) +
                        hh * std::log(hh * (1 + hh + ww) / ((1 + hh) * (hh + ww)));
    return (w * std::atan(1 / w) + h * std::atan(1 / h) - r * std::atan(1 / r) + 0.25 * logs) /
           (kPi * w);
}

double spot_falloff(double angle, double inner, double outer) {
    const double t = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    const double clamped = std::clamp(t, 0.0, 1.0);
    return clamped * clamped;
}

double spot_flux(double inner, double outer) {
    // The falloff is t^2 with t linear in the cosine: it integrates to a third over the rim.
    const double core = 1 - std::cos(inner);
    const double rim = std::cos(inner) - std::cos(outer);
    return 2 * kPi * (core + rim / 3);
}

}  // namespace aglow::validation
