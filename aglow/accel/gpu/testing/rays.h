// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/core/random.h"
#include "aglow/mesh/surfaces.h"

#include <array>
#include <cmath>
#include <vector>

namespace aglow::testing {

/// Where test rays are likely to find a mistake.
enum class RayClass : uint8_t {
    uniform,        ///< any origin around the scene, any direction
    edge,           ///< from anywhere to a point of an edge
    vertex,         ///< from anywhere to a vertex
    axis_parallel,  ///< one or two components of the direction are zero
    surface         ///< from a point on a surface, off it by its clearance
};
inline constexpr std::array kRayClasses = {RayClass::uniform, RayClass::edge, RayClass::vertex,
                                           RayClass::axis_parallel, RayClass::surface};

inline const char* name(RayClass kind) {
    constexpr std::array kNames = {"uniform", "edge", "vertex", "axis-parallel", "surface"};
    return kNames[static_cast<size_t>(kind)];
}

/// Makes rays of a scene; the same ones in every run.
class RaySource {
public:
    RaySource(const Surfaces& surfaces, uint64_t seed) : surfaces_(surfaces), random_(seed) {
        for (const vec3 p : surfaces.positions) box_.add(p);
        const vec3 margin = box_.size() * 0.1f;
        box_.lo = box_.lo - margin;
        box_.hi = box_.hi + margin;
    }

    Ray ray(RayClass kind) {
        switch (kind) {
            case RayClass::edge:
                return towards(edge_point());
            case RayClass::vertex:
                return towards(surfaces_.corner(triangle(), static_cast<int>(random_.next() % 3)));
            case RayClass::axis_parallel:
                return {point(), axis_parallel_direction()};
            case RayClass::surface:
                return from_surface();
            case RayClass::uniform:
                break;
        }
        return {point(), direction()};
    }

    std::vector<Ray> rays(RayClass kind, size_t count) {
        std::vector<Ray> result;
        result.reserve(count);
        for (size_t i = 0; i < count; ++i) result.push_back(ray(kind));
        return result;
    }

private:
    uint32_t triangle() {
        return random_.next() % static_cast<uint32_t>(surfaces_.triangles.size());
    }
    vec3 point() {
        const vec3 size = box_.size();
        const float x = random_.uniform(), y = random_.uniform(), z = random_.uniform();
        return box_.lo + vec3{size.x * x, size.y * y, size.z * z};
    }
    vec3 edge_point() {
        const uint32_t t = triangle();
        const int corner = static_cast<int>(random_.next() % 3);
        return shared::mix(surfaces_.corner(t, corner), surfaces_.corner(t, (corner + 1) % 3),
                           random_.uniform());
    }
    vec3 direction() {
        const float z = 1 - 2 * random_.uniform(), angle = 2 * kPi * random_.uniform();
        const float r = std::sqrt(std::max(0.0f, 1 - z * z));
        return normalize(vec3{r * std::cos(angle), r * std::sin(angle), z});
    }
    vec3 axis_parallel_direction() {
        std::array<float, 3> d{};
        const size_t axis = random_.next() % 3;
        d[axis] = random_.next() % 2 == 0 ? 1.0f : -1.0f;
        if (random_.next() % 2 == 0) d[(axis + 1) % 3] = 2 * random_.uniform() - 1;
        return normalize(vec3{d[0], d[1], d[2]});
    }
    Ray towards(vec3 target) {
        vec3 origin = point();
        while (!(length(target - origin) > 0)) origin = point();
        return {origin, normalize(target - origin)};
    }
    Ray from_surface() {
        for (;;) {
            const uint32_t t = triangle();
            vec3 normal = geometric_normal(surfaces_, t);
            if (length(normal) == 0) continue;
            if (random_.next() % 2 == 0) normal = -normal;
            const float u = random_.uniform(), v = random_.uniform() * (1 - u);
            vec3 away = direction();
            if (dot(away, normal) < 0) away = -away;
            return {offset_origin(position(surfaces_, {t, {u, v}}), normal,
                                  coordinate_magnitude(surfaces_, t)),
                    away};
        }
    }

    const Surfaces& surfaces_;
    Pcg32 random_;
    Box box_;
};

}  // namespace aglow::testing
