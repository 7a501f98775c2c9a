// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/gather/cpu/links.h"

#include "aglow/core/parallel.h"
#include "aglow/transport/gather/cpu/hemisphere.h"

#include <atomic>
#include <cmath>

namespace aglow::transport::cpu {
namespace {

constexpr size_t kGrain = 64;

/// A scene of few texels has few rays to average noise over, and each is cheap.
int rays_per_texel(const GatherOptions& options, size_t element_count) {
    constexpr int64_t kMost = 4096;
    const int64_t share =
        options.cache_rays / static_cast<int64_t>(std::max(size_t{1}, element_count));
    return std::max(options.cache_samples, static_cast<int>(std::min(kMost, share)));
}

/// Receives what the rays of one texel find.
struct LinkCollector {
    std::span<uint32_t> to;
    std::vector<PathLink>& paths;
    vec3& direct_sum;
    uint32_t from;
    uint32_t current = 0;

    void ray(uint32_t i) { current = i; }
    void direct(vec3 irradiance) { direct_sum += irradiance; }
    void texel(int delay, uint32_t element, vec3 weight) {
        if (delay == 0)
            to[current] = element;
        else
            paths.push_back({from, element, delay, weight});
    }
    void light(int delay, vec3 exitance) {
        if (exitance != vec3{0, 0, 0}) paths.push_back({from, kNoElement, delay, exitance});
    }
};

/// Reflectance of one texel and, where it reflects at all, its links and direct light. Bounces
/// leave from geometric normals.
void trace_texel(const World& world, const Texels& texels, const TexelMap& map,
                 const GatherOptions& options, uint32_t element, Links& links,
                 std::vector<PathLink>& paths, uint64_t& ray_count) {
    const uint32_t first = texels.first_sample[element];
    const uint32_t point_count = texels.first_sample[element + 1] - first;
    const auto ray_total = static_cast<uint32_t>(links.rays_per_texel);
    const Samples samples(options.seed, element, 0);
    const int max_vertices = options.bounces == kConverged ? kUnlimited : options.bounces - 1;

    const float weight = 1 / static_cast<float>(point_count);
    vec3 reflectance{0, 0, 0};
    for (uint32_t p = first; p < first + point_count; ++p)
        reflectance += diffuse_reflectance(world.scene, world.surfaces, texels.samples[p]) * weight;
    links.reflectance[element] = reflectance;
    if (reflectance == vec3{0, 0, 0}) return;  // what arrives here never leaves

    vec3 delta{0, 0, 0}, sampled{0, 0, 0};
    std::vector<Outlook> outlooks;
    outlooks.reserve(point_count);
    for (uint32_t p = first; p < first + point_count; ++p) {
        outlooks.emplace_back(world, vantage_on(world.surfaces, texels.samples[p], true));
        delta += delta_irradiance(world, outlooks.back().at, ray_count);
    }
    LinkCollector collector{std::span(links.to).subspan(size_t{element} * ray_total, ray_total),
                            paths, sampled, element};
    const Gathering gathering{world, map, samples, outlooks, max_vertices, ray_count};
    for (uint32_t i = 0; i < ray_total; i += kBatch)
        gather_batch(gathering, i, std::min(kBatch, ray_total - i), true, collector);
    links.direct[element] = delta * weight + sampled / static_cast<float>(ray_total);
}

/// sum over links of exitance, for texels [begin, end): `result` = direct + G B.
/// `exitance(delay)` is the B that a link over `delay` path vertices sees, null where it sees none.
template <class ExitanceOf>
void apply(const Links& links, std::span<const size_t> first_path, ExitanceOf&& exitance,
           int reflections, std::vector<vec3>& irradiance) {
    const auto ray_total = static_cast<size_t>(links.rays_per_texel);
    const float weight = 1 / static_cast<float>(ray_total);
    parallel_for(links.direct.size(), 1024, [&](size_t begin, size_t end) {
        const std::vector<vec3>* fronts = exitance(0);
        for (size_t e = begin; e < end; ++e) {
            vec3 sum{0, 0, 0};
            if (fronts)
                for (size_t i = 0; i < ray_total; ++i)
                    if (const uint32_t to = links.to[e * ray_total + i]; to != kNoElement)
                        sum += (*fronts)[to];
            for (size_t i = first_path[e]; i < first_path[e + 1]; ++i) {
                const PathLink& link = links.paths[i];
                if (link.to == kNoElement) {
                    if (link.delay < reflections) sum += link.weight;
                } else if (const std::vector<vec3>* behind = exitance(link.delay)) {
                    sum += (*behind)[link.to] * link.weight;
                }
            }
            irradiance[e] = links.direct[e] + sum * weight;
        }
    });
}

std::vector<size_t> path_offsets(const Links& links) {
    std::vector<size_t> first(links.direct.size() + 1, 0);
    for (const PathLink& link : links.paths) ++first[link.from + 1];
    for (size_t e = 1; e < first.size(); ++e) first[e] += first[e - 1];
    return first;
}

void reflect(const Links& links, const std::vector<vec3>& irradiance, std::vector<vec3>& exitance) {
    for (size_t e = 0; e < irradiance.size(); ++e)
        exitance[e] = links.reflectance[e] * irradiance[e];
}

double total(const std::vector<vec3>& values) {
    double sum = 0;
    for (const vec3 v : values) sum += static_cast<double>(luminance(v));
    return sum;
}

GatherCache solve_bounces(const Links& links, int bounces) {
    GatherCache cache;
    cache.bounces = bounces;
    const std::vector<size_t> first_path = path_offsets(links);
    std::vector<vec3> irradiance = links.direct;
    for (int n = 0; n < bounces; ++n) {
        if (n > 0)
            apply(
                links, first_path,
                [&](int delay) -> const std::vector<vec3>* {
                    const int k = n - 1 - delay;
                    return k >= 0 ? &cache.exitance_by_bounces[static_cast<size_t>(k)] : nullptr;
                },
                n, irradiance);
        cache.exitance_by_bounces.emplace_back(irradiance.size());
        reflect(links, irradiance, cache.exitance_by_bounces.back());
    }
    if (bounces > 0) cache.exitance = cache.exitance_by_bounces.back();
    return cache;
}

// Jacobi iteration. Each step adds one order of reflection; orders shrink by a ratio that settles
// quickly, so what all later orders would add is known: the step's gain times q / (1 - q).
GatherCache solve_to_convergence(const Links& links) {
    constexpr double kRemaining = 1e-4;  // of the exitance; a tenth of what the contract asks
    constexpr int kMaxIterations = 2000;
    GatherCache cache;
    const std::vector<size_t> first_path = path_offsets(links);
    std::vector<vec3> irradiance = links.direct;
    cache.exitance.resize(irradiance.size());
    reflect(links, irradiance, cache.exitance);
    double before = total(cache.exitance), gain_before = before;
    for (cache.bounces = 1; cache.bounces < kMaxIterations; ++cache.bounces) {
        apply(
            links, first_path, [&](int) { return &cache.exitance; }, kMaxIterations, irradiance);
        reflect(links, irradiance, cache.exitance);
        const double now = total(cache.exitance);
        const double gain = now - before;
        const double ratio = gain_before > 0 ? std::min(gain / gain_before, 0.999) : 0;
        before = now;
        gain_before = gain;
        if (gain * ratio <= kRemaining * (1 - ratio) * now) break;
    }
    return cache;
}

}  // namespace

Result<Links> trace_links(const World& world, const Texels& texels, const TexelMap& map,
                          const GatherOptions& options, const Monitor& monitor) {
    const size_t count = texels.element_count();
    Links links;
    links.rays_per_texel = rays_per_texel(options, count);
    links.to.assign(count * static_cast<size_t>(links.rays_per_texel), kNoElement);
    links.direct.resize(count);
    links.reflectance.resize(count);
    std::vector<std::vector<PathLink>> paths((count + kGrain - 1) / kGrain);
    std::atomic<uint64_t> ray_count = 0;
    std::atomic<size_t> done = 0;

    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        if (monitor.cancelled()) return;
        uint64_t rays = 0;
        for (size_t e = begin; e < end; ++e)
            trace_texel(world, texels, map, options, static_cast<uint32_t>(e), links,
                        paths[begin / kGrain], rays);
        ray_count += rays;
        monitor("light between texels",
                static_cast<double>(done += end - begin) / static_cast<double>(count));
    });
    if (monitor.cancelled())
        return fail(Errc::cancelled, "stopped while tracing light between texels");

    for (const auto& block : paths)
        links.paths.insert(links.paths.end(), block.begin(), block.end());
    links.ray_count = ray_count;
    return links;
}

GatherCache solve_links(const Links& links, int bounces) {
    GatherCache cache =
        bounces == kConverged ? solve_to_convergence(links) : solve_bounces(links, bounces);
    cache.ray_count = links.ray_count;
    return cache;
}

}  // namespace aglow::transport::cpu
