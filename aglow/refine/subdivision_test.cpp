// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/subdivision.h"
#include "aglow/core/testing/scenes.h"

#include "aglow/core/math.h"
#include "aglow/core/parallel.h"
#include "aglow/refine/tables/masks.h"
#include "aglow/refine/testing/control_meshes.h"
#include "aglow/refine/testing/open_subdiv.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

constexpr int kLevels = 5;
// Of the bounding box's diagonal; of normals, of the area that the tangents span beside the square
// over the longer: where that is small, rounded points decide where the normal is.
constexpr double kBound = 1e-5;

/// Vertices and faces of an OBJ file, as they are numbered there.
CoarseMesh read_obj(const std::string& path) {
    CoarseMesh mesh{path, {}, {}, {}, {}};
    std::ifstream file(path);
    for (std::string line, word; std::getline(file, line);) {
        std::istringstream words(line);
        words >> word;
        std::vector<uint32_t> corners;
        double x = 0, y = 0, z = 0;
        if (word == "v" && words >> x >> y >> z) mesh.add_vertex(x, y, z);
        while (word == "f" && words >> line)
            corners.push_back(static_cast<uint32_t>(std::stoul(line) - 1));
        if (!corners.empty()) mesh.add_face(corners);
    }
    return mesh;
}

float size_of(const std::vector<vec3>& points) {
    Box box;
    for (const vec3 p : points) box.add(p);
    return length(box.size());
}

double difference(vec3 a, OsdPoint b) {
    return std::hypot(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z);
}

/// The distance of a normal from u x v, weighted by how well these tell where it is.
double normal_difference(vec3 normal, OsdPoint u, OsdPoint v) {
    const OsdPoint n = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const double length = std::hypot(n.x, n.y, n.z);
    const double longer = std::max(std::hypot(u.x, u.y, u.z), std::hypot(v.x, v.y, v.z));
    const double spanned = length / (longer * longer);
    return spanned * difference(normal, {n.x / length, n.y / length, n.z / length});
}

struct Worst {
    double position = 0, limit = 0, normal = 0;
};

/// The largest differences from OpenSubdiv of all vertices, relative.
Worst worst_difference(const CoarseMesh& mesh, const SubdivisionOptions& options) {
    const Topology topology = topology_of(mesh);
    const Subdivision subdivision = *Subdivision::create(topology, options);
    std::vector<vec3> points(subdivision.vertex_count()), limit(points), normals(points);
    REQUIRE(subdivision.evaluate(mesh.positions, points));
    REQUIRE(subdivision.evaluate_limit(mesh.positions, limit, normals));

    const auto refiner = make_refiner(topology, options.scheme, options.corners);
    refine_uniform(*refiner, options.level);
    const Refined expected = refine_points(*refiner, options.level, mesh.positions);
    const auto match = match_vertices(topology, subdivision, *refiner, options.level);
    REQUIRE(expected.points.size() == points.size());
    const double size = double(size_of(mesh.positions));
    Worst worst;
    for (size_t v = 0; v < points.size(); ++v) {
        const size_t i = match[v];
        REQUIRE(i < expected.points.size());
        worst.position = std::max(worst.position, difference(points[v], expected.points[i]) / size);
        worst.limit = std::max(worst.limit, difference(limit[v], expected.limit[i]) / size);
        worst.normal =
            std::max(worst.normal, normal_difference(normals[v], expected.u[i], expected.v[i]));
    }
    return worst;
}

}  // namespace

TEST_CASE("points, limit points and normals are OpenSubdiv's at levels 1 to 5") {
    for (const Scheme scheme : {Scheme::loop, Scheme::catmull_clark})
        for (const CoarseMesh& polygons : coarse_meshes())
            for (const Corners corners : {Corners::smooth, Corners::sharp})
                for (int level = 1; level <= kLevels; ++level) {
                    const CoarseMesh mesh =
                        scheme == Scheme::loop ? triangulated(polygons) : polygons;
                    const Worst worst = worst_difference(mesh, {scheme, level, corners});
                    CAPTURE(mesh.name);
                    CAPTURE(level);
                    CAPTURE(int(scheme));
                    CAPTURE(int(corners));
                    CHECK(worst.position < kBound);
                    CHECK(worst.limit < kBound);
                    CHECK(worst.normal < kBound);
                }
}

TEST_CASE("levels that tables chain are OpenSubdiv's") {
    const CoarseMesh mesh = with_random_creases(prism(5), 7);
    for (const int level : {6, 7}) {
        const Worst loop = worst_difference(triangulated(mesh), {Scheme::loop, level, {}});
        const Worst quads = worst_difference(mesh, {Scheme::catmull_clark, level, {}});
        for (const Worst& worst : {loop, quads}) {
            CHECK(worst.position < kBound);
            CHECK(worst.limit < kBound);
            CHECK(worst.normal < kBound);
        }
    }
}

TEST_CASE("a model from a file is subdivided as OpenSubdiv does it") {
    const std::filesystem::path path = scenes_folder() / "meshes/spot.obj";
    if (!is_here(path)) return;
    const CoarseMesh spot = read_obj(path.string());
    REQUIRE(spot.polygons.face_count() > 1000);
    for (const Scheme scheme : {Scheme::loop, Scheme::catmull_clark}) {
        const CoarseMesh mesh = scheme == Scheme::loop ? triangulated(spot) : spot;
        const Worst worst = worst_difference(mesh, {scheme, 2, Corners::smooth});
        CHECK(worst.position < kBound);
        CHECK(worst.limit < kBound);
        // Edges are hundredths of the model, and points rounded to floats.
        CHECK(worst.normal < 3 * kBound);
    }
}

TEST_CASE("the mask of a smooth vertex is that of the factored form") {
    for (const uint32_t n : {3u, 4u, 5u, 6u, 7u, 12u, 40u}) {
        const Topology mesh = topology_of(bipyramid(n));
        refine::Masks masks(mesh, Scheme::loop);
        refine::Terms terms;
        masks.vertex(0, terms);
        // v' = v / 4 + 3 / (4n) of the sum of edge midpoints, v'' = v + cf(n) (v' - v).
        const double beta = 0.375 + std::cos(2 * double(kPi) / n) / 4;
        const double correct = 5.0 / 3 - 8.0 / 3 * beta * beta;
        REQUIRE(terms.size() == n + 1);
        for (const refine::Term& term : terms) {
            const double expected = term.vertex == 0 ? 1 - correct * 3 / 8 : correct * 3 / 8 / n;
            CHECK(term.weight == doctest::Approx(expected).epsilon(1e-7));
        }
    }
}

TEST_CASE("at level 0 control vertices stay, and have limits") {
    for (const Scheme scheme : {Scheme::loop, Scheme::catmull_clark}) {
        const CoarseMesh mesh =
            scheme == Scheme::loop ? bipyramid(7) : sheet(4, 5, 1, "sheet with a hole");
        const Topology topology = topology_of(mesh);
        const Subdivision still = *Subdivision::create(topology, {scheme, 0, Corners::smooth});
        const Subdivision fine = *Subdivision::create(topology, {scheme, 3, Corners::smooth});
        CHECK(still.vertex_count() == mesh.polygons.vertex_count);
        CHECK(still.triangles().size() == (scheme == Scheme::loop ? topology.face_count() : 0));
        CHECK(still.quads().empty());
        std::vector<vec3> points(still.vertex_count()), limit(points), normals(points);
        REQUIRE(still.evaluate(mesh.positions, points));
        CHECK(points == mesh.positions);
        REQUIRE(still.evaluate_limit(mesh.positions, limit, normals));
        std::vector<vec3> fine_limit(fine.vertex_count()), fine_normals(fine_limit);
        REQUIRE(fine.evaluate_limit(mesh.positions, fine_limit, fine_normals));
        for (size_t v = 0; v < limit.size(); ++v) {
            CHECK(length(limit[v] - fine_limit[v]) < 1e-5f);
            // Normals at boundaries are of finite differences, which levels make smaller.
            if (!topology.on_boundary(static_cast<uint32_t>(v)))
                CHECK(length(normals[v] - fine_normals[v]) < 1e-5f);
        }
    }
}

TEST_CASE("the number of threads changes no bit, and neither does what is evaluated beside") {
    const CoarseMesh mesh = triangulated(with_random_creases(torus(12, 6), 4));
    const Subdivision subdivision =
        *Subdivision::create(topology_of(mesh), {Scheme::loop, 4, Corners::smooth});
    const size_t count = subdivision.vertex_count();
    std::vector<vec3> points(count), again(count);
    REQUIRE(subdivision.evaluate(mesh.positions, points));
    {
        const ThreadLimit one(1);
        REQUIRE(subdivision.evaluate(mesh.positions, again));
    }
    CHECK(points == again);

    constexpr int kWidth = 7;  // the position in the middle of other numbers
    std::vector<float> control, wide(count * kWidth);
    for (const vec3 p : mesh.positions)
        control.insert(control.end(), {1, p.z, p.x, p.y, p.z, 0, 1});
    REQUIRE(subdivision.evaluate(control, kWidth, wide));
    bool same = true;
    for (size_t v = 0; v < count; ++v) {
        const float* row = &wide[v * kWidth];
        same &= points[v] == vec3{row[2], row[3], row[4]} && row[1] == points[v].z;
        same &= std::abs(row[0] - 1) < 1e-6f && std::abs(row[5]) < 1e-6f;
    }
    CHECK(same);
}

TEST_CASE("refined vertices come as corners, edges and insides, and all faces fit together") {
    for (const Scheme scheme : {Scheme::loop, Scheme::catmull_clark})
        for (const int level : {1, 2, 3, 4, 6}) {
            const CoarseMesh mesh = scheme == Scheme::loop ? triangulated(prism(5)) : prism(5);
            const Topology coarse = topology_of(mesh);
            const Subdivision fine = *Subdivision::create(coarse, {scheme, level, Corners::smooth});
            const PolygonList faces = refined_faces(fine);
            const auto built = build_topology(faces);
            REQUIRE(built);
            CHECK(built->repairs.none());
            const Topology& topology = built->topology;
            CHECK(topology.vertex_count() == fine.vertex_count());
            CHECK(faces.face_count() == fine.face_count());
            CHECK(std::ranges::count(topology.vertex_half, kNone) == 0);
            CHECK(std::ranges::count(topology.twin, kNone) == 0);
            // Sharp everywhere, edges stay straight, with equal steps along edge_half.
            Topology sharp = coarse;
            sharp.edge_sharpness.assign(coarse.edge_count(), kSharp);
            sharp.vertex_sharpness.assign(coarse.vertex_count(), kSharp);
            const Subdivision flat = *Subdivision::create(sharp, {scheme, level, Corners::smooth});
            std::vector<vec3> points(flat.vertex_count());
            REQUIRE(flat.evaluate(mesh.positions, points));
            const uint32_t steps = 1u << level;
            for (uint32_t e = 0; e < coarse.edge_count(); ++e) {
                const uint32_t h = coarse.edge_half[e];
                const vec3 a = mesh.positions[coarse.vertex[h]], b = mesh.positions[coarse.end(h)];
                for (uint32_t k = 1; k < steps; ++k) {
                    const float t = float(k) / float(steps);
                    const vec3 p = points[coarse.vertex_count() + e * (steps - 1) + k - 1];
                    CHECK(length(p - (a + (b - a) * t)) < 1e-5f);
                }
            }
        }
}

TEST_CASE("vertices that no face touches stay, with the normal 0") {
    CoarseMesh mesh = bipyramid(5);
    const uint32_t loose = mesh.add_vertex(7, 8, 9);
    for (const Scheme scheme : {Scheme::loop, Scheme::catmull_clark}) {
        const Subdivision subdivision =
            *Subdivision::create(topology_of(mesh), {scheme, 3, Corners::smooth});
        std::vector<vec3> points(subdivision.vertex_count()), limit(points), normals(points);
        REQUIRE(subdivision.evaluate(mesh.positions, points));
        REQUIRE(subdivision.evaluate_limit(mesh.positions, limit, normals));
        CHECK(points[loose] == vec3{7, 8, 9});
        CHECK(limit[loose] == vec3{7, 8, 9});
        CHECK(normals[loose] == vec3{0, 0, 0});
    }
}

TEST_CASE("a mesh without faces has no refined ones") {
    CoarseMesh mesh;
    mesh.add_vertex(1, 2, 3);
    const Subdivision subdivision =
        *Subdivision::create(topology_of(mesh), {Scheme::catmull_clark, 2, Corners::smooth});
    std::vector<vec3> points(1);
    REQUIRE(subdivision.evaluate(mesh.positions, points));
    CHECK(points == mesh.positions);
    CHECK(subdivision.quads().empty());
}

TEST_CASE("what cannot be subdivided is refused with a reason") {
    const Topology quads = topology_of(prism(5)), triangles = topology_of(bipyramid(5));
    const auto message = [](const Topology& mesh, const SubdivisionOptions& options) {
        const auto made = Subdivision::create(mesh, options);
        return made ? std::string() : made.error().message;
    };
    CHECK(message(quads, {Scheme::loop, 1, {}}).find("triangles") != std::string::npos);
    CHECK(message(triangles, {Scheme::loop, -1, {}}).find("-1") != std::string::npos);
    CHECK(message(triangles, {Scheme::loop, 11, {}}).find("11") != std::string::npos);
    const Topology many = topology_of(triangulated(torus(100, 60)));
    CHECK(message(many, {Scheme::loop, 10, {}}).find("too many") != std::string::npos);
}
