// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/device.h"

#include "aglow/core/testing/demand.h"
#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

using namespace aglow;
using namespace aglow::vk;

namespace {

/// An environment variable for the life of this.
class Environment {
public:
    Environment(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old;
        setenv(name, value, 1);
    }
    ~Environment() {
        if (old_)
            setenv(name_, old_->c_str(), 1);
        else
            unsetenv(name_);
    }

private:
    const char* name_;
    std::optional<std::string> old_;
};

bool contains(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("devices are listed best first, with what they are") {
    keep_driver_loaded();
    std::vector<GpuInfo> gpus = list_gpus();
    for (const GpuInfo& gpu : gpus) {
        CHECK_FALSE(gpu.name.empty());
        CHECK_FALSE(gpu.driver.empty());
        CHECK(gpu.api.substr(0, 2) == "1.");
        CHECK(gpu.memory_bytes > 0);
    }
    CHECK(std::is_sorted(gpus.begin(), gpus.end(), [](const GpuInfo& a, const GpuInfo& b) {
        return std::pair(!a.missing.empty(), a.kind) < std::pair(!b.missing.empty(), b.kind);
    }));
}

TEST_CASE("a device opens by part of its name in any case") {
    keep_driver_loaded();
    std::vector<GpuInfo> gpus = list_gpus();
    if (gpus.empty()) return;
    std::string part = gpus[0].name.substr(1);
    std::transform(part.begin(), part.end(), part.begin(),
                   [](char c) { return static_cast<char>(std::toupper(c)); });
    const Gpu gpu = demand(open_gpu(part));
    CHECK(info(*gpu).name == gpus[0].name);

    const Gpu best = demand(open_gpu());
    CHECK(info(*best).name == gpus[0].name);

    auto none = open_gpu("no such GPU");
    REQUIRE_FALSE(none);
    CHECK(none.error().code == Errc::unsupported);
    CHECK_MESSAGE(contains(none.error().message, gpus[0].name), none.error().message);
}

TEST_CASE("without a driver there is no device and a clear error") {
    keep_driver_loaded();
    Environment icds("VK_ICD_FILENAMES", "/nonexistent.json");
    Environment drivers("VK_DRIVER_FILES", "/nonexistent.json");
    CHECK(list_gpus().empty());
    auto gpu = open_gpu();
    REQUIRE_FALSE(gpu);
    CHECK(gpu.error().code == Errc::unsupported);
    CHECK_MESSAGE(contains(gpu.error().message, "driver"), gpu.error().message);
}

TEST_CASE("validation that is asked for and not installed is an error") {
    keep_driver_loaded();
    Environment layers("VK_LAYER_PATH", "/nonexistent");
    DeviceOptions options;
    options.validate = true;
    auto gpu = Device::open(options);
    REQUIRE_FALSE(gpu);
    CHECK(gpu.error().code == Errc::unsupported);
    CHECK_MESSAGE(contains(gpu.error().message, "validation layer"), gpu.error().message);
}

TEST_CASE("validation hears of what leaks when the device dies") {
    keep_driver_loaded();
    DeviceOptions options;
    options.validate = true;
    options.messages = std::make_shared<Messages>();
    {
        auto gpu = Device::open(options);
        if (!gpu) return;  // "a device opens" says why
        VkSemaphoreCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        VkSemaphore leaked = VK_NULL_HANDLE;
        REQUIRE(vkCreateSemaphore((*gpu)->get(), &info, nullptr, &leaked) == VK_SUCCESS);
        CHECK((*gpu)->messages().empty());
    }
    REQUIRE(options.messages->list().size() == 1);
    CHECK_MESSAGE(contains(options.messages->list()[0], "has not been destroyed"),
                  options.messages->list()[0]);
}

TEST_CASE("validation hears of work that lacks a barrier") {
    keep_driver_loaded();
    DeviceOptions options;
    options.validate = true;
    auto gpu = Device::open(options);
    if (!gpu) return;
    Stream stream = demand(Stream::create(*gpu));
    const Buffer a = demand(stream.make_buffer(64, "a"));
    const Buffer b = demand(stream.make_buffer(64, "b"));
    stream.fill(a, 1, 0, 64);
    stream.copy(a, 0, b, 0, 64);
    CHECK(stream.finish());
    std::vector<std::string> messages = (*gpu)->messages();
    REQUIRE(messages.size() == 1);
    CHECK_MESSAGE(contains(messages[0], "SYNC-HAZARD-READ-AFTER-WRITE"), messages[0]);
    CHECK_MESSAGE(contains(messages[0], "[a]"), messages[0]);
}

TEST_CASE("buffers have their size, an aligned address and a count of bytes") {
    TestDevice device;
    if (!device) return;
    std::vector<Buffer> buffers;
    for (uint64_t bytes : {0ull, 1ull, 4ull, 257ull, 100000ull, 20ull << 20, 40ull << 20}) {
        for (Memory memory : {Memory::device, Memory::upload, Memory::readback}) {
            Buffer buffer = demand(device->make_buffer(bytes, "b", memory));
            CHECK(buffer.size() == std::max<uint64_t>(bytes, 4));
            CHECK(buffer.address() % 256 == 0);
            CHECK((buffer.mapped() == nullptr) == (memory == Memory::device));
            buffers.push_back(std::move(buffer));
        }
    }
    CHECK(device->bytes_in_use() >= 3ull * (60 << 20));
    uint64_t peak = device->peak_bytes();
    CHECK(peak == device->bytes_in_use());
    buffers.clear();
    CHECK(device->bytes_in_use() == 0);
    CHECK(device->peak_bytes() == peak);
}

TEST_CASE("a buffer that no memory can hold is an error that says so") {
    TestDevice device;
    if (!device) return;
    for (int bits : {33, 45, 62}) {
        auto buffer = device->make_buffer(uint64_t{1} << bits, "radiosity of everything");
        REQUIRE_FALSE(buffer);
        CHECK(buffer.error().code == Errc::out_of_memory);
        CHECK(contains(buffer.error().message, "radiosity of everything"));
        CHECK(contains(buffer.error().message, std::to_string(uint64_t{1} << bits)));
    }
}

TEST_CASE("a buffer that grows gets room to spare, and one that is large enough stays") {
    TestDevice device;
    if (!device) return;
    Buffer buffer;
    demand(device->grow(buffer, 1000, "b"));
    CHECK(buffer.size() == 1000);
    const uint64_t address = buffer.address();
    for (uint64_t bytes : {1000ull, 1ull, 0ull}) {
        demand(device->grow(buffer, bytes, "b"));
        CHECK(buffer.address() == address);
        CHECK(buffer.size() == 1000);
    }
    for (uint64_t bytes = 1001; bytes <= 2000; ++bytes) {
        demand(device->grow(buffer, bytes, "b"));
        CHECK(buffer.size() >= bytes);
    }
    CHECK(device->allocation_count() == 5);             // at 1000, 1001, 1252, 1566 and 1958 bytes
    CHECK(device->bytes_in_use() < 2 * buffer.size());  // what it had before has gone back
    Buffer nothing;
    demand(device->grow(nothing, 0, "nothing"));
    CHECK(nothing.address() != 0);
}

TEST_CASE("a buffer that cannot grow is empty, and grows once there is memory") {
    for (int n : {0, 1}) {
        CAPTURE(n);
        DeviceOptions options;
        options.faults.fail_allocation = n;
        TestDevice device(options);
        if (!device) return;
        Buffer buffer;
        if (n == 1) demand(device->grow(buffer, 100, "b"));
        const Status grown = device->grow(buffer, 200, "b");
        REQUIRE_FALSE(grown);
        CHECK(grown.error().code == Errc::out_of_memory);
        CHECK(buffer.address() == 0);
        CHECK(buffer.size() == 0);
        CHECK(device->bytes_in_use() == 0);
        demand(device->grow(buffer, 200, "b"));
        CHECK(buffer.size() == 200);
    }
}

TEST_CASE("a buffer that dies while the device works on it dies after that") {
    TestDevice device;
    if (!device) return;
    Stream stream = device.stream();
    const Buffer kept = demand(stream.make_buffer(32 << 20, "kept"));
    {
        const Buffer brief = demand(stream.make_buffer(32 << 20, "brief"));
        stream.fill(brief, 5, 0, 32 << 20);
        stream.barrier();
        stream.copy(brief, 0, kept, 0, 32 << 20);
        stream.submit();
    }
    const auto last = demand(stream.download<uint32_t>(kept, 1, (8 << 20) - 1));
    CHECK(last.front() == 5);
}
