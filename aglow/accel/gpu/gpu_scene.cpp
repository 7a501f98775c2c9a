// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu_scene.h"

#include "aglow/accel/gpu/trace_rays.h"
#include "aglow/accel/gpu/trace_scene.h"
#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"
#include "aglow/vk/device.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace aglow {
namespace {

using accel::gpu::Query;
using shared::RayQuery;
using shared::TraceCounts;

constexpr size_t kBatch = size_t{1} << 18;  // rays: few enough that their counts fit 32 bits
constexpr const char* kTraceLabel = "trace";

static_assert(sizeof(GpuScene::GpuHit) == sizeof(shared::RayHit));
static_assert(offsetof(GpuScene::GpuHit, barycentrics) == offsetof(shared::RayHit, barycentrics));
static_assert(GpuScene::kNoHit == shared::kNoTriangle);

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<shared::Triangle> corners(const Surfaces& surfaces) {
    std::vector<shared::Triangle> triangles(surfaces.triangles.size());
    parallel_for(triangles.size(), 1 << 14, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const auto t = static_cast<uint32_t>(i);
            triangles[i] = {surfaces.corner(t, 0), surfaces.corner(t, 1), surfaces.corner(t, 2)};
        }
    });
    return triangles;
}

std::vector<RayQuery> queries(std::span<const Ray> rays) {
    std::vector<RayQuery> result;
    result.reserve(rays.size());
    for (const Ray& ray : rays) result.push_back({ray.origin, 0, ray.direction, ray.far});
    return result;
}

}  // namespace

struct GpuScene::State {
    State(Gpu device, accel::gpu::TraceScene trace_scene)
        : gpu(std::move(device)), scene(std::move(trace_scene)), kernels(gpu) {}

    Gpu gpu;
    accel::gpu::TraceScene scene;
    accel::gpu::TraceRays kernels;
    Accel accel = Accel::bvh;
    size_t triangle_count = 0;
    Status built;                            // why there is nothing to trace, if so
    vk::Buffer rays, hits, blocked, counts;  // of a batch
    AccelStats counted;
    AccelSeconds seconds;
    std::optional<vk::Stream> stream;  // a failed one is replaced

    Result<vk::Stream*> ready_stream();
    Status build(const Surfaces& surfaces);
    Status build(vk::Stream& on, std::span<const shared::Triangle> triangles);
    Status reserve(size_t count);
    template <class T>
    Result<std::vector<T>> trace(std::span<const Ray> all, Query query, Counting counting);
    template <class T>
    Status trace_batch(vk::Stream& on, std::span<const Ray> batch, Query query, Counting counting,
                       T* results);
    Status add_counts(vk::Stream& on, size_t rays_traced);
};

Result<vk::Stream*> GpuScene::State::ready_stream() {
    if (!stream) {
        AG_TRY(vk::Stream made, vk::Stream::create(gpu));
        stream.emplace(std::move(made));
    }
    return &*stream;
}

Status GpuScene::State::build(const Surfaces& surfaces) {
    AG_ASSERT(surfaces.triangles.size() == triangle_count, "a rebuild has as many triangles");
    counted = {};
    const Result<vk::Stream*> on = ready_stream();
    built = on ? build(**on, corners(surfaces)) : Status(tl::unexpected(on.error()));
    return built;
}

Status GpuScene::State::build(vk::Stream& on, std::span<const shared::Triangle> triangles) {
    AG_TRY(const vk::Buffer buffer, gpu->make_buffer(triangles.size_bytes(), "triangles"));
    if (!triangles.empty()) on.upload(triangles, buffer);
    Status done = on.finish();
    const auto start = std::chrono::steady_clock::now();
    if (done)
        done = scene.update(on, {buffer.address(), static_cast<uint32_t>(triangles.size())}, {});
    if (done) done = on.finish();
    seconds.build = seconds_since(start);
    if (!done) stream.reset();  // waits, while the triangles are still there
    return done;
}

Status GpuScene::State::reserve(size_t count) {
    const size_t wanted = std::min(count, kBatch);
    AG_CHECK(gpu->grow(rays, wanted * sizeof(RayQuery), "rays"));
    AG_CHECK(gpu->grow(hits, wanted * sizeof(GpuHit), "hits"));
    AG_CHECK(gpu->grow(blocked, wanted * sizeof(uint32_t), "shadow hits"));
    return gpu->grow(counts, sizeof(TraceCounts), "ray counts");
}

template <class T>
Status GpuScene::State::trace_batch(vk::Stream& on, std::span<const Ray> batch, Query query,
                                    Counting counting, T* results) {
    on.upload(std::span<const RayQuery>(queries(batch)), rays);
    on.fill(counts, 0, 0, sizeof(TraceCounts));
    on.barrier();
    {
        const vk::Stream::Scope scope(on, kTraceLabel);
        kernels.record(on, scene.kinds(), query, counting,
                       {.first_group = 0,
                        .ray_count = static_cast<uint32_t>(batch.size()),
                        .scene = scene.address(),
                        .rays = rays.address(),
                        .hits = hits.address(),
                        .blocked = blocked.address(),
                        .counts = counts.address()});
    }
    const vk::Buffer& from = query == Query::any ? blocked : hits;
    AG_CHECK(on.download_bytes(from, 0, std::as_writable_bytes(std::span(results, batch.size()))));
    return counting == Counting::on ? add_counts(on, batch.size()) : Status();
}

Status GpuScene::State::add_counts(vk::Stream& on, size_t rays_traced) {
    AG_TRY(const auto sums, on.download<TraceCounts>(counts, 1));
    counted.rays += rays_traced;
    counted.steps += sums[0].steps;
    counted.triangle_tests += sums[0].triangles;
    return {};
}

template <class T>
Result<std::vector<T>> GpuScene::State::trace(std::span<const Ray> all, Query query,
                                              Counting counting) {
    std::vector<T> results(all.size());
    AG_CHECK(kernels.prepare(scene.kinds(), query, counting));
    AG_CHECK(reserve(all.size()));
    AG_TRY(vk::Stream* const on, ready_stream());
    on->take_timings();
    for (size_t first = 0; first < all.size(); first += kBatch) {
        const auto batch = all.subspan(first, std::min(kBatch, all.size() - first));
        if (Status done = trace_batch(*on, batch, query, counting, results.data() + first); !done) {
            stream.reset();
            return tl::unexpected(done.error());
        }
    }
    seconds.trace = 0;
    for (const vk::Timing& timing : on->take_timings())
        if (timing.label == kTraceLabel) seconds.trace += timing.seconds;
    return results;
}

GpuScene::GpuScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
GpuScene::GpuScene(GpuScene&&) noexcept = default;
GpuScene& GpuScene::operator=(GpuScene&&) noexcept = default;
GpuScene::~GpuScene() = default;

Result<GpuScene> GpuScene::create(const Gpu& gpu, const Surfaces& surfaces, Accel accel,
                                  const AccelDemand& demand) {
    const size_t count = surfaces.triangles.size();
    if (accel == Accel::automatic) accel = choose_accel({count, demand.rays_per_build});
    const accel::gpu::Group all{0, static_cast<uint32_t>(count), accel::gpu::Motion::free};
    AG_TRY(auto scene,
           accel::gpu::TraceScene::create(gpu, std::span(&all, 1), accel, demand.rays_per_build));
    auto state = std::make_unique<State>(gpu, std::move(scene));
    state->accel = accel;
    state->triangle_count = count;
    AG_CHECK(state->build(surfaces));
    return GpuScene(std::move(state));
}

Status GpuScene::rebuild(const Surfaces& surfaces) { return state_->build(surfaces); }
Accel GpuScene::accel() const { return state_->accel; }
AccelSeconds GpuScene::seconds() const { return state_->seconds; }

AccelStats GpuScene::stats() const {
    AccelStats stats = state_->scene.stats();
    stats.rays = state_->counted.rays;
    stats.steps = state_->counted.steps;
    stats.triangle_tests = state_->counted.triangle_tests;
    return stats;
}

Result<std::vector<GpuScene::GpuHit>> GpuScene::intersect(std::span<const Ray> rays,
                                                          Counting counting) {
    AG_CHECK(state_->built);
    return state_->trace<GpuHit>(rays, Query::nearest, counting);
}

Result<std::vector<uint32_t>> GpuScene::occluded(std::span<const Ray> rays, Counting counting) {
    AG_CHECK(state_->built);
    return state_->trace<uint32_t>(rays, Query::any, counting);
}

}  // namespace aglow
