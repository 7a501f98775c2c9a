// SPDX-License-Identifier: Apache-2.0
// What takes too long for a test of how rays are traced on the GPU:
//   trace_bench agreement [RAYS]  RAYS (a million) in each of six scenes, against Embree
//   trace_bench leaks [RAYS]      RAYS (ten millions) inside each of four closed meshes
//   trace_bench bodies [COUNT]    COUNT (ten thousand) rigid bodies: time to build, time to move
//   trace_bench [rates [RAYS]]    seconds to build and to trace RAYS (a quarter million) diffuse
//                                 rays, in processor time of all threads, which other work on the
//                                 machine changes little; what choose_accel() is made from
// AGLOW_SCENES names the folder of scene files, AGLOW_TEST_GPU the device (llvmpipe).
#include "aglow/accel/gpu/testing/agreement.h"
#include "aglow/accel/gpu/testing/closed_meshes.h"
#include "aglow/accel/gpu/testing/rays.h"
#include "aglow/accel/gpu/trace_rays.h"
#include "aglow/accel/gpu/trace_scene.h"
#include "aglow/accel/gpu_scene.h"
#include "aglow/core/parallel.h"
#include "aglow/vk/device.h"
#include "tests/parity/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>

using namespace aglow;
using namespace aglow::testing;

namespace {

constexpr std::array kAccels = {Accel::grid, Accel::grid2, Accel::bvh};
constexpr size_t kBatch = size_t{1} << 18;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

void print_difference(const Ray& ray, Judge::Answer gpu, Judge::Answer cpu) {
    fmt::print(
        "    differs: origin ({:a} {:a} {:a}) direction ({:a} {:a} {:a}): gpu t {} triangle "
        "{}, Embree t {} triangle {}\n",
        ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z,
        gpu.distance, gpu.triangle, cpu.distance, cpu.triangle);
}

struct Tally {
    size_t rays = 0, rounded = 0, differs = 0;
};

Status compare(const TestScene& test, const RayScene& reference, GpuScene& scene, RaySource& source,
               RayClass kind, size_t count, Tally& tally) {
    const Judge judge(test.surfaces);
    for (; tally.rays < count; tally.rays += std::min(kBatch, count - tally.rays)) {
        const auto rays = source.rays(kind, std::min(kBatch, count - tally.rays));
        AG_TRY(const auto hits, scene.intersect(rays));
        std::vector<Judge::Answer> expected(rays.size());
        parallel_for(rays.size(), 1024, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i)
                expected[i] = Judge::answer(reference.intersect(rays[i]));
        });
        for (size_t i = 0; i < rays.size(); ++i) {
            const Judge::Answer found = Judge::answer(hits[i]);
            const Verdict verdict = judge(rays[i], found, expected[i]);
            tally.rounded += verdict == Verdict::rounded;
            tally.differs += verdict == Verdict::differs;
            if (verdict == Verdict::differs) print_difference(rays[i], found, expected[i]);
        }
    }
    return {};
}

Status agreement(const Gpu& gpu, size_t rays) {
    const size_t each = rays / kRayClasses.size();
    fmt::print(
        "| scene | structure | rays | {} | differs |\n|---|---|---|---|---|---|---|---|---|\n",
        "rounded: uniform | edge | vertex | axis-parallel | surface");
    for (const TestScene& test : test_scenes()) {
        AG_TRY(const RayScene reference, RayScene::create(test.scene, test.surfaces));
        for (const Accel accel : kAccels) {
            AG_TRY(GpuScene scene, GpuScene::create(gpu, test.surfaces, accel));
            std::string row = fmt::format("| {} | {} | {} |", test.name, aglow::name(accel),
                                          each * kRayClasses.size());
            size_t differs = 0;
            for (const RayClass kind : kRayClasses) {
                RaySource source(test.surfaces, static_cast<uint64_t>(kind));
                Tally tally;
                AG_CHECK(compare(test, reference, scene, source, kind, each, tally));
                row += fmt::format(" {} |", tally.rounded);
                differs += tally.differs;
            }
            fmt::print("{} {} |\n", row, differs);
            std::fflush(stdout);
        }
    }
    return {};
}

Status leaks(const Gpu& gpu, size_t rays) {
    fmt::print("| mesh | triangles | structure | rays | leave |\n|---|---|---|---|---|\n");
    for (const ClosedMesh& mesh : closed_meshes())
        for (const Accel accel : kAccels) {
            AG_TRY(GpuScene scene, GpuScene::create(gpu, mesh.surfaces, accel));
            size_t out = 0;
            for (size_t done = 0, batch = 0; done < rays; done += kBatch, ++batch) {
                const auto from = rays_from_inside(mesh, std::min(kBatch, rays - done), batch);
                AG_TRY(const auto hits, scene.intersect(from));
                out += static_cast<size_t>(std::count_if(
                    hits.begin(), hits.end(),
                    [](const GpuScene::GpuHit& hit) { return hit.triangle == GpuScene::kNoHit; }));
            }
            fmt::print("| {} | {} | {} | {} | {} |\n", mesh.name, mesh.surfaces.triangles.size(),
                       aglow::name(accel), rays, out);
            std::fflush(stdout);
        }
    return {};
}

/// Triangles of `count` boxes in rows, and where the i-th stands.
mat4 place_of(size_t i, size_t side, float turn) {
    const auto at = [&](size_t k) { return 4 * static_cast<float>(k % side); };
    return compose({at(i), at(i / side), at(i / side / side)},
                   {0, std::sin(turn), 0, std::cos(turn)}, {1, 1, 1});
}

Status bodies(const Gpu& gpu, size_t count) {
    const Surfaces body = cube(1, [](vec3 p) { return p; });
    const auto side = static_cast<size_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    std::vector<accel::gpu::Group> groups;
    std::vector<mat4> transforms;
    std::vector<shared::Triangle> triangles;
    for (size_t i = 0; i < count; ++i) {
        groups.push_back({static_cast<uint32_t>(triangles.size()),
                          static_cast<uint32_t>(body.triangles.size()), accel::gpu::Motion::rigid});
        transforms.push_back(place_of(i, side, 0));
        for (uint32_t t = 0; t < body.triangles.size(); ++t)
            triangles.push_back({transform_point(transforms[i], body.corner(t, 0)),
                                 transform_point(transforms[i], body.corner(t, 1)),
                                 transform_point(transforms[i], body.corner(t, 2))});
    }
    AG_TRY(vk::Stream stream, vk::Stream::create(gpu));
    AG_TRY(const vk::Buffer buffer,
           vk::make_buffer_of(stream, std::span<const shared::Triangle>(triangles), "triangles"));
    stream.barrier();
    const accel::gpu::TriangleSpan span{buffer.address(), static_cast<uint32_t>(triangles.size())};
    for (const Accel accel : kAccels) {
        double start = now();
        AG_TRY(auto scene, accel::gpu::TraceScene::create(gpu, groups, accel, 1e9));
        AG_CHECK(scene.update(stream, span, transforms));
        AG_CHECK(stream.finish());
        const double built = now() - start;
        start = now();
        constexpr int kFrames = 10;
        for (int frame = 1; frame <= kFrames; ++frame) {
            for (size_t i = 0; i < count; ++i)
                transforms[i] = place_of(i, side, 0.1f * static_cast<float>(frame));
            AG_CHECK(scene.update(stream, span, transforms));
            AG_CHECK(stream.finish());
        }
        fmt::print("{} bodies, {}: built in {:.3f} s, moved in {:.2f} ms a frame, {} bytes\n",
                   count, aglow::name(accel), built, (now() - start) / kFrames * 1e3,
                   scene.stats().bytes);
    }
    return {};
}

double processor_seconds() {
    return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

/// Processor time of the cheapest of three runs.
template <class Work>
Result<double> cost_of(Work work) {
    double best = kInfinity;
    for (int i = 0; i < 3; ++i) {
        const double start = processor_seconds();
        AG_CHECK(work());
        best = std::min(best, processor_seconds() - start);
    }
    return best;
}

Status rates(const Gpu& gpu, size_t count) {
    fmt::print(
        "| scene | triangles | structure | build s/Mtri | s/Mray | steps | tests |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const char* name : {"stress:10000", "stress:100000", "stress:1000000", "cad:10000",
                             "cad:100000", "cad:1000000"}) {
        const TestScene test = opaque_scene(name, *builtin_scene(name));
        const auto rays = RaySource(test.surfaces, 1).rays(RayClass::surface, count);
        const double mtris = static_cast<double>(test.surfaces.triangles.size()) / 1e6;
        const double mrays = static_cast<double>(count) / 1e6;
        const auto print = [&](const char* structure, double build, double trace,
                               const AccelStats& stats) {
            const auto per_ray = [&](uint64_t sum) {
                return static_cast<double>(sum) / static_cast<double>(count);
            };
            fmt::print("| {} | {} | {} | {:.3f} | {:.3f} | {:.1f} | {:.1f} |\n", name,
                       test.surfaces.triangles.size(), structure, build / mtris, trace / mrays,
                       per_ray(stats.steps), per_ray(stats.triangle_tests));
            std::fflush(stdout);
        };
        double start = processor_seconds();
        AG_TRY(const RayScene embree, RayScene::create(test.scene, test.surfaces));
        const double embree_build = processor_seconds() - start;
        AG_TRY(const double embree_trace, cost_of([&]() -> Status {
                   parallel_for(rays.size(), 1024, [&](size_t begin, size_t end) {
                       for (size_t i = begin; i < end; ++i) {
                           volatile bool hit = embree.intersect(rays[i]).has_value();
                           static_cast<void>(hit);
                       }
                   });
                   return {};
               }));
        print("embree", embree_build, embree_trace, {});
        for (const Accel accel : kAccels) {
            AG_TRY(GpuScene scene, GpuScene::create(gpu, test.surfaces, accel));
            AG_TRY(const double build, cost_of([&] { return scene.rebuild(test.surfaces); }));
            AG_TRY(const double trace, cost_of([&]() -> Status {
                       AG_TRY(const auto hits, scene.intersect(rays));
                       return {};
                   }));
            AG_TRY(const auto counted, scene.intersect(rays, Counting::on));
            print(aglow::name(accel), build, trace, scene.stats());
        }
    }
    return {};
}

Status run(std::string_view what, size_t count) {
    const char* device = std::getenv("AGLOW_TEST_GPU");
    AG_TRY(const Gpu gpu, open_gpu(device ? device : "llvmpipe"));
    const auto or_else = [&](size_t usual) { return count > 0 ? count : usual; };
    if (what == "agreement") return agreement(gpu, or_else(1000000));
    if (what == "leaks") return leaks(gpu, or_else(10000000));
    if (what == "bodies") return bodies(gpu, or_else(10000));
    if (what == "rates") return rates(gpu, or_else(size_t{1} << 18));
    return fail(Errc::bad_argument, "trace_bench agreement|leaks|bodies|rates [COUNT]");
}

}  // namespace

int main(int argc, char** argv) {
    const long long count = argc > 2 ? std::atoll(argv[2]) : 0;
    const Status done =
        run(argc > 1 ? argv[1] : "rates", static_cast<size_t>(std::max(0LL, count)));
    if (!done) fmt::print(stderr, "{}\n", to_string(done.error()));
    return done ? 0 : 1;
}
