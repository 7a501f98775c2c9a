// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/path/path.h"

#include "aglow/core/parallel.h"
#include "aglow/core/random.h"
#include "tests/quad.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <memory>

using namespace aglow;

namespace {

using testing::add_quad;

/// The cube [0, edge]^3 seen from inside.
Primitive room(float edge) {
    const float e = edge;
    Primitive p;
    add_quad(p, {0, 0, 0}, {0, 0, e}, {e, 0, e}, {e, 0, 0});  // floor
    add_quad(p, {0, e, 0}, {e, e, 0}, {e, e, e}, {0, e, e});  // ceiling
    add_quad(p, {0, 0, 0}, {e, 0, 0}, {e, e, 0}, {0, e, 0});
    add_quad(p, {0, 0, e}, {0, e, e}, {e, e, e}, {e, 0, e});
    add_quad(p, {0, 0, 0}, {0, e, 0}, {0, e, e}, {0, 0, e});
    add_quad(p, {e, 0, 0}, {e, 0, e}, {e, e, e}, {e, e, 0});
    p.material = 0;
    return p;
}

/// The square [-half, half]^2 at height 0 that faces up.
Primitive ground(float half) {
    Primitive p;
    add_quad(p, {-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half});
    p.material = 0;
    return p;
}

Scene scene_of(Primitive primitive, float rho, float emitted = 0) {
    Scene scene;
    Material material;
    material.base_color = {rho, rho, rho, 1};
    material.metallic = 0;
    material.emission = {emitted, emitted, emitted};
    scene.materials = {material};
    Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    scene.meshes.push_back(std::move(mesh));
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

/// A scene with all that a World refers to.
struct Stage {
    explicit Stage(Scene s)
        : scene(std::move(s)),
          surfaces(pose(scene)),
          rays(RayScene::create(scene, surfaces).value()),
          lights(scene, surfaces, world_transforms(scene)) {}
    World world() const { return {scene, surfaces, rays, lights}; }

    Scene scene;
    Surfaces surfaces;
    RayScene rays;
    Lights lights;
};

Receiver sensor(vec3 position, vec3 normal) { return {position, normal, normal, 0}; }

/// Receivers spread evenly over all triangles of a room, one at random in each of side x side
/// cells of equal area, so that their mean is the walls' mean without bias.
std::vector<Receiver> over_walls(const Surfaces& surfaces, int side) {
    std::vector<Receiver> result;
    Pcg32 random(1);
    const auto n = static_cast<float>(side);
    for (uint32_t triangle = 0; triangle < surfaces.triangles.size(); ++triangle)
        for (int i = 0; i < side; ++i)
            for (int k = 0; k < side; ++k) {
                const float u = std::sqrt((static_cast<float>(i) + random.uniform()) / n);
                const float v = (static_cast<float>(k) + random.uniform()) / n;
                result.push_back(receiver_at(surfaces, {triangle, {u * (1 - v), u * v}}));
            }
    return result;
}

struct Mean {
    double value = 0, error = 0;
};

Mean mean_of(const IrradianceField& field, auto part) {
    Mean mean;
    for (size_t i = 0; i < field.values.size(); ++i) {
        mean.value += double{luminance(part(field.values[i]))};
        mean.error += double{field.standard_error[i]} * double{field.standard_error[i]};
    }
    const auto count = static_cast<double>(field.values.size());
    return {mean.value / count, std::sqrt(mean.error) / count};
}

}  // namespace

TEST_CASE("direct light of a point light is I cos / r^2, at every scale") {
    for (float metre : {1e-3f, 1.0f, 1e3f}) {
        CAPTURE(metre);
        Scene scene = scene_of(ground(metre), 0.5f);
        add_point_light(scene, {1 * metre, 2 * metre, 0}, 1000);
        const Stage stage(std::move(scene));
        // The middle of the diagonal of the ground.
        const Receiver floor = receiver_at(stage.surfaces, {0, {0, 0.5f}});
        const Receiver wall = sensor({0, 1e-3f * metre, 0}, {1, 0, 0});
        const auto field =
            trace_receivers(stage.world(), std::vector{floor, wall}, {.bounces = 0, .samples = 2});
        REQUIRE(field);
        const double candela = 1000 / (4 * double{kPi}), m2 = double{metre} * double{metre};
        const double r2 = 5 * m2, height = 1.999, s2 = (1 + height * height) * m2;
        CHECK(luminance(field->values[0].direct) ==
              doctest::Approx(candela / r2 * 2 / std::sqrt(5.0)).epsilon(1e-5));
        CHECK(luminance(field->values[1].direct) ==
              doctest::Approx(candela / s2 / std::sqrt(1 + height * height)).epsilon(1e-5));
        CHECK(luminance(field->values[0].indirect) == 0);
        CHECK(field->bounces == 0);
    }
}

TEST_CASE("a furnace gives E = pi L / (1 - rho) everywhere") {
    const float L = 100;
    for (float rho : {0.2f, 0.5f, 0.8f}) {
        CAPTURE(rho);
        const Stage stage(scene_of(room(2), rho, L));
        const auto field =
            trace_receivers(stage.world(), over_walls(stage.surfaces, 8), {.samples = 256});
        REQUIRE(field);
        const double expected = double{kPi} * double{L} / (1 - double{rho});
        const Mean mean = mean_of(*field, [](const Irradiance& e) { return e.total(); });
        CAPTURE(mean.error);
        CHECK(mean.error < 0.003 * expected);
        CHECK(std::abs(mean.value - expected) < 4 * mean.error);
        // The first reflection brings rho times what arrives directly.
        const Mean direct = mean_of(*field, [](const Irradiance& e) { return e.direct; });
        CHECK(direct.value == doctest::Approx(double{kPi} * double{L}).epsilon(0.01));
    }
}

TEST_CASE("the mean indirect light of a closed room is flux / area * rho / (1 - rho)") {
    for (float rho : {0.2f, 0.5f, 0.8f}) {
        CAPTURE(rho);
        Scene scene = scene_of(room(4), rho);
        add_point_light(scene, {2, 2, 2}, 10000);
        const Stage stage(std::move(scene));
        const auto receivers = over_walls(stage.surfaces, 24);
        const auto field = trace_receivers(stage.world(), receivers, {.samples = 16, .seed = 7});
        REQUIRE(field);
        const double expected = 10000.0 / (6 * 16) * double{rho} / (1 - double{rho});
        const Mean mean = mean_of(*field, [](const Irradiance& e) { return e.indirect; });
        CAPTURE(mean.error);
        CHECK(mean.error < 0.005 * expected);
        CHECK(std::abs(mean.value - expected) < 4 * mean.error);
    }
}

TEST_CASE("N bounces give the first N terms of the furnace's series") {
    const float L = 100, rho = 0.5f;
    const Stage stage(scene_of(room(2), rho, L));
    const auto receivers = over_walls(stage.surfaces, 4);
    double expected = 0;
    for (int bounces = 0; bounces < 4; ++bounces) {
        CAPTURE(bounces);
        expected += double{kPi} * double{L} * std::pow(0.5, bounces);
        const auto field =
            trace_receivers(stage.world(), receivers, {.bounces = bounces, .samples = 64});
        REQUIRE(field);
        const Mean mean = mean_of(*field, [](const Irradiance& e) { return e.total(); });
        CHECK(mean.value == doctest::Approx(expected).epsilon(0.01));
        CHECK(field->bounces == bounces);
    }
}

TEST_CASE("a uniform sky gives pi L on open ground and half of it on a wall") {
    Scene scene = scene_of(ground(1e4f), 0);
    scene.sky = Sky{{50, 50, 50}, nullptr};
    const Stage stage(std::move(scene));
    const std::vector receivers = {sensor({0, 1, 0}, {0, 1, 0}), sensor({0, 1, 0}, {1, 0, 0}),
                                   sensor({0, 1, 0}, {0, -1, 0})};
    const auto field = trace_receivers(stage.world(), receivers, {.samples = 20000});
    REQUIRE(field);
    CHECK(luminance(field->values[0].direct) == doctest::Approx(50 * kPi).epsilon(1e-4));
    CHECK(luminance(field->values[1].direct) == doctest::Approx(25 * kPi).epsilon(0.02));
    CHECK(std::abs(luminance(field->values[1].direct) - 25 * kPi) < 4 * field->standard_error[1]);
    CHECK(luminance(field->values[2].direct) < 0.01f);
}

TEST_CASE("a sky image is weighted between sky sampling and cosine sampling without bias") {
    // North is ten times brighter than the south: E on a horizontal plane is pi times the mean.
    auto image = std::make_shared<Image>(64, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const float v = x >= 16 && x < 48 ? 100.0f : 10.0f;
            image->at(x, y) = {v, v, v};
        }
    Scene scene = scene_of(ground(0.01f), 0);
    scene.sky = Sky{{1, 1, 1}, image};
    const Stage stage(std::move(scene));
    REQUIRE(stage.lights.samples_sky());
    const auto seen_by = [&](const Receiver& receiver) {
        const std::vector<Receiver> same(32, receiver);
        const auto field = trace_receivers(stage.world(), same, {.bounces = 0, .samples = 20000});
        return mean_of(field.value(), [](const Irradiance& e) { return e.direct; });
    };
    const Mean up = seen_by(sensor({0, 1, 0}, {0, 1, 0}));
    CHECK(up.error < 1e-3 * 55 * double{kPi});
    CHECK(std::abs(up.value - 55 * double{kPi}) < 4 * up.error);
    const Mean north = seen_by(sensor({0, 1, 0}, {0, 0, -1}));
    CHECK(north.error < 1e-3 * 100 * double{kPi});
    CHECK(std::abs(north.value - 100 * double{kPi}) < 4 * north.error + 0.01);
}

TEST_CASE("the standard error says how far results scatter") {
    const Stage stage(scene_of(room(2), 0.5f, 100));
    const std::vector<Receiver> same(400, sensor({0.5f, 0, 0.7f}, {0, 1, 0}));
    const auto field = trace_receivers(stage.world(), same, {.samples = 40});
    REQUIRE(field);
    double sum = 0, squares = 0, claimed = 0;
    for (size_t i = 0; i < same.size(); ++i) {
        const double e = double{luminance(field->values[i].total())};
        sum += e;
        squares += e * e;
        claimed += double{field->standard_error[i]} * double{field->standard_error[i]};
    }
    const double n = static_cast<double>(same.size()), mean = sum / n;
    const double scatter = std::sqrt((squares - n * mean * mean) / (n - 1));
    CHECK(std::sqrt(claimed / n) == doctest::Approx(scatter).epsilon(0.1));
}

TEST_CASE("a texel holds the mean over its sample points") {
    Scene scene = scene_of(ground(1), 0);
    add_point_light(scene, {0, 1, 0}, 4 * kPi);  // 1 cd
    const Stage stage(std::move(scene));
    Texels texels;
    texels.width = texels.height = 1;
    texels.pixel_of = texels.element_at = {0};
    texels.first_sample = {0, 3};
    // The middle of the ground twice, at distance 1, and its corner, at distance sqrt(3).
    texels.samples = {{0, {0, 0.5f}}, {1, {0.5f, 0}}, {0, {0, 0}}};
    texels.area = {4};
    const auto field = trace_texels(stage.world(), texels, {.bounces = 0, .samples = 12});
    REQUIRE(field);
    const double expected = (1 + 1 + 1 / std::pow(3.0, 1.5)) / 3;
    CHECK(luminance(field->values[0].direct) == doctest::Approx(expected).epsilon(1e-4));
}

TEST_CASE("surfaces emit from the front and reflect from both sides") {
    // A ground that faces up, lit from below by a lamp under it: its underside lights the sensor.
    Scene scene = scene_of(ground(1e3f), 0.5f);
    add_point_light(scene, {0, -1, 0}, 1000);
    const Stage below(std::move(scene));
    const auto sensor_below = std::vector{sensor({0, -1, 0}, {0, 1, 0})};
    const auto field = trace_receivers(below.world(), sensor_below, {.samples = 20000});
    REQUIRE(field);
    // The plane at distance h receives I h / d^3 and shows rho / pi of it; seen from the lamp's own
    // place, the integral of that luminance over the plane is 2/5 rho I / h^2.
    const double expected = 0.4 * 0.5 * 1000 / (4 * double{kPi});
    const double indirect = double{luminance(field->values[0].indirect)};
    CHECK(field->standard_error[0] < 0.006 * expected);
    CHECK(std::abs(indirect - expected) < 4 * double{field->standard_error[0]});

    const Stage lamp(scene_of(ground(1), 0, 100));
    const std::vector both = {sensor({0, 1, 0}, {0, -1, 0}), sensor({0, -1, 0}, {0, 1, 0})};
    const auto lit = trace_receivers(lamp.world(), both, {.samples = 16});
    REQUIRE(lit);
    CHECK(luminance(lit->values[0].direct) > 100);
    CHECK(luminance(lit->values[1].direct) == 0);
}

TEST_CASE("an image of a furnace shows the same luminance everywhere") {
    const Stage stage(scene_of(room(2), 0.5f, 100));
    const auto camera = [](float x, float y) {
        return Ray{{1, 1, 1}, normalize(vec3{x / 8 - 0.5f, 0.5f - y / 8, -1})};
    };
    const auto image = trace_image(stage.world(), 8, 8, camera, {.samples = 256});
    REQUIRE(image);
    double sum = 0;
    for (vec3 pixel : image->pixels) sum += double{luminance(pixel)};
    CHECK(sum / 64 == doctest::Approx(100 / (1 - 0.5)).epsilon(0.01));
}

TEST_CASE("a surface lit by a lamp has the luminance rho / pi * E on either side") {
    Scene scene = scene_of(ground(1e-3f), 0.4f);
    add_point_light(scene, {0, 2, 0}, 4 * kPi * 100);   // 100 cd
    add_point_light(scene, {0, -1, 0}, 4 * kPi * 100);  // below
    const Stage stage(std::move(scene));
    const auto luminance_from = [&](float height) {
        const auto camera = [&](float, float) {
            return Ray{{0, height, 0}, {0, height > 0 ? -1.0f : 1.0f, 0}};
        };
        return trace_image(stage.world(), 1, 1, camera, {.bounces = 0, .samples = 3})->pixels[0].y;
    };
    CHECK(luminance_from(1) == doctest::Approx(0.4 / double{kPi} * 25).epsilon(1e-4));
    CHECK(luminance_from(-1) == doctest::Approx(0.4 / double{kPi} * 100).epsilon(1e-4));
}

TEST_CASE("camera rays that leave the scene see the sky") {
    Scene scene = scene_of(ground(1), 0.5f);
    scene.sky = Sky{{3, 5, 7}, nullptr};
    const Stage stage(std::move(scene));
    const auto up = [](float, float) { return Ray{{0, 1, 0}, {0, 1, 0}}; };
    const auto image = trace_image(stage.world(), 2, 2, up, {.samples = 4});
    REQUIRE(image);
    CHECK(image->at(1, 1).x == doctest::Approx(3));
    CHECK(image->at(1, 1).z == doctest::Approx(7));
}

TEST_CASE("results have the same bits for one thread and for two") {
    const Stage stage(scene_of(room(2), 0.7f, 100));
    const auto receivers = over_walls(stage.surfaces, 4);
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        return trace_receivers(stage.world(), receivers, {.samples = 20, .seed = 3}).value();
    };
    const IrradianceField one = run(1), two = run(2);
    CHECK(one.ray_count == two.ray_count);
    CHECK(one.standard_error == two.standard_error);
    bool same = true;
    for (size_t i = 0; i < receivers.size(); ++i)
        same = same && one.values[i].direct == two.values[i].direct &&
               one.values[i].indirect == two.values[i].indirect;
    CHECK(same);
}

TEST_CASE("bad options and interruption are errors") {
    const Stage stage(scene_of(room(2), 0.5f, 100));
    const auto receivers = over_walls(stage.surfaces, 1);
    const auto code = [&](const PathOptions& options, const Monitor& monitor = {}) {
        return trace_receivers(stage.world(), receivers, options, monitor).error().code;
    };
    CHECK(code({.samples = 0}) == Errc::bad_argument);
    CHECK(code({.bounces = -2}) == Errc::bad_argument);
    std::atomic<bool> cancel = true;
    CHECK(code({.samples = 4}, {.report = {}, .cancel = &cancel}) == Errc::cancelled);
}
