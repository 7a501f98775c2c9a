// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/gather/gather.h"

#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"
#include "aglow/transport/gather/cpu/final_gather.h"
#include "aglow/transport/gather/cpu/links.h"

#include <atomic>
#include <new>

namespace aglow {
namespace {

using transport::cpu::Gathered;
using transport::cpu::TexelMap;

/// Gathers at every receiver: `points_of(i, points)` fills in the points of receiver i.
template <class PointsOf>
Result<IrradianceField> gather_all(const World& world, const TexelMap& map,
                                   const GatherCache& cache, size_t count, float floor,
                                   const GatherOptions& options, const Monitor& monitor,
                                   PointsOf&& points_of) {
    IrradianceField field;
    field.values.resize(count);
    field.standard_error.resize(count);
    field.bounces = cache.bounces;
    std::atomic<uint64_t> ray_count = 0, sample_count = 0;
    std::atomic<size_t> done = 0;

    // Few receivers are sensors, and each takes long.
    const size_t grain = count < 1024 ? 1 : 16;
    parallel_for(count, grain, [&](size_t begin, size_t end) {
        if (monitor.cancelled()) return;
        uint64_t rays = 0, samples = 0;
        std::vector<Receiver> points;
        for (size_t i = begin; i < end; ++i) {
            points_of(i, points);
            const Gathered gathered = transport::cpu::gather_points(
                world, map, cache, points, static_cast<uint32_t>(i), floor, options, rays);
            field.values[i] = gathered.irradiance;
            field.standard_error[i] = gathered.standard_error;
            samples += gathered.samples;
        }
        ray_count += rays;
        sample_count += samples;
        monitor("last gather",
                static_cast<double>(done += end - begin) / static_cast<double>(count));
    });
    if (monitor.cancelled()) return fail(Errc::cancelled, "stopped during the last gather");

    field.ray_count = cache.ray_count + ray_count;
    field.samples = count ? static_cast<double>(sample_count) / static_cast<double>(count) : 0;
    return field;
}

/// Below a tenth of the scene's mean irradiance, noise is judged by that instead of by the
/// receiver's own.
float noise_floor(const GatherCache& cache) {
    double sum = 0;
    for (const vec3 exitance : cache.exitance) sum += static_cast<double>(luminance(exitance));
    const double mean =
        cache.exitance.empty() ? 0 : sum / static_cast<double>(cache.exitance.size());
    return static_cast<float>(mean / 10);
}

}  // namespace

Result<GatherCache> solve_gather(const World& world, const Texels& texels,
                                 const GatherOptions& options, const Monitor& monitor) try {
    AG_ASSERT(world.surfaces.lightmap_uvs.size() == world.surfaces.positions.size(),
              "surfaces posed with the atlas of the texels");
    if (options.bounces == 0 || texels.element_count() == 0) return GatherCache{};
    const TexelMap map(world.surfaces, texels);
    AG_TRY(const auto links, transport::cpu::trace_links(world, texels, map, options, monitor));
    return transport::cpu::solve_links(links, options.bounces);
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "not enough memory to link " +
                                         std::to_string(texels.element_count()) +
                                         " texels; use a larger --texel-size");
}

Result<IrradianceField> gather_texels(const World& world, const Texels& texels,
                                      const GatherCache& cache, const GatherOptions& options,
                                      const Monitor& monitor) {
    const TexelMap map(world.surfaces, texels);
    return gather_all(world, map, cache, texels.element_count(), noise_floor(cache), options,
                      monitor, [&](size_t element, std::vector<Receiver>& points) {
                          points.clear();
                          for (uint32_t i = texels.first_sample[element];
                               i < texels.first_sample[element + 1]; ++i)
                              points.push_back(receiver_at(world.surfaces, texels.samples[i]));
                      });
}

Result<IrradianceField> gather_receivers(const World& world, const Texels& texels,
                                         const GatherCache& cache,
                                         std::span<const Receiver> receivers,
                                         const GatherOptions& options, const Monitor& monitor) {
    const TexelMap map(world.surfaces, texels);
    return gather_all(
        world, map, cache, receivers.size(), noise_floor(cache), options, monitor,
        [&](size_t i, std::vector<Receiver>& points) { points.assign(1, receivers[i]); });
}

}  // namespace aglow
