// SPDX-License-Identifier: Apache-2.0
#include "devices.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::cli;

TEST_CASE("the CPU is no GPU, and auto never takes a software device") {
    auto cpu = choose_device("cpu");
    REQUIRE(cpu);
    CHECK_FALSE(cpu->has_value());
    auto automatic = choose_device("auto");
    REQUIRE_MESSAGE(automatic, automatic.error().message);
    if (*automatic) CHECK(info(***automatic).kind != GpuKind::software);
}

TEST_CASE("gpu is the best there is, and gpu:NAME goes by part of the name") {
    const std::vector<GpuInfo> gpus = list_gpus();
    auto best = choose_device("gpu");
    if (gpus.empty()) {
        REQUIRE_FALSE(best);
        CHECK(best.error().code == Errc::unsupported);
        return;
    }
    REQUIRE_MESSAGE(best, best.error().message);
    CHECK(info(***best).name == gpus[0].name);
    auto named = choose_device("gpu:" + gpus.back().name.substr(0, 5));
    REQUIRE_MESSAGE(named, named.error().message);
    auto unknown = choose_device("gpu:no such device");
    REQUIRE_FALSE(unknown);
    CHECK(unknown.error().code == Errc::unsupported);
    CHECK(unknown.error().message.find(gpus[0].name) != std::string::npos);
}

TEST_CASE("the list begins with the CPU and names all GPUs as --device does") {
    const std::vector<GpuInfo> gpus = list_gpus();
    const Json list = device_list(3);
    REQUIRE(list.size() == gpus.size() + 1);
    CHECK(list[0]["name"] == "cpu");
    CHECK(list[0]["threads"] == 3);
    for (size_t i = 0; i < gpus.size(); ++i) {
        CHECK(list[i + 1]["name"] == "gpu:" + gpus[i].name);
        CHECK(list[i + 1]["memory_bytes"] == gpus[i].memory_bytes);
        CHECK(list[i + 1].contains("missing") == !gpus[i].missing.empty());
    }
}
