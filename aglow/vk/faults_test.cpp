// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/device.h"
#include "aglow/vk/testing/kernels.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::vk;
using namespace aglow::vk::testing;

namespace {

/// Counts from 1 on the device in several submits; takes every way there is to move data.
Status count_up(const Gpu& gpu) {
    const uint32_t count = 100000;
    AG_TRY(Stream stream, Stream::create(gpu));
    AG_TRY(Kernel iota, Kernel::create(gpu, "iota", shaders::iota_comp));
    AG_TRY(Kernel shift, Kernel::create(gpu, "shift", shaders::shift_comp, std::array{1u}));
    AG_TRY(Buffer a, stream.make_buffer(count * 4, "a"));
    Stream::Scope scope(stream, "counting");
    stream.run(iota, IotaArgs{0, count, a.address(), 0}, group_count(count, 64));
    Buffer b;
    AG_CHECK(gpu->grow(b, 100, "b"));
    AG_CHECK(gpu->grow(b, count * 4, "b"));
    stream.fill(b, 0, 0, count * 4);
    stream.barrier();
    stream.run(shift, ShiftArgs{0, count, a.address(), b.address()}, group_count(count, 64));
    stream.barrier();
    AG_CHECK(stream.finish());
    std::vector<uint32_t> tail = numbers(7, 50);
    AG_TRY(Buffer c, make_buffer_of(stream, std::span<const uint32_t>(tail), "c"));
    stream.barrier();
    stream.copy(c, 0, b, (count - 50) * 4, 200);
    AG_TRY(std::vector<uint32_t> values, stream.download<uint32_t>(b, count));
    std::vector<uint32_t> expected = numbers(1, count);
    std::copy(tail.begin(), tail.end(), expected.end() - 50);
    CHECK(values == expected);
    return {};
}

}  // namespace

TEST_CASE("memory that cannot be had is an error, whichever buffer it is, and nothing leaks") {
    int allocations = 0;
    {
        TestDevice device;
        if (!device) return;
        REQUIRE(count_up(device.gpu()));
        allocations = device->allocation_count();
    }
    REQUIRE(allocations == 6);  // a, b twice, c, staging for uploads and for downloads
    for (int n = 0; n < allocations; ++n) {
        CAPTURE(n);
        DeviceOptions options;
        options.faults.fail_allocation = n;
        TestDevice device(options);  // checks for leaks and messages when it dies
        Status status = count_up(device.gpu());
        REQUIRE_FALSE(status);
        CHECK(status.error().code == Errc::out_of_memory);
        CHECK_MESSAGE(status.error().message.find("buffer \"") == 0, status.error().message);
        CHECK(device->bytes_in_use() == 0);
        CHECK(count_up(device.gpu()));  // once there is memory again
    }
}

TEST_CASE("a device that is lost is an error, whichever submit it is, and stays lost") {
    int submits = 0;
    {
        TestDevice device;
        if (!device) return;
        REQUIRE(count_up(device.gpu()));
        submits = device->submit_count();
    }
    REQUIRE(submits > 5);
    for (int n = 0; n < submits; ++n) {
        CAPTURE(n);
        DeviceOptions options;
        options.faults.lose_at_submit = n;
        TestDevice device(options);
        Status status = count_up(device.gpu());
        // Slow work is cut into more submits, so a run can end before the last one of another.
        REQUIRE(status.has_value() == (device->submit_count() <= n));
        if (status) continue;
        CHECK(status.error().code == Errc::device_lost);
        CHECK_MESSAGE(status.error().message.find("of counting") != std::string::npos,
                      status.error().message);
        CHECK(device->bytes_in_use() == 0);
        status = count_up(device.gpu());
        REQUIRE_FALSE(status);
        CHECK(status.error().code == Errc::device_lost);
        CHECK(device->submit_count() == n + 2);
    }
}
