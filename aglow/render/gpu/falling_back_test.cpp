// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/testing/demand.h"
#include "aglow/render/testing/stage.h"
#include "aglow/vk/testing/test_device.h"

#include <cmath>

using namespace aglow;
using namespace aglow::render::testing;

namespace {

constexpr int kFrames = 3;
constexpr RaysOptions kOptions{.samples = 1, .reflections = 1};

/// A square that slides over a mirror under a lamp.
Scene sliding_square() {
    Quads quads;
    quads.floor(metal(0.8f, 0.1f), 2);
    quads.floor(diffuse({0.7f, 0.4f, 0.2f}), 0.5f, 0.5f);
    add_point_light(quads.scene, {0.5f, 0.5f, 2}, 1000);
    quads.scene.animations.push_back(
        {"", {{.node = 1, .times = {0, 1}, .values = {0, 0, 0, 1, 0, 0}}}});
    return std::move(quads.scene);
}

/// What a sequence became.
struct Shot {
    std::vector<Image> frames;
    int warnings = 0;
    int submits = 0;
    int allocations = 0;
};

/// Draws the sequence on a device with the faults, and on the CPU from where that fails.
Shot shoot(const Scene& scene, const vk::Faults& faults) {
    const Footage footage{scene, nullptr, kOptions};
    Shot shot;
    vk::DeviceOptions options;
    options.faults = faults;
    const vk::TestDevice device(options);
    const auto on_cpu = [&] { return make_cpu_frame_renderer(footage); };
    const auto warn = [&](const Error& error) {
        CHECK((error.code == Errc::device_lost || error.code == Errc::out_of_memory));
        CHECK_FALSE(error.message.empty());
        ++shot.warnings;
    };
    auto first = make_gpu_frame_renderer(device.gpu(), footage, Accel::grid);
    if (!first) {
        warn(first.error());
        first = on_cpu();
    }
    const auto renderer = make_falling_back(demand(std::move(first)), on_cpu, warn);
    for (int frame = 0; frame < kFrames; ++frame) {
        shot.frames.push_back(
            demand(renderer->draw(frame / 2.0, from_above(3, 1.5f, 12), {})).luminance);
    }
    shot.submits = device->submit_count();
    shot.allocations = device->allocation_count();
    return shot;
}

/// Pixels that are not the same in both but for rounding.
int differing(const Shot& a, const Shot& b) {
    int count = 0;
    for (size_t frame = 0; frame < a.frames.size(); ++frame)
        for (size_t i = 0; i < a.frames[frame].pixels.size(); ++i) {
            const float x = a.frames[frame].pixels[i].x, y = b.frames[frame].pixels[i].x;
            count += std::abs(x - y) > 1e-3f * (1 + x);
        }
    return count;
}

}  // namespace

TEST_CASE("a device lost at any submit, or short of memory at any allocation, costs no frame") {
    if (list_gpus().empty()) {
        MESSAGE("skipped: there is no Vulkan driver");
        return;
    }
    const Scene scene = sliding_square();
    const Shot whole = shoot(scene, {});
    CHECK(whole.warnings == 0);
    REQUIRE(whole.submits > 3);
    REQUIRE(whole.allocations > 3);
    // The first ones, and some of all others.
    const auto next = [](int i) { return i < 4 ? i + 1 : i + 1 + i / 2; };
    for (int i = 0; i < whole.submits; i = next(i)) {
        CAPTURE(i);
        const Shot shot = shoot(scene, {.lose_at_submit = i});
        CHECK(shot.warnings == (shot.submits > i ? 1 : 0));  // a faster run submits less often
        CHECK(differing(shot, whole) <= 2);
    }
    for (int i = 0; i < whole.allocations; i = next(i)) {
        CAPTURE(i);
        const Shot shot = shoot(scene, {.fail_allocation = i});
        CHECK(shot.warnings <= 1);  // staging memory may do with less
        CHECK(differing(shot, whole) <= 2);
    }
}
