// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/math.h"
#include "aglow/vk/device.h"
#include "aglow/vk/graphics_pipeline.h"
#include "aglow/vk/render_target.h"
#include "aglow/vk/stream.h"
#include "aglow/vk/testing/drawn.frag.h"
#include "aglow/vk/testing/drawn.mesh.h"
#include "aglow/vk/testing/drawn.vert.h"
#include "aglow/vk/testing/kernels.h"
#include "aglow/vk/testing/patch.tesc.h"
#include "aglow/vk/testing/patch.tese.h"
#include "aglow/vk/testing/test_device.h"
#include "aglow/vk/testing/twice.geom.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

using namespace aglow;
using namespace aglow::vk;
using namespace aglow::vk::testing;

namespace {

using Color = std::array<float, 4>;
using Corner = std::array<float, 4>;  // x, y, depth, brightness

/// Push constants of drawn.vert and drawn.frag.
struct DrawnArgs {
    uint64_t corners = 0;
    Color color{1, 1, 1, 1};
    std::array<float, 2> step{};
};

/// Push constants of drawn.mesh and drawn.frag.
struct DrawnGroupsArgs {
    uint32_t first_group = 0, count = 0;
    Color color{1, 1, 1, 1};
    std::array<float, 2> step{};
    uint64_t corners = 0;
};

constexpr uint32_t kSize = 64;
const Color kRed{1, 0, 0, 1}, kGreen{0, 1, 0, 1}, kBlack{0, 0, 0, 1};

/// The half of the picture below the diagonal from its top left, counter-clockwise.
std::vector<Corner> lower_left(float depth = 0.5f) {
    return {{-1, 1, depth, 1}, {-1, -1, depth, 1}, {1, -1, depth, 1}};
}

std::vector<Corner> whole(float depth = 0.5f, float brightness = 1) {
    return {{-1, 1, depth, brightness}, {-1, -1, depth, brightness}, {1, -1, depth, brightness},
            {-1, 1, depth, brightness}, {1, -1, depth, brightness},  {1, 1, depth, brightness}};
}

GraphicsShaders shaders_of(bool fragments = true) {
    GraphicsShaders set;
    set.vertex = shaders::drawn_vert;
    if (fragments) set.fragment = shaders::drawn_frag;
    return set;
}

/// A picture of 32-bit colours; failures end the test.
struct Easel {
    explicit Easel(const TestDevice& device, uint32_t samples = 1)
        : gpu(device.gpu()), stream(device.stream()), target(must(make_target(gpu, samples))) {}

    template <class T>
    static T must(Result<T> result) {
        REQUIRE_MESSAGE(result, result.error().message);
        return std::move(*result);
    }
    static Result<RenderTarget> make_target(const Gpu& gpu, uint32_t samples) {
        TargetFormat format{VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_D32_SFLOAT, samples};
        return RenderTarget::create(gpu, kSize, kSize, format, "easel");
    }
    GraphicsPipeline pipeline(GraphicsState state = {}, const GraphicsShaders& set = shaders_of()) {
        state.target = target.format();
        return must(GraphicsPipeline::create(gpu, "drawn", set, state));
    }
    uint64_t corners(const std::vector<Corner>& values) {
        kept.push_back(must(make_buffer_of(stream, std::span(values), "corners")));
        stream.barrier();
        return kept.back().address();
    }
    std::vector<Color> read() {
        Buffer pixels = must(stream.make_buffer(target.row_bytes() * kSize, "picture"));
        stream.read(target, pixels);
        return must(stream.download<Color>(pixels, kSize * kSize));
    }

    Gpu gpu;
    Stream stream;
    RenderTarget target;
    std::vector<Buffer> kept;
};

uint32_t count_of(const std::vector<Color>& pixels, const Color& color) {
    return static_cast<uint32_t>(std::count(pixels.begin(), pixels.end(), color));
}

}  // namespace

TEST_CASE("a triangle covers the pixels whose middle it covers, and y points up") {
    TestDevice device;
    if (!device) return;
    Easel easel(device);
    GraphicsPipeline pipeline = easel.pipeline();
    const uint64_t corners = easel.corners(lower_left());
    easel.stream.clear(easel.target, kBlack);
    easel.stream.draw(pipeline, easel.target, DrawnArgs{corners, kRed}, {0, 3});
    const std::vector<Color> pixels = easel.read();
    bool right = true;
    for (uint32_t y = 0; y < kSize; ++y) {
        for (uint32_t x = 0; x < kSize; ++x) {
            if (x == y) continue;  // its edge runs through their middles
            right &= pixels[y * kSize + x] == (x < y ? kRed : kBlack);
        }
    }
    CHECK(right);
}

TEST_CASE("with four samples a pixel that an edge divides is the mean of both sides") {
    TestDevice device;
    if (!device) return;
    Easel easel(device, 4);
    GraphicsPipeline pipeline = easel.pipeline();
    const uint64_t corners = easel.corners(lower_left());
    easel.stream.clear(easel.target, kBlack);
    easel.stream.draw(pipeline, easel.target, DrawnArgs{corners, {100, 0, 0, 1}}, {0, 3});
    const std::vector<Color> pixels = easel.read();
    float sum = 0;
    for (const Color& pixel : pixels) sum += pixel[0];
    CHECK(sum == doctest::Approx(100 * kSize * kSize / 2.0).epsilon(0.001));
    CHECK(pixels[10 * kSize + 10][0] == 50);
    CHECK(pixels[10 * kSize + 11][0] == 0);
    CHECK(pixels[11 * kSize + 10][0] == 100);
}

TEST_CASE("what is nearer is seen, whatever is drawn first, and across submits") {
    TestDevice device;
    if (!device) return;
    for (bool near_first : {false, true}) {
        for (bool submit : {false, true}) {
            CAPTURE(near_first);
            CAPTURE(submit);
            Easel easel(device, 4);
            GraphicsPipeline pipeline = easel.pipeline();
            const uint64_t near = easel.corners(lower_left(0.75f));
            const uint64_t far = easel.corners(whole(0.25f));
            easel.stream.clear(easel.target, kBlack);
            for (bool near_now : {near_first, !near_first}) {
                DrawnArgs args{near_now ? near : far, near_now ? kRed : kGreen};
                easel.stream.draw(pipeline, easel.target, args, {0, near_now ? 3u : 6u});
                if (submit) easel.stream.submit();
            }
            const std::vector<Color> pixels = easel.read();
            CHECK(count_of(pixels, kRed) == kSize * (kSize - 1) / 2);
            CHECK(count_of(pixels, kGreen) == kSize * (kSize - 1) / 2);
        }
    }
}

TEST_CASE("back faces are left out where that is asked for") {
    TestDevice device;
    if (!device) return;
    Easel easel(device);
    GraphicsState state;
    state.cull = VK_CULL_MODE_BACK_BIT;
    GraphicsPipeline pipeline = easel.pipeline(state);
    std::vector<Corner> corners = whole();
    std::swap(corners[1], corners[2]);  // the first turns its back
    const uint64_t address = easel.corners(corners);
    easel.stream.clear(easel.target, kBlack);
    easel.stream.draw(pipeline, easel.target, DrawnArgs{address, kRed}, {0, 6});
    const std::vector<Color> pixels = easel.read();
    CHECK(pixels[kSize - 1] == kRed);
    CHECK(pixels[(kSize - 1) * kSize] == kBlack);
}

TEST_CASE("blended colours cover in their order what lies behind, and leave its depth") {
    TestDevice device;
    if (!device) return;
    Easel easel(device, 4);
    GraphicsState state;
    GraphicsPipeline opaque = easel.pipeline(state);
    state.blend = Blend::over;
    state.write_depth = false;
    GraphicsPipeline glass = easel.pipeline(state);
    const uint64_t back = easel.corners(whole(0.2f)), front = easel.corners(whole(0.6f));
    const uint64_t hidden = easel.corners(whole(0.1f));
    easel.stream.clear(easel.target, kBlack);
    easel.stream.draw(opaque, easel.target, DrawnArgs{back, {8, 0, 0, 1}}, {0, 6});
    easel.stream.draw(glass, easel.target, DrawnArgs{front, {0, 2, 0, 0.5f}}, {0, 6});
    easel.stream.draw(glass, easel.target, DrawnArgs{front, {0, 0, 1, 0.25f}}, {0, 6});
    easel.stream.draw(glass, easel.target, DrawnArgs{hidden, {9, 9, 9, 1}}, {0, 6});
    // ((8, 0, 0) / 2 + (0, 2, 0)) * 3/4 + (0, 0, 1)
    CHECK(count_of(easel.read(), {3, 1.5f, 1, 1}) == kSize * kSize);
}

TEST_CASE("instances and indices reach the shader, however a draw is cut") {
    TestDevice device;
    if (!device) return;
    Easel easel(device);
    GraphicsPipeline pipeline = easel.pipeline();
    const float w = 2.0f / kSize;  // of a pixel
    // One row of pixels, two triangles each: an instance. Each row is one instance further down.
    std::vector<Corner> row;
    std::vector<uint32_t> indices;
    for (uint32_t x = 0; x < kSize; ++x) {
        const float left = -1 + w * static_cast<float>(x), value = static_cast<float>(x + 1);
        const uint32_t first = 4 * x;
        for (const auto& [dx, dy] : {std::array{0.f, 0.f}, {w, 0.f}, {w, w}, {0.f, w}})
            row.push_back({left + dx, 1 - w + dy, 0.5f, value});
        for (uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + corner);
    }
    const uint64_t corners = easel.corners(row);
    Buffer index_buffer =
        Easel::must(make_buffer_of(easel.stream, std::span<const uint32_t>(indices), "indices"));
    easel.stream.barrier();
    for (int round = 0; round < 3; ++round) {  // pieces grow as the speed becomes known
        easel.stream.clear(easel.target, kBlack);
        Draw draw{6, 6 * (kSize - 1), 0, kSize, &index_buffer};  // but for the first pixel
        easel.stream.draw(pipeline, easel.target, DrawnArgs{corners, kRed, {0, -w}}, draw);
        const std::vector<Color> pixels = easel.read();
        bool right = true;
        for (uint32_t i = 0; i < kSize * kSize; ++i) {
            const float expected = i % kSize == 0 ? 0 : static_cast<float>(i % kSize + 1);
            right &= pixels[i][0] == expected;
        }
        CHECK(right);
    }
    CHECK(device->submit_count() >= 5);  // three downloads, and a draw of unknown cost is cut
}

TEST_CASE("what a kernel writes is drawn, and what is drawn is timed under its label") {
    TestDevice device;
    if (!device) return;
    Easel easel(device);
    Kernel shift = shift_kernel(easel.gpu);
    GraphicsPipeline pipeline = easel.pipeline();
    const std::vector<Corner> corners = whole();
    const uint64_t from = easel.corners(corners);
    const uint32_t words = 4 * static_cast<uint32_t>(corners.size());
    Buffer to = Easel::must(easel.stream.make_buffer(words * 4, "copied"));
    {
        Stream::Scope scope(easel.stream, "frame");
        easel.stream.clear(easel.target, kBlack);
        easel.stream.run(shift, ShiftArgs{0, words, from, to.address()}, 1);
        easel.stream.barrier();
        easel.stream.draw(pipeline, easel.target, DrawnArgs{to.address(), kGreen}, {0, 6});
        easel.stream.barrier();
        easel.stream.fill(to, 0, 0, words * 4);
    }
    CHECK(count_of(easel.read(), kGreen) == kSize * kSize);
    std::vector<std::string> kernels;
    for (const Timing& timing : easel.stream.take_timings())
        if (timing.label == "frame") kernels.push_back(timing.kernel);
    CHECK(kernels == std::vector<std::string>{"clear", "shift", "drawn", "fill"});
}

TEST_CASE("constants reach shaders that draw") {
    TestDevice device;
    if (!device) return;
    Easel easel(device);
    const std::array<uint32_t, 1> gain{7};
    GraphicsState state;
    state.constants = gain;
    GraphicsPipeline pipeline = easel.pipeline(state);
    const uint64_t corners = easel.corners(whole());
    easel.stream.clear(easel.target, kBlack);
    easel.stream.draw(pipeline, easel.target, DrawnArgs{corners, {1, 0, 0, 0}}, {0, 6});
    CHECK(count_of(easel.read(), {7, 0, 0, 0}) == kSize * kSize);
}

TEST_CASE("a tessellated triangle covers what it covered whole") {
    TestDevice device;
    if (!device || !device->physical().drawing.tessellation_shader) return;
    Easel easel(device, 4);
    GraphicsShaders set = shaders_of();
    set.tessellation_control = shaders::patch_tesc;
    set.tessellation_evaluation = shaders::patch_tese;
    GraphicsState state;
    state.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
    GraphicsPipeline patches = easel.pipeline(state, set), triangles = easel.pipeline();
    const uint64_t corners = easel.corners(lower_left());
    std::array<std::vector<Color>, 2> pictures;
    for (size_t i = 0; i < 2; ++i) {
        easel.stream.clear(easel.target, kBlack);
        easel.stream.draw(i ? patches : triangles, easel.target, DrawnArgs{corners, kRed}, {0, 3});
        pictures[i] = easel.read();
    }
    CHECK(pictures[0] == pictures[1]);
}

TEST_CASE("groups of a mesh shader draw what vertices would, however the draw is cut") {
    TestDevice device;
    if (!device) return;
    if (!device->physical().drawing.mesh_shader) {
        MESSAGE("skipped: the GPU has no mesh shaders");
        return;
    }
    Easel easel(device, 4);
    GraphicsShaders groups;
    groups.mesh = shaders::drawn_mesh;
    groups.fragment = shaders::drawn_frag;
    GraphicsPipeline by_groups = easel.pipeline({}, groups), by_vertices = easel.pipeline();
    const std::vector<Corner> corners{{-1, -0.96f, 0.5f, 1}, {-1, -1, 0.5f, 1},
                                      {-0.9f, -1, 0.5f, 1},  {-0.9f, 0.2f, 0.25f, 2},
                                      {-1, 0, 0.25f, 2},     {-0.9f, 0, 0.25f, 2}};
    const uint64_t address = easel.corners(corners);
    const std::array<float, 2> step{1.8f / 40000, 0.7f / 40000};
    const int before = device->submit_count();
    std::array<std::vector<Color>, 2> pictures;
    easel.stream.clear(easel.target, kBlack);
    easel.stream.draw(by_vertices, easel.target, DrawnArgs{address, kRed, step}, {0, 6, 0, 40000});
    pictures[0] = easel.read();
    easel.stream.clear(easel.target, kBlack);
    easel.stream.draw_groups(by_groups, easel.target, DrawnGroupsArgs{0, 2, kRed, step, address},
                             80000);
    pictures[1] = easel.read();
    CHECK(pictures[0] == pictures[1]);
    CHECK(count_of(pictures[1], {2, 0, 0, 2}) > 100);
    CHECK(device->submit_count() > before + 2);
}

TEST_CASE("captured vertices arrive in the order of their primitives, however a draw is cut") {
    TestDevice device;
    if (!device || !device->physical().drawing.transform_feedback) return;
    Stream stream = device.stream();
    GraphicsShaders set = shaders_of(false);
    set.geometry = shaders::twice_geom;
    GraphicsPipeline pipeline =
        Easel::must(GraphicsPipeline::create(device.gpu(), "twice", set, GraphicsState{}));
    const uint32_t triangles = 5000;
    std::vector<Corner> corners;
    for (uint32_t i = 0; i < 3 * triangles; ++i)
        corners.push_back({0, 0.25f, 0, static_cast<float>(i)});
    Buffer from = Easel::must(make_buffer_of(stream, std::span<const Corner>(corners), "corners"));
    Buffer to = Easel::must(stream.make_buffer(triangles * 96 + 16, "captured"));
    stream.fill(to, 0, 0, to.size());
    stream.barrier();
    stream.capture(pipeline, DrawnArgs{from.address()}, {0, 3 * triangles}, {to, 16, 96});
    const auto captured = stream.download<Corner>(to, 6 * triangles, 1);
    REQUIRE_MESSAGE(captured, captured.error().message);
    bool right = true;
    for (uint32_t i = 0; i < 6 * triangles; ++i) {
        const uint32_t triangle = i / 6, copy = i % 6 / 3, corner = i % 3;
        const float value = static_cast<float>((3 * triangle + corner) * (copy + 1));
        right &= (*captured)[i] == Corner{0, 0.25f, 0, value};
    }
    CHECK(right);
    CHECK(device->submit_count() > 2);  // one of them the download
}

TEST_CASE("a device that only computes says so when it is to draw") {
    DeviceOptions options;
    options.drawing = false;
    TestDevice device(options);
    if (!device) return;
    auto target = Easel::make_target(device.gpu(), 1);
    REQUIRE_FALSE(target);
    CHECK(target.error().code == Errc::unsupported);
    CHECK(target.error().message.find("cannot draw") != std::string::npos);
    auto pipeline = GraphicsPipeline::create(device.gpu(), "drawn", shaders_of(), {});
    REQUIRE_FALSE(pipeline);
    CHECK(pipeline.error().code == Errc::unsupported);
}

TEST_CASE("targets that a device does not offer are errors that name the image") {
    TestDevice device;
    if (!device) return;
    TargetFormat format{VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_D32_SFLOAT, 1};
    auto large = RenderTarget::create(device.gpu(), 1 << 20, 1, format, "wall");
    REQUIRE_FALSE(large);
    CHECK(large.error().code == Errc::unsupported);
    CHECK_MESSAGE(large.error().message.find("image \"wall colours\" has 1048576 x 1") == 0,
                  large.error().message);
    format.samples = 64;
    auto fine = RenderTarget::create(device.gpu(), 4, 4, format, "wall");
    REQUIRE_FALSE(fine);
    CHECK(fine.error().code == Errc::unsupported);
    const TargetFormat offered = hdr_format(*device.operator->(), 64);
    CHECK(RenderTarget::create(device.gpu(), 4, 4, offered, "wall"));
}

namespace {

Status draw_something(const Gpu& gpu) {
    AG_TRY(Stream stream, Stream::create(gpu));
    AG_TRY(RenderTarget target, Easel::make_target(gpu, 4));
    GraphicsState state;
    state.target = target.format();
    AG_TRY(GraphicsPipeline pipeline, GraphicsPipeline::create(gpu, "drawn", shaders_of(), state));
    std::vector<Corner> corners = whole();
    Stream::Scope scope(stream, "a picture");
    AG_TRY(Buffer buffer, make_buffer_of(stream, std::span<const Corner>(corners), "corners"));
    stream.barrier();
    stream.clear(target, kBlack);
    stream.draw(pipeline, target, DrawnArgs{buffer.address(), kRed}, {0, 6});
    AG_TRY(Buffer pixels, stream.make_buffer(target.row_bytes() * kSize, "picture"));
    stream.read(target, pixels);
    AG_TRY(std::vector<Color> colors, stream.download<Color>(pixels, kSize * kSize));
    CHECK(count_of(colors, kRed) == kSize * kSize);
    return {};
}

}  // namespace

TEST_CASE("drawing without memory or with a lost device is an error, and nothing leaks") {
    int allocations = 0, submits = 0;
    {
        TestDevice device;
        if (!device) return;
        REQUIRE(draw_something(device.gpu()));
        allocations = device->allocation_count();
        submits = device->submit_count();
    }
    REQUIRE(allocations == 7);  // three images, corners, picture, staging for both ways
    for (int n = 0; n < allocations + submits; ++n) {
        CAPTURE(n);
        const bool memory = n < allocations;
        DeviceOptions options;
        (memory ? options.faults.fail_allocation : options.faults.lose_at_submit) =
            memory ? n : n - allocations;
        TestDevice device(options);
        Status status = draw_something(device.gpu());
        REQUIRE_FALSE(status);
        CHECK(status.error().code == (memory ? Errc::out_of_memory : Errc::device_lost));
        CHECK(device->bytes_in_use() == 0);
    }
}
