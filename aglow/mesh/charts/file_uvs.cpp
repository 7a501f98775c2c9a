// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/file_uvs.h"

#include "aglow/mesh/charts/validity.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace aglow::mesh {
namespace {

/// Files round their UVs: this far outside the unit square still counts as inside.
constexpr float kSlack = 1e-4f;
constexpr size_t kSet = 1;  // TEXCOORD_1

bool in_range(vec2 uv) {
    return uv.x >= -kSlack && uv.x <= 1 + kSlack && uv.y >= -kSlack && uv.y <= 1 + kSlack;
}

/// UV triangles of the whole mesh in soup order, or nothing where a UV is missing or out of range.
std::optional<std::vector<Triangle2>> uv_triangles(const Mesh& mesh) {
    std::vector<Triangle2> triangles;
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.triangles.empty()) continue;
        if (primitive.texcoords.size() <= kSet) return std::nullopt;
        const std::vector<vec2>& uvs = primitive.texcoords[kSet];
        if (uvs.size() != primitive.positions.size()) return std::nullopt;
        for (const uvec3& t : primitive.triangles) {
            Triangle2 triangle;
            for (size_t i = 0; i < 3; ++i) {
                const vec2 uv = uvs[i == 0 ? t.x : i == 1 ? t.y : t.z];
                if (!in_range(uv)) return std::nullopt;
                triangle[i] = {double(uv.x), double(uv.y)};
            }
            triangles.push_back(triangle);
        }
    }
    return triangles;
}

/// Number of regions of UV triangles that hang together at their corners.
int count_regions(const std::vector<Triangle2>& triangles) {
    std::vector<uint32_t> parent(3 * triangles.size()), order(parent.size());
    std::iota(parent.begin(), parent.end(), 0u);
    std::iota(order.begin(), order.end(), 0u);
    const auto root = [&](uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    const auto point = [&](uint32_t i) { return triangles[i / 3][i % 3]; };
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return std::make_tuple(point(a).x, point(a).y, a) <
               std::make_tuple(point(b).x, point(b).y, b);
    });
    for (size_t i = 1; i < order.size(); ++i) {
        const Point2 p = point(order[i]), q = point(order[i - 1]);
        if (p.x == q.x && p.y == q.y) parent[root(order[i])] = root(order[i - 1]);
    }
    for (uint32_t t = 0; t < triangles.size(); ++t)
        for (uint32_t i : {1u, 2u}) parent[root(3 * t + i)] = root(3 * t);
    int count = 0;
    for (uint32_t t = 0; t < triangles.size(); ++t) count += root(3 * t) == 3 * t;
    return count;
}

/// Root mean square lengths of the surface's derivatives by u and v, scaled so that areas agree.
Point2 surface_lengths(const Soup& soup, const std::vector<Triangle2>& uvs) {
    double by_u = 0, by_v = 0, uv_area = 0, area = 0;
    for (uint32_t t = 0; t < uvs.size(); ++t) {
        const Point2 a = uvs[t][1] - uvs[t][0], b = uvs[t][2] - uvs[t][0];
        const double determinant = cross(a, b);
        if (determinant == 0 || soup.slivers[t]) continue;
        const Point3 p = soup.corner(t, 1) - soup.corner(t, 0);
        const Point3 q = soup.corner(t, 2) - soup.corner(t, 0);
        const Point3 du = (p * b.y - q * a.y) * (1 / determinant);
        const Point3 dv = (q * a.x - p * b.x) * (1 / determinant);
        const double weight = std::abs(determinant) / 2;
        by_u += weight * dot(du, du);
        by_v += weight * dot(dv, dv);
        uv_area += weight;
        area += soup.areas[t];
    }
    if (!(uv_area > 0) || !(by_u > 0) || !(by_v > 0)) return {1, 1};
    const double u = std::sqrt(by_u / uv_area), v = std::sqrt(by_v / uv_area);
    const double k = std::sqrt(area / (u * v * uv_area));
    return {u * k, v * k};
}

}  // namespace

std::optional<FileUvs> valid_file_uvs(const Mesh& mesh, const MeshShape& shape, const Soup& soup) {
    const auto triangles = uv_triangles(mesh);
    if (!triangles || triangles->empty() || triangles->size() != shape.triangles.size())
        return std::nullopt;
    FileUvs uvs;
    uvs.low = uvs.high = (*triangles)[0][0];
    for (uint32_t t = 0; t < triangles->size(); ++t) {
        const Triangle2& triangle = (*triangles)[t];
        // Less than the smallest step of float UVs squared is no area.
        if (!soup.slivers[t] && std::abs(doubled_area(triangle)) < 1e-14) return std::nullopt;
        for (const Point2& p : triangle) {
            uvs.low = {std::min(uvs.low.x, p.x), std::min(uvs.low.y, p.y)};
            uvs.high = {std::max(uvs.high.x, p.x), std::max(uvs.high.y, p.y)};
        }
    }
    const double cells = 32 * std::sqrt(double(triangles->size()));
    if (any_overlap(*triangles, std::clamp(static_cast<int>(cells), 256, 4096)))
        return std::nullopt;
    uvs.meters_per_unit = surface_lengths(soup, *triangles);
    uvs.chart_count = count_regions(*triangles);
    return uvs;
}

}  // namespace aglow::mesh
