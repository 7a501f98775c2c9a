// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/patches.h"

#include "aglow/core/parallel.h"
#include "aglow/refine/pattern.h"
#include "aglow/refine/testing/control_meshes.h"
#include "aglow/refine/testing/patch_meshes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

/// Twice as precise as what is tested.
struct Exact {
    double x = 0, y = 0, z = 0;
    Exact() = default;
    Exact(double a, double b, double c) : x(a), y(b), z(c) {}
    explicit Exact(vec3 v) : x(v.x), y(v.y), z(v.z) {}
    Exact operator+(Exact o) const { return {x + o.x, y + o.y, z + o.z}; }
    Exact operator-(Exact o) const { return {x - o.x, y - o.y, z - o.z}; }
    Exact operator*(double s) const { return {x * s, y * s, z * s}; }
};
double dot(Exact a, Exact b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(Exact a) { return std::sqrt(dot(a, a)); }

struct Corner {
    Exact p, n;
    shared::ShapeTags tags = {};
};
using Corners = std::array<Corner, 3>;

/// The point of the edge from a to b that belongs to a: Vlachos et al., section 3.1.
Exact pn_edge_point(const Corner& a, const Corner& b) {
    const double w = dot(b.p - a.p, a.n);
    return (a.p * 2 + b.p - a.n * w) * (1.0 / 3);
}

/// docs/derivations/tagged-pn.md
Exact tagged_edge_point(const Corner& a, const Corner& b) {
    const Exact d = b.p - a.p;
    const Exact tangent = d - a.n * (dot(d, a.n) * (1 - double(a.tags.sharpness)));
    const double beta = 0.5 * (double(a.tags.bias) - double(b.tags.bias));
    return a.p + tangent * ((1 - double(a.tags.tension)) * (1 + beta) / 3);
}

template <class EdgePoint>
Exact cubic(const Corners& c, const EdgePoint& point, double u, double v, double w) {
    const Exact b210 = point(c[0], c[1]), b120 = point(c[1], c[0]), b021 = point(c[1], c[2]),
                b012 = point(c[2], c[1]), b102 = point(c[2], c[0]), b201 = point(c[0], c[2]);
    const Exact e = (b210 + b120 + b021 + b012 + b102 + b201) * (1.0 / 6);
    const Exact mean = (c[0].p + c[1].p + c[2].p) * (1.0 / 3);
    const Exact b111 = e + (e - mean) * 0.5;
    return c[0].p * (u * u * u) + c[1].p * (v * v * v) + c[2].p * (w * w * w) +
           b210 * (3 * u * u * v) + b120 * (3 * u * v * v) + b021 * (3 * v * v * w) +
           b012 * (3 * v * w * w) + b102 * (3 * w * w * u) + b201 * (3 * w * u * u) +
           b111 * (6 * u * v * w);
}

/// Boubekeur & Alexa, section 3: projections of the flat point, blended by barycentrics.
Exact phong(const Corners& c, double shape, double u, double v, double w) {
    const Exact flat = c[0].p * u + c[1].p * v + c[2].p * w;
    const auto projected = [&](const Corner& k) { return flat - k.n * dot(flat - k.p, k.n); };
    const Exact curved = projected(c[0]) * u + projected(c[1]) * v + projected(c[2]) * w;
    return flat * (1 - shape) + curved * shape;
}

/// Vlachos et al., section 3.3.
Exact quadratic_normal(const Corners& c, double u, double v, double w) {
    const auto middle = [](const Corner& a, const Corner& b) {
        const Exact d = b.p - a.p;
        const double k = 2 * dot(d, a.n + b.n) / dot(d, d);
        const Exact h = a.n + b.n - d * k;
        return h * (1 / length(h));
    };
    const Exact n = c[0].n * (u * u) + c[1].n * (v * v) + c[2].n * (w * w) +
                    middle(c[0], c[1]) * (u * v) + middle(c[1], c[2]) * (v * w) +
                    middle(c[2], c[0]) * (w * u);
    return n * (1 / length(n));
}

Corners corners_of(const PatchMesh& mesh, uint32_t f) {
    Corners c;
    for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t h = mesh.topology.face_begin[f] + i;
        const uint32_t v = mesh.topology.vertex[h];
        c[i] = {Exact(mesh.positions[v]), Exact(mesh.normals[h]),
                mesh.tags.empty() ? shared::ShapeTags{} : mesh.tags[v]};
    }
    return c;
}

double diagonal(const PatchMesh& mesh) {
    Box box;
    for (const vec3 p : mesh.positions) box.add(p);
    return double(length(box.size()));
}

struct Evaluated {
    PatchControl control;
    std::vector<vec3> positions, normals;
};

Evaluated evaluate(const PatchMesh& mesh, const PatchOptions& options, const PatchInput& input,
                   const Tessellation& tessellation) {
    const Patches patches = demand(Patches::create(mesh.topology, options));
    Evaluated e;
    patches.update(input, e.control);
    e.positions.resize(tessellation.vertex_count());
    e.normals.resize(tessellation.vertex_count());
    patches.evaluate(e.control, tessellation, e.positions);
    patches.evaluate_normals(e.control, tessellation, e.normals);
    return e;
}

/// The largest distance from exact(corners, u, v, w), over all vertices of all faces of a uniform
/// tessellation; the tessellation of the cut mesh tells which are whose.
template <class Formula>
double distance_to(const PatchMesh& mesh, int segments, const std::vector<vec3>& values,
                   const Formula& exact) {
    const Topology cut = cut_all(mesh.topology);
    const Tessellation whole = demand(Tessellation::uniform(mesh.topology, segments));
    const Tessellation parts = demand(Tessellation::uniform(cut, segments));
    const std::vector<uint32_t> sources = refined_sources(cut, parts, mesh.topology, whole);
    const Pattern pattern = triangle_pattern(segments);
    const size_t per_face = pattern.triangles.size();
    double worst = 0;
    for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) {
        const Corners corners = corners_of(mesh, f);
        for (size_t t = 0; t < per_face; ++t) {
            const uvec3 from = pattern.triangles[t], to = parts.triangles[f * per_face + t];
            for (const auto& [p, v] :
                 {std::pair(from.x, to.x), std::pair(from.y, to.y), std::pair(from.z, to.z)}) {
                const vec2 at = pattern.coordinates[p];
                const Exact e =
                    exact(corners, 1 - double(at.x) - double(at.y), double(at.x), double(at.y));
                worst = std::max(worst, length(e - Exact(values[sources[v]])));
            }
        }
    }
    return worst;
}

bool same_bits(vec3 a, vec3 b) {
    using Bits = std::array<uint32_t, 3>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

TEST_CASE("PN, tagged and Phong triangles are those of the formulas in double precision") {
    const PatchMesh mesh = random_sheet(11, 5, 4, 0);
    const double bound = 1e-6 * diagonal(mesh);
    for (const int segments : {1, 2, 5, 16, 31}) {
        const Tessellation t = demand(Tessellation::uniform(mesh.topology, segments));
        const Evaluated pn = evaluate(mesh, {}, mesh.input(), t);
        const auto cubic_with = [](const auto& point) {
            return [&point](const Corners& c, double u, double v, double w) {
                return cubic(c, point, u, v, w);
            };
        };
        CHECK(distance_to(mesh, segments, pn.positions, cubic_with(pn_edge_point)) < bound);
        CHECK(distance_to(mesh, segments, pn.normals, quadratic_normal) < 1e-6);
        const Evaluated tagged = evaluate(mesh, {}, mesh.tagged_input(), t);
        CHECK(distance_to(mesh, segments, tagged.positions, cubic_with(tagged_edge_point)) < bound);
        const PatchOptions options = {.shape = PatchShape::phong, .phong_shape = 0.6f};
        const Evaluated soft = evaluate(mesh, options, mesh.input(), t);
        CHECK(distance_to(mesh, segments, soft.positions,
                          [](const Corners& c, double u, double v, double w) {
                              return phong(c, double(0.6f), u, v, w);
                          }) < bound);
        const Evaluated flat = evaluate(mesh, {.shape = PatchShape::flat}, mesh.input(), t);
        CHECK(distance_to(mesh, segments, flat.positions,
                          [](const Corners& c, double u, double v, double w) {
                              return phong(c, 0, u, v, w);
                          }) < bound);
    }
}

TEST_CASE("a level per edge evaluates the same surface as one level for all") {
    const PatchMesh mesh = random_sheet(12, 4, 4, 0.4f);
    const Tessellation uniform = demand(Tessellation::uniform(mesh.topology, 12));
    const Tessellation adaptive = demand(Tessellation::adaptive(
        mesh.topology, std::vector<float>(mesh.topology.edge_count(), 12.0f)));
    const Evaluated a = evaluate(mesh, {}, mesh.tagged_input(), uniform);
    const Evaluated b = evaluate(mesh, {}, mesh.tagged_input(), adaptive);
    for (size_t v = 0; v < a.positions.size(); ++v) {
        CHECK(length(a.positions[v] - b.positions[v]) < 2e-6 * diagonal(mesh));
        CHECK(length(a.normals[v] - b.normals[v]) < 1e-6f);
    }
}

TEST_CASE("tags of zero are PN triangles, and full sharpness gives flat triangles") {
    PatchMesh mesh = random_sheet(13, 4, 4, 0);
    const Tessellation t = demand(Tessellation::uniform(mesh.topology, 9));
    const Evaluated pn = evaluate(mesh, {}, mesh.input(), t);
    mesh.tags.assign(mesh.tags.size(), {});
    const Evaluated zero = evaluate(mesh, {}, mesh.tagged_input(), t);
    for (size_t v = 0; v < pn.positions.size(); ++v)
        CHECK(length(pn.positions[v] - zero.positions[v]) < 1e-6f);
    mesh.tags.assign(mesh.tags.size(), {1, 0, 0});
    const Evaluated sharp = evaluate(mesh, {}, mesh.tagged_input(), t);
    CHECK(distance_to(mesh, 9, sharp.positions, [](const Corners& c, double u, double v, double w) {
              return c[0].p * u + c[1].p * v + c[2].p * w;
          }) < 1e-6 * diagonal(mesh));
}

TEST_CASE("planes are reproduced by triangles and quads") {
    PatchMesh mesh = random_sheet(14, 4, 4, 0.5f);
    for (vec3& p : mesh.positions) p.z = 0.5f * p.x - 0.25f * p.y;
    const vec3 n = normalize(vec3{-0.5f, 0.25f, 1});
    mesh.normals.assign(mesh.normals.size(), n);
    const Tessellation t = demand(Tessellation::uniform(mesh.topology, 7));
    for (const PatchShape shape : {PatchShape::flat, PatchShape::pn, PatchShape::phong}) {
        const Evaluated e = evaluate(mesh, {.shape = shape}, mesh.tagged_input(), t);
        for (const vec3 p : e.positions) CHECK(std::abs(dot(p, n)) < 1e-6f);
        for (const vec3 m : e.normals) CHECK(length(m - n) < 1e-6f);
    }
}

/// The largest distance of a refined sphere from the sphere.
double sphere_error(int segments, PatchShape shape) {
    const PatchMesh mesh = sphere(segments);
    const Tessellation t = demand(Tessellation::uniform(mesh.topology, 8));
    double worst = 0;
    for (const vec3 p : evaluate(mesh, {.shape = shape}, mesh.input(), t).positions)
        worst = std::max(worst, std::abs(double(length(p)) - 1));
    return worst;
}

TEST_CASE(
    "PN triangles approach a sphere with the fourth power of the edge, flat with the second") {
    for (const int n : {4, 8}) {
        CHECK(sphere_error(n, PatchShape::pn) / sphere_error(2 * n, PatchShape::pn) > 12);
        CHECK(sphere_error(n, PatchShape::flat) / sphere_error(2 * n, PatchShape::flat) < 4.5);
    }
    CHECK(sphere_error(4, PatchShape::pn) < 5e-3);
}

TEST_CASE("faces meet bitwise on their edges, whatever the levels, normals, tags and seams") {
    HeightMap map = make_height_map(std::array{0.0f, 1.0f, 0.5f, 0.25f}, 2, 2);
    for (uint64_t seed = 0; seed < 12; ++seed) {
        PatchMesh mesh = random_sheet(seed, 4, 4, 0.3f);
        roughen_normals(mesh, seed);
        const Topology cut = cut_all(mesh.topology);
        const std::vector<float> levels = random_levels(mesh.topology, seed, 20, seed % 2 == 0);
        const auto kind = static_cast<Tessellation::Levels>(seed / 2 % 2);
        const bool uniform = seed >= 8;
        const Tessellation whole =
            demand(uniform ? Tessellation::uniform(mesh.topology, static_cast<int>(seed))
                           : Tessellation::adaptive(mesh.topology, levels, kind));
        const Tessellation parts = demand(
            uniform ? Tessellation::uniform(cut, static_cast<int>(seed))
                    : Tessellation::adaptive(cut, levels_of_cut(cut, mesh.topology, levels), kind));
        const std::vector<uint32_t> sources = refined_sources(cut, parts, mesh.topology, whole);
        const Patches patches = demand(Patches::create(mesh.topology, {}));
        PatchControl control;
        patches.update(mesh.tagged_input(), control);
        std::vector<vec3> one(whole.vertex_count()), other(parts.vertex_count());
        patches.evaluate(control, whole, one);
        patches.evaluate(control, parts, other);
        for (size_t v = 0; v < other.size(); ++v) CHECK(same_bits(other[v], one[sources[v]]));

        DisplacementMap displacement;
        displacement.map = map;
        displacement.uvs = mesh.uvs;
        displacement.settings.amplitude = 0.1f;
        displacement.settings.frequency = {3, 2, 1};
        displacement.settings.octaves = 3;
        displacement.settings.lacunarity = 2;
        displacement.settings.gain = 0.5f;
        for (uint32_t d = 0; d < 4; ++d) {
            displacement.settings.kind = d;
            displacement.settings.map = map.levels;
            patches.evaluate(control, whole, displacement, one, {});
            patches.evaluate(control, parts, displacement, other, {});
            for (size_t v = 0; v < other.size(); ++v) CHECK(same_bits(other[v], one[sources[v]]));
        }
    }
}

TEST_CASE("irregular patterns draw vertices to where they are wanted, and faces still meet") {
    PatchMesh mesh = random_sheet(21, 4, 4, 0);
    Pcg32 random(21);
    Tessellation whole = demand(Tessellation::uniform(mesh.topology, 9));
    const Topology cut = cut_all(mesh.topology);
    Tessellation parts = demand(Tessellation::uniform(cut, 9));
    const std::vector<uint32_t> sources = refined_sources(cut, parts, mesh.topology, whole);
    for (size_t v = 0; v < mesh.positions.size(); ++v)
        whole.density.push_back(0.2f + 4 * random.uniform());
    parts.density = whole.density;
    const Evaluated one = evaluate(mesh, {}, mesh.input(), whole);
    const Patches patches = demand(Patches::create(mesh.topology, {}));
    std::vector<vec3> other(parts.vertex_count());
    patches.evaluate(one.control, parts, other);
    for (size_t v = 0; v < other.size(); ++v) CHECK(same_bits(other[v], one.positions[sources[v]]));

    const Evaluated even = evaluate(mesh, {.shape = PatchShape::flat}, mesh.input(),
                                    demand(Tessellation::uniform(mesh.topology, 9)));
    const Evaluated drawn = evaluate(mesh, {.shape = PatchShape::flat}, mesh.input(), whole);
    for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e) {
        const uint32_t h = mesh.topology.edge_half[e];
        const uint32_t a = mesh.topology.vertex[h], b = mesh.topology.end(h);
        for (uint32_t v = whole.edge_first[e]; v < whole.edge_first[e + 1]; ++v)
            CHECK((dot(drawn.positions[v] - even.positions[v],
                       mesh.positions[b] - mesh.positions[a]) > 0) ==
                  (whole.density[b] > whole.density[a]));
    }
    for (const uvec3 t : whole.triangles) {
        const auto area = [&](const std::vector<vec3>& p) {
            return cross(p[t.y] - p[t.x], p[t.z] - p[t.x]);
        };
        CHECK(dot(area(drawn.positions), area(even.positions)) > 0);  // nothing folds
    }
}

TEST_CASE("the rim of a cylinder stays round where the cap and the side have their own normals") {
    // A ring of quads and a fan of triangles on top of it, radius 1.
    constexpr uint32_t kSides = 12;
    PolygonList polygons;
    PatchMesh mesh;
    for (uint32_t i = 0; i < kSides; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / kSides;
        for (const float y : {0.0f, 1.0f})
            mesh.positions.push_back({std::cos(angle), y, -std::sin(angle)});
    }
    mesh.positions.push_back({0, 1, 0});
    for (uint32_t i = 0; i < kSides; ++i) {
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % kSides);
        polygons.corners.insert(polygons.corners.end(), {a, b, b + 1, a + 1});
        polygons.face_begin.push_back(static_cast<uint32_t>(polygons.corners.size()));
        polygons.corners.insert(polygons.corners.end(), {a + 1, b + 1, 2 * kSides});
        polygons.face_begin.push_back(static_cast<uint32_t>(polygons.corners.size()));
    }
    polygons.vertex_count = 2 * kSides + 1;
    mesh.topology = topology_of(polygons);
    for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
        const vec3 p = mesh.positions[mesh.topology.vertex[h]];
        mesh.normals.push_back(mesh.topology.face_size(mesh.topology.face[h]) == 3
                                   ? vec3{0, 1, 0}
                                   : vec3{p.x, 0, p.z});
    }
    const Tessellation t = demand(Tessellation::uniform(mesh.topology, 8));
    const Evaluated e = evaluate(mesh, {}, mesh.input(), t);
    size_t on_rim = 0;
    for (uint32_t edge = 0; edge < mesh.topology.edge_count(); ++edge) {
        const uint32_t h = mesh.topology.edge_half[edge], twin = mesh.topology.twin[h];
        if (twin == kNone || mesh.topology.face_size(mesh.topology.face[h]) ==
                                 mesh.topology.face_size(mesh.topology.face[twin]))
            continue;
        for (uint32_t v = t.edge_first[edge]; v < t.edge_first[edge + 1]; ++v, ++on_rim) {
            CHECK(std::hypot(e.positions[v].x, e.positions[v].z) ==
                  doctest::Approx(1).epsilon(2e-3));
            CHECK(e.positions[v].y == doctest::Approx(1));
        }
    }
    CHECK(on_rim == kSides * 7);
}

TEST_CASE("normals of a mesh without any are those of its faces, apart across sharp edges") {
    PatchMesh ball = sphere(8);
    for (uint32_t h = 0; h < ball.topology.half_edge_count(); ++h) {
        const std::vector<vec3> n = corner_normals(ball.topology, ball.positions);
        CHECK(length(n[h] - ball.normals[h]) < 0.03f);
        if (h > 40) break;
    }
    PatchMesh box = sphere(1);
    box.topology.edge_sharpness.assign(box.topology.edge_count(), kSharp);
    const std::vector<vec3> n = corner_normals(box.topology, box.positions);
    for (uint32_t h = 0; h < box.topology.half_edge_count(); ++h)
        for (const float part : {n[h].x, n[h].y, n[h].z})
            CHECK(std::abs(part) == doctest::Approx(std::sqrt(1.0 / 3)));
}

TEST_CASE("normals of a mesh are the same for all triangulations of its faces") {
    const CoarseMesh cube = cube_of_triangles();  // up to six triangles at a corner, as few as four
    const Topology topology = topology_of(cube);
    const std::vector<vec3> normals = corner_normals(topology, cube.positions);
    const std::vector<vec3> expected = normals_from_origin(topology, cube.positions);
    for (size_t h = 0; h < normals.size(); ++h) CHECK(length(normals[h] - expected[h]) < 1e-6f);
}

TEST_CASE("what is evaluated does not depend on the number of threads") {
    const PatchMesh mesh = sphere(12);
    const Tessellation t = demand(Tessellation::uniform(mesh.topology, 10));
    const Evaluated many = evaluate(mesh, {}, mesh.input(), t);
    const ThreadLimit limit(1);
    const Evaluated one = evaluate(mesh, {}, mesh.input(), t);
    for (size_t v = 0; v < one.positions.size(); ++v) {
        CHECK(same_bits(one.positions[v], many.positions[v]));
        CHECK(same_bits(one.normals[v], many.normals[v]));
    }
}

}  // namespace
