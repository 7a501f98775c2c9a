// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Coarse meshes for tests of refinement.
namespace aglow::refine::testing {

struct CoarseMesh {
    std::string name;
    PolygonList polygons;
    std::vector<Crease> creases;
    std::vector<std::pair<uint32_t, float>> sharp_vertices;
    std::vector<vec3> positions;

    void add_face(const std::vector<uint32_t>& corners) {
        polygons.corners.insert(polygons.corners.end(), corners.begin(), corners.end());
        polygons.face_begin.push_back(static_cast<uint32_t>(polygons.corners.size()));
    }
    uint32_t add_vertex(double x, double y, double z) {
        positions.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
        polygons.vertex_count = static_cast<uint32_t>(positions.size());
        return polygons.vertex_count - 1;
    }
};

inline Topology topology_of(const CoarseMesh& mesh) {
    Topology topology = build_topology(mesh.polygons, mesh.creases)->topology;
    for (const auto& [v, sharpness] : mesh.sharp_vertices) topology.vertex_sharpness[v] = sharpness;
    return topology;
}

/// Numbers that look random and are the same everywhere, in [0, 1).
class Noise {
public:
    explicit Noise(uint32_t seed) : state_(seed * 2654435761u + 1) {}
    double operator()() {
        state_ = state_ * 1664525u + 1013904223u;
        return (state_ >> 8) / 16777216.0;
    }

private:
    uint32_t state_;
};

/// Every polygon as a fan of triangles.
inline CoarseMesh triangulated(const CoarseMesh& mesh) {
    CoarseMesh result = mesh;
    result.polygons.face_begin = {0};
    result.polygons.corners.clear();
    for (uint32_t f = 0; f < mesh.polygons.face_count(); ++f) {
        const uint32_t first = mesh.polygons.face_begin[f], last = mesh.polygons.face_begin[f + 1];
        for (uint32_t c = first + 1; c + 1 < last; ++c)
            result.add_face({mesh.polygons.corners[first], mesh.polygons.corners[c],
                             mesh.polygons.corners[c + 1]});
    }
    return result;
}

inline CoarseMesh tetrahedron() {
    CoarseMesh mesh{"tetrahedron", {}, {}, {}, {}};
    for (const auto& p : {std::array{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}})
        mesh.add_vertex(p[0], p[1], p[2]);
    for (const auto& f : {std::array{0u, 1u, 2u}, {0u, 2u, 3u}, {0u, 3u, 1u}, {1u, 3u, 2u}})
        mesh.add_face({f[0], f[1], f[2]});
    return mesh;
}

inline CoarseMesh cube(std::string name, std::vector<Crease> creases) {
    CoarseMesh mesh{std::move(name), {}, std::move(creases), {}, {}};
    for (int i = 0; i < 8; ++i) mesh.add_vertex(i & 1, (i >> 1) & 1, i >> 2);
    for (const auto& f : {std::array{0u, 2u, 3u, 1u},
                          {4u, 5u, 7u, 6u},
                          {0u, 1u, 5u, 4u},
                          {2u, 6u, 7u, 3u},
                          {0u, 4u, 6u, 2u},
                          {1u, 3u, 7u, 5u}})
        mesh.add_face({f[0], f[1], f[2], f[3]});
    return mesh;
}

/// A cube of edge 2 around the origin: 12 triangles.
inline CoarseMesh cube_of_triangles() {
    CoarseMesh mesh = triangulated(cube("cube of triangles", {}));
    for (vec3& p : mesh.positions) p = p * 2.0f - vec3{1, 1, 1};
    return mesh;
}

/// [half-edge] unit vectors away from the origin.
inline std::vector<vec3> normals_from_origin(const Topology& topology,
                                             const std::vector<vec3>& positions) {
    std::vector<vec3> normals;
    for (const uint32_t v : topology.vertex) normals.push_back(normalize(positions[v]));
    return normals;
}

/// Two points over and under a ring of `n`: valence n and 4.
inline CoarseMesh bipyramid(uint32_t n) {
    CoarseMesh mesh{"bipyramid " + std::to_string(n), {}, {}, {}, {}};
    const uint32_t top = mesh.add_vertex(0.1, 0, 1.5), bottom = mesh.add_vertex(0, 0.2, -1);
    for (uint32_t i = 0; i < n; ++i) {
        const double a = 6.283185307179586 * i / n, r = 1 + 0.2 * std::sin(3.0 * a);
        mesh.add_vertex(r * std::cos(a), r * std::sin(a), 0.1 * std::cos(5.0 * a));
    }
    for (uint32_t i = 0; i < n; ++i) {
        mesh.add_face({2 + i, 2 + (i + 1) % n, top});
        mesh.add_face({2 + (i + 1) % n, 2 + i, bottom});
    }
    return mesh;
}

/// A polygon of n corners at both ends of a ring of quads, one rim sharp, the other semi-sharp.
inline CoarseMesh prism(uint32_t n) {
    CoarseMesh mesh{"prism " + std::to_string(n), {}, {}, {}, {}};
    std::vector<uint32_t> top, bottom;
    for (uint32_t i = 0; i < n; ++i) {
        const double a = 6.283185307179586 * i / n;
        bottom.push_back(mesh.add_vertex(std::cos(a), std::sin(a), 0.1 * std::sin(2 * a)));
        top.push_back(mesh.add_vertex(1.2 * std::cos(a), std::sin(a), 1 + 0.2 * std::cos(3 * a)));
    }
    for (uint32_t i = 0; i < n; ++i) {
        const uint32_t j = (i + 1) % n;
        mesh.add_face({bottom[i], bottom[j], top[j], top[i]});
        mesh.creases.push_back({bottom[i], bottom[j], kSharp});
        mesh.creases.push_back({top[i], top[j], 1.6f});
    }
    mesh.add_face(top);
    mesh.add_face({bottom.rbegin(), bottom.rend()});
    return mesh;
}

/// A centre and `n` points round it, open between the last and the first: valence n at a boundary.
inline CoarseMesh open_fan(uint32_t n) {
    CoarseMesh mesh{"open fan " + std::to_string(n), {}, {}, {}, {}};
    mesh.add_vertex(0, 0, 0.5);
    for (uint32_t i = 0; i < n; ++i) {
        const double a = 5.5 * i / (n - 1);
        mesh.add_vertex(std::cos(a), std::sin(a), 0.2 * std::sin(4 * a));
    }
    for (uint32_t i = 1; i < n; ++i) mesh.add_face({0, i, i + 1});
    mesh.creases.push_back({0, n / 2, 2.3f});
    return mesh;
}

/// A sheet of quads with bumps and a hole, some pairs of them merged to hexagons.
inline CoarseMesh sheet(uint32_t columns, uint32_t rows, uint32_t seed, std::string name) {
    CoarseMesh mesh{std::move(name), {}, {}, {}, {}};
    Noise noise(seed);
    for (uint32_t y = 0; y <= rows; ++y)
        for (uint32_t x = 0; x <= columns; ++x)
            mesh.add_vertex(x + 0.2 * noise(), y + 0.2 * noise(), noise());
    const auto at = [&](uint32_t x, uint32_t y) { return y * (columns + 1) + x; };
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            if (x == columns / 2 && y == rows / 2) continue;
            if (noise() < 0.3) {
                mesh.add_face({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
                mesh.add_face({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
            } else if (x + 1 < columns && noise() < 0.3 && y != rows / 2) {
                mesh.add_face({at(x, y), at(x + 1, y), at(x + 2, y), at(x + 2, y + 1),
                               at(x + 1, y + 1), at(x, y + 1)});
                ++x;
            } else {
                mesh.add_face({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
            }
        }
    // Vertices that lost their only face to the hole do not occur: it is of one face.
    return mesh;
}

/// Sharp, semi-sharp and smooth edges without any order, and some sharp vertices.
inline CoarseMesh with_random_creases(CoarseMesh mesh, uint32_t seed) {
    mesh.name += " with random creases";
    Noise noise(seed);
    const Topology topology = topology_of(mesh);
    for (uint32_t e = 0; e < topology.edge_count(); ++e) {
        const uint32_t h = topology.edge_half[e];
        const double kind = noise(), sharpness = 4 * noise();
        if (kind < 0.25)
            mesh.creases.push_back({topology.vertex[h], topology.end(h),
                                    kind < 0.08 ? kSharp : static_cast<float>(sharpness)});
    }
    for (uint32_t v = 0; v < topology.vertex_count(); ++v)
        if (noise() < 0.1) mesh.sharp_vertices.emplace_back(v, static_cast<float>(3 * noise()));
    return mesh;
}

/// A torus of quads, every other of them split along one or the other diagonal: valences 4 to 8.
inline CoarseMesh torus(uint32_t major, uint32_t minor) {
    CoarseMesh mesh{"torus", {}, {}, {}, {}};
    for (uint32_t i = 0; i < major; ++i)
        for (uint32_t j = 0; j < minor; ++j) {
            const double a = 6.283185307179586 * i / major, b = 6.283185307179586 * j / minor;
            const double r = 3 + (1 + 0.3 * std::sin(3 * a)) * std::cos(b);
            mesh.add_vertex(r * std::cos(a), r * std::sin(a), std::sin(b));
        }
    const auto at = [&](uint32_t i, uint32_t j) { return i % major * minor + j % minor; };
    for (uint32_t i = 0; i < major; ++i)
        for (uint32_t j = 0; j < minor; ++j) {
            const std::array corner = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
            if ((i + j) % 2 == 0) {
                mesh.add_face({corner.begin(), corner.end()});
                continue;
            }
            const size_t k = (i * 7 + j) % 2;
            mesh.add_face({corner[k], corner[k + 1], corner[k + 2]});
            mesh.add_face({corner[k], corner[k + 2], corner[(k + 3) % 4]});
        }
    return mesh;
}

/// Both as one mesh of two components.
inline CoarseMesh joined(const CoarseMesh& a, const CoarseMesh& b) {
    CoarseMesh mesh = a;
    mesh.name += " and " + b.name;
    const uint32_t first = a.polygons.vertex_count;
    for (const vec3 p : b.positions) mesh.add_vertex(double(p.x) + 5, double(p.y), double(p.z));
    for (uint32_t f = 0; f < b.polygons.face_count(); ++f) {
        std::vector<uint32_t> corners;
        for (uint32_t c = b.polygons.face_begin[f]; c < b.polygons.face_begin[f + 1]; ++c)
            corners.push_back(first + b.polygons.corners[c]);
        mesh.add_face(corners);
    }
    for (const Crease& c : b.creases)
        mesh.creases.push_back({first + c.a, first + c.b, c.sharpness});
    for (const auto& [v, s] : b.sharp_vertices) mesh.sharp_vertices.emplace_back(first + v, s);
    return mesh;
}

/// Boundaries, creases of all kinds, valences 3 to 40, faces of 3 to 40 corners, several pieces.
inline std::vector<CoarseMesh> coarse_meshes() {
    return {
        tetrahedron(),
        cube("cube", {}),
        cube("cube, sharp round a face and along an edge",
             {{0, 1}, {1, 3}, {3, 2}, {2, 0}, {4, 5}}),
        cube("cube, semi-sharp",
             {{0, 1, 0.5f}, {1, 5, 1.0f}, {5, 4, 2.7f}, {3, 7, 3.2f}, {7, 6, 0.1f}}),
        bipyramid(40),
        bipyramid(7),
        prism(40),
        open_fan(40),
        sheet(7, 5, 1, "sheet with a hole"),
        with_random_creases(sheet(6, 6, 2, "sheet"), 3),
        with_random_creases(torus(12, 6), 4),
        joined(joined(torus(9, 5), prism(5)), joined(open_fan(3), tetrahedron())),
    };
}

}  // namespace aglow::refine::testing
