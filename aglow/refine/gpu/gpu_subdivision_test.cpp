// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu_subdivision.h"

#include "aglow/core/math.h"
#include "aglow/refine/testing/control_meshes.h"
#include "aglow/vk/device.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

// Of the bounding box's diagonal. Forms in geometry shaders round at every level.
constexpr double kBound = 2e-6;

/// Triangles without creases: with boundaries, valences 3 to 40, a vertex that no face touches.
std::vector<CoarseMesh> smooth_meshes() {
    std::vector<CoarseMesh> meshes;
    for (const CoarseMesh& mesh : coarse_meshes()) {
        meshes.push_back(triangulated(mesh));
        meshes.back().creases.clear();
        meshes.back().sharp_vertices.clear();
    }
    meshes.back().add_vertex(1, 2, 3);
    return meshes;
}

double largest_difference(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    double largest = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double d = double{length(a[i] - b[i])};
        if (!(d <= largest)) largest = std::isnan(d) ? 1e30 : d;
    }
    return largest;
}

double size_of(const std::vector<vec3>& points) {
    Box box;
    for (const vec3 p : points) box.add(p);
    return double{length(box.size())};
}

}  // namespace

TEST_CASE("all forms make the points that the CPU makes, one, two and more levels at a time") {
    vk::TestDevice device;
    if (!device) return;
    for (const CoarseMesh& mesh : smooth_meshes())
        for (const Corners corners : {Corners::smooth, Corners::sharp})
            for (const int level : {1, 2, 3, 4}) {
                CAPTURE(mesh.name);
                CAPTURE(level);
                CAPTURE(int(corners));
                const Topology topology = topology_of(mesh);
                const SubdivisionOptions options{.level = level, .corners = corners};
                const Subdivision cpu = demand(Subdivision::create(topology, options));
                std::vector<vec3> expected(cpu.vertex_count()), points(cpu.vertex_count());
                demand(cpu.evaluate(mesh.positions, expected));
                for (const SubdivisionForm form : kSubdivisionForms) {
                    CAPTURE(name(form));
                    GpuSubdivision gpu =
                        demand(GpuSubdivision::create(device.gpu(), topology, options, form));
                    demand(gpu.evaluate(mesh.positions, points));
                    CHECK(largest_difference(points, expected) < kBound * size_of(mesh.positions));
                }
            }
}

TEST_CASE("triangles are told apart by their numbers where there are more than one draw takes") {
    vk::TestDevice device;
    if (!device) return;
    const CoarseMesh mesh = triangulated(torus(24, 24));
    const Topology topology = topology_of(mesh);
    const Subdivision cpu = demand(Subdivision::create(topology, {.level = 3}));
    CHECK(cpu.face_count() > 4 * 16384);
    std::vector<vec3> expected(cpu.vertex_count()), points(cpu.vertex_count());
    demand(cpu.evaluate(mesh.positions, expected));
    for (const SubdivisionForm form : kSubdivisionForms) {
        CAPTURE(name(form));
        GpuSubdivision gpu =
            demand(GpuSubdivision::create(device.gpu(), topology, {.level = 3}, form));
        demand(gpu.evaluate(mesh.positions, points));
        CHECK(largest_difference(points, expected) < kBound * size_of(mesh.positions));
    }
}

TEST_CASE("frames follow the control points, and their time is told") {
    vk::TestDevice device;
    if (!device) return;
    CoarseMesh mesh = triangulated(torus(9, 5));
    const Topology topology = topology_of(mesh);
    for (const SubdivisionForm form : kSubdivisionForms) {
        CAPTURE(name(form));
        GpuSubdivision gpu =
            demand(GpuSubdivision::create(device.gpu(), topology, {.level = 2}, form));
        std::vector<vec3> rest(gpu.vertex_count()), moved(gpu.vertex_count());
        demand(gpu.evaluate(mesh.positions, rest));
        std::vector<vec3> control = mesh.positions;
        for (vec3& p : control) p = p + vec3{1, 2, 3};
        demand(gpu.evaluate(control, moved));
        for (vec3& p : rest) p = p + vec3{1, 2, 3};
        CHECK(largest_difference(moved, rest) < kBound * size_of(control));
        CHECK(demand(gpu.frame_seconds(2)) > 0);
    }
}

TEST_CASE("geometry shaders refuse what they cannot do and say what can") {
    vk::TestDevice device;
    if (!device) return;
    const CoarseMesh creased = triangulated(prism(5)), quads = cube("cube", {});
    const auto refused = [&](const CoarseMesh& mesh, const SubdivisionOptions& options) {
        const auto made = GpuSubdivision::create(device.gpu(), topology_of(mesh), options,
                                                 SubdivisionForm::triangle_adjacency);
        return !made && made.error().code == Errc::unsupported &&
               made.error().message.find("compute form") != std::string::npos;
    };
    CHECK(refused(creased, {.level = 1}));
    CHECK(refused(quads, {.scheme = Scheme::catmull_clark, .level = 1}));
    CHECK(refused(triangulated(quads), {.level = 0}));
}
