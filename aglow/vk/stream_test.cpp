// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/stream.h"

#include "aglow/vk/testing/kernels.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <thread>

using namespace aglow;
using namespace aglow::vk;
using namespace aglow::vk::testing;

namespace {

constexpr uint64_t kMiB = uint64_t{1} << 20;

}  // namespace

TEST_CASE("a kernel writes what is read back, however many pieces it takes") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    Kernel iota = iota_kernel(device.gpu());
    for (uint32_t count : {1u, 63u, 64u, 65u, 1000u, 1u << 20, 65535u * 64 + 1}) {
        CAPTURE(count);
        const Buffer buffer = demand(stream.make_buffer(uint64_t{count} * 4, "values"));
        stream.run(iota, IotaArgs{0, count, buffer.address(), 7}, group_count(count, 64));
        const auto values = demand(stream.download<uint32_t>(buffer, count));
        CHECK(values == numbers(7, count));
    }
}

TEST_CASE("nothing to do is done") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    Kernel iota = iota_kernel(device.gpu());
    const Buffer buffer = demand(stream.make_buffer(0, "nothing"));
    stream.run(iota, IotaArgs{}, 0);
    stream.upload(std::span<const uint32_t>(), buffer);
    stream.barrier();
    CHECK(stream.finish());
    CHECK(stream.download<uint32_t>(buffer, 0)->empty());
    CHECK(device->submit_count() == 0);
    CHECK(stream.take_timings().empty());
}

TEST_CASE("uploads, copies and fills of any size arrive in order") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    for (uint64_t count : {uint64_t{1}, uint64_t{1000}, 3 * kMiB, 9 * kMiB + 5}) {
        CAPTURE(count);
        std::vector<uint32_t> data = numbers(3, count);
        const Buffer from = demand(make_buffer_of(stream, std::span<const uint32_t>(data), "from"));
        const Buffer to = demand(stream.make_buffer(count * 4, "to"));
        stream.barrier();
        stream.copy(from, 0, to, 0, count * 4);
        stream.barrier();
        stream.fill(to, 9, (count - 1) * 4, 4);
        const auto values = demand(stream.download<uint32_t>(to, count));
        data.back() = 9;
        CHECK(values == data);
    }
}

TEST_CASE("many small uploads are not limited by the staging memory") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    const uint64_t count = 3000, words = 1000;
    const Buffer buffer = demand(stream.make_buffer(count * words * 4, "buffer"));
    for (uint32_t i = 0; i < count; ++i) {
        std::vector<uint32_t> data = numbers(i, words);
        stream.upload(std::span<const uint32_t>(data), buffer, i * words * 4);
    }
    const auto values = demand(stream.download<uint32_t>(buffer, count * words));
    bool all = true;
    for (uint32_t i = 0; i < count * words; ++i) all &= values[i] == i / words + i % words;
    CHECK(all);
}

TEST_CASE("a buffer beyond the device's storage range is read and written by address") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    Kernel shift = shift_kernel(device.gpu(), 0);
    const uint64_t bytes = 200 * kMiB;
    const uint32_t count = 10000, far = 150u << 18;  // 150 MiB into the buffer
    std::vector<uint32_t> data = numbers(11, count);
    const Buffer small = demand(make_buffer_of(stream, std::span<const uint32_t>(data), "small"));
    const Buffer large = demand(stream.make_buffer(bytes, "large"));
    const Buffer back = demand(stream.make_buffer(count * 4, "back"));
    stream.fill(large, 1, 0, bytes);
    stream.barrier();
    stream.run(shift, ShiftArgs{0, count, small.address(), large.address(), 0, far},
               group_count(count, 64));
    stream.barrier();
    stream.run(shift, ShiftArgs{0, count, large.address(), back.address(), far, 0},
               group_count(count, 64));
    const auto values = demand(stream.download<uint32_t>(back, count));
    CHECK(values == data);
    const auto edge = demand(stream.download<uint32_t>(large, count + 2, far - 1));
    CHECK(edge.front() == 1);
    CHECK(edge.back() == 1);
    CHECK(std::equal(data.begin(), data.end(), edge.begin() + 1));
}

TEST_CASE("each kernel's time is found under its label, in order of first appearance") {
    for (bool timestamps : {true, false}) {
        CAPTURE(timestamps);
        DeviceOptions options;
        options.timestamps = timestamps;
        TestDevice device(options);
        if (!device) return;
        Stream stream = device.stream();
        Kernel iota = iota_kernel(device.gpu()), shift = shift_kernel(device.gpu());
        const Buffer a = demand(stream.make_buffer(4 * kMiB, "a"));
        const Buffer b = demand(stream.make_buffer(4 * kMiB, "b"));
        stream.fill(b, 0, 0, 4 * kMiB);
        for (int frame = 0; frame < 2; ++frame) {
            Stream::Scope scope(stream, "frame");
            stream.run(iota, IotaArgs{0, kMiB, a.address(), 0}, kMiB / 64);
            stream.barrier();
            stream.run(shift, ShiftArgs{0, kMiB, a.address(), b.address()}, kMiB / 64);
            stream.barrier();
        }
        stream.run(iota, IotaArgs{0, 64, a.address(), 0}, 1);
        demand(stream.finish());
        std::vector<Timing> timings = stream.take_timings();
        REQUIRE(timings.size() == 4);
        const std::array<const char*, 4> labels{"", "frame", "frame", ""};
        const std::array<const char*, 4> kernels{"fill", "iota", "shift", "iota"};
        const std::array<uint64_t, 4> dispatches{1, 2, 2, 1};
        double total = 0;
        for (size_t i = 0; i < 4; ++i) {
            CHECK(timings[i].label == labels[i]);
            CHECK(timings[i].kernel == kernels[i]);
            CHECK(timings[i].dispatches == dispatches[i]);
            CHECK(timings[i].seconds > 0);
            total += timings[i].seconds;
        }
        double submits = 0;
        for (double seconds : stream.take_submit_seconds()) submits += seconds;
        CHECK(total == doctest::Approx(submits));
        CHECK(stream.take_timings().empty());
        CHECK(stream.take_submit_seconds().empty());
    }
}

TEST_CASE("a slow kernel is cut so that no submit takes 100 ms") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    Kernel shift = shift_kernel(device.gpu(), 1);
    const uint32_t groups = 1000, count = groups * 64;
    std::vector<uint32_t> data = numbers(0, count);
    const Buffer from = demand(make_buffer_of(stream, std::span<const uint32_t>(data), "from"));
    const Buffer to = demand(stream.make_buffer(count * 4, "to"));
    demand(stream.finish());
    stream.take_submit_seconds();
    const uint32_t rounds = device->info().kind == GpuKind::software ? 5000 : 500000;
    stream.run(shift, ShiftArgs{0, count, from.address(), to.address(), 0, 0, rounds}, groups);
    demand(stream.finish());
    std::vector<double> seconds = stream.take_submit_seconds();
    const auto values = demand(stream.download<uint32_t>(to, count));
    CHECK(values == numbers(1, count));
    REQUIRE(seconds.size() > 3);
    seconds.erase(seconds.begin());  // in which the kernel was unknown, and compiled
    std::sort(seconds.begin(), seconds.end());
    // A software device shares the processors with other programs, which can halt any submit.
    bool shared = device->info().kind == GpuKind::software;
    CHECK(seconds[shared ? seconds.size() / 2 : seconds.size() - 1] < 0.1);
}

TEST_CASE("streams of several threads share a device") {
    TestDevice device;
    if (!device) return;
    std::array<bool, 3> right{};
    std::vector<std::thread> threads;
    for (size_t t = 0; t < right.size(); ++t) {
        threads.emplace_back([&, t] {
            auto stream = Stream::create(device.gpu());
            auto iota = Kernel::create(device.gpu(), "iota", shaders::iota_comp);
            right[t] = stream && iota;
            for (uint32_t i = 0; i < 20 && right[t]; ++i) {
                auto buffer = stream->make_buffer(40000, "values");
                if (!buffer) return;
                stream->run(*iota, IotaArgs{0, 10000, buffer->address(), i}, 157);
                auto values = stream->download<uint32_t>(*buffer, 10000);
                right[t] = values && *values == numbers(i, 10000);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (bool each : right) CHECK(each);
}

TEST_CASE("a stream keeps its device until its own buffers are gone") {
    TestDevice driver;
    if (!driver) return;
    DeviceOptions options;
    options.name = driver->info().name;
    options.validate = true;
    options.messages = std::make_shared<Messages>();
    Gpu gpu = demand(Device::open(options));
    {
        Stream stream = demand(Stream::create(gpu));
        const uint32_t value = 7;
        {
            const Buffer buffer = demand(stream.make_buffer(4, "value"));
            stream.upload(std::span(&value, 1), buffer);
            CHECK(demand(stream.download<uint32_t>(buffer, 1))[0] == value);
        }
        gpu.reset();
    }
    CHECK(options.messages->list().empty());
}
