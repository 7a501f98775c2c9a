// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/tables/tables.h"

#include "aglow/core/random.h"
#include "aglow/render/cpu/surface.h"
#include "aglow/scene/texture.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace aglow;
using namespace aglow::render;

namespace {

/// A scene with one material whose base colour is an image.
Scene textured(TextureImage image, Texture texture = {}) {
    Scene scene;
    scene.images.push_back(std::move(image));
    texture.image = 0;
    scene.textures.push_back(texture);
    scene.materials.resize(1);
    scene.materials[0].base_color_texture.texture = 0;
    return scene;
}

TextureImage noise(int width, int height) {
    TextureImage image{"noise", width, height, {}};
    Pcg32 random(7);
    for (int i = 0; i < 4 * width * height; ++i)
        image.rgba.push_back(static_cast<uint8_t>(random.next() >> 24));
    return image;
}

}  // namespace

TEST_CASE("level 0 is what scene/texture samples, with any wrap, filter and transform") {
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge})
        for (const Filter filter : {Filter::nearest, Filter::linear}) {
            Texture sampler;
            sampler.wrap_s = wrap;
            sampler.wrap_t = Wrap::repeat;
            sampler.filter = filter;
            Scene scene = textured(noise(5, 8), sampler);
            TextureRef& reference = scene.materials[0].base_color_texture;
            reference.offset = {0.3f, -0.2f};
            reference.scale = {1.5f, 0.7f};
            reference.rotation = 0.4f;
            const MaterialTable table = material_table(scene);
            const shared::TextureUse use = table.materials[0].base_color_texture;
            Pcg32 random(1);
            for (int i = 0; i < 200; ++i) {
                const vec2 uv{random.uniform() * 6 - 3, random.uniform() * 6 - 3};
                const vec4 a = sample(scene, reference, uv, ColorCoding::srgb);
                const vec4 b = cpu::sample_texture(table, use.texture,
                                                   shared::texture_coordinates(use, uv), 0);
                CHECK(std::abs(a.x - b.x) < 2e-5f);
                CHECK(std::abs(a.z - b.z) < 2e-5f);
                CHECK(std::abs(a.w - b.w) < 2e-5f);
            }
        }
}

TEST_CASE("mip levels are means of linear light, alpha included, whatever the size") {
    for (const auto& size : {std::pair(16, 16), std::pair(7, 5), std::pair(1, 9)}) {
        const int width = size.first, height = size.second;
        CAPTURE(width);
        const Scene scene = textured(noise(width, height));
        const MaterialTable table = material_table(scene);
        REQUIRE(table.textures.size() == 1);
        const shared::TextureLevels texture = table.textures[0];
        double red = 0, alpha = 0;
        const std::vector<uint8_t>& rgba = scene.images[0].rgba;
        for (size_t i = 0; i < rgba.size(); i += 4) {
            red += static_cast<double>(srgb_to_linear(static_cast<float>(rgba[i]) / 255));
            alpha += static_cast<double>(rgba[i + 3]) / 255;
        }
        const double count = width * height;
        const auto last = static_cast<float>(texture.level_count - 1);
        const vec4 top = cpu::sample_texture(table, 0, {0.5f, 0.5f}, last);
        // Every level rounds to 8 bits.
        CHECK(static_cast<double>(top.x) == doctest::Approx(red / count).epsilon(0.02));
        CHECK(static_cast<double>(top.w) == doctest::Approx(alpha / count).epsilon(0.02));
    }
}

TEST_CASE("the mip level on a plane is that whose texels are as wide as a pixel") {
    // A square of 4 m with a texture of 256 texels a side: 64 texels to the metre.
    shared::TextureLevels texture{};
    texture.width = texture.height = 256;
    texture.level_count = 9;
    const vec2 a{0, 0}, b{1, 0}, c{0, 1};
    const float area = 8;  // m^2, of the triangle that takes half of the texture
    for (const float width : {1 / 64.0f, 1 / 16.0f, 0.25f, 1.0f}) {
        const double texels = 64 * static_cast<double>(width);
        CHECK(shared::texture_level(texture, a, b, c, area, width, 1) ==
              doctest::Approx(std::log2(texels)));
        CHECK(shared::texture_level(texture, a, b, c, area, width, 0.5f) ==
              doctest::Approx(std::log2(texels) + 1));
    }
    CHECK(shared::texture_level(texture, a, b, c, area, 1e-3f, 1) == 0);
    CHECK(shared::texture_level(texture, a, b, c, area, 1e3f, 1) == 8);
    CHECK(shared::texture_level(texture, a, a, a, area, 1, 1) == 0);
    CHECK(shared::texture_level(texture, a, b, c, 0, 1, 1) == 8);
}

TEST_CASE("a camera's cone is a pixel wide at any distance, shared among its samples") {
    shared::CameraView view{};
    view.half_height = 0.5f;
    view.height = 100;
    view.width = 100;
    view.perspective = 1;
    CHECK(shared::advanced_cone(shared::camera_cone(view, 1), 7).width == doctest::Approx(0.07));
    CHECK(shared::advanced_cone(shared::camera_cone(view, 16), 7).width ==
          doctest::Approx(0.07 / 4));
    view.perspective = 0;
    CHECK(shared::advanced_cone(shared::camera_cone(view, 1), 7).width == doctest::Approx(0.01));
}

TEST_CASE("a convex mirror spreads a cone as optics says") {
    // Two rays 2 w apart meet a sphere of radius R: their normals differ by 2 w / R, the rays by
    // twice that.
    const shared::RayCone cone = shared::reflected_cone({0.02f, 0}, 1 / 0.5f, 0);
    CHECK(cone.spread == doctest::Approx(2 * 0.02 / 0.5));
    CHECK(shared::reflected_cone({0.02f, 0.1f}, 0, 0).spread == doctest::Approx(0.1));
}

TEST_CASE("emissive triangles are chosen by power") {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[0].emission = {10, 10, 10};
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, 0, 1}, {0, 1, 1}};
    p.normals.assign(6, {0, 0, 1});
    p.triangles = {{0, 1, 2}, {3, 4, 5}};
    p.material = 0;
    Primitive dark = p;
    dark.material = 1;
    scene.meshes.resize(1);
    scene.meshes[0].primitives = {dark, p};
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    const EmitterTable table = emitter_table(scene, pose(scene));
    CHECK(table.triangles == std::vector<uint32_t>{2, 3});
    REQUIRE(table.cumulative.size() == 2);
    CHECK(table.cumulative[0] == doctest::Approx(0.25));
    CHECK(table.cumulative[1] == 1);
}

TEST_CASE("the sky's density is that of its luminance on the sphere") {
    Scene scene;
    auto image = std::make_shared<Image>(6, 4);
    for (size_t i = 0; i < image->pixels.size(); ++i)
        image->pixels[i] = vec3{1, 1, 1} * static_cast<float>(i % 5);
    scene.sky = Sky{{2, 2, 2}, image};
    const SkyTable table = sky_table(scene);
    REQUIRE(table.width == 6);
    double total = 0;
    const auto weight = [&](size_t x, size_t y) {
        return std::sin((static_cast<double>(y) + 0.5) / 4 * 3.14159265358979) *
               static_cast<double>(image->pixels[y * 6 + x].x);
    };
    for (size_t y = 0; y < 4; ++y)
        for (size_t x = 0; x < 6; ++x) total += weight(x, y);
    for (size_t y = 0; y < 4; ++y)
        for (size_t x = 0; x < 6; ++x) {
            const float row = table.rows[y] - (y ? table.rows[y - 1] : 0);
            const float cell = table.cells[y * 6 + x] - (x ? table.cells[y * 6 + x - 1] : 0);
            CHECK(static_cast<double>(row * cell) ==
                  doctest::Approx(weight(x, y) / total).epsilon(1e-5));
        }
    scene.sky->luminance = {0, 0, 0};
    CHECK(sky_table(scene).width == 0);
}
