// SPDX-License-Identifier: Apache-2.0
// Test double for unwrapping: every triangle gets a square cell of its own, and light that tells
// where it was seen. Independent of the real charts, so that a test knows every UV it should find.
#pragma once
#include "aglow/encode/lightmap.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/mesh/unwrap.h"
#include "aglow/scene/scene.h"

#include <algorithm>
#include <cmath>

namespace aglow::encode::testing {

inline constexpr int kCell = 6;  // texels; the triangle keeps 1.5 texels of distance to the border

template <class T>
std::vector<T> corners_of(const std::vector<T>& values, const std::vector<uint32_t>& vertices,
                          size_t width = 1) {
    std::vector<T> out;
    if (values.empty()) return out;
    for (const uint32_t v : vertices)
        for (size_t i = 0; i < width; ++i) out.push_back(values[v * width + i]);
    return out;
}

/// Gives every triangle vertices of its own.
inline void split_all(Primitive& p) {
    std::vector<uint32_t> vertices;
    for (const uvec3 t : p.triangles) vertices.insert(vertices.end(), {t.x, t.y, t.z});
    p.positions = corners_of(p.positions, vertices);
    p.normals = corners_of(p.normals, vertices);
    p.colors = corners_of(p.colors, vertices);
    for (auto& set : p.texcoords) set = corners_of(set, vertices);
    p.joints = corners_of(p.joints, vertices, static_cast<size_t>(p.influences));
    p.weights = corners_of(p.weights, vertices, static_cast<size_t>(p.influences));
    for (auto* tag : {&p.sharpness, &p.tension, &p.bias}) *tag = corners_of(*tag, vertices);
    for (MorphTarget& target : p.targets) {
        target.positions = corners_of(target.positions, vertices);
        target.normals = corners_of(target.normals, vertices);
    }
    p.source_vertex = p.source_vertex.empty() ? vertices : corners_of(p.source_vertex, vertices);
    for (uint32_t i = 0; i < p.triangles.size(); ++i)
        p.triangles[i] = {3 * i, 3 * i + 1, 3 * i + 2};
}

/// Cells per side of the square of a mesh.
inline int side_of(const Mesh& mesh) {
    size_t count = 1;
    for (const Primitive& p : mesh.primitives) count += p.triangles.size();
    return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
}

inline void lay_out_mesh(Mesh& mesh) {
    const int side = side_of(mesh);
    const float size = static_cast<float>(side * kCell);
    int cell = 0;
    for (Primitive& p : mesh.primitives) {
        split_all(p);
        p.lightmap_uvs.clear();
        for (size_t t = 0; t < p.triangles.size(); ++t, ++cell) {
            const float x = static_cast<float>(cell % side * kCell);
            const float y = static_cast<float>(cell / side * kCell);
            for (const vec2 corner : {vec2{1.5f, 1.5f}, vec2{4.5f, 1.5f}, vec2{1.5f, 4.5f}})
                p.lightmap_uvs.push_back({(x + corner.x) / size, (y + corner.y) / size});
        }
    }
}

/// Lays out the whole scene: placements stand beside each other on shelves.
inline Atlas lay_out(Scene& scene) {
    Atlas atlas;
    atlas.texel_size = 0.05f;
    for (Mesh& mesh : scene.meshes) lay_out_mesh(mesh);
    atlas.origins.assign(scene.meshes.size(), UvOrigin::charts);
    constexpr int kWidth = 1024;
    int x = 0, y = 0, shelf = 0;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        if (!node.in_scene || node.mesh < 0) continue;
        const int size = kCell * side_of(scene.meshes[static_cast<size_t>(node.mesh)]);
        const size_t count = std::max<size_t>(1, node.instances.size());
        for (size_t i = 0; i < count; ++i) {
            if (x > 0 && x + size > kWidth) {
                x = 0;
                y += shelf;
                shelf = 0;
            }
            const float s = static_cast<float>(size);
            atlas.placements.push_back({static_cast<int>(n),
                                        static_cast<int>(i),
                                        node.mesh,
                                        {s, s},
                                        {static_cast<float>(x), static_cast<float>(y)}});
            x += size;
            shelf = std::max(shelf, size);
            atlas.width = std::max(atlas.width, x);
        }
    }
    atlas.height = y + shelf;
    return atlas;
}

/// Light is the position relative to this point: far enough out that it is never negative, even
/// where it goes on beyond the triangles.
inline vec3 origin_of(const Surfaces& surfaces) {
    Box box;
    for (const vec3 p : surfaces.positions) box.add(p);
    return box.lo - box.size() * 1.1f - vec3{1, 1, 1};
}

/// Light whose value is the position of the surface in the world: an affine function of the texel
/// over every cell, which bilinear look-ups reproduce exactly.
inline Lightmap position_light(const Surfaces& surfaces, const Atlas& atlas) {
    Lightmap map{Image(atlas.width, atlas.height), {}};
    map.covered.assign(map.irradiance.pixels.size(), 0);
    const vec3 origin = origin_of(surfaces);
    for (uint32_t t = 0; t < surfaces.triangles.size(); ++t) {
        const uvec3 tri = surfaces.triangles[t];
        const vec2 a = surfaces.lightmap_uvs[tri.x];
        const vec2 u = surfaces.lightmap_uvs[tri.y] - a;
        const vec2 v = surfaces.lightmap_uvs[tri.z] - a;
        const vec3 p = surfaces.positions[tri.x], q = surfaces.positions[tri.y],
                   r = surfaces.positions[tri.z];
        const float det = u.x * v.y - u.y * v.x;
        // The first vertex stands at (1.5, 1.5) of its cell, in mirrored nodes too.
        const int x0 = static_cast<int>(std::lround(a.x - 1.5f));
        const int y0 = static_cast<int>(std::lround(a.y - 1.5f));
        for (int y = y0; y < y0 + kCell; ++y) {
            for (int x = x0; x < x0 + kCell; ++x) {
                const vec2 d = vec2{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f} - a;
                const float b = (d.x * v.y - d.y * v.x) / det;
                const float c = (u.x * d.y - u.y * d.x) / det;
                const vec3 value = p + (q - p) * b + (r - p) * c - origin;
                map.irradiance.at(x, y) = shared::max(value, vec3{0, 0, 0});
                map.covered[static_cast<size_t>(y * atlas.width + x)] = 1;
            }
        }
    }
    return map;
}

/// Texels that say nothing but how large the atlas is.
inline Texels empty_texels(const Atlas& atlas) {
    Texels texels;
    texels.width = atlas.width;
    texels.height = atlas.height;
    texels.first_sample = {0};
    return texels;
}

}  // namespace aglow::encode::testing
