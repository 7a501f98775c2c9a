// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/kernel.h"

#include "aglow/vk/stream.h"
#include "aglow/vk/testing/kernels.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::vk;
using namespace aglow::vk::testing;

TEST_CASE("constants reach the shader") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    Kernel shift = shift_kernel(device.gpu(), 1000);
    std::vector<uint32_t> data = numbers(0, 100);
    const Buffer from = demand(make_buffer_of(stream, std::span<const uint32_t>(data), "from"));
    const Buffer to = demand(stream.make_buffer(400, "to"));
    stream.barrier();
    stream.run(shift, ShiftArgs{0, 100, from.address(), to.address()}, 2);
    const auto values = demand(stream.download<uint32_t>(to, 100));
    CHECK(values == numbers(1000, 100));
}

TEST_CASE("words that are no SPIR-V are an error that names the kernel") {
    TestDevice device;
    if (!device) return;
    const std::array<uint32_t, 6> garbage{1, 2, 3, 4, 5, 6};
    auto kernel = Kernel::create(device.gpu(), "garbage", garbage);
    REQUIRE_FALSE(kernel);
    CHECK(kernel.error().code == Errc::unsupported);
    CHECK(kernel.error().message.find("\"garbage\"") != std::string::npos);
    CHECK_FALSE(Kernel::create(device.gpu(), "nothing", {}));
}

TEST_CASE("groups larger than the device takes are an error") {
    TestDevice device;
    if (!device) return;
    std::vector<uint32_t> spirv(std::begin(shaders::iota_comp), std::end(shaders::iota_comp));
    const std::array<uint32_t, 3> size{64, 1, 1};
    auto declared = std::search(spirv.begin(), spirv.end(), size.begin(), size.end());
    REQUIRE(declared != spirv.end());
    *declared = 1 << 20;
    auto kernel = Kernel::create(device.gpu(), "huge", spirv);
    REQUIRE_FALSE(kernel);
    CHECK(kernel.error().code == Errc::unsupported);
    CHECK(kernel.error().message.find("1048576 invocations") != std::string::npos);
}

TEST_CASE("a kernel that dies while it runs dies after that") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    const Buffer buffer = demand(stream.make_buffer(16 * 64 * 4, "values"));
    {
        Kernel iota = iota_kernel(device.gpu());
        stream.run(iota, IotaArgs{0, 16 * 64, buffer.address(), 1}, 16);
        stream.submit();
    }
    const auto values = demand(stream.download<uint32_t>(buffer, 16 * 64));
    CHECK(values == numbers(1, 16 * 64));
}
