// SPDX-License-Identifier: Apache-2.0
// Pictures of engine `raster` against those of engine `rays` and against closed forms.
#include "aglow/render/raster.h"

#include "aglow/core/testing/demand.h"
#include "aglow/render/testing/raster.h"
#include "aglow/scene/builtin.h"
#include "aglow/vk/testing/test_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

using namespace aglow;
using namespace aglow::render::testing;

namespace {

constexpr RaysOptions kFine{.samples = 256, .reflections = 0};

/// What engine `raster` shows under the filter of engine `rays`: drawn `n` times as large with one
/// sample, and weighed by the tent that is one pixel wide at half its height.
Image filtered(const Gpu& gpu, const Footage& footage, View view, double time = -1) {
    constexpr int n = 6;
    View large = view;
    large.width *= n;
    large.height *= n;
    const Image fine = rastered(gpu, footage, large, time, {.samples = 1});
    Image image(view.width, view.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            vec3 sum = {0, 0, 0};
            float weights = 0;
            for (int j = -n / 2; j < n + n / 2; ++j) {
                for (int i = -n / 2; i < n + n / 2; ++i) {
                    const auto share = [](int k) {
                        return 1 - std::fabs((static_cast<float>(k) + 0.5f) / n - 0.5f);
                    };
                    const float weight = share(i) * share(j);
                    const int fx = std::clamp(x * n + i, 0, fine.width - 1);
                    const int fy = std::clamp(y * n + j, 0, fine.height - 1);
                    sum += fine.at(fx, fy) * weight;
                    weights += weight;
                }
            }
            image.at(x, y) = sum * (1 / weights);
        }
    }
    return image;
}

/// How pictures agree: over all, and in pixels around which `wanted` is even.
struct Agreement {
    double relative_rmse = 0;
    double largest_inside = 0;  // relative difference
    int inside = 0;             // pixels
};

Agreement agreement(const Image& drawn, const Image& wanted) {
    Agreement result;
    result.relative_rmse = demand(difference(drawn, wanted)).relative_rmse;
    for (int y = 2; y + 2 < wanted.height; ++y) {
        for (int x = 2; x + 2 < wanted.width; ++x) {
            float least = kInfinity, most = 0;
            for (int j = -2; j <= 2; ++j)
                for (int i = -2; i <= 2; ++i) {
                    const float value = luminance(wanted.at(x + i, y + j));
                    least = std::min(least, value);
                    most = std::max(most, value);
                }
            if (!(most > 0) || most > 1.2f * least) continue;
            ++result.inside;
            const float value = luminance(wanted.at(x, y));
            const float off = std::fabs(luminance(drawn.at(x, y)) - value) / value;
            result.largest_inside = std::max(result.largest_inside, static_cast<double>(off));
        }
    }
    return result;
}

/// A room with its front open, and cards in it; every surface has a lightmap that varies.
struct LitRoom {
    Quads quads;
    Lit lit;

    LitRoom() {
        const Material grey = diffuse({0.7f, 0.7f, 0.7f});
        quads.floor(grey, 2);
        quads.add(diffuse({0.2f, 0.4f, 0.8f}), {-2, 2, 0}, {2, 2, 0}, {2, 2, 3}, {-2, 2, 3});
        quads.add(diffuse({0.8f, 0.2f, 0.1f}), {-2, -2, 0}, {-2, 2, 0}, {-2, 2, 3}, {-2, -2, 3});
        quads.add(metal(0.6f, 0.2f), {-1, 1, 0.5f}, {1, 0, 0.5f}, {1, 0, 1.5f}, {-1, 1, 1.5f});
        Material lamp = diffuse({0, 0, 0});
        lamp.emission = {90, 80, 70};
        quads.add(lamp, {0, 0.5f, 2.5f}, {0, 1.5f, 2.5f}, {1, 1.5f, 2.5f}, {1, 0.5f, 2.5f});
        quads.add(unlit({0.3f, 0.9f, 0.2f}), {1.5f, 0, 0.2f}, {1.9f, 0, 0.2f}, {1.9f, 0, 1},
                  {1.5f, 0, 1});
        lit = quads.lit(16, {1, 1, 1});
        for (int y = 0; y < lit.irradiance.height; ++y)
            for (int x = 0; x < lit.irradiance.width; ++x)
                lit.irradiance.at(x, y) = {100 + 4 * static_cast<float>(x % 18),
                                           150 + 3 * static_cast<float>(y), 120};
    }
};

View room_view(int width, int height) {
    // From (0, -5, 1.5) along +Y.
    View view;
    view.to_world = {{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, -5, 1.5f, 1}};
    view.half_width = 0.6f;
    view.half_height = 0.6f * static_cast<float>(height) / static_cast<float>(width);
    view.width = width;
    view.height = height;
    return view;
}

Light lamp_of(LightKind kind, float intensity) {
    Light light;
    light.kind = kind;
    light.intensity = {intensity, 0.8f * intensity, 0.5f * intensity};
    light.inner_cone = 0.3f;
    light.outer_cone = 0.6f;
    return light;
}

}  // namespace

TEST_CASE("a room of baked light looks as the ray tracer shows it without reflections") {
    vk::TestDevice device;
    if (!device) return;
    LitRoom room;
    const Footage footage{room.quads.scene, &room.lit};
    const View view = room_view(96, 72);
    const Image wanted = picture(room.quads.scene, &room.lit, view, kFine);
    // Under one filter: what is left is that edges fall between 36 even samples, or 256 scattered
    // ones, and within these, textures between texels.
    const Agreement same = agreement(filtered(device.gpu(), footage, view), wanted);
    CHECK(same.relative_rmse < 0.015);
    CHECK(same.largest_inside < 0.004);
    CHECK(same.inside > 2500);
    // Four samples under a box filter where the ray tracer has a tent: edges are as sharp as that.
    const Agreement plain = agreement(rastered(device.gpu(), footage, view), wanted);
    CHECK(plain.relative_rmse < 0.1);
    CHECK(plain.largest_inside < 0.02);
}

TEST_CASE("what moves is drawn where it is: nodes, skins and morph targets") {
    vk::TestDevice device;
    if (!device) return;
    for (const char* name : {"toys", "walker"}) {
        CAPTURE(name);
        Scene scene = demand(builtin_scene(name));
        for (Material& material : scene.materials) {
            material.unlit = true;
            material.double_sided = true;
            material.base_color_texture = {};
        }
        const View view = auto_view(scene, 0.7, 80, 60);
        const Image wanted = picture(scene, nullptr, view, kFine, 0.7);
        const Agreement same = agreement(filtered(device.gpu(), {scene}, view, 0.7), wanted);
        CHECK(same.relative_rmse < 0.02);
        CHECK(same.largest_inside < 0.02);
        const Image rest = filtered(device.gpu(), {scene}, view);
        CHECK(agreement(rest, wanted).relative_rmse > 2 * same.relative_rmse);
    }
}

TEST_CASE("lights without extent are those of the ray tracer where nothing is in the way") {
    vk::TestDevice device;
    if (!device) return;
    for (const LightKind kind : {LightKind::point, LightKind::spot, LightKind::directional}) {
        CAPTURE(static_cast<int>(kind));
        Quads quads;
        quads.floor(diffuse({0.8f, 0.6f, 0.4f}), 3);
        quads.scene.lights.push_back(lamp_of(kind, 50));
        Node node;
        node.light = 0;
        node.translation = {0.5f, 0.3f, 1.5f};
        quads.scene.nodes.push_back(node);
        const View view = from_above(4, 2, 40);
        const Image wanted = picture(quads.scene, nullptr, view, kFine);
        const Image drawn = filtered(device.gpu(), {quads.scene}, view);
        CHECK(demand(difference(drawn, wanted)).relative_rmse < 0.003);
    }
}

TEST_CASE("emissive triangles light by their form factors, many by a choice of them") {
    vk::TestDevice device;
    if (!device) return;
    const auto corner = [](float a, float b) {
        const float u = std::sqrt(1 + a * a), v = std::sqrt(1 + b * b);
        return (a / u * std::atan(b / u) + b / v * std::atan(a / v)) / (2 * kPi);
    };
    for (const int side : {1, 8}) {  // squares along a side of the lamp
        CAPTURE(side);
        Quads quads;
        quads.floor(diffuse({0.5f, 0.5f, 0.5f}), 0.1f);
        Material lamp = diffuse({0, 0, 0});
        lamp.emission = {1000, 1000, 1000};
        const float step = 2.0f / static_cast<float>(side);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const float l = -1 + step * static_cast<float>(x), r = l + step;
                const float b = -1 + step * static_cast<float>(y), t = b + step;
                quads.add(lamp, {l, b, 2}, {l, t, 2}, {r, t, 2}, {r, b, 2});  // faces the floor
            }
        const Image drawn = rastered(device.gpu(), {quads.scene}, from_above(1, 0.05f, 5));
        const double wanted = 0.5 * 1000 * 4 * static_cast<double>(corner(0.5f, 0.5f));
        CHECK(static_cast<double>(luminance(drawn.at(2, 2))) ==
              doctest::Approx(wanted).epsilon(side == 1 ? 0.001 : 0.03));
    }
}

TEST_CASE("the sky lights what it stands over, and is seen where nothing stands") {
    vk::TestDevice device;
    if (!device) return;
    Quads quads;
    quads.floor(diffuse({0.5f, 0.5f, 0.5f}), 0.5f);
    Sky sky;
    sky.luminance = {2, 2, 2};
    quads.scene.sky = sky;
    const View view = from_above(4, 1, 8);
    Image drawn = rastered(device.gpu(), {quads.scene}, view);
    CHECK(drawn.at(4, 4).x == doctest::Approx(1).epsilon(0.002));  // rho L
    CHECK(drawn.at(0, 0).x == doctest::Approx(2).epsilon(1e-5));
    // Brighter to the east, L = 2 (2 + x): a floor that faces +Z sees 2 * 2 on average.
    Image image(64, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const float azimuth = ((static_cast<float>(x) + 0.5f) / 64 - 0.5f) * 2 * kPi;
            const float polar = (static_cast<float>(y) + 0.5f) / 32 * kPi;
            image.at(x, y) = vec3{1, 1, 1} * (2 + std::sin(polar) * std::sin(azimuth));
        }
    quads.scene.sky->image = std::make_shared<const Image>(image);
    drawn = rastered(device.gpu(), {quads.scene}, view);
    CHECK(drawn.at(4, 4).x == doctest::Approx(2).epsilon(0.01));
    CHECK(drawn.at(0, 0).x == doctest::Approx(4).epsilon(0.02));  // down, along -Z: x = 0
}

TEST_CASE("backs of single-sided materials are left out") {
    vk::TestDevice device;
    if (!device) return;
    for (const bool both : {false, true}) {
        Quads quads;
        Material card = unlit({1, 1, 1});
        card.double_sided = both;
        quads.add(card, {-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0});  // faces down
        const Image drawn = rastered(device.gpu(), {quads.scene}, from_above(1, 0.5f, 4));
        CHECK(drawn.at(2, 2).x == (both ? kUnlitWhite : 0));
    }
}

TEST_CASE("blended surfaces cover what lies behind, whatever their order in the file") {
    vk::TestDevice device;
    if (!device) return;
    for (const bool upper_first : {false, true}) {
        CAPTURE(upper_first);
        Quads quads;
        Material red = unlit({1, 0, 0}), green = unlit({0, 1, 0});
        red.alpha_mode = green.alpha_mode = AlphaMode::blend;
        red.base_color.w = 0.5f;
        green.base_color.w = 0.25f;
        if (upper_first) quads.floor(green, 1, 1);
        quads.floor(red, 1, 0.5f);
        if (!upper_first) quads.floor(green, 1, 1);
        quads.floor(unlit({0, 0, 1}), 1, 0);
        const Image drawn = rastered(device.gpu(), {quads.scene}, from_above(2, 0.5f, 4));
        CHECK(drawn.at(2, 2).x == doctest::Approx(37.5));  // 0.75 * 0.5
        CHECK(drawn.at(2, 2).y == doctest::Approx(25));    // 0.25
        CHECK(drawn.at(2, 2).z == doctest::Approx(37.5));
    }
}

TEST_CASE("masks are cut as finely as edges") {
    vk::TestDevice device;
    if (!device) return;
    Quads quads;
    TextureImage image;
    image.width = image.height = 2;
    for (int i = 0; i < 4; ++i)
        for (const int v : {255, 255, 255, i % 2 == 0 ? 255 : 0})
            image.rgba.push_back(static_cast<uint8_t>(v));
    quads.scene.images = {image};
    quads.scene.textures = {{0, Wrap::clamp_to_edge, Wrap::clamp_to_edge, Filter::nearest}};
    Material mask = unlit({1, 1, 1});
    mask.alpha_mode = AlphaMode::mask;
    mask.base_color_texture.texture = 0;
    const int node = quads.floor(mask, 1);
    Primitive& primitive =
        quads.scene.meshes[static_cast<size_t>(quads.scene.nodes[static_cast<size_t>(node)].mesh)]
            .primitives[0];
    primitive.texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const Image drawn = rastered(device.gpu(), {quads.scene}, from_above(1, 1, 5));
    CHECK(drawn.at(1, 2).x == kUnlitWhite);
    CHECK(drawn.at(3, 2).x == 0);
    CHECK(drawn.at(2, 2).x == doctest::Approx(kUnlitWhite / 2));  // the mask ends in its middle
}

TEST_CASE("a refined octahedron has the outline of its curved triangles, mirrored too") {
    vk::TestDevice device;
    if (!device) return;
    for (const bool mirrored : {false, true}) {
        CAPTURE(mirrored);
        const Scene scene = octahedron(mirrored);
        const View view = from_above(4, 1.25f, 64);
        const double square = 2 / 6.25;
        // The area about the origin of four cubics with the control points (1, 0), (1, 1/3),
        // (1/3, 1), (0, 1) is 41 / 15.
        const double outline = 41.0 / 15 / 6.25;
        CHECK(covered(rastered(device.gpu(), {scene}, view)) ==
              doctest::Approx(square).epsilon(0.01));
        const Refinement curved{Refinement::Kind::pn, 3};
        const Image round =
            rastered(device.gpu(), {scene}, view, -1, {.samples = 4, .refinement = curved});
        CHECK(covered(round) == doctest::Approx(outline).epsilon(0.01));
        // No gap anywhere within.
        int gaps = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const vec2 at = position_of(x, y, 1.25f, 64);
                gaps += at.x * at.x + at.y * at.y < 0.7f && round.at(x, y).x != kUnlitWhite;
            }
        CHECK(gaps == 0);
    }
}

TEST_CASE("flat surfaces stay as they are when they are refined") {
    vk::TestDevice device;
    if (!device) return;
    LitRoom room;
    const Footage footage{room.quads.scene, &room.lit};
    const View view = room_view(96, 72);
    const Image flat = rastered(device.gpu(), footage, view);
    for (const auto kind : {Refinement::Kind::pn, Refinement::Kind::tagged}) {
        const Image refined =
            rastered(device.gpu(), footage, view, -1, {.samples = 4, .refinement = {kind, 2}});
        const Agreement same = agreement(refined, flat);
        CHECK(same.relative_rmse < 0.01);
        // Pixels that an edge of the pattern crosses are shaded on both sides of it.
        CHECK(same.largest_inside < 0.01);
    }
    CHECK(make_raster_frame_renderer(device.gpu(), footage,
                                     {.refinement = {Refinement::Kind::pn, kMostRefinement + 1}})
              .error()
              .code == Errc::bad_argument);
}

TEST_CASE("a picture is the same every time, and of any size in turn") {
    vk::TestDevice device;
    if (!device) return;
    LitRoom room;
    const auto renderer =
        demand(make_raster_frame_renderer(device.gpu(), {room.quads.scene, &room.lit}));
    const Image first = demand(renderer->draw(-1, room_view(40, 30), {})).luminance;
    CHECK(demand(renderer->draw(-1, room_view(16, 16), {})).luminance.width == 16);
    const DrawnFrame again = demand(renderer->draw(-1, room_view(40, 30), {}));
    bool same = true;
    for (size_t i = 0; i < first.pixels.size(); ++i)
        same &= first.pixels[i].x == again.luminance.pixels[i].x &&
                first.pixels[i].z == again.luminance.pixels[i].z;
    CHECK(same);
    std::vector<std::string> passes;
    for (const PassTime& pass : again.seconds) passes.push_back(pass.pass);
    CHECK(passes == std::vector<std::string>{"other", "pose", "draw", "read", "host"});
}

TEST_CASE("renderers keep their device open") {
    vk::TestDevice device;
    if (!device) return;
    LitRoom room;
    const Footage footage{room.quads.scene, &room.lit, {.samples = 1}};
    Gpu gpu = demand(open_gpu(device->info().name));
    auto raster = demand(make_raster_frame_renderer(gpu, footage));
    auto rays = demand(make_gpu_frame_renderer(gpu, footage, Accel::automatic));
    const std::weak_ptr<vk::Device> open = gpu;
    gpu.reset();
    CHECK(demand(raster->draw(-1, room_view(8, 8), {})).luminance.width == 8);
    CHECK(demand(rays->draw(-1, room_view(8, 8), {})).luminance.width == 8);
    raster.reset();
    CHECK_FALSE(open.expired());
    rays.reset();
    CHECK(open.expired());
}

TEST_CASE("what cannot be drawn is an error, and nothing leaks") {
    LitRoom room;
    const Footage footage{room.quads.scene, &room.lit};
    {
        vk::DeviceOptions options;
        options.drawing = false;
        vk::TestDevice device(options);
        if (!device) return;
        const auto renderer = make_raster_frame_renderer(device.gpu(), footage);
        REQUIRE_FALSE(renderer);
        CHECK(renderer.error().code == Errc::unsupported);
    }
    int allocations = 0;
    {
        vk::TestDevice device;
        CHECK(make_raster_frame_renderer(device.gpu(), footage, {.samples = 0}).error().code ==
              Errc::bad_argument);
        rastered(device.gpu(), footage, room_view(8, 8));
        allocations = device->allocation_count();
    }
    for (int n = 0; n < allocations; n += 3) {
        CAPTURE(n);
        vk::DeviceOptions options;
        options.faults.fail_allocation = n;
        vk::TestDevice device(options);
        const auto renderer = make_raster_frame_renderer(device.gpu(), footage);
        if (!renderer) {
            CHECK(renderer.error().code == Errc::out_of_memory);
            continue;
        }
        for (int again = 0; again < 2; ++again) {  // it draws no more
            const auto frame = (*renderer)->draw(-1, room_view(8, 8), {});
            REQUIRE_FALSE(frame);
            CHECK(frame.error().code == Errc::out_of_memory);
        }
    }
}
