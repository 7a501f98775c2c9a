// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/gather/cpu/final_gather.h"

#include "aglow/transport/gather/cpu/hemisphere.h"

#include <cmath>

namespace aglow::transport::cpu {
namespace {

/// Receives what the rays of one receiver find.
struct Collector {
    const GatherCache& cache;
    int bounces;
    vec3 direct_sum{0, 0, 0};
    vec3 indirect_sum{0, 0, 0};

    void ray(uint32_t) {}
    void direct(vec3 irradiance) { direct_sum += irradiance; }
    void texel(int delay, uint32_t element, vec3 weight) {
        if (bounces == kConverged) {
            indirect_sum += cache.exitance[element] * weight;
        } else if (delay < bounces) {
            indirect_sum +=
                cache.exitance_by_bounces[static_cast<size_t>(bounces - 1 - delay)][element] *
                weight;
        }
    }
    void light(int delay, vec3 exitance) {
        if (bounces == kConverged || delay < bounces) indirect_sum += exitance;
    }
};

/// Standard error of the mean of all samples, from the spread of the means of batches.
class Spread {
public:
    void add(double batch_mean) {
        ++count_;
        const double delta = batch_mean - mean_;
        mean_ += delta / count_;
        squares_ += delta * (batch_mean - mean_);
    }
    double standard_error() const {
        return count_ > 1 ? std::sqrt(squares_ / (count_ - 1.0) / count_) : 0;
    }

private:
    double mean_ = 0, squares_ = 0;
    double count_ = 0;
};

}  // namespace

Gathered gather_points(const World& world, const TexelMap& map, const GatherCache& cache,
                       std::span<const Receiver> points, uint32_t index, float floor,
                       const GatherOptions& options, uint64_t& ray_count) {
    const Samples samples(options.seed, index, 1);
    const int max_vertices = options.bounces == kConverged ? kUnlimited : options.bounces;
    const bool looks_around =
        options.bounces != 0 || world.lights.has_sky() || world.lights.has_emitters();
    const auto max_samples = static_cast<uint32_t>(options.max_samples);

    vec3 delta{0, 0, 0};
    std::vector<Outlook> outlooks;
    outlooks.reserve(points.size());
    for (const Receiver& point : points) {
        outlooks.emplace_back(world, vantage_of(point));
        delta += delta_irradiance(world, outlooks.back().at, ray_count);
    }
    delta = delta / static_cast<float>(points.size());

    const Gathering gathering{world, map, samples, outlooks, max_vertices, ray_count};
    Collector collector{cache, options.bounces};
    Spread spread;
    uint32_t done = 0;
    for (auto round = static_cast<uint32_t>(options.min_samples); done < max_samples;
         round = done * 2) {
        while (done < std::min(round, max_samples)) {
            const vec3 before = collector.direct_sum + collector.indirect_sum;
            const uint32_t count = std::min(kBatch, max_samples - done);
            gather_batch(gathering, done, count, looks_around, collector);
            done += count;
            const vec3 gained = collector.direct_sum + collector.indirect_sum - before;
            spread.add(static_cast<double>(luminance(gained)) / count);
        }
        const vec3 sum = collector.direct_sum + collector.indirect_sum;
        const float mean = luminance(delta + sum / static_cast<float>(done));
        if (spread.standard_error() <=
            static_cast<double>(options.target_error * shared::max(mean, floor)))
            break;
    }
    const float weight = 1 / static_cast<float>(std::max(1u, done));
    return {{delta + collector.direct_sum * weight, collector.indirect_sum * weight},
            static_cast<float>(spread.standard_error()),
            done};
}

}  // namespace aglow::transport::cpu
