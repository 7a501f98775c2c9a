// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/testing/demand.h"
#include "aglow/vk/device.h"
#include "aglow/vk/instance.h"
#include "aglow/vk/stream.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <memory>
#include <string>

namespace aglow::vk {

/// Keeps the driver and the validation layer loaded until the program ends. Devices open faster so,
/// and the leak sanitizer can see what the driver's global variables still point to.
inline void keep_driver_loaded() {
    static const Instance* const kept = [] {
        auto instance = Instance::create(std::make_shared<Messages>());
        return instance ? instance->release() : nullptr;
    }();
    static_cast<void>(kept);
}

/// The device of a test, with validation and synchronisation validation. When it dies, the test
/// fails if there was any message, or if anything made from the device outlives it.
///
///     TEST_CASE("...") {
///         vk::TestDevice device;
///         if (!device) return;  // there is no Vulkan driver; the test says that it is skipped
///
/// Opens llvmpipe, or what the environment's AGLOW_TEST_GPU names. With AGLOW_REQUIRE_GPU a test
/// fails where there is no device.
class TestDevice {
public:
    explicit TestDevice(DeviceOptions options = {}) : messages_(std::make_shared<Messages>()) {
        keep_driver_loaded();
        const char* named = std::getenv("AGLOW_TEST_GPU");
        if (options.name.empty()) options.name = named ? named : "llvmpipe";
        options.validate = true;
        options.messages = messages_;
        if (list_gpus().empty() && !std::getenv("AGLOW_REQUIRE_GPU")) {
            MESSAGE("skipped: there is no Vulkan driver");
            return;
        }
        gpu_ = demand(Device::open(options));
    }
    TestDevice(const TestDevice&) = delete;
    TestDevice& operator=(const TestDevice&) = delete;
    ~TestDevice() {
        CHECK_MESSAGE(gpu_.use_count() <= 1, "something outlives its device");
        if (gpu_) CHECK(gpu_->bytes_in_use() == 0);
        gpu_.reset();
        for (const std::string& message : messages_->list()) FAIL_CHECK(message);
    }

    explicit operator bool() const { return gpu_ != nullptr; }
    const Gpu& gpu() const { return gpu_; }
    Device* operator->() const { return gpu_.get(); }
    Stream stream() const { return demand(Stream::create(gpu_)); }

private:
    std::shared_ptr<Messages> messages_;
    Gpu gpu_;
};

}  // namespace aglow::vk
