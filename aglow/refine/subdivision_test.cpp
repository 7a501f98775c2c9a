// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/subdivision.h"

#include "aglow/core/math.h"
#include "aglow/core/parallel.h"
#include "aglow/refine/testing/control_meshes.h"
#include "aglow/refine/testing/open_subdiv.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

constexpr int kLevels = 5;
// Of the bounding box's diagonal; of normals, of the area that the tangents span beside the square
// over the longer: where that is small, rounded points decide where the normal is.
constexpr double kBound = 1e-5;

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
