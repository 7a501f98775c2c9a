// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu_scene.h"
#include "aglow/core/parallel.h"
#include "aglow/core/random.h"
#include "aglow/render/camera.h"
#include "bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace aglow::cli {
namespace {

constexpr int kRepeats = 3;  // the best counts: what else runs only ever adds time

/// Rays that do one job in a picture.
struct Job {
    std::string name;
    std::vector<Ray> rays;
    bool any_hit = false;
    double embree_seconds = 0;
};

template <class Work>
double best_seconds(Work work) {
    double best = kInfinity;
    for (int i = 0; i < kRepeats; ++i) {
        const Stopwatch watch;
        work();
        best = std::min(best, watch.seconds());
    }
    return best;
}

/// One ray through the middle of each pixel of a picture of about `count`.
std::vector<Ray> primary_rays(const View& view) {
    std::vector<Ray> rays;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x)
            rays.push_back(view.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
    return rays;
}

std::vector<std::optional<Hit>> hits_of(const RayScene& scene, const std::vector<Ray>& rays) {
    std::vector<std::optional<Hit>> hits(rays.size());
    parallel_for(rays.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) hits[i] = scene.intersect(rays[i]);
    });
    return hits;
}

struct Start {
    vec3 origin, normal;
};

/// Where the rays hit, off the surface on the side that they came from.
std::vector<Start> starts_of(const Surfaces& surfaces,
                             const std::vector<std::optional<Hit>>& hits) {
    std::vector<Start> starts;
    for (const auto& hit : hits) {
        if (!hit) continue;
        const uint32_t triangle = hit->at.triangle;
        vec3 normal = geometric_normal(surfaces, triangle);
        if (!hit->front) normal = -normal;
        starts.push_back({offset_origin(position(surfaces, hit->at), normal,
                                        coordinate_magnitude(surfaces, triangle)),
                          normal});
    }
    return starts;
}

/// To one point below the top of the scene.
std::vector<Ray> shadow_rays(const Surfaces& surfaces, const std::vector<Start>& starts) {
    Box box;
    for (const vec3 p : surfaces.positions) box.add(p);
    const vec3 size = box.size();
    const vec3 light = box.center() + vec3{0.11f * size.x, 0.47f * size.y, 0.13f * size.z};
    std::vector<Ray> rays;
    for (const Start& start : starts) {
        const vec3 line = light - start.origin;
        const float distance = length(line);
        if (distance > 0) rays.push_back({start.origin, line / distance, distance});
    }
    return rays;
}

/// In directions that follow the cosine, each its own.
std::vector<Ray> diffuse_rays(const std::vector<Start>& starts, uint64_t seed) {
    Pcg32 random(seed);
    std::vector<Ray> rays;
    for (const Start& start : starts) {
        const float r = std::sqrt(random.uniform()), angle = 2 * kPi * random.uniform();
        const vec3 local{r * std::cos(angle), r * std::sin(angle),
                         std::sqrt(std::max(0.0f, 1 - r * r))};
        rays.push_back({start.origin, normalize(Frame(start.normal).to_world(local))});
    }
    return rays;
}

Result<std::vector<Job>> make_jobs(const Scene& scene, const Surfaces& surfaces,
                                   const RayScene& embree, int rays, uint64_t seed) {
    const int side = std::max(1, static_cast<int>(std::lround(std::sqrt(rays))));
    AG_TRY(const View view, choose_view(scene, surfaces, embree, "auto", side, side, kBenchTime));
    std::vector<Job> jobs;
    jobs.push_back({.name = "primary", .rays = primary_rays(view)});
    const auto starts = starts_of(surfaces, hits_of(embree, jobs[0].rays));
    jobs.push_back({.name = "shadow", .rays = shadow_rays(surfaces, starts), .any_hit = true});
    jobs.push_back({.name = "diffuse", .rays = diffuse_rays(starts, seed)});
    return jobs;
}

void time_embree(const RayScene& embree, Job& job) {
    job.embree_seconds = best_seconds([&] {
        parallel_for(job.rays.size(), 1024, [&](size_t begin, size_t end) {
            float sum = 0;  // keeps the compiler from leaving rays out
            for (size_t i = begin; i < end; ++i)
                sum += job.any_hit ? embree.visibility(job.rays[i])
                                   : embree.intersect(job.rays[i]).value_or(Hit{}).distance;
            volatile float sink = sum;
            static_cast<void>(sink);
        });
    });
}

Status trace(GpuScene& scene, const Job& job, Counting counting) {
    if (job.any_hit) {
        AG_TRY(const auto blocked, scene.occluded(job.rays, counting));
    } else {
        AG_TRY(const auto hits, scene.intersect(job.rays, counting));
    }
    return {};
}

double million(double count) { return count / 1e6; }

/// Rate on the device, the same by Embree's, and work per ray.
Result<Json> measure_job(GpuScene& scene, const Job& job) {
    const auto count = static_cast<double>(job.rays.size());
    if (job.rays.empty()) return Json{{"rays", 0}};
    AG_CHECK(trace(scene, job, Counting::off));  // the shader is compiled here
    double seconds = kInfinity;
    for (int i = 0; i < kRepeats; ++i) {
        AG_CHECK(trace(scene, job, Counting::off));
        seconds = std::min(seconds, scene.seconds().trace);
    }
    const AccelStats before = scene.stats();
    AG_CHECK(trace(scene, job, Counting::on));
    const AccelStats after = scene.stats();
    return Json{{"rays", job.rays.size()},
                {"mrays_per_second", million(count) / seconds},
                {"ratio_to_embree", job.embree_seconds / seconds},
                {"steps_per_ray", static_cast<double>(after.steps - before.steps) / count},
                {"tests_per_ray",
                 static_cast<double>(after.triangle_tests - before.triangle_tests) / count}};
}

Result<Json> measure_structure(const Gpu& gpu, const Surfaces& surfaces, Accel accel,
                               const std::vector<Job>& jobs, double embree_build) {
    AG_TRY(GpuScene scene, GpuScene::create(gpu, surfaces, accel));
    double build = kInfinity;
    for (int i = 0; i < kRepeats; ++i) {
        AG_CHECK(scene.rebuild(surfaces));
        build = std::min(build, scene.seconds().build);
    }
    const auto triangles = static_cast<double>(std::max<size_t>(surfaces.triangles.size(), 1));
    const AccelStats stats = scene.stats();
    Json row = {{"accel", name(accel)},
                {"build_ms", build * 1e3},
                {"build_mtris_per_second", million(triangles) / build},
                {"build_ratio_to_embree", embree_build / build},
                {"references_per_triangle", static_cast<double>(stats.references) / triangles},
                {"bytes_per_triangle", static_cast<double>(stats.bytes) / triangles}};
    for (const Job& job : jobs) {
        AG_TRY(row[job.name], measure_job(scene, job));
    }
    return row;
}

Result<Json> measure(const Gpu& gpu, const std::string& name, const BenchOptions& options,
                     Console& console) {
    AG_TRY(const Scene scene, bench_scene(name));
    const Surfaces surfaces = pose(scene, kBenchTime);
    const Stopwatch watch;
    AG_TRY(const RayScene embree, RayScene::create(scene, surfaces));
    const double embree_build = watch.seconds();
    AG_TRY(std::vector<Job> jobs,
           make_jobs(scene, surfaces, embree, options.rays, console.options().seed));
    Json reference = {{"accel", "embree"}, {"build_ms", embree_build * 1e3}};
    for (Job& job : jobs) {
        time_embree(embree, job);
        reference[job.name] = {{"rays", job.rays.size()},
                               {"mrays_per_second", million(static_cast<double>(job.rays.size())) /
                                                        job.embree_seconds}};
    }
    Json structures = Json::array({reference});
    for (const Accel accel : kBenchAccels) {
        AG_CHECK(console.go_on(fmt::format("{}, {}", name, aglow::name(accel))));
        AG_TRY(const Json row, measure_structure(gpu, surfaces, accel, jobs, embree_build));
        structures.push_back(row);
    }
    return Json::array({Json{
        {"scene", name}, {"triangles", surfaces.triangles.size()}, {"structures", structures}}});
}

std::string cell(const Json& row, const char* key, const char* format) {
    return row.contains(key) ? fmt::format(fmt::runtime(format), row[key].get<double>()) : "";
}

std::string text_of(const Json& report) {
    std::string text =
        "rates in million rays per second (x Embree's), steps + triangle tests per ray\n";
    for (const Json& scene : report["scenes"]) {
        text += fmt::format("\n{}: {} triangles\n", scene["scene"].get<std::string>(),
                            scene["triangles"].get<size_t>());
        text += fmt::format("  {:<7} {:>9} {:>8} {:>10}", "", "build ms", "refs/tri", "bytes/tri");
        for (const char* job : {"primary", "shadow", "diffuse"})
            text += fmt::format(" | {:<30}", job);
        text += '\n';
        for (const Json& row : scene["structures"]) {
            text += fmt::format("  {:<7} {:>9} {:>8} {:>10}", row["accel"].get<std::string>(),
                                cell(row, "build_ms", "{:.2f}"),
                                cell(row, "references_per_triangle", "{:.2f}"),
                                cell(row, "bytes_per_triangle", "{:.1f}"));
            for (const char* job : {"primary", "shadow", "diffuse"}) {
                const Json& rates = row[job];
                const std::string rate = cell(rates, "mrays_per_second", "{:.3f}") +
                                         cell(rates, "ratio_to_embree", " ({:.3f})");
                const std::string work = cell(rates, "steps_per_ray", "{:.1f} + ") +
                                         cell(rates, "tests_per_ray", "{:.1f}");
                text += fmt::format(" | {:<15} {:<14}", rate, work);
            }
            text += '\n';
        }
    }
    return text;
}

}  // namespace

BenchTable accel_table(const BenchOptions&) {
    return {bench_scenes(), Json::object(), measure, text_of};
}

}  // namespace aglow::cli
