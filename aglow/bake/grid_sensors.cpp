// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/bake.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace aglow {
namespace {

/// A triangle looks up where its normal is within 45 degrees of +Y.
constexpr float kUpward = 0.70710678f;

struct GridPoint {
    uint32_t part;
    long row, column;
    Receiver sensor;
};

/// Barycentrics of the vertical line through (x, z), where it passes inside the triangle.
bool inside(const Surfaces& surfaces, uint32_t triangle, double x, double z, vec2& barycentrics) {
    const vec3 a = surfaces.corner(triangle, 0), b = surfaces.corner(triangle, 1),
               c = surfaces.corner(triangle, 2);
    const double bx = static_cast<double>(b.x) - a.x, bz = static_cast<double>(b.z) - a.z;
    const double cx = static_cast<double>(c.x) - a.x, cz = static_cast<double>(c.z) - a.z;
    const double px = x - a.x, pz = z - a.z;
    const double determinant = bx * cz - bz * cx;
    if (determinant == 0) return false;
    const double v = (px * cz - pz * cx) / determinant, w = (bx * pz - bz * px) / determinant;
    if (v < 0 || w < 0 || v + w >= 1) return false;
    barycentrics = {static_cast<float>(v), static_cast<float>(w)};
    return true;
}

}  // namespace

std::vector<Receiver> grid_sensors(const Scene& scene, float spacing, double time) {
    const Surfaces surfaces = pose(scene, time);
    std::vector<GridPoint> points;
    const double step = spacing;
    for (uint32_t triangle = 0; triangle < surfaces.triangles.size(); ++triangle) {
        const vec3 normal = geometric_normal(surfaces, triangle);
        if (normal.y < kUpward) continue;
        Box box;
        for (int i = 0; i < 3; ++i) box.add(surfaces.corner(triangle, i));
        // Points lie at odd multiples of half the spacing, away from walls at round coordinates.
        const auto first = [&](float lo) { return std::lround(std::ceil(lo / step - 0.5)); };
        for (long row = first(box.lo.z); (static_cast<double>(row) + 0.5) * step < box.hi.z; ++row)
            for (long column = first(box.lo.x);
                 (static_cast<double>(column) + 0.5) * step < box.hi.x; ++column) {
                vec2 barycentrics;
                if (!inside(surfaces, triangle, (static_cast<double>(column) + 0.5) * step,
                            (static_cast<double>(row) + 0.5) * step, barycentrics))
                    continue;
                const vec3 p = position(surfaces, {triangle, barycentrics});
                points.push_back({surfaces.part_of[triangle], row, column, {p, normal, normal, 0}});
            }
    }
    std::stable_sort(points.begin(), points.end(), [](const GridPoint& a, const GridPoint& b) {
        return std::tie(a.part, a.row, a.column) < std::tie(b.part, b.row, b.column);
    });
    std::vector<Receiver> sensors;
    sensors.reserve(points.size());
    for (const GridPoint& point : points) sensors.push_back(point.sensor);
    return sensors;
}

}  // namespace aglow
