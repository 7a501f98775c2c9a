// SPDX-License-Identifier: Apache-2.0
// Curved patches on patterns: how fast the host evaluates them on one thread, as a share of what it
// can write past its caches, and a device, as a share of what it can copy, in one run.
//   pattern_bench [part of the device's name]
// Seconds are the least of several repetitions.
#include "aglow/core/parallel.h"
#include "aglow/refine/gpu/device_patches.h"
#include "aglow/refine/patches.h"
#include "aglow/refine/testing/control_meshes.h"
#include "aglow/vk/device.h"

#include <emmintrin.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <vector>

using namespace aglow;
using refine::gpu::DevicePatches;
using refine::gpu::DevicePattern;

namespace {

/// Least seconds of what is done several times, until a second is over.
double seconds(const std::function<void()>& work) {
    using Clock = std::chrono::steady_clock;
    double least = 1e30, all = 0;
    for (int i = 0; i < 5 || (all < 1 && i < 200); ++i) {
        const auto start = Clock::now();
        work();
        const double passed = std::chrono::duration<double>(Clock::now() - start).count();
        least = std::min(least, passed);
        all += passed;
    }
    return least;
}

struct CoarseMesh {
    Topology topology;
    std::vector<vec3> positions, normals;
};

/// A torus of columns x rows cells, two triangles each, with its exact normals.
Result<CoarseMesh> torus(uint32_t columns, uint32_t rows) {
    PolygonList polygons;
    CoarseMesh mesh;
    std::vector<vec3> at_vertex;
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const float u = 2 * kPi * static_cast<float>(x) / static_cast<float>(columns);
            const float v = 2 * kPi * static_cast<float>(y) / static_cast<float>(rows);
            const vec3 out = {std::cos(u), std::sin(u), 0};
            const vec3 n = out * std::cos(v) + vec3{0, 0, std::sin(v)};
            mesh.positions.push_back(out + n * 0.4f);
            at_vertex.push_back(n);
        }
    const auto vertex = [&](uint32_t x, uint32_t y) { return y % rows * columns + x % columns; };
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const uint32_t a = vertex(x, y), b = vertex(x + 1, y), c = vertex(x + 1, y + 1),
                           d = vertex(x, y + 1);
            for (const uint32_t corner : {a, b, c, a, c, d}) {
                polygons.corners.push_back(corner);
                if (polygons.corners.size() % 3 == 0)
                    polygons.face_begin.push_back(static_cast<uint32_t>(polygons.corners.size()));
            }
        }
    polygons.vertex_count = columns * rows;
    AG_TRY(TopologyResult made, build_topology(polygons));
    mesh.topology = std::move(made.topology);
    for (const uint32_t v : mesh.topology.vertex) mesh.normals.push_back(at_vertex[v]);
    return mesh;
}

/// Twelve triangles whose normals lead away from their centre.
Result<CoarseMesh> cube() {
    const refine::testing::CoarseMesh shape = refine::testing::cube_of_triangles();
    AG_TRY(TopologyResult made, build_topology(shape.polygons));
    CoarseMesh mesh{std::move(made.topology), shape.positions, {}};
    mesh.normals = refine::testing::normals_from_origin(mesh.topology, mesh.positions);
    return mesh;
}

/// Bytes per second that one thread writes past the caches.
double write_rate(std::span<vec3> to) {
    const size_t count = to.size_bytes() / 16;
    float* out = &to.front().x;
    while (reinterpret_cast<uintptr_t>(out) % 16 != 0) ++out;
    const __m128 value = _mm_set1_ps(1);
    const double time = seconds([&] {
        for (size_t i = 0; i + 1 < count; ++i) _mm_stream_ps(out + 4 * i, value);
        _mm_sfence();
    });
    return static_cast<double>(16 * (count - 1)) / time;
}

Status bench_host(const CoarseMesh& mesh, int segments) {
    AG_TRY(const Tessellation t, Tessellation::uniform(mesh.topology, segments));
    AG_TRY(const Patches patches, Patches::create(mesh.topology, {}));
    PatchControl control;
    const double update = seconds([&] { patches.update({mesh.positions, mesh.normals}, control); });
    std::vector<vec3> positions(t.vertex_count());
    const double before = write_rate(positions);
    const double time = seconds([&] { patches.evaluate(control, t, positions); });
    const double most = std::max(before, write_rate(positions));
    const double rate = static_cast<double>(positions.size() * sizeof(vec3)) / time;
    fmt::print(
        "  {:3} segments {:10} vertices: control points {:6.2f} ms, positions {:7.2f} ms, "
        "{:5.2f} GB/s, {:3.0f} % of {:.2f} GB/s written\n",
        segments, positions.size(), 1e3 * update, 1e3 * time, 1e-9 * rate, 100 * rate / most,
        1e-9 * most);
    return {};
}

/// Seconds of kernels and copies that `record` records, the least of several runs.
Result<double> device_seconds(vk::Stream& stream, const std::function<void()>& record) {
    double least = 1e30;
    for (int i = 0; i < 6; ++i) {
        {
            const vk::Stream::Scope scope(stream, "timed");
            record();
        }
        AG_CHECK(stream.finish());
        double sum = 0;
        for (const vk::Timing& timing : stream.take_timings()) sum += timing.seconds;
        least = std::min(least, sum);
    }
    return least;
}

/// A mesh on the device: control points and a pattern on every face, with normals.
Status bench_device(vk::Stream& stream, const char* what, const CoarseMesh& mesh, int segments,
                    const DisplacementMap* displacement) {
    AG_TRY(const DevicePatches patches,
           DevicePatches::create(stream, mesh.topology, {}, {.displacement = displacement}));
    AG_TRY(const DevicePattern pattern, refine::gpu::upload_triangle_pattern(stream, segments));
    const uint32_t faces = patches.face_count();
    const uint64_t vertices = uint64_t{faces} * pattern.vertex_count;
    AG_TRY(const vk::Buffer in_positions,
           vk::make_buffer_of(stream, std::span<const vec3>(mesh.positions), "positions"));
    AG_TRY(const vk::Buffer in_normals,
           vk::make_buffer_of(stream, std::span<const vec3>(mesh.normals), "normals"));
    AG_TRY(const vk::Buffer positions, stream.make_buffer(vertices * sizeof(vec3), "refined"));
    AG_TRY(const vk::Buffer normals, stream.make_buffer(vertices * sizeof(vec3), "normals"));
    AG_CHECK(stream.finish());
    stream.take_timings();
    AG_TRY(const double update, device_seconds(stream, [&] {
               patches.update(stream, in_positions.address(), in_normals.address());
           }));
    AG_TRY(const double evaluate, device_seconds(stream, [&] {
               patches.evaluate(stream, pattern, DevicePatches::Levels::uniform, 0, faces,
                                positions.address(), normals.address());
           }));
    AG_TRY(const double copy, device_seconds(stream, [&] {
               stream.copy(positions, 0, normals, 0, positions.size());
           }));

    AG_TRY(const Tessellation t, Tessellation::uniform(mesh.topology, segments));
    AG_TRY(const Patches host, Patches::create(mesh.topology, {}));
    PatchControl control;
    host.update({mesh.positions, mesh.normals}, control);
    std::vector<vec3> host_positions(t.vertex_count()), host_normals(t.vertex_count());
    const DisplacementMap flat;
    const double on_host = seconds([&] {
        host.update({mesh.positions, mesh.normals}, control);
        host.evaluate(control, t, displacement ? *displacement : flat, host_positions,
                      host_normals);
    });
    const double all = update + evaluate, triangles = double(faces) * pattern.triangle_count;
    // A copy reads and writes as many bytes as evaluation writes: positions and normals.
    fmt::print(
        "  {:34} {:9.0f} triangles: {:8.3f} ms + {:6.3f} ms, {:8.1f} Mtri/s, {:4.1f} % of "
        "copy; host {:8.2f} ms: {:.1f} x\n",
        what, triangles, 1e3 * evaluate, 1e3 * update, 1e-6 * triangles / all,
        100 * copy / evaluate, 1e3 * on_host, on_host / all);
    return {};
}

Status bench(const std::string& name) {
    fmt::print("host, one thread, positions of PN triangles:\n");
    {
        const ThreadLimit one(1);
        AG_TRY(const CoarseMesh mesh, torus(100, 50));
        for (const int segments : {8, 16, 32, 64}) AG_CHECK(bench_host(mesh, segments));
    }
    AG_TRY(const Gpu gpu, open_gpu(name));
    AG_TRY(vk::Stream stream, vk::Stream::create(gpu));
    const bool hardware = gpu->info().kind != GpuKind::software;
    fmt::print("{}: positions and normals; beside the host with all its threads:\n",
               gpu->info().name);
    DisplacementMap sine;
    sine.settings.kind = shared::kSineDisplacement;
    sine.settings.amplitude = 0.05f;
    sine.settings.frequency = {20, 30, 25};
    AG_TRY(const CoarseMesh box, cube());
    AG_CHECK(bench_device(stream, "12 triangles, a sin(f P)", box, 256, &sine));
    AG_CHECK(bench_device(stream, "12 triangles", box, 256, nullptr));
    AG_TRY(const CoarseMesh mesh, torus(100, 50));
    AG_CHECK(bench_device(stream, "torus, 1 M", mesh, 10, nullptr));
    if (hardware) AG_CHECK(bench_device(stream, "torus, 100 M", mesh, 100, nullptr));
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    const Status done = bench(argc > 1 ? argv[1] : "");
    if (!done) fmt::print(stderr, "{}\n", to_string(done.error()));
    return done ? 0 : 1;
}
