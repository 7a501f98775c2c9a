// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/geometry.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace aglow::builtin {
namespace {

auto key(vec3 p) { return std::tuple(p.x, p.y, p.z); }

vec3 area_normal(const std::vector<vec3>& p, uvec3 t) {
    return cross(p[t.y] - p[t.x], p[t.z] - p[t.x]);
}

bool same_place(const Shape& shape, uvec3 t) {
    const auto& p = shape.positions;
    return p[t.x] == p[t.y] || p[t.y] == p[t.z] || p[t.z] == p[t.x];
}

/// Corners (3 * triangle + i) ordered so that those at one position are neighbours.
std::vector<uint32_t> corners_by_position(const Shape& shape) {
    std::vector<uint32_t> corners(3 * shape.triangles.size());
    std::iota(corners.begin(), corners.end(), 0u);
    const auto place = [&](uint32_t corner) { return key(shape.positions[corner]); };
    std::stable_sort(corners.begin(), corners.end(),
                     [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
    return corners;
}

}  // namespace

Shape soup_to_shape(Shape soup, float crease_degrees) {
    for (vec3& p : soup.positions) p = p + vec3{0, 0, 0};  // no negative zeros
    Shape corners;                                         // vertex = corner, in triangle order
    for (const uvec3 t : soup.triangles) {
        if (same_place(soup, t)) continue;
        const auto first = static_cast<uint32_t>(corners.positions.size());
        for (const uint32_t vertex : {t.x, t.y, t.z}) {
            corners.positions.push_back(soup.positions[vertex]);
            corners.texcoords.push_back(soup.texcoords[vertex]);
        }
        corners.triangles.push_back({first, first + 1, first + 2});
    }

    std::vector<vec3> face(corners.triangles.size());
    for (size_t i = 0; i < face.size(); ++i)
        face[i] = area_normal(corners.positions, corners.triangles[i]);
    corners.normals.resize(corners.positions.size());
    const float crease = std::cos(crease_degrees * kPi / 180);
    const std::vector<uint32_t> order = corners_by_position(corners);
    for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() &&
               corners.positions[order[end]] == corners.positions[order[begin]])
            ++end;
        for (size_t i = begin; i < end; ++i) {
            const vec3 own = normalize(face[order[i] / 3]);
            vec3 sum{};
            for (size_t k = begin; k < end; ++k)
                if (dot(own, normalize(face[order[k] / 3])) >= crease) sum += face[order[k] / 3];
            corners.normals[order[i]] = normalize(sum);
        }
    }

    Shape shape;
    std::map<std::tuple<float, float, float, float, float, float, float, float>, uint32_t> known;
    const auto vertex = [&](uint32_t corner) {
        const vec3 p = corners.positions[corner], n = corners.normals[corner];
        const vec2 uv = corners.texcoords[corner];
        const auto next = static_cast<uint32_t>(shape.positions.size());
        const auto [at, is_new] =
            known.try_emplace({p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}, next);
        if (is_new) {
            shape.positions.push_back(p);
            shape.normals.push_back(n);
            shape.texcoords.push_back(uv);
        }
        return at->second;
    };
    for (const uvec3 t : corners.triangles)
        shape.triangles.push_back({vertex(t.x), vertex(t.y), vertex(t.z)});
    return shape;
}

void set_smooth_normals(Shape& shape) {
    shape.normals.assign(shape.positions.size(), {0, 0, 0});
    for (const uvec3 t : shape.triangles) {
        const vec3 n = area_normal(shape.positions, t);
        for (const uint32_t vertex : {t.x, t.y, t.z}) shape.normals[vertex] += n;
    }
    for (vec3& n : shape.normals) n = normalize(n);
}

void Shape::append(const Shape& other) {
    const auto first = static_cast<uint32_t>(positions.size());
    positions.insert(positions.end(), other.positions.begin(), other.positions.end());
    normals.insert(normals.end(), other.normals.begin(), other.normals.end());
    texcoords.insert(texcoords.end(), other.texcoords.begin(), other.texcoords.end());
    for (const uvec3 t : other.triangles)
        triangles.push_back({t.x + first, t.y + first, t.z + first});
}

Shape Shape::moved(vec3 offset) const {
    Shape result = *this;
    for (vec3& p : result.positions) p += offset;
    return result;
}

Shape Shape::scaled(vec3 factors) const {
    Shape result = *this;
    for (vec3& p : result.positions) p *= factors;
    for (vec3& n : result.normals)
        n = normalize(vec3{n.x / factors.x, n.y / factors.y, n.z / factors.z});
    return result;
}

Shape Shape::turned(vec3 axis, float degrees) const {
    const vec3 k = normalize(axis);
    const float c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
    const auto turn = [&](vec3 v) { return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c)); };
    Shape result = *this;
    for (vec3& p : result.positions) p = turn(p);
    for (vec3& n : result.normals) n = normalize(turn(n));
    return result;
}

Shape Shape::flipped() const {
    Shape result = *this;
    for (vec3& n : result.normals) n = -n;
    for (uvec3& t : result.triangles) std::swap(t.y, t.z);
    return result;
}

Shape Shape::with_texcoord_scale(vec2 scale) const {
    Shape result = *this;
    for (vec2& uv : result.texcoords) uv = uv * scale;
    return result;
}

}  // namespace aglow::builtin
