// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/stream.h"

#include "aglow/vk/testing/iota.comp.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

#include <numeric>

using namespace aglow;
using namespace aglow::vk;

namespace {

struct IotaArgs {
    uint32_t first_group = 0;
    uint32_t count = 0;
    uint64_t values = 0;
    uint32_t value = 0;
};

Kernel make_iota(const Gpu& gpu) {
    auto kernel = Kernel::create(gpu, "iota", shaders::iota_comp);
    REQUIRE_MESSAGE(kernel, kernel.error().message);
    return std::move(*kernel);
}

std::vector<uint32_t> numbers(uint32_t first, uint64_t count) {
    std::vector<uint32_t> values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

}  // namespace

TEST_CASE("a kernel writes what is read back, however many pieces it takes") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    Kernel iota = make_iota(device.gpu());
    for (uint32_t count : {1u, 63u, 64u, 65u, 1000u, 1u << 20, 65535u * 64 + 1}) {
        CAPTURE(count);
        auto buffer = device->make_buffer(uint64_t{count} * 4, "values");
        REQUIRE(buffer);
        CHECK(buffer->address() % 256 == 0);
        stream.run(iota, IotaArgs{0, count, buffer->address(), 7}, group_count(count, 64));
        auto values = stream.download<uint32_t>(*buffer, count);
        REQUIRE_MESSAGE(values, values.error().message);
        CHECK(*values == numbers(7, count));
    }
}

TEST_CASE("uploads, copies and fills happen in order") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    for (uint64_t count : {1ull, 1000ull, 3ull << 20, (9ull << 20) + 5}) {
        CAPTURE(count);
        std::vector<uint32_t> data = numbers(3, count);
        auto from = make_buffer_of(stream, std::span<const uint32_t>(data), "from");
        REQUIRE(from);
        auto to = device->make_buffer(count * 4, "to");
        REQUIRE(to);
        stream.barrier();
        stream.copy(*from, 0, *to, 0, count * 4);
        stream.barrier();
        stream.fill(*to, 9, 0, 4);
        auto values = stream.download<uint32_t>(*to, count);
        REQUIRE_MESSAGE(values, values.error().message);
        data[0] = 9;
        CHECK(*values == data);
    }
}
