// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/scene.h"

#include <doctest/doctest.h>
#include <cmath>

using namespace aglow;

namespace {

/// Direction that the light of node `i` shines in.
vec3 shines(const Scene& scene, size_t i) {
    return transform_direction(world_transforms(scene)[i], {0, 0, -1});
}

}  // namespace

TEST_CASE("a point light of 4 pi lumen has one candela in every channel") {
    Scene scene;
    add_point_light(scene, {1, 2, 3}, 12.566371f);
    REQUIRE(scene.lights.size() == 1);
    REQUIRE(scene.nodes.size() == 1);
    CHECK(scene.lights[0].kind == LightKind::point);
    CHECK(luminance(scene.lights[0].intensity) == doctest::Approx(1).epsilon(1e-6));
    CHECK(scene.lights[0].intensity.x == scene.lights[0].intensity.z);
    CHECK(scene.nodes[0].light == 0);
    CHECK(scene.nodes[0].parent == -1);
    CHECK(scene.nodes[0].in_scene);
    CHECK(scene.nodes[0].translation == vec3{1, 2, 3});
}

TEST_CASE("the sun stands where azimuth and elevation say") {
    struct Case {
        float azimuth, elevation;
        vec3 towards;  // the sun
    };
    const float s = std::sqrt(0.5f);
    const Case cases[] = {
        {0, 0, {0, 0, -1}},   {90, 0, {1, 0, 0}},  {180, 0, {0, 0, 1}}, {270, 0, {-1, 0, 0}},
        {123, 90, {0, 1, 0}}, {90, 45, {s, s, 0}}, {45, 0, {s, 0, -s}},
    };
    for (const Case& c : cases) {
        CAPTURE(c.azimuth);
        CAPTURE(c.elevation);
        Scene scene;
        add_sun(scene, c.azimuth, c.elevation, 50000);
        const vec3 error = shines(scene, 0) + c.towards;
        CHECK(length(error) < 1e-6f);
        CHECK(scene.lights[0].kind == LightKind::directional);
        CHECK(luminance(scene.lights[0].intensity) == doctest::Approx(50000).epsilon(1e-6));
    }
}

TEST_CASE("clay is grey and opaque everywhere, and keeps what emits") {
    Scene scene;
    Material lamp;
    lamp.base_color = {1, 0, 0, 0.5f};
    lamp.base_color_texture.texture = 0;
    lamp.metallic_roughness_texture.texture = 0;
    lamp.emission = {10, 20, 30};
    lamp.emissive_texture.texture = 0;
    lamp.alpha_mode = AlphaMode::blend;
    lamp.double_sided = true;
    scene.materials.push_back(lamp);
    Mesh mesh;
    mesh.primitives.resize(2);
    mesh.primitives[0].material = 0;
    mesh.primitives[0].colors = {{0, 1, 0, 1}};
    mesh.primitives[1].material = -1;  // the default material is white, which is not clay
    scene.meshes.push_back(mesh);

    apply_clay(scene, 0.4f);
    for (const Primitive& primitive : scene.meshes[0].primitives) {
        REQUIRE(primitive.material >= 0);
        const Material& clay = scene.materials[static_cast<size_t>(primitive.material)];
        CHECK(clay.base_color == vec4{0.4f, 0.4f, 0.4f, 1});
        CHECK(clay.metallic == 0);
        CHECK(clay.base_color_texture.texture == -1);
        CHECK(clay.metallic_roughness_texture.texture == -1);
        CHECK(clay.alpha_mode == AlphaMode::opaque);
        CHECK(primitive.colors.empty());
    }
    CHECK(scene.materials[0].emission == vec3{10, 20, 30});
    CHECK(scene.materials[0].emissive_texture.texture == 0);
    CHECK(scene.materials[0].double_sided);
    CHECK(scene.materials[1].emission == vec3{0, 0, 0});
}
