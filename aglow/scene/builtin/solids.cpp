// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/geometry.h"

#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

constexpr float kCreaseDegrees = 40;

struct Corner {
    vec3 position;
    vec2 uv;
};

void add_triangle(Shape& soup, Corner a, Corner b, Corner c) {
    const auto first = static_cast<uint32_t>(soup.positions.size());
    for (const Corner& corner : {a, b, c}) {
        soup.positions.push_back(corner.position);
        soup.texcoords.push_back(corner.uv);
    }
    soup.triangles.push_back({first, first + 1, first + 2});
}

void add_quad(Shape& soup, Corner a, Corner b, Corner c, Corner d) {
    add_triangle(soup, a, b, c);
    add_triangle(soup, a, c, d);
}

/// Joins rows of equally many corners; the front is where (along a row) x (to the next row)
/// points to.
Shape skin(const std::vector<std::vector<Corner>>& rows, float crease_degrees) {
    Shape soup;
    for (size_t j = 0; j + 1 < rows.size(); ++j)
        for (size_t i = 0; i + 1 < rows[j].size(); ++i)
            add_quad(soup, rows[j][i], rows[j][i + 1], rows[j + 1][i + 1], rows[j + 1][i]);
    return soup_to_shape(std::move(soup), crease_degrees);
}

float fraction(int i, int count) { return static_cast<float>(i) / static_cast<float>(count); }

/// Point i of `count` on the unit circle; the last is exactly the first, so that seams close.
vec2 on_circle(int i, int count) {
    const float angle = 2 * kPi * fraction(i % count, count);
    return {std::cos(angle), std::sin(angle)};
}

/// Coordinates of a rounded box along one axis: arcs at both ends, even steps between them.
/// Both ends are exact, so that neighbouring faces meet.
std::vector<float> rounded_steps(float lo, float hi, float radius, int segments, int inner) {
    std::vector<float> steps;
    const auto arc = [&](int i) { return radius * std::tan(kPi / 4 * fraction(i, segments)); };
    for (int i = segments; i > 0; --i) steps.push_back(i == segments ? lo : lo + radius - arc(i));
    const float from = lo + radius, to = hi - radius;
    const int middle = to - from > 1e-6f ? inner : 0;
    for (int i = 0; i <= middle; ++i)
        steps.push_back(middle == 0 ? (from + to) / 2 : from + (to - from) * fraction(i, middle));
    for (int i = 1; i <= segments; ++i) steps.push_back(i == segments ? hi : hi - radius + arc(i));
    return steps;
}

float component(vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

struct RoundedBox {
    vec3 lo, hi;
    float radius, bulge;

    /// Image of a point of the sharp box's surface. A function of that point alone: the faces
    /// that share an edge agree on it to the last bit.
    vec3 operator()(vec3 p) const {
        const vec3 r{radius, radius, radius};
        const vec3 core = shared::min(shared::max(p, lo + r), hi - r);
        const vec3 out = p - core;
        const vec3 direction = normalize(out);
        const vec3 center = (lo + hi) * 0.5f, half = (hi - lo) * 0.5f;
        const vec3 q{(p.x - center.x) / half.x, (p.y - center.y) / half.y,
                     (p.z - center.z) / half.z};
        const vec3 soft{1 - q.x * q.x, 1 - q.y * q.y, 1 - q.z * q.z};
        const vec3 swell{soft.y * soft.z * q.x, soft.x * soft.z * q.y, soft.x * soft.y * q.z};
        return core + direction * radius + swell * bulge;
    }
};

}  // namespace

Shape quad(vec3 a, vec3 b, vec3 c, vec3 d) {
    Shape soup;
    add_quad(soup, {a, {0, 1}}, {b, {1, 1}}, {c, {1, 0}}, {d, {0, 0}});
    return soup_to_shape(std::move(soup), kCreaseDegrees);
}

Shape box(vec3 lo, vec3 hi) {
    const auto p = [&](int x, int y, int z) {
        return vec3{x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z};
    };
    Shape result = quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));  // +Z
    result.append(quad(p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0)));  // -Z
    result.append(quad(p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1)));  // +X
    result.append(quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)));  // -X
    result.append(quad(p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0)));  // +Y
    result.append(quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)));  // -Y
    return result;
}

Shape rounded_box(vec3 lo, vec3 hi, float radius, int segments, float bulge) {
    const RoundedBox image{lo, hi, radius, bulge};
    const int inner = bulge != 0 ? 2 * segments + 2 : 1;
    std::array<std::vector<float>, 3> steps;
    for (int axis = 0; axis < 3; ++axis)
        steps[static_cast<size_t>(axis)] =
            rounded_steps(component(lo, axis), component(hi, axis), radius, segments, inner);
    Shape soup;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            // u x v points along +axis; the lower face swaps them.
            const int u_axis = (axis + (upper ? 1 : 2)) % 3, v_axis = (axis + (upper ? 2 : 1)) % 3;
            const auto& us = steps[static_cast<size_t>(u_axis)];
            const auto& vs = steps[static_cast<size_t>(v_axis)];
            const auto corner = [&](size_t i, size_t j) {
                std::array<float, 3> p{};
                p[static_cast<size_t>(axis)] = component(upper ? hi : lo, axis);
                p[static_cast<size_t>(u_axis)] = us[i];
                p[static_cast<size_t>(v_axis)] = vs[j];
                return Corner{image({p[0], p[1], p[2]}), {us[i], -vs[j]}};
            };
            for (size_t j = 0; j + 1 < vs.size(); ++j)
                for (size_t i = 0; i + 1 < us.size(); ++i)
                    add_quad(soup, corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                             corner(i, j + 1));
        }
    return soup_to_shape(std::move(soup), kCreaseDegrees);
}

Shape sphere(vec3 center, float radius, int slices, int stacks) {
    std::vector<vec2> profile;
    for (int i = 0; i <= stacks; ++i) {
        const float angle = kPi * fraction(i, stacks);
        const bool pole = i == 0 || i == stacks;
        profile.push_back({pole ? 0 : radius * std::sin(angle), -radius * std::cos(angle)});
    }
    return lathe(profile, slices).moved(center);
}

Shape cylinder(vec3 base, float radius, float height, int slices) {
    const std::array<vec2, 4> profile = {vec2{0, 0}, {radius, 0}, {radius, height}, {0, height}};
    return lathe(profile, slices).moved(base);
}

Shape lathe(std::span<const vec2> profile, int slices) {
    std::vector<std::vector<Corner>> rows;
    for (size_t j = 0; j < profile.size(); ++j) {
        const float v = 1 - fraction(static_cast<int>(j), static_cast<int>(profile.size()) - 1);
        std::vector<Corner>& row = rows.emplace_back();
        for (int i = 0; i <= slices; ++i) {
            const vec2 c = on_circle(i, slices) * profile[j].x;
            row.push_back({{c.x, profile[j].y, -c.y}, {fraction(i, slices), v}});
        }
    }
    return skin(rows, kCreaseDegrees);
}

Shape tube(std::span<const vec3> path, std::span<const float> radii, int slices) {
    const size_t last = path.size() - 1;
    const auto direction = [&](size_t i) {
        return normalize(path[std::min(i + 1, last)] - path[i > 0 ? i - 1 : 0]);
    };
    vec3 across = Frame(direction(0)).tangent;
    std::vector<std::vector<Corner>> rows;
    const auto ring = [&](size_t i, float radius) {
        const vec3 along = direction(i);
        across = normalize(across - along * dot(across, along));  // least twist from ring to ring
        const vec3 up = cross(along, across);
        std::vector<Corner>& row = rows.emplace_back();
        for (int k = 0; k <= slices; ++k) {
            const vec2 c = on_circle(k, slices) * radius;
            const float v = fraction(static_cast<int>(i), static_cast<int>(last));
            row.push_back({path[i] + across * c.x + up * c.y, {fraction(k, slices), v}});
        }
    };
    ring(0, 0);
    for (size_t i = 0; i <= last; ++i) ring(i, radii[i]);
    ring(last, 0);
    return skin(rows, kCreaseDegrees);
}

Shape sheet(const std::function<vec3(float, float)>& point, int columns, int rows) {
    std::vector<std::vector<Corner>> corners;
    for (int j = 0; j <= rows; ++j) {
        const float v = fraction(j, rows);
        std::vector<Corner>& row = corners.emplace_back();
        for (int i = 0; i <= columns; ++i) {
            const float u = fraction(i, columns);
            row.push_back({point(u, v), {u, 1 - v}});
        }
    }
    return skin(corners, 180);
}

}  // namespace aglow::builtin
