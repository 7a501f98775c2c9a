// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/testing/stage.h"

#include <algorithm>
#include <cmath>

using namespace aglow;
using namespace aglow::render::testing;

namespace {

/// A perspective view that looks down at the origin at a slant.
View slanted(int size) {
    const vec3 eye{0, -3, 2.5f}, back = normalize(eye), right{1, 0, 0}, up = cross(back, right);
    View view;
    view.to_world.m = {right.x, right.y, right.z, 0, up.x,  up.y,  up.z,  0,
                       back.x,  back.y,  back.z,  0, eye.x, eye.y, eye.z, 1};
    view.half_width = view.half_height = 0.3f;
    view.width = view.height = size;
    return view;
}

View below_the_floor(View view) {
    for (size_t i = 2; i < 16; i += 4) view.to_world.m[i] = -view.to_world.m[i];
    return view;
}

void hang_pictures(Quads& quads) {
    quads.add(unlit({0.9f, 0.1f, 0.2f}), {-2, 4, 0.5f}, {0, 4, 0.5f}, {0, 4, 2}, {-2, 4, 2});
    quads.add(unlit({0.1f, 0.8f, 0.3f}), {0, 4, 1}, {2, 4, 1}, {2, 4, 3}, {0, 4, 3});
    quads.add(unlit({0.2f, 0.2f, 0.9f}), {-3, 5, 0.2f}, {3, 5, 0.2f}, {3, 5, 1.5f}, {-3, 5, 1.5f});
}

}  // namespace

TEST_CASE("a mirror shows what a camera in the mirrored place sees") {
    const int size = 48;
    const View view = slanted(size);
    Quads with_mirror, without;
    hang_pictures(with_mirror);
    hang_pictures(without);
    with_mirror.floor(metal(0.9f, 0), 10);
    const RaysOptions options{.samples = 1, .reflections = 1};
    const Image mirrored = picture(with_mirror.scene, nullptr, view, options);
    const Image direct = picture(without.scene, nullptr, below_the_floor(view), options);
    int lit = 0, wrong = 0;
    for (size_t i = 0; i < mirrored.pixels.size(); ++i) {
        const View& v = view;
        const Ray ray = v.ray(static_cast<float>(i % 48) + 0.5f, static_cast<float>(i / 48) + 0.5f);
        // Schlick's Fresnel term at the pixel's middle; the ray may pass half a pixel from it.
        const double away = 1 + static_cast<double>(ray.direction.z);
        const double f = 0.9 + 0.1 * std::pow(away, 5);
        lit += direct.pixels[i].x > 0;
        wrong += std::abs(static_cast<double>(mirrored.pixels[i].x) -
                          f * static_cast<double>(direct.pixels[i].x)) >
                 2e-3 * static_cast<double>(direct.pixels[i].x);
    }
    CHECK(lit > 600);
    CHECK(wrong <= 2);  // a ray along an edge may round to either side
}

TEST_CASE("face on, black glass mirrors 4 % of the sky and metal its colour") {
    for (const auto& [material, share] :
         {std::pair(diffuse({0, 0, 0}), 0.04f), std::pair(metal(0.6f, 0), 0.6f)}) {
        Quads quads;
        Material smooth = material;
        smooth.roughness = 0;
        quads.floor(smooth, 1);
        quads.scene.sky = Sky{{50, 50, 50}, nullptr};
        const Lit dark = quads.lit(8, {0, 0, 0});
        const Image image = picture(quads.scene, &dark, from_above(2, 0.5f, 3), {.samples = 4});
        CHECK(image.at(1, 1).x == doctest::Approx(share * 50));
    }
}

TEST_CASE("two mirrors that face each other show as many images as reflections are asked for") {
    // Above a mirror hangs a second one with a light in it; each reflection takes 10 %.
    Quads quads;
    quads.floor(metal(0.9f, 0), 5);
    quads.add(metal(0.9f, 0), {-5, 5, 3}, {5, 5, 3}, {5, -5, 3}, {-5, -5, 3});
    Lit lit = quads.lit(4, {0, 0, 0});
    // E where the rays end, in the last mirror that is asked for, is 0 but for the last step.
    for (vec3& pixel : lit.irradiance.pixels) pixel = vec3{1, 1, 1} * kPi;
    for (const int depth : {1, 2, 5}) {
        const Image image = picture(quads.scene, &lit, from_above(2, 0.2f, 1),
                                    {.samples = 1, .reflections = depth});
        // The last surface shows 0.9 of the mean radiance E / pi = 1.
        CHECK(image.pixels[0].x == doctest::Approx(std::pow(0.9, depth + 1)));
    }
}

TEST_CASE("a closed room of uniform light gets no brighter, and no darker than what is absorbed") {
    const float L0 = 100;
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.0f, 0.4f, 1.0f})
            for (const int reflections : {0, 1, 3}) {
                CAPTURE(metallic);
                CAPTURE(roughness);
                CAPTURE(reflections);
                Material white = metal(1, roughness);
                white.metallic = metallic;
                Quads room;
                room.floor(white, 1, -1);
                room.add(white, {-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1});
                room.add(white, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1}, {-1, -1, 1});
                room.add(white, {1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1});
                room.add(white, {-1, -1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, -1, -1});
                room.add(white, {-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1});
                const Lit lit = room.lit(4, vec3{1, 1, 1} * (kPi * L0));
                View view;
                view.half_width = view.half_height = 1.5f;
                view.width = view.height = 12;
                const Image image =
                    picture(room.scene, &lit, view, {.samples = 2, .reflections = reflections});
                const auto [least, most] =
                    std::minmax_element(image.pixels.begin(), image.pixels.end(),
                                        [](vec3 a, vec3 b) { return a.x < b.x; });
                CHECK(most->x <= L0 * 1.00001f);
                CHECK(least->x >=
                      L0 * std::pow(0.98f, static_cast<float>(reflections + 1)) * 0.9999f);
            }
}

TEST_CASE("a punctual light whose light is baked is not counted twice on rough metal") {
    Quads quads;
    quads.floor(metal(0.9f, 1), 1);
    add_sun(quads.scene);
    // Straight down onto it; the lightmap holds that and a sky's 300 lux.
    const Lit lit = quads.lit(8, {1300, 1300, 1300});
    const Image image = picture(quads.scene, &lit, from_above(2, 0.5f, 3), {.samples = 1});
    // GGX with alpha 1: D = 1 / pi, V = 1 / 4 face on, F = 0.9.
    const double highlight = 0.9 / 3.14159265 / 4 * 1000, mean = 0.9 / 3.14159265 * 300;
    CHECK(static_cast<double>(image.at(1, 1).x) == doctest::Approx(highlight + mean).epsilon(1e-4));
}

TEST_CASE("the highlight of a lamp is where a mirror would show it, unless something shades it") {
    for (const Shading shading : {Shading::metallic_roughness, Shading::phong}) {
        Quads quads;
        quads.floor(metal(0.9f, 0.3f), 2);
        add_point_light(quads.scene, {0.5f, 0, 1}, 1000);
        const Lit lit = quads.lit(4, {0, 0, 0});
        const int size = 61;
        const RaysOptions options{.samples = 1, .reflections = 1, .shading = shading};
        const Image image = picture(quads.scene, &lit, from_above(2, 1, size), options);
        const auto brightest = std::max_element(image.pixels.begin(), image.pixels.end(),
                                                [](vec3 a, vec3 b) { return a.x < b.x; });
        const auto at = static_cast<int>(brightest - image.pixels.begin());
        const vec2 place = position_of(at % size, at / size, 1, size);
        // Seen along the normal, a mirror shows the lamp where it stands.
        CHECK(std::abs(place.x - 0.5f) < 0.05f);
        CHECK(std::abs(place.y) < 0.05f);
        Quads shaded = quads;
        shaded.floor(diffuse({0, 0, 0}), 3, 0.9f);
        std::rotate(shaded.scene.nodes.begin() + 1, shaded.scene.nodes.end() - 1,
                    shaded.scene.nodes.end());
        const Lit dark = shaded.lit(4, {0, 0, 0});
        View below = from_above(0.5f, 1, size);
        CHECK(picture(shaded.scene, &dark, below, options).at(45, 30).x == 0);
    }
}
