// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/surfaces.h"

#include "aglow/mesh/testing/meshes.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::mesh::testing;

namespace {

void check_near(vec3 found, vec3 expected, float tolerance = 1e-5f) {
    CAPTURE(found.x);
    CAPTURE(found.y);
    CAPTURE(found.z);
    CHECK(length(found - expected) <= tolerance);
}

/// The quad with a material: what the reflectance tests start from.
Scene painted_quad(const Material& material) {
    Primitive quad = unit_quad();
    quad.material = 0;
    Scene scene = scene_of({quad});
    scene.materials.push_back(material);
    return scene;
}

constexpr SurfacePoint kMiddle{0, {0.25f, 0.5f}};

}  // namespace

TEST_CASE("a mirrored node keeps its triangles counter-clockwise from the front") {
    Primitive quad = unit_quad();
    const Surfaces s = pose(scene_of({quad}, {scaling({-2, 3, 1}), scaling({1, 1, -1})}));
    REQUIRE(s.triangles.size() == 4);
    for (uint32_t t : {0u, 1u}) check_near(geometric_normal(s, t), {0, 0, 1});
    for (uint32_t t : {2u, 3u}) check_near(geometric_normal(s, t), {0, 0, -1});
    for (uint32_t t = 0; t < 4; ++t)
        check_near(shading_normal(s, {t, {0.2f, 0.3f}}), geometric_normal(s, t));
    CHECK(area(s, 0) + area(s, 1) == doctest::Approx(6.0).epsilon(1e-6));
}

TEST_CASE("normals stay perpendicular under non-uniform scale") {
    // The plane x + y = 1 scaled by (4, 1, 1) has the normal (1/4, 1, 0) up to length.
    Primitive slope = primitive({{1, 0, 0}, {0, 1, 0}, {0, 1, -1}}, {{0, 2, 1}});
    slope.normals.assign(3, vec3{0.70710678f, 0.70710678f, 0});
    const Surfaces s = pose(scene_of({slope}, {scaling({4, 1, 1})}));
    const vec3 expected = normalize(vec3{0.25f, 1, 0});
    check_near(shading_normal(s, {0, {0.3f, 0.3f}}), expected);
    check_near(geometric_normal(s, 0), expected);
}

TEST_CASE("instances are placed relative to their node, in order") {
    Scene scene = scene_of({unit_quad()}, {translation({10, 0, 0})});
    scene.nodes[0].instances = {translation({0, 5, 0}), scaling({2, 2, 2})};
    const Surfaces s = pose(scene);
    REQUIRE(s.parts.size() == 2);
    CHECK(s.parts[1].instance == 1);
    check_near(s.corner(0, 0), {10, 5, 0});
    check_near(s.corner(3, 1), {12, 2, 0});
}

TEST_CASE("nodes outside the active scene are left out") {
    Scene scene = scene_of({unit_quad()}, {mat4{}, mat4{}});
    scene.nodes[0].in_scene = false;
    CHECK(pose(scene).parts.size() == 1);
}

TEST_CASE("a skinned vertex is the weighted mean of where its joints would move it") {
    Primitive quad = unit_quad();
    quad.influences = 4;
    quad.joints.assign(16, 0);
    quad.weights.assign(16, 0);
    for (size_t v = 0; v < 4; ++v) {
        quad.joints[4 * v + 1] = 1;
        quad.weights[4 * v] = 0.25f;
        quad.weights[4 * v + 1] = 0.75f;
    }
    // The mesh's own node is ignored; the second joint turns by 90 degrees about Z and moves by 4.
    Scene scene = scene_of({quad}, {translation({100, 0, 0})});
    scene.nodes[0].skin = 0;
    Node joint;
    scene.nodes.push_back(joint);
    joint.translation = {4, 0, 0};
    joint.rotation = {0, 0, std::sqrt(0.5f), std::sqrt(0.5f)};
    scene.nodes.push_back(joint);
    scene.skins.push_back({{1, 2}, {mat4{}, translation({-1, 0, 0})}});
    const Surfaces s = pose(scene);
    // v: 1/4 v + 3/4 (R (v - x) + 4 x), with R (x, y) = (-y, x).
    for (uint32_t v = 0; v < 4; ++v) {
        const vec3 p = quad.positions[v];
        const double x = 0.25 * double(p.x) + 0.75 * (4 - double(p.y));
        const double y = 0.25 * double(p.y) + 0.75 * (double(p.x) - 1);
        check_near(s.positions[v], {float(x), float(y), 0});
    }
}

TEST_CASE("morph targets follow animated weights in all three interpolations") {
    Primitive quad = unit_quad();
    quad.targets.resize(2);
    quad.targets[0].positions.assign(4, vec3{1, 0, 0});
    quad.targets[1].positions.assign(4, vec3{0, 0, 2});
    Scene scene = scene_of({quad});
    scene.meshes[0].weights = {0.5f, 0.25f};
    check_near(pose(scene).positions[0], {0.5f, 0, 0.5f});

    AnimationChannel channel{0, Path::weights, Interpolation::linear, {1, 3}, {0, 1, 1, 0}};
    const auto posed_at = [&](double time) {
        scene.animations = {{"wave", {channel}}};
        return pose(scene, time).positions[0];
    };
    check_near(posed_at(1.5), {0.25f, 0, 1.5f});
    check_near(posed_at(0), {0, 0, 2});
    check_near(posed_at(9), {1, 0, 0});
    channel.interpolation = Interpolation::step;
    check_near(posed_at(2.9), {0, 0, 2});
    // Cubic: p0 = 0, p1 = 1, out-tangent 0.6 /s, in-tangent -0.2 /s over 2 s, at a quarter:
    // h(t) = (3t^2 - 2t^3) + 2 s (0.6 (t^3 - 2t^2 + t) - 0.2 (t^3 - t^2)) = 0.34375
    channel.interpolation = Interpolation::cubic_spline;
    channel.values = {0, 0, 0, 0, 0.6f, 0, -0.2f, 0, 1, 0, 0, 0};
    check_near(posed_at(1.5), {0.34375f, 0, 0});
}

TEST_CASE("metal reflects no diffuse light and nothing reflects all") {
    Material material;
    material.base_color = {0.8f, 0.4f, 1.0f, 1};
    material.metallic = 0.25f;
    Scene scene = painted_quad(material);
    check_near(diffuse_reflectance(scene, pose(scene), kMiddle), {0.6f, 0.3f, 0.75f});
    scene.materials[0].metallic = 0;
    check_near(diffuse_reflectance(scene, pose(scene), kMiddle), {0.8f, 0.4f, kMaxReflectance});
    scene.meshes[0].primitives[0].material = -1;
    check_near(diffuse_reflectance(scene, pose(scene), kMiddle), vec3{1, 1, 1} * kMaxReflectance);
}

TEST_CASE("vertex colours are interpolated and multiply the base colour") {
    Material material;
    material.base_color = {0.5f, 1, 1, 1};
    Scene scene = painted_quad(material);
    scene.meshes[0].primitives[0].colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {0, 0, 0, 1}};
    check_near(base_color(scene, pose(scene), kMiddle), {0.125f, 0.25f, 0.5f});
}

TEST_CASE("textures are read at the interpolated coordinate of their own set") {
    Material material;
    material.metallic_roughness_texture = {0, 1};
    Scene scene = painted_quad(material);
    // Two texels, blue 0 and 51: metallic 0 on the left and 0.2 on the right.
    scene.images.push_back({"m", 2, 1, {0, 0, 0, 255, 0, 0, 51, 255}});
    scene.textures.push_back({0, Wrap::repeat, Wrap::repeat, Filter::nearest});
    Primitive& quad = scene.meshes[0].primitives[0];
    quad.texcoords = {std::vector<vec2>(4, vec2{0, 0}), {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const Surfaces s = pose(scene);
    check_near(diffuse_reflectance(scene, s, {0, {0.1f, 0.1f}}), vec3{1, 1, 1} * kMaxReflectance);
    check_near(diffuse_reflectance(scene, s, {0, {0.5f, 0.4f}}), {0.8f, 0.8f, 0.8f});
}

TEST_CASE("alpha counts as the alpha mode says") {
    Material material;
    material.base_color = {1, 1, 1, 0.4f};
    Scene scene = painted_quad(material);
    const auto opacity_in = [&](AlphaMode mode) {
        scene.materials[0].alpha_mode = mode;
        return opacity(scene, pose(scene), kMiddle);
    };
    CHECK(opacity_in(AlphaMode::opaque) == 1.0f);
    CHECK(opacity_in(AlphaMode::mask) == 0.0f);
    CHECK(opacity_in(AlphaMode::blend) == doctest::Approx(0.4));
    scene.materials[0].alpha_cutoff = 0.4f;
    CHECK(opacity_in(AlphaMode::mask) == 1.0f);
}

TEST_CASE("unlit surfaces reflect their base colour and do not emit") {
    Material material;
    material.base_color = {0.5f, 0.5f, 0.5f, 1};
    material.emission = {7, 8, 9};
    Scene scene = painted_quad(material);
    check_near(emitted_luminance(scene, pose(scene), kMiddle), {7, 8, 9});
    check_near(diffuse_reflectance(scene, pose(scene), kMiddle), {0, 0, 0});
    scene.materials[0].unlit = true;
    check_near(emitted_luminance(scene, pose(scene), kMiddle), {0, 0, 0});
    check_near(diffuse_reflectance(scene, pose(scene), kMiddle), {0.5f, 0.5f, 0.5f});
}
