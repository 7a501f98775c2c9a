// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/triangles.h"

#include <cmath>

namespace aglow::gltf {
namespace {

/// In double: products of edges of tiny or huge triangles leave the range of float.
struct Vec3d {
    double x = 0, y = 0, z = 0;
};

Vec3d difference(vec3 a, vec3 b) {
    return {static_cast<double>(a.x) - b.x, static_cast<double>(a.y) - b.y,
            static_cast<double>(a.z) - b.z};
}

/// Twice the area times the normal.
Vec3d area_normal(const Primitive& primitive, uvec3 t) {
    const Vec3d u = difference(primitive.positions[t.y], primitive.positions[t.x]);
    const Vec3d v = difference(primitive.positions[t.z], primitive.positions[t.x]);
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

/// Unit vector along `v`, or up where it has no direction.
vec3 unit_or_up(Vec3d v) {
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length > 0) || !std::isfinite(length)) return {0, 1, 0};
    return {static_cast<float>(v.x / length), static_cast<float>(v.y / length),
            static_cast<float>(v.z / length)};
}

template <class T>
void gather(std::vector<T>& values, std::span<const uint32_t> from, size_t width = 1) {
    if (values.empty()) return;
    std::vector<T> gathered;
    gathered.reserve(from.size() * width);
    for (const uint32_t i : from)
        for (size_t k = 0; k < width; ++k) gathered.push_back(values[i * width + k]);
    values = std::move(gathered);
}

/// Tags of vertices that were split, on one copy of each; those of vertices without triangles go.
void renumber_tags(Primitive& primitive, std::span<const uint32_t> from, size_t vertex_count) {
    if (primitive.creases.empty() && primitive.corners.empty()) return;
    constexpr uint32_t kGone = UINT32_MAX;
    std::vector<uint32_t> copy(vertex_count, kGone);
    for (uint32_t i = 0; i < from.size(); ++i) copy[from[i]] = i;
    for (SharpEdge& crease : primitive.creases) {
        crease.a = copy[crease.a];
        crease.b = copy[crease.b];
    }
    for (SharpVertex& corner : primitive.corners) corner.vertex = copy[corner.vertex];
    std::erase_if(primitive.creases,
                  [](const SharpEdge& c) { return c.a == kGone || c.b == kGone; });
    std::erase_if(primitive.corners, [](const SharpVertex& c) { return c.vertex == kGone; });
}

}  // namespace

std::vector<uvec3> triangles_of(int mode, std::span<const uint32_t> indices) {
    std::vector<uvec3> triangles;
    const size_t count = indices.size();
    if (mode == 4)
        for (size_t i = 0; i + 2 < count; i += 3)
            triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    if (mode == 5)
        for (size_t i = 0; i + 2 < count; ++i)
            triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    if (mode == 6)
        for (size_t i = 0; i + 2 < count; ++i)
            triangles.push_back({indices[i + 1], indices[i + 2], indices[0]});
    return triangles;
}

void make_flat(Primitive& primitive) {
    std::vector<uint32_t> from;
    from.reserve(3 * primitive.triangles.size());
    primitive.normals.clear();
    for (const uvec3 t : primitive.triangles) {
        from.insert(from.end(), {t.x, t.y, t.z});
        const vec3 normal = unit_or_up(area_normal(primitive, t));
        primitive.normals.insert(primitive.normals.end(), 3, normal);
    }
    renumber_tags(primitive, from, primitive.positions.size());
    gather(primitive.positions, from);
    for (auto& set : primitive.texcoords) gather(set, from);
    gather(primitive.colors, from);
    gather(primitive.joints, from, static_cast<size_t>(primitive.influences));
    gather(primitive.weights, from, static_cast<size_t>(primitive.influences));
    for (auto* tag : {&primitive.sharpness, &primitive.tension, &primitive.bias})
        gather(*tag, from);
    for (MorphTarget& target : primitive.targets) {
        gather(target.positions, from);
        // Without normals of its own, a primitive has none to displace (section 3.7.2.2).
        target.normals.clear();
    }
    for (uint32_t t = 0; t < primitive.triangles.size(); ++t)
        primitive.triangles[t] = {3 * t, 3 * t + 1, 3 * t + 2};
    primitive.source_vertex = std::move(from);
}

size_t repair_normals(Primitive& primitive) {
    std::vector<Vec3d> around;
    size_t repaired = 0;
    for (size_t i = 0; i < primitive.normals.size(); ++i) {
        vec3& n = primitive.normals[i];
        if (n != vec3{0, 0, 0}) {
            n = unit_or_up({n.x, n.y, n.z});
            continue;
        }
        if (around.empty()) {
            around.resize(primitive.normals.size());
            for (const uvec3 t : primitive.triangles) {
                const Vec3d normal = area_normal(primitive, t);
                for (const uint32_t corner : {t.x, t.y, t.z}) {
                    around[corner].x += normal.x;
                    around[corner].y += normal.y;
                    around[corner].z += normal.z;
                }
            }
        }
        n = unit_or_up(around[i]);
        ++repaired;
    }
    return repaired;
}

}  // namespace aglow::gltf
