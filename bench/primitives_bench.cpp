// SPDX-License-Identifier: Apache-2.0
// How fast the device's primitives are: elements per second, the share of its own copy bandwidth,
// and the ratio to the standard library and oneTBB on the processor, measured in the same run.
//     primitives_bench [part of the device's name]
#include "aglow/core/parallel.h"
#include "aglow/core/random.h"
#include "aglow/shared/ray.h"
#include "aglow/vk/compact.h"
#include "aglow/vk/device.h"
#include "aglow/vk/radix_sort.h"
#include "aglow/vk/reduce.h"
#include "aglow/vk/scan.h"
#include "aglow/vk/segmented_bounds.h"
#include "aglow/vk/stream.h"

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

using namespace aglow;
using namespace aglow::vk;

namespace {

constexpr int kRepeats = 5;
constexpr const char* kTimed = "timed";

/// The best of some runs: what else runs on the machine only ever adds time.
struct DeviceTime {
    double seconds = std::numeric_limits<double>::infinity();
    std::vector<Timing> kernels;
};

Result<DeviceTime> time_device(Stream& stream, const std::function<void()>& prepare,
                               const std::function<void()>& record) {
    DeviceTime best;
    for (int i = 0; i < kRepeats; ++i) {
        prepare();
        stream.barrier();
        {
            const Stream::Scope scope(stream, kTimed);
            record();
        }
        AG_CHECK(stream.finish());
        DeviceTime time{0, stream.take_timings()};
        std::erase_if(time.kernels, [](const Timing& t) { return t.label != kTimed; });
        for (const Timing& timing : time.kernels) time.seconds += timing.seconds;
        if (time.seconds < best.seconds) std::swap(best, time);
    }
    return best;
}

double time_host(const std::function<void()>& prepare, const std::function<void()>& run) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kRepeats; ++i) {
        prepare();
        const auto start = std::chrono::steady_clock::now();
        run();
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        best = std::min(best, time.count());
    }
    return best;
}

void nothing() {}

std::vector<uint32_t> random_keys(size_t count, uint32_t bits) {
    Pcg32 random(1);
    std::vector<uint32_t> keys(count);
    std::ranges::generate(keys, [&] { return random.next() >> (32 - bits); });
    return keys;
}

struct Row {
    const char* what;
    double bytes;  ///< that any way to do it must read and write, per element
    DeviceTime time;
};

/// Bytes read and written per second.
Result<double> copy_rate(Stream& stream, const Buffer& from, const Buffer& to) {
    AG_TRY(const DeviceTime time,
           time_device(stream, nothing, [&] { stream.copy(from, 0, to, 0, from.size()); }));
    return 2 * static_cast<double>(from.size()) / time.seconds;
}

void print(const Row& row, size_t count, double bytes_per_second) {
    const double rate = static_cast<double>(count) / row.time.seconds;
    fmt::print("  {:22} {:8.1f} M/s  {:5.1f} % of copy |", row.what, rate * 1e-6,
               100 * rate * row.bytes / bytes_per_second);
    for (const Timing& timing : row.time.kernels)
        fmt::print(" {} {:.0f} %", timing.kernel, 100 * timing.seconds / row.time.seconds);
    fmt::print("\n");
}

void print_peer(const char* what, size_t count, double seconds, double device_seconds) {
    fmt::print("    {:24} {:6.1f} M/s; the device runs at {:.2f} of it\n", what,
               static_cast<double>(count) / seconds * 1e-6, seconds / device_seconds);
}

Status bench_sort(Stream& stream, RadixSort& sort, size_t count, uint32_t bits,
                  double bytes_per_second) {
    const std::vector<uint32_t> keys = random_keys(count, bits);
    AG_TRY(const Buffer key_buffer, stream.make_buffer(4 * count, "keys"));
    AG_TRY(const Buffer value_buffer, stream.make_buffer(4 * count, "values"));
    AG_CHECK(sort.reserve(count));
    AG_TRY(const DeviceTime time,
           time_device(
               stream, [&] { stream.upload(std::span<const uint32_t>(keys), key_buffer); },
               [&] {
                   static_cast<void>(sort.record(stream, key_buffer.address(),
                                                 value_buffer.address(), count, bits));
               }));
    const std::string what = fmt::format("sort, {} bits", bits);
    print({what.c_str(), 16, time}, count, bytes_per_second);

    // A key above its place in one integer: any sort keeps the order of equal keys.
    std::vector<uint64_t> pairs(count);
    const auto fill = [&] {
        for (size_t i = 0; i < count; ++i) pairs[i] = uint64_t{keys[i]} << 32 | i;
    };
    const auto key = [](uint64_t pair) { return pair >> 32; };
    print_peer("std::sort", count, time_host(fill, [&] { std::ranges::sort(pairs); }),
               time.seconds);
    print_peer("std::stable_sort", count,
               time_host(fill, [&] { std::ranges::stable_sort(pairs, {}, key); }), time.seconds);
    print_peer("tbb::parallel_sort", count,
               time_host(fill, [&] { tbb::parallel_sort(pairs.begin(), pairs.end()); }),
               time.seconds);
    return {};
}

Status bench_passes(Stream& stream, size_t count, double bytes_per_second) {
    const Gpu& gpu = stream.gpu();
    AG_TRY(auto reduce, Reduce::create(gpu, Reduction::sum_uint));
    AG_TRY(auto scan, Scan::create(gpu));
    AG_TRY(auto compact, Compact::create(gpu));
    AG_CHECK(reduce.reserve(count));
    AG_CHECK(scan.reserve(count));
    AG_CHECK(compact.reserve(count));
    const std::vector<uint32_t> values = random_keys(count, 1);
    AG_TRY(const Buffer in, make_buffer_of(stream, std::span<const uint32_t>(values), "values"));
    AG_TRY(const Buffer out, stream.make_buffer(4 * count, "results"));
    AG_TRY(const Buffer one, stream.make_buffer(4, "result"));

    AG_TRY(const DeviceTime reduced, time_device(stream, nothing, [&] {
               reduce.record(stream, in.address(), count, one.address());
           }));
    print({"reduce", 4, reduced}, count, bytes_per_second);
    AG_TRY(const DeviceTime scanned, time_device(stream, nothing, [&] {
               scan.record(stream, in.address(), out.address(), count);
           }));
    print({"scan", 8, scanned}, count, bytes_per_second);
    std::vector<uint32_t> sums(count);
    print_peer(
        "std::exclusive_scan", count,
        time_host(nothing,
                  [&] { std::exclusive_scan(values.begin(), values.end(), sums.begin(), 0u); }),
        scanned.seconds);
    AG_TRY(const DeviceTime compacted, time_device(stream, nothing, [&] {
               compact.record(stream, in.address(), count, out.address(), one.address());
           }));
    print({"compact, half are kept", 6, compacted}, count, bytes_per_second);
    return {};
}

Status bench_bounds(Stream& stream, size_t count, size_t length, double bytes_per_second) {
    AG_TRY(auto bounds, SegmentedBounds::create(stream.gpu()));
    const std::vector<shared::Bounds> boxes(count, {{0, 0, 0}, {1, 1, 1}});
    std::vector<uint32_t> starts(count / length + 1);
    for (size_t s = 0; s < starts.size(); ++s) starts[s] = static_cast<uint32_t>(s * length);
    AG_TRY(const Buffer in,
           make_buffer_of(stream, std::span<const shared::Bounds>(boxes), "boxes"));
    AG_TRY(const Buffer first, make_buffer_of(stream, std::span<const uint32_t>(starts), "starts"));
    AG_TRY(const Buffer out, stream.make_buffer(24 * (starts.size() - 1), "bounds"));
    AG_TRY(const DeviceTime time, time_device(stream, nothing, [&] {
               bounds.record(stream, in.address(), count, first.address(), starts.size() - 1,
                             out.address());
           }));
    const std::string what = fmt::format("bounds of {}", length);
    const double bytes = 24 + 28 / static_cast<double>(length);
    print({what.c_str(), bytes, time}, count, bytes_per_second);
    return {};
}

Status bench(const std::string& device) {
    AG_TRY(const Gpu gpu, open_gpu(device));
    AG_TRY(Stream stream, Stream::create(gpu));
    fmt::print("{}, subgroups of {}; best of {} runs\n", gpu->info().name, gpu->subgroup_size(),
               kRepeats);
    if (gpu->timestamp_period() == 0)
        return fail(Errc::unsupported, gpu->info().name + ": its queue has no timestamps");
    AG_TRY(auto sort, RadixSort::create(gpu));
    for (const int power : {20, 22, 24}) {
        const size_t count = size_t{1} << power;
        AG_TRY(const Buffer from, stream.make_buffer(16 * count, "copied"));
        AG_TRY(const Buffer to, stream.make_buffer(16 * count, "copy"));
        AG_TRY(const double rate, copy_rate(stream, from, to));
        fmt::print("2^{} elements; the device copies {:.1f} GB/s (read and written)\n", power,
                   rate * 1e-9);
        AG_CHECK(bench_passes(stream, count, rate));
        for (const uint32_t bits : {20u, 32u})
            AG_CHECK(bench_sort(stream, sort, count, bits, rate));
        for (const size_t length : {size_t{1}, size_t{10}, count})
            AG_CHECK(bench_bounds(stream, count, length, rate));
    }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    const Status status = bench(argc > 1 ? argv[1] : "");
    if (status) return 0;
    fmt::print(stderr, "{}\n", to_string(status.error()));
    return 1;
}
