// SPDX-License-Identifier: Apache-2.0
// Pictures drawn on a GPU against those of the CPU renderer, pixel by pixel.
#include "aglow/core/testing/demand.h"
#include "aglow/core/testing/scenes.h"
#include "aglow/render/compare.h"
#include "aglow/render/testing/stage.h"
#include "aglow/scene/builtin.h"
#include "aglow/scene/load.h"
#include "aglow/scene/photometry.h"
#include "aglow/vk/testing/test_device.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <regex>
#include <string>

using namespace aglow;
using namespace aglow::render::testing;

namespace {

constexpr Accel kAccels[] = {Accel::grid, Accel::grid2, Accel::bvh};

/// Both renderers of the same footage.
struct Pair {
    std::unique_ptr<FrameRenderer> gpu, cpu;

    Pair(const Gpu& device, const Footage& footage, Accel accel)
        : gpu(demand(make_gpu_frame_renderer(device, footage, accel))),
          cpu(demand(make_cpu_frame_renderer(footage))) {}

    /// Relative RMSE between their pictures, which must hold something. They must be of as many
    /// rays of each kind, but for one in a thousand where silhouettes tell the pictures apart.
    double difference_at(double time, const View& view) const {
        const auto drawn = demand(gpu->draw(time, view, {}));
        const auto wanted = demand(cpu->draw(time, view, {}));
        const Difference d = difference(drawn.luminance, wanted.luminance).value();
        CHECK(d.count == drawn.luminance.pixels.size());
        CHECK(d.non_finite == 0);
        compare(drawn.rays, wanted.rays, d.relative_rmse < kSame ? 0 : 1e-3);
        return d.relative_rmse;
    }

private:
    static constexpr double kSame = 1e-5;  // relative RMSE of pictures but for rounding

    static void compare(const RayTally& drawn, const RayTally& wanted, double tolerance) {
        CHECK(drawn.camera == wanted.camera);
        const auto close = [&](uint64_t a, uint64_t b) {
            const auto most = static_cast<double>(std::max(a, b));
            return static_cast<double>(a > b ? a - b : b - a) <= tolerance * most;
        };
        CHECK_MESSAGE(close(drawn.mirror, wanted.mirror), drawn.mirror << " " << wanted.mirror);
        CHECK_MESSAGE(close(drawn.shadow, wanted.shadow), drawn.shadow << " " << wanted.shadow);
    }
};

View view_of(const Scene& scene, double time, int width, int height) {
    const Surfaces surfaces = pose(scene, time);
    const RayScene rays = RayScene::create(scene, surfaces).value();
    return choose_view(scene, surfaces, rays, "auto", width, height, time).value();
}

TextureImage image_of(int size, auto&& rgba) {
    TextureImage image;
    image.width = image.height = size;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (const int v : rgba(x, y)) image.rgba.push_back(static_cast<uint8_t>(v));
    return image;
}

/// A scene with something of all that shaders read: textures of each wrap mode, masked, blended,
/// unlit, emissive, rough and mirroring materials, and a card that moves through it.
struct Everything {
    Quads quads;

    Everything() {
        Scene& scene = quads.scene;
        scene.images = {
            image_of(64,
                     [](int x, int y) {
                         const int on = (x / 8 + y / 8) % 2;
                         return std::array{40 + 200 * on, 200 - 2 * x, 3 * y, 255};
                     }),
            image_of(16,
                     [](int x, int y) {
                         return std::array{255, 16 * x, 255 - 12 * y, (x + y) % 3 == 0 ? 0 : 255};
                     }),
            image_of(5, [](int x, int y) {
                return std::array{50 * x, 60 * y, 200, 255};
            })};
        scene.textures = {{0, Wrap::repeat, Wrap::mirrored_repeat, Filter::linear},
                          {1, Wrap::clamp_to_edge, Wrap::repeat, Filter::nearest},
                          {2, Wrap::mirrored_repeat, Wrap::clamp_to_edge, Filter::linear}};
        Material floor = diffuse({1, 1, 1});
        floor.base_color_texture = {0, 0, {0.1f, 0.2f}, {3, 5}, 0.4f};
        floor.roughness = 0.25f;
        textured(quads.floor(floor, 3));
        Material wall = metal(0.9f, 0.05f);
        textured(quads.add(wall, {-3, 3, 0}, {3, 3, 0}, {3, 3, 3}, {-3, 3, 3}));
        Material mask = diffuse({0.9f, 0.8f, 0.7f});
        mask.base_color_texture.texture = 1;
        mask.alpha_mode = AlphaMode::mask;
        mask.metallic_roughness_texture.texture = 2;
        textured(card(mask, -1.6f));
        Material glass = diffuse({0.2f, 0.7f, 0.9f});
        glass.base_color.w = 0.4f;
        glass.alpha_mode = AlphaMode::blend;
        card(glass, -0.5f);
        card(unlit({0.5f, 0.3f, 0.1f}), 0.6f);
        Material lamp = diffuse({0.1f, 0.1f, 0.1f});
        lamp.emission = {300, 250, 200};
        lamp.emissive_texture.texture = 2;
        lamp.double_sided = true;
        textured(card(lamp, 1.7f));
        moving_ = card(metal(0.6f, 0.4f), 0.1f);
        quads.scene.nodes[static_cast<size_t>(moving_)].translation = {0, -0.3f, 0};
        for (Mesh& mesh : scene.meshes) mesh.primitives[0].colors.assign(4, vec4{1, 1, 0.9f, 0.8f});
        move();
        add_lights();
    }

    View view() const {
        // From (0, -4, 2), looking along +y and down by atan(1/3).
        View view;
        const float c = 3 / std::sqrt(10.0f), s = 1 / std::sqrt(10.0f);
        view.to_world.m = {1, 0, 0, 0, 0, s, c, 0, 0, -c, s, 0, 0, -4, 2, 1};
        view.half_width = 0.8f;
        view.half_height = 0.5f;
        view.width = 80;
        view.height = 50;
        return view;
    }

private:
    int card(const Material& material, float x) {
        return quads.add(material, {x - 0.4f, 0.5f, 0.1f}, {x + 0.4f, 0.5f, 0.1f},
                         {x + 0.4f, 0.8f, 1}, {x - 0.4f, 0.8f, 1});
    }
    void textured(int node) {
        quads.scene.meshes[static_cast<size_t>(node)].primitives[0].texcoords = {
            {{0, 0}, {1.3f, 0}, {1.3f, 1.7f}, {0, 1.7f}}};
    }
    void move() {
        AnimationChannel channel;
        channel.node = moving_;
        channel.times = {0, 1};
        channel.values = {0, -0.5f, 0, 0.4f, -1, 0.5f};
        quads.scene.animations.push_back({"", {channel}});
    }
    void add_lights() {
        Scene& scene = quads.scene;
        add_point_light(scene, {1, -1, 2}, 900);
        auto photometry = std::make_shared<Photometry>();
        photometry->gamma = {0, 30, 60, 90};
        photometry->c = {0, 90, 180, 270, 360};
        for (int i = 0; i < 20; ++i)
            photometry->candela.push_back(static_cast<float>(20 + 13 * (i * 7 % 11)));
        add_luminaire(scene, {-1, 0, 3}, photometry);
        add_sun(scene, 30, 50, 80);
        Light spot;
        spot.kind = LightKind::spot;
        spot.intensity = {60, 90, 120};
        spot.inner_cone = 0.2f;
        spot.outer_cone = 0.5f;
        scene.lights.push_back(spot);
        Node node;
        node.light = static_cast<int>(scene.lights.size()) - 1;
        node.translation = {0, -0.5f, 3};
        scene.nodes.push_back(node);
        auto sky = std::make_shared<Image>(16, 8);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 16; ++x)
                sky->at(x, y) = vec3{1, 1.5f, 2} * static_cast<float>(1 + (3 * x + 5 * y) % 13);
        scene.sky = Sky{{2, 2, 2}, sky};
    }

    int moving_ = -1;
};

}  // namespace

TEST_CASE("a GPU and the CPU draw the same picture of everything that shaders read") {
    vk::TestDevice device;
    if (!device) return;
    const Everything scene;
    Lit lit = scene.quads.lit(8, {120, 100, 80});
    for (size_t i = 0; i < lit.irradiance.pixels.size(); ++i)
        lit.irradiance.pixels[i] *= 1 + static_cast<float>(i % 7) / 7;
    struct Case {
        Accel accel;
        const Lit* lit;
        int reflections;
        Shading shading;
    };
    for (const Case& c : {Case{Accel::grid, nullptr, 2, Shading::phong},
                          Case{Accel::grid2, &lit, 0, Shading::metallic_roughness},
                          Case{Accel::bvh, &lit, 3, Shading::phong},
                          Case{Accel::bvh, nullptr, 1, Shading::metallic_roughness}}) {
        CAPTURE(std::string(name(c.accel)));
        CAPTURE(c.lit != nullptr);
        const Pair pair(
            device.gpu(),
            {scene.quads.scene,
             c.lit,
             {.samples = 4, .reflections = c.reflections, .shading = c.shading, .seed = 3}},
            c.accel);
        for (const double time : {0.0, 0.7, -1.0})
            CHECK(pair.difference_at(time, scene.view()) < 0.01);
    }
}

TEST_CASE("a GPU and the CPU draw the same rooms") {
    vk::TestDevice device;
    if (!device) return;
    for (const char* name : {"cornell-box", "corridor", "living-room"}) {
        CAPTURE(name);
        const Scene scene = builtin_scene(name).value();
        const Pair pair(device.gpu(), {scene, nullptr, {.samples = 2}}, Accel::automatic);
        CHECK(pair.difference_at(-1, view_of(scene, -1, 96, 60)) < 0.01);
    }
}

TEST_CASE("a GPU and the CPU draw the same of models in motion") {
    vk::TestDevice device;
    if (!device) return;
    const auto folder = scenes_folder() / "khronos";
    if (!is_here(folder)) return;
    for (const char* name : {"BoxAnimated", "CesiumMan", "Fox", "AnimatedMorphCube"}) {
        CAPTURE(name);
        Scene scene = demand(load_scene(folder / name / (std::string(name) + ".glb")));
        scene.sky = Sky{{1000, 1000, 1000}, nullptr};
        const View view = view_of(scene, 0, 96, 60);
        for (const Accel accel : kAccels) {
            CAPTURE(std::string(aglow::name(accel)));
            const Pair pair(device.gpu(), {scene, nullptr, {.samples = 1}}, accel);
            for (const double time : {0.0, 1.2, 3.0}) {
                CAPTURE(time);
                CHECK(pair.difference_at(time, view) < 0.01);
            }
        }
    }
}

TEST_CASE("a GPU counts the rays of each kind as the CPU does") {
    vk::TestDevice device;
    if (!device) return;
    Quads quads;
    quads.floor(metal(0.8f, 0.1f), 2);
    add_point_light(quads.scene, {0.5f, 0.5f, 2}, 1000);
    add_point_light(quads.scene, {-0.5f, 0.5f, 2}, 1000);
    const View view = from_above(3, 1, 9);
    for (const int reflections : {0, 2}) {
        const Pair pair(device.gpu(),
                        {quads.scene, nullptr, {.samples = 3, .reflections = reflections}},
                        Accel::bvh);
        for (FrameRenderer* renderer : {pair.gpu.get(), pair.cpu.get()}) {
            const DrawnFrame frame = demand(renderer->draw(0, view, {}));
            const uint64_t hits = 9 * 9 * 3;  // each by a camera ray; its mirror ray meets nothing
            CHECK(frame.rays.camera == hits);
            CHECK(frame.rays.mirror == (reflections > 0 ? hits : 0));
            CHECK(frame.rays.shadow == 2 * hits);
            CHECK(frame.rays.total() == (reflections > 0 ? 4 : 3) * hits);
        }
    }
}

TEST_CASE("what does not fit on a GPU says what it needs and what there is") {
    constexpr uint64_t kMiB = uint64_t{1} << 20;
    const auto says = [](const Error& error, uint64_t memory) {
        CAPTURE(error.message);
        CHECK(error.code == Errc::out_of_memory);
        std::smatch found;
        const std::regex wanted(
            "buffer \"(.+)\" needs (\\d+) bytes of \\w+ memory; (\\d+) of (\\d+) are in use");
        REQUIRE(std::regex_search(error.message, found, wanted));
        CHECK(std::stoull(found[4]) == memory);
        CHECK(std::stoull(found[2]) > memory - std::stoull(found[3]));
        return std::pair{found[1].str(), std::stoull(found[2])};
    };
    vk::DeviceOptions options;
    options.faults.memory_bytes = kMiB;
    {
        vk::TestDevice device(options);
        if (!device) return;
        const Scene scene = builtin_scene("stress:40000").value();
        const auto renderer = make_gpu_frame_renderer(device.gpu(), {scene}, Accel::bvh);
        REQUIRE_FALSE(renderer);
        says(renderer.error(), kMiB);
    }
    options.faults.memory_bytes = 128 * kMiB;
    vk::TestDevice device(options);
    Quads quads;
    quads.floor(diffuse({1, 1, 1}), 2);
    const auto renderer = demand(make_gpu_frame_renderer(device.gpu(), {quads.scene}, Accel::grid));
    const auto frame = renderer->draw(0, from_above(3, 1, 4096), {});
    REQUIRE_FALSE(frame);
    const auto [buffer, bytes] = says(frame.error(), 128 * kMiB);
    CHECK(buffer == "image");
    CHECK(bytes == 4096 * 4096 * sizeof(vec3));
}

TEST_CASE("a frame comes out the same again, and whatever was drawn before it") {
    vk::TestDevice device;
    if (!device) return;
    const Everything scene;
    const Footage footage{scene.quads.scene, nullptr, {.samples = 2}};
    auto renderer = demand(make_gpu_frame_renderer(device.gpu(), footage, Accel::bvh));
    const Image first = renderer->draw(0.3, scene.view(), {}).value().luminance;
    View other = scene.view();
    other.width = 33;
    other.height = 7;
    CHECK(renderer->draw(-1, other, {}).value().luminance.pixels.size() == 33 * 7);
    CHECK(renderer->draw(0.3, scene.view(), {}).value().luminance.pixels == first.pixels);
    CHECK(renderer->device() == device.gpu()->info().name);
    CHECK(renderer->accel() == "bvh");
}

TEST_CASE("an empty scene shows its sky, and one without light is black") {
    vk::TestDevice device;
    if (!device) return;
    Scene empty;
    empty.sky = Sky{{3, 2, 1}, nullptr};
    auto renderer = demand(make_gpu_frame_renderer(device.gpu(), {empty}, Accel::automatic));
    const View view = from_above(1, 1, 5);
    const Image sky = renderer->draw(0, view, {}).value().luminance;
    for (const vec3 pixel : sky.pixels) CHECK(pixel == vec3{3, 2, 1});

    Quads dark;
    dark.floor(diffuse({1, 1, 1}), 2);
    renderer = demand(make_gpu_frame_renderer(device.gpu(), {dark.scene}, Accel::automatic));
    const Image night = renderer->draw(0, view, {}).value().luminance;
    for (const vec3 pixel : night.pixels) CHECK(pixel == vec3{0, 0, 0});
}

TEST_CASE("bad options, empty views and interruptions are errors on a GPU too") {
    vk::TestDevice device;
    if (!device) return;
    Quads quads;
    quads.floor(diffuse({1, 1, 1}), 2);
    for (const RaysOptions& bad : {RaysOptions{.samples = 0}, RaysOptions{.reflections = -1}})
        CHECK(make_gpu_frame_renderer(device.gpu(), {quads.scene, nullptr, bad}, Accel::grid)
                  .error()
                  .code == Errc::bad_argument);
    auto renderer = demand(make_gpu_frame_renderer(device.gpu(), {quads.scene}, Accel::grid));
    CHECK(renderer->draw(0, from_above(1, 1, 0), {}).error().code == Errc::bad_argument);
    const std::atomic<bool> cancel = true;
    const View view = from_above(1, 1, 5);
    CHECK(renderer->draw(0, view, {{}, &cancel}).error().code == Errc::cancelled);
    CHECK(renderer->draw(0, view, {}));
}

namespace {

/// A run of the tests takes samples, because opening a device takes most of a second.
bool every_fault() { return std::getenv("AGLOW_EVERY_FAULT") != nullptr; }

struct Trial {
    bool failed = false;
    int allocations = 0, submits = 0;
};

/// Draws a moving scene with these faults, and goes on with the CPU where the GPU fails.
Trial draw_with(const vk::Faults& faults) {
    vk::DeviceOptions options;
    options.faults = faults;
    vk::TestDevice device(options);
    if (!device) return {};
    const Everything scene;
    const Footage footage{scene.quads.scene, nullptr, {.samples = 1}};
    const auto on_cpu = [&] { return make_cpu_frame_renderer(footage); };
    Trial trial;
    View view = scene.view();
    view.width = view.height = 16;
    {
        auto renderer = make_gpu_frame_renderer(device.gpu(), footage, Accel::bvh);
        if (!renderer) {
            trial.failed = true;
            const bool memory = faults.fail_allocation >= 0;
            CHECK(renderer.error().code == (memory ? Errc::out_of_memory : Errc::device_lost));
            CHECK_FALSE(renderer.error().message.empty());
        } else {
            const auto either = make_falling_back(std::move(*renderer), on_cpu,
                                                  [&](const Error&) { trial.failed = true; });
            for (const double time : {0.0, 0.5}) {
                const auto frame = demand(either->draw(time, view, {}));
                const Image wanted = on_cpu().value()->draw(time, view, {}).value().luminance;
                CHECK(difference(frame.luminance, wanted).value().relative_rmse < 0.01);
            }
        }
    }
    trial.allocations = device.gpu()->allocation_count();
    trial.submits = device.gpu()->submit_count();
    return trial;
}

}  // namespace

TEST_CASE(
    "memory that cannot be had ends in an error or a smaller wavefront, and in all pictures") {
    const Trial whole = draw_with({});
    CHECK_FALSE(whole.failed);
    const int step = every_fault() ? 1 : 4;
    for (int n = 0; n < whole.allocations; n += step) {
        CAPTURE(n);
        draw_with({.fail_allocation = n});
    }
}

TEST_CASE("a device that is lost leaves the rest of the pictures to the CPU") {
    const Trial whole = draw_with({});
    const int step = every_fault() ? 1 : 1 + whole.submits / 5;
    for (int n = 0; n < whole.submits; n += step) {
        CAPTURE(n);
        const Trial trial = draw_with({.lose_at_submit = n});
        CHECK(trial.failed == (trial.submits > n));  // a faster run submits less often
    }
}
