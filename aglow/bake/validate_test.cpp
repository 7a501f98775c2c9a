// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/validate.h"

#include "aglow/bake/validate/closed_forms.h"
#include "aglow/bake/validate/experiment.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace aglow;
using namespace aglow::validation;

namespace {

/// Mean over the unit square y = 0 of the factor to a rectangle, by quadrature.
double mean_factor(Point corner, Point u, Point v) {
    const Quadrature q;
    double sum = 0;
    for (size_t i = 0; i < q.node.size(); ++i)
        for (size_t j = 0; j < q.node.size(); ++j) {
            const Point at{(1 + q.node[i]) / 2, 0, (1 + q.node[j]) / 2};
            sum += q.weight[i] * q.weight[j] / 4 * rectangle_factor(at, {0, 1, 0}, corner, u, v);
        }
    return sum;
}

/// Every case of a group lies within `bound` of its expected value.
void check_group(const ValidationOptions& options, double bound) {
    const auto cases = validate(options);
    REQUIRE(cases.has_value());
    for (const ValidationCase& c : *cases) {
        CAPTURE(c.name);
        CAPTURE(c.quantity);
        CAPTURE(c.scale);
        CAPTURE(c.expected);
        CAPTURE(c.measured);
        CHECK(std::fabs(c.error) < bound);
    }
}

}  // namespace

TEST_CASE("the polygon formula and the corner formulas agree") {
    for (double w : {0.1, 1.0, 7.0})
        for (double h : {0.2, 1.0, 5.0}) {
            CAPTURE(w);
            CAPTURE(h);
            CHECK(rectangle_factor({0, 0, 0}, {0, 1, 0}, {0, h, 0}, {w, 0, 0}, {0, 0, 2}) ==
                  doctest::Approx(corner_parallel(w, 2, h)).epsilon(1e-9));
            CHECK(rectangle_factor({0, 0, 0}, {0, 1, 0}, {h, 0, 0}, {0, 0, w}, {0, 3, 0}) ==
                  doctest::Approx(corner_perpendicular(w, 3, h)).epsilon(1e-9));
        }
}

TEST_CASE("a sensor in a box sees nothing but the box") {
    const Point at{0.3, 0.2, -0.1}, n = unit({0.3, 0.8, 0.5});
    const Point lo{-1, -1, -1}, x{2, 0, 0}, y{0, 2, 0}, z{0, 0, 2};
    double sum = 0;
    for (const auto& [corner, u, v] : {std::array{lo, x, y},
                                       {lo, y, z},
                                       {lo, z, x},
                                       {lo + x, y, z},
                                       {lo + y, z, x},
                                       {lo + z, x, y}})
        sum += rectangle_factor(at, n, corner, u, v);
    CHECK(sum == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("factors between unit squares are the published ones") {
    CHECK(facing_rectangles(1, 1, 1) == doctest::Approx(0.199825).epsilon(3e-6));
    CHECK(adjoining_rectangles(1, 1, 1) == doctest::Approx(0.200044).epsilon(3e-6));
    CHECK(mean_factor({0, 1, 0}, {1, 0, 0}, {0, 0, 1}) ==
          doctest::Approx(facing_rectangles(1, 1, 1)).epsilon(1e-9));
    CHECK(mean_factor({0, 0, 0}, {0, 2, 0}, {0, 0, 1}) ==
          doctest::Approx(adjoining_rectangles(2, 1, 1)).epsilon(1e-3));
}

TEST_CASE("the flux of a spot is the integral of its falloff") {
    const double inner = 0.3, outer = 0.7;
    double sum = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double angle = (i + 0.5) / steps * outer;
        sum += spot_falloff(angle, inner, outer) * 2 * validation::kPi * std::sin(angle) * outer /
               steps;
    }
    CHECK(sum == doctest::Approx(spot_flux(inner, outer)).epsilon(1e-6));
}

TEST_CASE("light in the cube has the values of an independent solution") {
    // Published solutions by discretised radiosity, four digits.
    CHECK(cube_indirect(10000, 0.2).face_centre == doctest::Approx(28.87).epsilon(1e-3));
    CHECK(cube_indirect(10000, 0.5).face_centre == doctest::Approx(112.05).epsilon(1e-3));
    CHECK(cube_indirect(10000, 0.8).face_centre == doctest::Approx(431.2).epsilon(1e-3));
    for (double rho : {0.2, 0.5, 0.8})
        CHECK(cube_indirect(10000, rho).mean ==
              doctest::Approx(10000.0 / 96 * rho / (1 - rho)).epsilon(1e-9));
}

TEST_CASE("scaling a scene keeps a point light's illuminance") {
    Scene scene;
    add_rectangle(scene, add_grey(scene, 0.5f), {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    add_light(scene, {.name = "lamp", .kind = LightKind::point, .intensity = {100, 100, 100}},
              {0, 2, 0});
    scale_scene(scene, 1000);
    const float height = scene.nodes[1].translation.y;
    CHECK(height == doctest::Approx(2000));
    CHECK(scene.lights[0].intensity.x / (height * height) == doctest::Approx(25));
    CHECK(scene.meshes[0].primitives[0].positions[2].x == doctest::Approx(1000));
}

TEST_CASE("boxes show their fronts to the side asked for, and enclose their volume") {
    for (Facing facing : {Facing::inwards, Facing::outwards}) {
        Scene scene;
        add_box(scene, add_grey(scene, 0.5f), {1, 2, 3}, {2, 4, 6}, facing);
        const Primitive& box = scene.meshes[0].primitives[0];
        float volume = 0;
        for (uvec3 t : box.triangles)
            volume += dot(box.positions[t.x], cross(box.positions[t.y], box.positions[t.z])) / 6;
        CHECK(volume == doctest::Approx(facing == Facing::outwards ? 6 : -6));
    }
}

TEST_CASE("a light's node turns -Z to where the light shines") {
    for (vec3 direction : {vec3{0, -1, 0}, vec3{0, 0, 1}, vec3{0, 0, -1}, vec3{0.6f, 0, 0.8f}}) {
        Scene scene;
        add_light(scene, {}, {1, 2, 3}, direction);
        const Node& node = scene.nodes[0];
        const vec3 shines =
            transform_direction(compose(node.translation, node.rotation, node.scale), {0, 0, -1});
        CHECK(length(shines - direction) == doctest::Approx(0).epsilon(1e-6));
    }
}

TEST_CASE("a filter that leaves nothing and a scale of zero are errors") {
    CHECK(validate({.filter = "no such case"}).error().code == Errc::bad_argument);
    CHECK(validate({.scales = {0}, .filter = "sun"}).error().code == Errc::bad_argument);
}

TEST_CASE("light from the punctual kinds agrees with closed forms in every unit of length") {
    for (const char* group : {"point light: ", "spot: ", "directional: ", "sun: "})
        check_group({.quality = Quality::draft, .scales = {0.001, 1000}, .filter = group}, 2e-4);
}

TEST_CASE("direct light from areas agrees with closed forms") {
    for (const char* group : {"area source", "square to square", "uniform sky: over",
                              "uniform sky: beside", "sky image"})
        check_group({.quality = Quality::draft, .scales = {1}, .filter = group}, 0.0075);
}

TEST_CASE("light in closed rooms agrees with closed forms") {
    for (const char* group :
         {"furnace: rho = 0.5", "cube 4 m, 10 klm: rho = 0.8", "flux balance: point light"})
        check_group({.quality = Quality::medium, .scales = {1}, .filter = group}, 0.0075);
}

TEST_CASE("no light arrives where none can") {
    const auto cases = validate({.quality = Quality::draft, .scales = {1}, .filter = "darkness"});
    REQUIRE(cases.has_value());
    for (const ValidationCase& c : *cases) {
        CAPTURE(c.name);
        CAPTURE(c.quantity);
        CAPTURE(c.scale);
        CHECK(c.measured == 0);
    }
}

TEST_CASE("reports hold every case and count those beyond their bounds") {
    ValidationCase good{.group = "g",
                        .name = "n",
                        .quantity = "E",
                        .unit = "lx",
                        .source = "s",
                        .expected = 100,
                        .measured = 100.1,
                        .error = 0.001,
                        .tolerance = 0.005};
    ValidationCase bad = good;
    bad.scale = 1000;
    bad.measured = 90;
    bad.error = -0.1;
    const std::vector<ValidationCase> cases = {good, bad};
    const auto json = nlohmann::json::parse(validation_json(cases));
    CHECK(json["failed"] == 1);
    CHECK(json["passed"] == false);
    CHECK(json["worst_error"] == doctest::Approx(0.1));
    CHECK(json["cases"].size() == 2);
    CHECK(validation_table(cases).find("1 of 2 cases") != std::string::npos);
    const std::string page = validation_markdown(
        cases, {.command = "aglow validate", .date = "2026-01-01", .device = "cpu"});
    CHECK(page.find("| n | E | s | 100 lx | 100.1 | +0.100 % | 90 | -10.000 % **beyond** |") !=
          std::string::npos);
}
