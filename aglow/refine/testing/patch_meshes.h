// SPDX-License-Identifier: Apache-2.0
// Coarse meshes for the tests of patches.
#pragma once
#include "aglow/core/random.h"
#include "aglow/core/testing/demand.h"
#include "aglow/mesh/topology.h"
#include "aglow/refine/patches.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace aglow::refine::testing {

struct PatchMesh {
    Topology topology;
    std::vector<vec3> positions;          ///< [vertex]
    std::vector<vec3> normals;            ///< [half-edge]
    std::vector<shared::ShapeTags> tags;  ///< [vertex]
    std::vector<vec2> uvs;                ///< [half-edge]

    PatchInput input() const { return {positions, normals, {}}; }
    PatchInput tagged_input() const { return {positions, normals, tags}; }
};

inline Topology topology_of(const PolygonList& polygons) {
    Result<TopologyResult> made = build_topology(polygons);
    REQUIRE_MESSAGE(made, made.error().message);
    REQUIRE(made->repairs.none());
    return std::move(made->topology);
}

/// The same faces and corners, no two of which share a vertex.
inline Topology cut_all(const Topology& topology) {
    PolygonList polygons;
    polygons.face_begin = topology.face_begin;
    polygons.vertex_count = topology.half_edge_count();
    for (uint32_t h = 0; h < polygons.vertex_count; ++h) polygons.corners.push_back(h);
    return topology_of(polygons);
}

inline vec3 random_vector(Pcg32& random) {
    return {2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1};
}

/// A sheet of columns x rows cells, some of them split into triangles, with rough positions and
/// normals, tags and texture coordinates that differ from face to face.
inline PatchMesh random_sheet(uint64_t seed, uint32_t columns, uint32_t rows, float quads) {
    Pcg32 random(seed);
    PatchMesh mesh;
    PolygonList polygons;
    const auto face = [&](std::vector<uint32_t> corners) {
        polygons.corners.insert(polygons.corners.end(), corners.begin(), corners.end());
        polygons.face_begin.push_back(static_cast<uint32_t>(polygons.corners.size()));
    };
    for (uint32_t y = 0; y <= rows; ++y)
        for (uint32_t x = 0; x <= columns; ++x)
            mesh.positions.push_back(vec3{static_cast<float>(x), static_cast<float>(y), 0} +
                                     random_vector(random) * 0.3f);
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const uint32_t a = y * (columns + 1) + x, b = a + 1, d = a + columns + 1, c = d + 1;
            if (random.uniform() < quads) {
                face({a, b, c, d});
            } else if (random.uniform() < 0.5f) {
                face({a, b, c});
                face({c, d, a});
            } else {
                face({d, b, c});
                face({b, d, a});
            }
        }
    polygons.vertex_count = static_cast<uint32_t>(mesh.positions.size());
    mesh.topology = topology_of(polygons);
    std::vector<vec3> at_vertex;
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        at_vertex.push_back(normalize(vec3{0, 0, 1} + random_vector(random) * 0.5f));
        mesh.tags.push_back({random.uniform(), 2 * random.uniform() - 1, 2 * random.uniform() - 1});
    }
    for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
        mesh.normals.push_back(at_vertex[mesh.topology.vertex[h]]);
        mesh.uvs.push_back({random.uniform(), random.uniform()});
    }
    return mesh;
}

/// Some corners get a normal of their own: creases.
inline void roughen_normals(PatchMesh& mesh, uint64_t seed) {
    Pcg32 random(seed);
    for (vec3& n : mesh.normals)
        if (random.uniform() < 0.3f) n = normalize(n + random_vector(random));
}

/// A sphere of radius 1: an octahedron with `segments` on its edges, and its exact normals.
inline PatchMesh sphere(int segments) {
    const uint32_t n = static_cast<uint32_t>(segments);
    PatchMesh mesh;
    PolygonList polygons;
    std::map<std::array<int, 3>, uint32_t> numbers;
    const auto vertex = [&](int x, int y, int z) {
        const auto [at, is_new] =
            numbers.try_emplace({x, y, z}, static_cast<uint32_t>(mesh.positions.size()));
        if (is_new)
            mesh.positions.push_back(normalize(
                vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}));
        return at->second;
    };
    for (const int sx : {1, -1})
        for (const int sy : {1, -1})
            for (const int sz : {1, -1}) {
                const auto corner = [&](uint32_t i, uint32_t j) {
                    return vertex(sx * static_cast<int>(n - i - j), sy * static_cast<int>(i),
                                  sz * static_cast<int>(j));
                };
                const auto face = [&](uint32_t a, uint32_t b, uint32_t c) {
                    const bool outwards = sx * sy * sz > 0;
                    polygons.corners.insert(polygons.corners.end(),
                                            {a, outwards ? b : c, outwards ? c : b});
                    polygons.face_begin.push_back(static_cast<uint32_t>(polygons.corners.size()));
                };
                for (uint32_t j = 0; j < n; ++j)
                    for (uint32_t i = 0; i + j < n; ++i) {
                        face(corner(i, j), corner(i + 1, j), corner(i, j + 1));
                        if (i + j + 1 < n)
                            face(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
                    }
            }
    polygons.vertex_count = static_cast<uint32_t>(mesh.positions.size());
    mesh.topology = topology_of(polygons);
    for (const uint32_t v : mesh.topology.vertex) mesh.normals.push_back(mesh.positions[v]);
    return mesh;
}

/// A level for each edge, from 1 to `most`.
inline std::vector<float> random_levels(const Topology& topology, uint64_t seed, int most,
                                        bool whole) {
    Pcg32 random(seed);
    std::vector<float> levels;
    for (uint32_t e = 0; e < topology.edge_count(); ++e) {
        const float level = 1 + random.uniform() * static_cast<float>(most - 1);
        levels.push_back(whole ? std::round(level) : level);
    }
    return levels;
}

/// Levels of the edges of a cut topology.
inline std::vector<float> levels_of_cut(const Topology& cut, const Topology& whole,
                                        const std::vector<float>& levels) {
    std::vector<float> result;
    for (const uint32_t h : cut.edge_half) result.push_back(levels[whole.edge[h]]);
    return result;
}

}  // namespace aglow::refine::testing
