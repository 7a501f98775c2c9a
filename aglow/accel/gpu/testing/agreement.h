// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu_scene.h"
#include "aglow/accel/ray_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace aglow::testing {

/// What two ray tracers say of one ray.
enum class Verdict : uint8_t {
    same,     ///< both miss, or both hit at one distance, on whatever triangle
    rounded,  ///< they differ, and coordinates in single precision cannot tell who is right
    differs   ///< one of them is wrong
};

/// Judges two answers about one ray by double precision.
///
/// Distances are the same within 1e-4 of the length plus 2^-20 of the largest coordinate on the
/// way. Where one meets a triangle that the other passes, rounding decides if the ray runs within
/// that much of the triangle's border, or starts that close to it; where both meet it, if the ray
/// runs so flat along it that as small a shift moves the distance as far.
class Judge {
public:
    explicit Judge(const Surfaces& surfaces) : surfaces_(surfaces) {
        for (const vec3 p : surfaces.positions) size_ = std::max(size_, magnitude(p));
    }

    struct Answer {
        float distance = kInfinity;
        uint32_t triangle = GpuScene::kNoHit;
        bool hit() const { return triangle != GpuScene::kNoHit; }
    };
    static Answer answer(const GpuScene::GpuHit& hit) {
        return {hit.triangle == GpuScene::kNoHit ? kInfinity : hit.distance, hit.triangle};
    }
    static Answer answer(const std::optional<Hit>& hit) {
        return hit ? Answer{hit->distance, hit->at.triangle} : Answer{};
    }

    Verdict operator()(const Ray& ray, Answer a, Answer b) const {
        if (!a.hit() && !b.hit()) return Verdict::same;
        if (a.distance > b.distance) std::swap(a, b);  // a is the nearer one
        const double slack =
            kRounding * static_cast<double>(std::max(size_, magnitude(ray.origin)));
        const double near = static_cast<double>(a.distance);
        if (b.hit() && static_cast<double>(b.distance) - near <= 1e-4 * near + slack)
            return Verdict::same;
        if (near <= slack) return Verdict::rounded;
        const Seen seen = look(ray, a.triangle);
        const bool at_border = seen.border_distance <= slack;
        const bool flat = static_cast<double>(b.distance) - near <= slack / seen.cosine;
        return at_border || flat ? Verdict::rounded : Verdict::differs;
    }

private:
    static constexpr double kRounding = 0x1p-20;
    using Point = std::array<double, 3>;

    /// A triangle as the ray sees it.
    struct Seen {
        double border_distance;  // from the ray to the nearest edge, across the ray
        double cosine;           // between ray and normal
    };

    static float magnitude(vec3 v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    }
    static Point point(vec3 v) {
        return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    }
    static Point minus(const Point& a, const Point& b) {
        return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    }
    static double dot(const Point& a, const Point& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    static Point cross(const Point& a, const Point& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }

    Seen look(const Ray& ray, uint32_t triangle) const {
        const Point origin = point(ray.origin), along = point(ray.direction);
        std::array<Point, 3> corner{};  // seen along the ray: without their part along it
        std::array<Point, 3> world{};
        for (size_t i = 0; i < 3; ++i) {
            world[i] = point(surfaces_.corner(triangle, static_cast<int>(i)));
            corner[i] = minus(world[i], origin);
            const double depth = dot(corner[i], along) / dot(along, along);
            for (size_t k = 0; k < 3; ++k) corner[i][k] -= depth * along[k];
        }
        Seen seen{.border_distance = 1e300, .cosine = 0};
        for (size_t i = 0; i < 3; ++i)
            seen.border_distance =
                std::min(seen.border_distance, distance_to_segment(corner[i], corner[(i + 1) % 3]));
        const Point normal = cross(minus(world[1], world[0]), minus(world[2], world[0]));
        const double scale = std::sqrt(dot(normal, normal) * dot(along, along));
        seen.cosine = scale > 0 ? std::abs(dot(normal, along)) / scale : 0;
        return seen;
    }

    /// From the point where all coordinates are 0.
    static double distance_to_segment(const Point& a, const Point& b) {
        const Point edge = minus(b, a);
        const double squared = dot(edge, edge);
        const double at = squared > 0 ? std::clamp(-dot(a, edge) / squared, 0.0, 1.0) : 0.0;
        const Point nearest{a[0] + at * edge[0], a[1] + at * edge[1], a[2] + at * edge[2]};
        return std::sqrt(dot(nearest, nearest));
    }

    const Surfaces& surfaces_;
    float size_ = 0;
};

}  // namespace aglow::testing
