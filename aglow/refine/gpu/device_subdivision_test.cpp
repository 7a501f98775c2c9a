// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu/device_subdivision.h"

#include "aglow/core/math.h"
#include "aglow/refine/testing/control_meshes.h"
#include "aglow/vk/device.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

using namespace aglow;
using namespace aglow::refine::testing;
using refine::gpu::DeviceSubdivision;

namespace {

// Of the bounding box's diagonal. Sums of a ring's points are rounded on both sides, on the device
// with fused products.
constexpr double kBound = 1e-6;
// Normals are where the tangents are told apart; these are the CPU's own bound beside OpenSubdiv.
constexpr double kNormalBound = 1e-4;
constexpr float kUnwritten = -1234.5f;

double size_of(std::span<const vec3> points) {
    Box box;
    for (const vec3 p : points) box.add(p);
    return double{length(box.size())};
}

double largest_difference(std::span<const vec3> a, std::span<const vec3> b) {
    double largest = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double d = double{length(a[i] - b[i])};
        if (!(d <= largest)) largest = std::isnan(d) ? 1e30 : d;
    }
    return largest;
}

struct Case {
    CoarseMesh mesh;
    SubdivisionOptions options;
};

/// All meshes in both schemes, at the levels given.
std::vector<Case> cases(std::initializer_list<int> levels) {
    std::vector<Case> result;
    for (const Scheme scheme : {Scheme::loop, Scheme::catmull_clark})
        for (const CoarseMesh& mesh : coarse_meshes())
            for (const int level : levels)
                result.push_back({scheme == Scheme::loop ? triangulated(mesh) : mesh,
                                  {.scheme = scheme, .level = level}});
    return result;
}

Subdivision subdivision_of(const Case& c) {
    return demand(Subdivision::create(topology_of(c.mesh), c.options));
}

/// A stream, and buffers whose content is known.
struct Bench {
    explicit Bench(const vk::TestDevice& device) : stream(device.stream()) {}
    template <class T>
    vk::Buffer upload(std::span<const T> values) {
        return demand(vk::make_buffer_of(stream, values, "control"));
    }
    vk::Buffer unwritten(size_t floats) {
        vk::Buffer buffer = demand(stream.make_buffer(floats * sizeof(float), "refined"));
        stream.fill(buffer, std::bit_cast<uint32_t>(kUnwritten), 0, floats * sizeof(float));
        return buffer;
    }
    vk::Stream stream;
};

/// The device refines the mesh's positions as the CPU does.
void check_points(Bench& bench, const Case& c, const Subdivision& cpu,
                  const DeviceSubdivision& gpu) {
    std::vector<vec3> expected(cpu.vertex_count());
    demand(cpu.evaluate(c.mesh.positions, expected));
    const vk::Buffer control = bench.upload(std::span<const vec3>(c.mesh.positions));
    const vk::Buffer refined = bench.unwritten(expected.size() * 3);
    bench.stream.barrier();
    gpu.record(bench.stream, control.address(), refined.address());
    const auto points = demand(bench.stream.download<vec3>(refined, expected.size()));
    CHECK(largest_difference(points, expected) < kBound * size_of(c.mesh.positions));
}

}  // namespace

TEST_CASE("refined points are the CPU's, in both schemes, at every level, whatever the valence") {
    vk::TestDevice device;
    if (!device) return;
    Bench bench(device);
    for (const Case& c : cases({0, 1, 2, 3, 4})) {
        CAPTURE(c.mesh.name);
        CAPTURE(c.options.level);
        CAPTURE(int(c.options.scheme));
        const Subdivision cpu = subdivision_of(c);
        const DeviceSubdivision gpu = demand(DeviceSubdivision::create(bench.stream, cpu));
        check_points(bench, c, cpu, gpu);
    }
}

TEST_CASE("deep levels come in steps, twelve triangles become 786 432") {
    vk::TestDevice device;
    if (!device) return;
    Bench bench(device);
    const Case c{triangulated(cube("cube", {})), {.level = 8}};
    const Subdivision cpu = subdivision_of(c);
    CHECK(cpu.face_count() == 786'432);
    const DeviceSubdivision gpu = demand(DeviceSubdivision::create(bench.stream, cpu));
    CHECK(gpu.has_steps());
    check_points(bench, c, cpu, gpu);
}

TEST_CASE("attributes of any width are refined like positions") {
    vk::TestDevice device;
    if (!device) return;
    Bench bench(device);
    for (const Case& c : cases({0, 2})) {
        CAPTURE(c.mesh.name);
        const Subdivision cpu = subdivision_of(c);
        const DeviceSubdivision gpu = demand(DeviceSubdivision::create(bench.stream, cpu));
        for (const uint32_t width : {1u, 2u, 4u, 8u}) {
            CAPTURE(width);
            Noise noise(width);
            std::vector<float> control(size_t{cpu.control_count()} * width);
            for (float& value : control) value = static_cast<float>(noise());
            std::vector<float> expected(size_t{cpu.vertex_count()} * width);
            demand(cpu.evaluate(control, static_cast<int>(width), expected));
            const vk::Buffer from = bench.upload(std::span<const float>(control));
            const vk::Buffer to = bench.unwritten(expected.size());
            bench.stream.barrier();
            gpu.record(bench.stream, from.address(), to.address(), width);
            const auto values = demand(bench.stream.download<float>(to, expected.size()));
            float largest = 0;
            for (size_t i = 0; i < values.size(); ++i)
                largest = std::max(largest, std::abs(values[i] - expected[i]));
            CHECK(double{largest} < kBound);
        }
    }
}

TEST_CASE("limit points and normals are the CPU's, also where only normals are asked for") {
    vk::TestDevice device;
    if (!device) return;
    Bench bench(device);
    for (const Case& c : cases({0, 1, 3})) {
        CAPTURE(c.mesh.name);
        CAPTURE(c.options.level);
        CAPTURE(int(c.options.scheme));
        const Subdivision cpu = subdivision_of(c);
        const uint32_t count = cpu.vertex_count();
        std::vector<vec3> expected(count), expected_normals(count);
        demand(cpu.evaluate_limit(c.mesh.positions, expected, expected_normals));
        const DeviceSubdivision gpu =
            demand(DeviceSubdivision::create(bench.stream, cpu, DeviceSubdivision::Limits::with));
        const vk::Buffer control = bench.upload(std::span<const vec3>(c.mesh.positions));
        const vk::Buffer positions = bench.unwritten(size_t{count} * 3);
        const vk::Buffer normals = bench.unwritten(size_t{count} * 3);
        const vk::Buffer normals_only = bench.unwritten(size_t{count} * 3);
        bench.stream.barrier();
        gpu.record_limit(bench.stream, control.address(), positions.address(), normals.address());
        bench.stream.barrier();
        gpu.record_limit(bench.stream, control.address(), 0, normals_only.address());
        const auto points = demand(bench.stream.download<vec3>(positions, count));
        const auto directions = demand(bench.stream.download<vec3>(normals, count));
        CHECK(largest_difference(points, expected) < kBound * size_of(c.mesh.positions));
        CHECK(largest_difference(directions, expected_normals) < kNormalBound);
        CHECK(demand(bench.stream.download<vec3>(normals_only, count)) == directions);
    }
}
