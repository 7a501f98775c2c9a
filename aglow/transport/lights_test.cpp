// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/lights.h"

#include "aglow/core/random.h"
#include "aglow/scene/photometry.h"
#include "aglow/shared/sobol.h"
#include "aglow/transport/lights/emitters.h"
#include "aglow/transport/lights/light_tree.h"
#include "aglow/transport/lights/sky_distribution.h"
#include "aglow/transport/lights/triangle_sampling.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace aglow;
using namespace aglow::transport;

namespace {

/// Irradiance factor pi * F from the origin's +z plane to the triangle, by Lambert's polygon sum in
/// double precision; all corners above the plane.
double lambert(const vec3 (&t)[3]) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const vec3 p = t[i], q = t[(i + 1) % 3];
        const double cx = static_cast<double>(p.y) * q.z - static_cast<double>(p.z) * q.y;
        const double cy = static_cast<double>(p.z) * q.x - static_cast<double>(p.x) * q.z;
        const double cz = static_cast<double>(p.x) * q.y - static_cast<double>(p.y) * q.x;
        const double sine = std::sqrt(cx * cx + cy * cy + cz * cz);
        const double cosine = static_cast<double>(p.x) * q.x + static_cast<double>(p.y) * q.y +
                              static_cast<double>(p.z) * q.z;
        sum += std::atan2(sine, cosine) * cz / sine;
    }
    return std::fabs(sum) / 2;
}

double sampled(const vec3 (&t)[3], uint32_t count) {
    const TriangleSampler sampler(t[0], t[1], t[2]);
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const auto s = sampler.sample(shared::owen_sobol_2d(i, 3));
        if (!(s.pdf > 0)) continue;
        const vec3 p = t[0] * (1 - s.barycentrics.x - s.barycentrics.y) + t[1] * s.barycentrics.x +
                       t[2] * s.barycentrics.y;
        sum += static_cast<double>(normalize(p).z / s.pdf);
    }
    return sum / count;
}

Scene emitter_scene(int count) {
    Scene scene;
    Material material;
    material.emission = {100, 100, 100};
    scene.materials.push_back(material);
    Primitive primitive;
    primitive.material = 0;
    Pcg32 random(7);
    for (int i = 0; i < count; ++i) {
        const vec3 center{random.uniform() * 4 - 2, random.uniform() * 4 - 2, 1 + random.uniform()};
        const auto base = static_cast<uint32_t>(primitive.positions.size());
        for (const vec3 corner : {vec3{0, 0, 0}, vec3{0, 0.1f, 0}, vec3{0.1f, 0, 0}}) {
            primitive.positions.push_back(center + corner);
            primitive.normals.push_back({0, 0, -1});
        }
        primitive.triangles.push_back({base, base + 1, base + 2});
    }
    scene.meshes.push_back({"lights", {primitive}, {}});
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

}  // namespace

TEST_CASE("sampling a triangle by solid angle integrates the cosine to Lambert's closed form") {
    const vec3 triangles[][3] = {{{-1, -1, 0.5f}, {2, -1, 0.5f}, {0, 3, 1}},
                                 {{0.1f, 0.1f, 0.01f}, {0.2f, 0.1f, 0.02f}, {0.1f, 0.4f, 0.3f}},
                                 {{-50, -50, 1}, {50, -50, 1}, {0, 80, 1}},
                                 {{3, 3, 3}, {3.1f, 3, 3}, {3, 3.1f, 3}},  // small: by area
                                 {{0.5f, 0, 1e-3f}, {0.5f, 1, 1e-3f}, {0.5f, 0, 2}}};
    for (const auto& t : triangles)
        CHECK(sampled(t, 4096) == doctest::Approx(lambert(t)).epsilon(2e-3));
}

TEST_CASE("one octant of the sphere has solid angle pi/2") {
    CHECK(solid_angle({2, 0, 0}, {0, 5, 0}, {0, 0, 1}) == doctest::Approx(kPi / 2));
}

TEST_CASE("the light tree draws every emitter that can be seen, with the probability it states") {
    std::vector<TreeEmitter> emitters;
    Pcg32 random(11);
    for (int i = 0; i < 37; ++i) {
        TreeEmitter e;
        const vec3 c{random.uniform() * 6 - 3, random.uniform() * 6 - 3,
                     0.5f + random.uniform() * 3};
        e.bounds.add(c);
        e.bounds.add(c + vec3{0.1f, 0.1f, 0.0f});
        e.normal = {0, 0, -1};
        e.power = 1 + random.uniform() * 5;
        emitters.push_back(e);
    }
    const LightTree tree(emitters);
    constexpr int kDraws = 50000;
    std::vector<double> stated(emitters.size(), 0), drawn(emitters.size(), 0);
    for (int i = 0; i < kDraws; ++i) {
        const auto choice =
            tree.draw({0, 0, 0}, {0, 0, 1}, (static_cast<float>(i) + 0.5f) / kDraws);
        REQUIRE(choice.probability > 0);
        stated[choice.emitter] = static_cast<double>(choice.probability);
        CHECK(tree.probability(choice.emitter, {0, 0, 0}, {0, 0, 1}) ==
              doctest::Approx(choice.probability).epsilon(1e-4));
        drawn[choice.emitter] += 1.0 / kDraws;
    }
    double sum = 0;
    for (size_t i = 0; i < emitters.size(); ++i) {
        CHECK(drawn[i] == doctest::Approx(stated[i]).epsilon(0.02));
        CHECK(drawn[i] > 0);
        sum += stated[i];
    }
    CHECK(sum == doctest::Approx(1).epsilon(1e-4));
}

TEST_CASE("many emitters light a point as the sum of their closed forms") {
    const Scene scene = emitter_scene(50);
    const Surfaces surfaces = pose(scene);
    const Lights lights(scene, surfaces, world_transforms(scene));
    const EmittersSeen seen(lights.emitters(), {0, 0, 0}, {0, 0, 1});
    double expected = 0;
    for (uint32_t i = 0; i < surfaces.triangles.size(); ++i)
        expected +=
            100 * lambert({surfaces.corner(i, 0), surfaces.corner(i, 1), surfaces.corner(i, 2)});
    double sum = 0;
    constexpr uint32_t kCount = 1 << 15;
    for (uint32_t i = 0; i < kCount; ++i) {
        const LightSample s = seen.sample(shared::owen_sobol_3d(i, 1));
        sum += static_cast<double>(luminance(s.normal_irradiance) * std::max(0.0f, s.direction.z));
    }
    CHECK(sum / kCount == doctest::Approx(expected).epsilon(0.003));
}

TEST_CASE("emitters are dark from behind unless double-sided") {
    Scene scene = emitter_scene(1);
    Surfaces surfaces = pose(scene);
    const SurfacePoint at{0, {0.2f, 0.2f}};
    CHECK(Lights(scene, surfaces, world_transforms(scene)).emitted(at, true).x == 100);
    CHECK(Lights(scene, surfaces, world_transforms(scene)).emitted(at, false).x == 0);
    scene.materials[0].double_sided = true;
    CHECK(Lights(scene, surfaces, world_transforms(scene)).emitted(at, false).x == 100);
}

TEST_CASE("north is the centre of a sky image, east to its right, the zenith on top") {
    const auto check = [](vec2 uv, vec3 d) {
        CHECK(length(equirectangular_direction(uv) - d) < 1e-5f);
    };
    check({0.5f, 0.5f}, {0, 0, -1});
    check({0.75f, 0.5f}, {1, 0, 0});
    check({0.25f, 0.5f}, {-1, 0, 0});
    check({0.5f, 0}, {0, 1, 0});
    const vec2 uv = equirectangular_uv(equirectangular_direction({0.3f, 0.7f}));
    CHECK(uv.x == doctest::Approx(0.3));
    CHECK(uv.y == doctest::Approx(0.7));
}

TEST_CASE("sky directions follow luminance: their weighted mean is the sky's integral") {
    Image sky(16, 8);
    double integral = 0;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
            const float value =
                x == 5 && y == 2 ? 1000.0f : static_cast<float>((x * 7 + y * 3) % 5);
            sky.at(x, y) = {value, value, value};
            const double solid =
                2 * M_PI / 16 * (std::cos(M_PI * y / 8) - std::cos(M_PI * (y + 1) / 8));
            integral += static_cast<double>(value) * solid;
        }
    const SkyDistribution distribution(sky);
    double sum = 0;
    constexpr uint32_t kCount = 1 << 14;
    for (uint32_t i = 0; i < kCount; ++i) {
        const auto s = distribution.draw(shared::owen_sobol_2d(i, 21));
        const vec2 uv = equirectangular_uv(s.direction);
        const vec3 value = sky.at(std::min(15, static_cast<int>(uv.x * 16)),
                                  std::min(7, static_cast<int>(uv.y * 8)));
        CHECK(distribution.pdf(s.direction) == doctest::Approx(s.pdf).epsilon(0.02));
        sum += static_cast<double>(value.x / s.pdf) / kCount;
    }
    CHECK(sum == doctest::Approx(integral).epsilon(0.005));
}

TEST_CASE("a luminaire shines by its photometry, turned with its node") {
    auto photometry = std::make_shared<Photometry>();
    photometry->gamma = {0, 90};
    photometry->c = {0, 90, 180, 270, 360};
    photometry->candela = {100, 10, 100, 20, 100, 30, 100, 40, 100, 10};
    Scene scene;
    add_luminaire(scene, {0, 2, 0}, photometry);  // down, C0 to +X, C90 to -Z
    const Surfaces surfaces;
    const Lights lights(scene, surfaces, world_transforms(scene));
    REQUIRE(lights.delta_count() == 1);
    const auto at = [&](vec3 p) { return lights.delta(0, p).normal_irradiance.x; };
    CHECK(at({0, 0, 0}) == doctest::Approx(100 / 4.0));
    CHECK(at({3, 2 - 1e-5f, 0}) == doctest::Approx(10 / 9.0).epsilon(1e-3));
    CHECK(at({0, 2 - 1e-5f, -3}) == doctest::Approx(20 / 9.0).epsilon(1e-3));
    CHECK(at({-3, 2 - 1e-5f, 0}) == doctest::Approx(30 / 9.0).epsilon(1e-3));
    CHECK(at({0, 2 - 1e-5f, 3}) == doctest::Approx(40 / 9.0).epsilon(1e-3));
    CHECK(at({0, 3, 0}) == 0);
}

TEST_CASE("a spot keeps its candela inside the inner cone and has none outside the outer") {
    Scene scene;
    Light light;
    light.kind = LightKind::spot;
    light.intensity = {100, 100, 100};
    light.inner_cone = 0.3f;
    light.outer_cone = 0.6f;
    scene.lights.push_back(light);
    Node node;
    node.light = 0;
    node.translation = {0, 0, 2};
    scene.nodes.push_back(node);
    const Surfaces surfaces;
    const Lights lights(scene, surfaces, world_transforms(scene));
    REQUIRE(lights.delta_count() == 1);
    CHECK(lights.delta(0, {0, 0, 0}).normal_irradiance.x == doctest::Approx(25));
    CHECK(lights.delta(0, {2, 0, 0}).normal_irradiance.x == 0);
    // Between the cones: KHR_lights_punctual's ((cos a - cos outer) / (cos inner - cos outer))^2.
    const double angle = 0.45,
                 t = (std::cos(angle) - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6));
    const LightSample between = lights.delta(0, {static_cast<float>(2 * std::tan(angle)), 0, 0});
    const double r2 = 4 / std::cos(angle) / std::cos(angle);
    CHECK(between.normal_irradiance.x == doctest::Approx(100 * t * t / r2).epsilon(1e-4));
}
