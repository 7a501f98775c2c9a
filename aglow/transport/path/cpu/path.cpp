// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/path/path.h"

#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"
#include "aglow/transport/path/cpu/tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>

namespace aglow {
namespace {

using transport::cpu::PathSample;
using transport::cpu::Tracer;

constexpr int kBatches = 16;       // independent groups of paths whose spread gives the error
constexpr size_t kReceivers = 16;  // of one task
constexpr size_t kPixels = 64;     // of one task

/// Sum of colours that loses nothing over millions of samples.
struct Sum {
    double x = 0, y = 0, z = 0;

    void add(vec3 c) {
        x += double{c.x};
        y += double{c.y};
        z += double{c.z};
    }
    void add(const Sum& other) {
        x += other.x;
        y += other.y;
        z += other.z;
    }
    vec3 over(double count) const {
        return {static_cast<float>(x / count), static_cast<float>(y / count),
                static_cast<float>(z / count)};
    }
    double luminance() const { return 0.2126 * x + 0.7152 * y + 0.0722 * z; }
};

struct Batch {
    Sum direct, indirect;
    int samples = 0;
};

/// Mean of all paths and the standard error of its luminance: paths are independent, so the
/// weighted spread of the batches' means estimates the variance of one path.
struct Estimate {
    Irradiance mean;
    double standard_error = 0;
};

Estimate combine(std::span<const Batch> batches) {
    Sum direct, indirect;
    double count = 0;
    for (const Batch& batch : batches) {
        direct.add(batch.direct);
        indirect.add(batch.indirect);
        count += batch.samples;
    }
    const double mean = (direct.luminance() + indirect.luminance()) / count;
    double spread = 0;
    for (const Batch& batch : batches) {
        const double sum = batch.direct.luminance() + batch.indirect.luminance();
        const double deviation = sum / batch.samples - mean;
        spread += batch.samples * deviation * deviation;
    }
    const auto freedom = static_cast<double>(batches.size() - 1);
    return {{direct.over(count), indirect.over(count)},
            batches.size() > 1 ? std::sqrt(spread / freedom / count) : 0};
}

Status check(const PathOptions& options) {
    if (options.samples < 1)
        return fail(Errc::bad_argument,
                    fmt::format("{} paths per receiver: at least 1 is needed", options.samples));
    if (options.bounces < kConverged)
        return fail(
            Errc::bad_argument,
            fmt::format("the number of bounces is {}: it cannot be negative", options.bounces));
    return {};
}

/// What all receivers took together.
struct Totals {
    std::atomic<uint64_t> ray_count = 0;
    std::atomic<int> bounces = 0;
    std::atomic<size_t> done = 0;

    void add(uint64_t rays, int longest) {
        ray_count.fetch_add(rays, std::memory_order_relaxed);
        int seen = bounces.load(std::memory_order_relaxed);
        while (seen < longest && !bounces.compare_exchange_weak(seen, longest)) {
        }
    }
};

/// Traces all paths of receiver `index`; path i starts from start(i).
template <class Start>
Estimate trace_one(const Tracer& tracer, size_t index, const PathOptions& options,
                   const Start& start, Totals& totals) {
    Pcg32 random(options.seed, index);
    std::array<Batch, kBatches> batches;
    const int batch_count = std::min(kBatches, options.samples);
    uint64_t rays = 0;
    int bounces = 0;
    for (int b = 0; b < batch_count; ++b) {
        Batch& batch = batches[static_cast<size_t>(b)];
        const auto bound = [&](int k) {
            return static_cast<int>(int64_t{options.samples} * k / batch_count);
        };
        for (int i = bound(b); i < bound(b + 1); ++i) {
            const PathSample sample = tracer.trace(start(i), random);
            batch.direct.add(sample.irradiance.direct);
            batch.indirect.add(sample.irradiance.indirect);
            ++batch.samples;
            rays += static_cast<uint64_t>(sample.ray_count);
            bounces = std::max(bounces, sample.bounces);
        }
    }
    totals.add(rays, bounces);
    return combine(std::span(batches).first(static_cast<size_t>(batch_count)));
}

/// Traces `count` receivers; path i of receiver k starts from start(k, i).
template <class Start>
Result<IrradianceField> trace_all(const World& world, size_t count, const PathOptions& options,
                                  const Monitor& monitor, const Start& start) try {
    AG_CHECK(check(options));
    IrradianceField field;
    field.values.resize(count);
    field.standard_error.resize(options.samples > 1 ? count : 0);
    field.samples = options.samples;
    const Tracer tracer(world, options.bounces);
    Totals totals;
    parallel_for(count, kReceivers, [&](size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            if (monitor.cancelled()) return;
            const Estimate estimate = trace_one(
                tracer, k, options, [&](int i) { return start(k, i); }, totals);
            field.values[k] = estimate.mean;
            if (options.samples > 1)
                field.standard_error[k] = static_cast<float>(estimate.standard_error);
        }
        const size_t done = totals.done.fetch_add(end - begin) + (end - begin);
        monitor("path tracing", static_cast<double>(done) / static_cast<double>(count));
    });
    if (monitor.cancelled()) return fail(Errc::cancelled, "path tracing was interrupted");
    field.ray_count = totals.ray_count;
    field.bounces = totals.bounces;
    return field;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory,
                fmt::format("not enough memory for the light of {} receivers", count));
}

/// Side of the square of subpixels that `samples` jittered rays fill row by row; rays beyond the
/// square are jittered over the whole pixel.
int strata_of(int samples) {
    return static_cast<int>(std::sqrt(static_cast<double>(samples) + 0.5));
}

vec2 jitter(int i, int strata, Pcg32& random) {
    const float u = random.uniform(), v = random.uniform();
    if (i >= strata * strata) return {u, v};
    const auto side = static_cast<float>(strata);
    // Sums that round up to the pixel's far edge are kept inside it.
    const auto within = [side](int k, float w) {
        return std::min((static_cast<float>(k) + w) / side, 1 - 0x1p-24f);
    };
    return {within(i % strata, u), within(i / strata, v)};
}

}  // namespace

Result<IrradianceField> trace_texels(const World& world, const Texels& texels,
                                     const PathOptions& options, const Monitor& monitor) {
    const auto start = [&](size_t element, int path) {
        const uint32_t first = texels.first_sample[element];
        const uint32_t count = texels.first_sample[element + 1] - first;
        AG_ASSERT(count > 0, "every covered texel has a sample point");
        const SurfacePoint at = texels.samples[first + static_cast<uint32_t>(path) % count];
        return receiver_at(world.surfaces, at);
    };
    return trace_all(world, texels.element_count(), options, monitor, start);
}

Result<IrradianceField> trace_receivers(const World& world, std::span<const Receiver> receivers,
                                        const PathOptions& options, const Monitor& monitor) {
    const auto start = [&](size_t k, int) -> const Receiver& { return receivers[k]; };
    return trace_all(world, receivers.size(), options, monitor, start);
}

Result<Image> trace_image(const World& world, int width, int height,
                          const std::function<Ray(float x, float y)>& camera,
                          const PathOptions& options, const Monitor& monitor) try {
    AG_CHECK(check(options));
    Image image(width, height);
    const Tracer tracer(world, options.bounces);
    const int strata = strata_of(options.samples);
    std::atomic<size_t> done = 0;
    parallel_for(image.pixels.size(), kPixels, [&](size_t begin, size_t end) {
        for (size_t pixel = begin; pixel < end; ++pixel) {
            if (monitor.cancelled()) return;
            const auto row = static_cast<size_t>(width);
            const auto x = static_cast<float>(pixel % row), y = static_cast<float>(pixel / row);
            Pcg32 random(options.seed, pixel);
            Sum sum;
            for (int i = 0; i < options.samples; ++i) {
                const vec2 inside = jitter(i, strata, random);
                sum.add(tracer.luminance_along(camera(x + inside.x, y + inside.y), random));
            }
            image.pixels[pixel] = sum.over(options.samples);
        }
        const size_t so_far = done.fetch_add(end - begin) + (end - begin);
        monitor("path tracing",
                static_cast<double>(so_far) / static_cast<double>(image.pixels.size()));
    });
    if (monitor.cancelled()) return fail(Errc::cancelled, "path tracing was interrupted");
    return image;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory,
                fmt::format("not enough memory for {} x {} pixels", width, height));
}

}  // namespace aglow
