// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin.h"
#include "aglow/scene/load.h"
#include "aglow/scene/photometry.h"
#include "aglow/scene/write.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

using namespace aglow;

namespace {

Scene reloaded(const Scene& scene) {
    const auto glb = to_glb(scene);
    REQUIRE(glb);
    auto loaded = load_gltf(std::as_bytes(std::span(*glb)), "test.glb", {});
    REQUIRE(loaded);
    return std::move(*loaded);
}

Primitive one_triangle() {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.normals.assign(3, {0, 0, 1});
    p.triangles = {{0, 1, 2}};
    return p;
}

/// Something of all that a scene made by code can hold.
Scene varied_scene() {
    Scene scene;
    scene.name = "varied";
    scene.images.push_back({"checks", 2, 1, {255, 0, 10, 255, 1, 2, 3, 77}});
    scene.textures.push_back({0, Wrap::mirrored_repeat, Wrap::clamp_to_edge, Filter::nearest});
    scene.textures.push_back({0, Wrap::repeat, Wrap::repeat, Filter::linear});

    Material painted;
    painted.name = "painted \"x\"";
    painted.base_color = {0.1f, 0.2f, 0.3f, 0.4f};
    painted.metallic = 0.25f;
    painted.roughness = 0.75f;
    painted.base_color_texture = {1, 1, {0.5f, 0.25f}, {2, 3}, 0.7f};
    painted.metallic_roughness_texture.texture = 0;
    painted.alpha_mode = AlphaMode::mask;
    painted.alpha_cutoff = 0.3f;
    painted.double_sided = true;
    Material lamp;
    lamp.name = "lamp";
    lamp.emission = {1000, 250, 3};
    lamp.emissive_texture.texture = 0;
    Material glow;
    glow.emission = {0.5f, 0.25f, 0};
    glow.alpha_mode = AlphaMode::blend;
    Material sign;
    sign.unlit = true;
    scene.materials = {painted, lamp, glow, sign};

    Primitive rich = one_triangle();
    rich.material = 0;
    rich.texcoords = {{{0, 0}, {1, 0}, {0, 1}}, {{0.5f, 0}, {2, 3}, {-4, 5}}};
    rich.colors = {{1, 0, 0, 1}, {0, 1, 0, 0.5f}, {0, 0, 1, 0}};
    rich.sharpness = {0, 0.5f, 1};
    rich.tension = {1, 2, 3};
    rich.bias = {-1, 0, 0.25f};
    rich.creases = {{0, 1, 2.5f}, {2, 0, 10}};
    rich.corners = {{2, 0.1f}};
    Primitive plain = one_triangle();
    plain.material = -1;
    scene.meshes.push_back({"mesh", {rich, plain}, {}});

    scene.cameras.push_back({"eye", true, 0.9f, 1.5f, 1, 1, 0.02f});
    scene.cameras.push_back({"map", false, 0.8f, 0, 3, 2, 0.1f});
    scene.lights.push_back({"bulb", LightKind::point, {100, 50, 25}, 7});
    scene.lights.push_back({"spot", LightKind::spot, {5, 5, 5}, kInfinity, 0.2f, 0.6f});
    scene.lights.push_back({"sun", LightKind::directional, {20'000, 20'000, 19'000}});

    scene.nodes.resize(6);
    scene.nodes[0].name = "root";
    scene.nodes[0].children = {1, 2};
    scene.nodes[0].translation = {1, 2, 3};
    scene.nodes[0].rotation = {0, 0.6f, 0, 0.8f};
    scene.nodes[0].scale = {1, -2, 3};
    scene.nodes[1].parent = scene.nodes[2].parent = 0;
    scene.nodes[1].mesh = 0;
    scene.nodes[2].light = 1;
    scene.nodes[2].has_matrix = true;
    scene.nodes[2].matrix = translation({4, 5, 6});
    scene.nodes[3].camera = 0;
    scene.nodes[3].light = 0;
    scene.nodes[4].camera = 1;
    scene.nodes[5].light = 2;
    return scene;
}

void check_same(const TextureRef& a, const TextureRef& b) {
    CHECK(a.texture == b.texture);
    CHECK(a.texcoord == b.texcoord);
    CHECK(a.offset == b.offset);
    CHECK(a.scale == b.scale);
    CHECK(a.rotation == b.rotation);
}

void check_near(vec3 a, vec3 b) {
    CHECK(a.x == doctest::Approx(b.x).epsilon(1e-6));
    CHECK(a.y == doctest::Approx(b.y).epsilon(1e-6));
    CHECK(a.z == doctest::Approx(b.z).epsilon(1e-6));
}

void check_same(const Material& a, const Material& b) {
    CHECK(a.name == b.name);
    CHECK(a.base_color == b.base_color);
    CHECK(a.metallic == b.metallic);
    CHECK(a.roughness == b.roughness);
    check_same(a.base_color_texture, b.base_color_texture);
    check_same(a.metallic_roughness_texture, b.metallic_roughness_texture);
    check_same(a.emissive_texture, b.emissive_texture);
    check_near(a.emission, b.emission);
    CHECK(a.alpha_mode == b.alpha_mode);
    CHECK(a.alpha_cutoff == b.alpha_cutoff);
    CHECK(a.double_sided == b.double_sided);
    CHECK(a.unlit == b.unlit);
}

void check_same(const Primitive& a, const Primitive& b) {
    CHECK(a.material == b.material);
    CHECK(a.triangles == b.triangles);
    CHECK(a.positions == b.positions);
    REQUIRE(a.normals.size() == b.normals.size());
    float turned = 0;  // loading makes unit vectors of them, which may change their last bits
    for (size_t i = 0; i < a.normals.size(); ++i)
        turned = std::max(turned, length(a.normals[i] - b.normals[i]));
    CHECK(turned < 1e-6f);
    CHECK(a.texcoords == b.texcoords);
    CHECK(a.colors == b.colors);
    CHECK(a.sharpness == b.sharpness);
    CHECK(a.tension == b.tension);
    CHECK(a.bias == b.bias);
    CHECK(a.creases == b.creases);
    CHECK(a.corners == b.corners);
    CHECK(a.influences == b.influences);
    CHECK(a.joints == b.joints);
    CHECK(a.weights == b.weights);
    REQUIRE(a.targets.size() == b.targets.size());
    for (size_t i = 0; i < a.targets.size(); ++i) {
        CHECK(a.targets[i].positions == b.targets[i].positions);
        CHECK(a.targets[i].normals == b.targets[i].normals);
    }
}

void check_same(const Animation& a, const Animation& b) {
    CHECK(a.name == b.name);
    REQUIRE(a.channels.size() == b.channels.size());
    for (size_t i = 0; i < a.channels.size(); ++i) {
        CHECK(a.channels[i].node == b.channels[i].node);
        CHECK(a.channels[i].path == b.channels[i].path);
        CHECK(a.channels[i].interpolation == b.channels[i].interpolation);
        CHECK(a.channels[i].times == b.channels[i].times);
        CHECK(a.channels[i].values == b.channels[i].values);
    }
}

void check_same(const Node& a, const Node& b) {
    CHECK(a.name == b.name);
    CHECK(a.parent == b.parent);
    CHECK(a.children == b.children);
    CHECK(a.has_matrix == b.has_matrix);
    CHECK(a.matrix == b.matrix);
    CHECK(a.translation == b.translation);
    CHECK(a.rotation == b.rotation);
    CHECK(a.scale == b.scale);
    CHECK(a.mesh == b.mesh);
    CHECK(a.skin == b.skin);
    CHECK(a.weights == b.weights);
    CHECK(a.camera == b.camera);
    CHECK(a.light == b.light);
    CHECK(a.in_scene == b.in_scene);
}

}  // namespace

TEST_CASE("meshes, nodes and materials come back from a GLB as they were") {
    const Scene scene = varied_scene(), back = reloaded(scene);
    REQUIRE(back.meshes.size() == scene.meshes.size());
    CHECK(back.meshes[0].name == "mesh");
    REQUIRE(back.meshes[0].primitives.size() == 2);
    for (size_t i = 0; i < 2; ++i)
        check_same(back.meshes[0].primitives[i], scene.meshes[0].primitives[i]);
    REQUIRE(back.nodes.size() == scene.nodes.size());
    for (size_t i = 0; i < scene.nodes.size(); ++i) check_same(back.nodes[i], scene.nodes[i]);
    REQUIRE(back.materials.size() == scene.materials.size());
    for (size_t i = 0; i < scene.materials.size(); ++i)
        check_same(back.materials[i], scene.materials[i]);
}

TEST_CASE("textures, cameras and lights come back from a GLB as they were") {
    const Scene scene = varied_scene(), back = reloaded(scene);
    REQUIRE(back.images.size() == 1);
    CHECK(back.images[0].name == "checks");
    CHECK(back.images[0].rgba == scene.images[0].rgba);
    REQUIRE(back.textures.size() == 2);
    for (size_t i = 0; i < 2; ++i) {
        CHECK(back.textures[i].image == scene.textures[i].image);
        CHECK(back.textures[i].wrap_s == scene.textures[i].wrap_s);
        CHECK(back.textures[i].wrap_t == scene.textures[i].wrap_t);
        CHECK(back.textures[i].filter == scene.textures[i].filter);
    }
    REQUIRE(back.cameras.size() == 2);
    CHECK(back.cameras[0].name == "eye");
    CHECK(back.cameras[0].y_fov == 0.9f);
    CHECK(back.cameras[0].aspect == 1.5f);
    CHECK_FALSE(back.cameras[1].perspective);
    CHECK(back.cameras[1].x_mag == 3);
    CHECK(back.cameras[1].y_mag == 2);
    REQUIRE(back.lights.size() == 3);
    for (size_t i = 0; i < 3; ++i) {
        CHECK(back.lights[i].name == scene.lights[i].name);
        CHECK(back.lights[i].kind == scene.lights[i].kind);
        CHECK(back.lights[i].range == scene.lights[i].range);
        check_near(back.lights[i].intensity, scene.lights[i].intensity);
    }
    CHECK(back.lights[1].inner_cone == 0.2f);
    CHECK(back.lights[1].outer_cone == 0.6f);
}

TEST_CASE("built-in scenes come back from a GLB triangle by triangle, without warnings") {
    for (const char* name : {"cornell-box", "corridor", "cube-tc58", "living-room", "walker",
                             "marbles", "toys", "forest", "scatter", "cad:5000"}) {
        CAPTURE(name);
        const Scene scene = *builtin_scene(name), back = reloaded(scene);
        CHECK(back.warnings.empty());
        REQUIRE(back.meshes.size() == scene.meshes.size());
        for (size_t i = 0; i < scene.meshes.size(); ++i) {
            CHECK(back.meshes[i].name == scene.meshes[i].name);
            REQUIRE(back.meshes[i].primitives.size() == scene.meshes[i].primitives.size());
            for (size_t k = 0; k < scene.meshes[i].primitives.size(); ++k)
                check_same(back.meshes[i].primitives[k], scene.meshes[i].primitives[k]);
        }
        REQUIRE(back.materials.size() == scene.materials.size());
        for (size_t i = 0; i < scene.materials.size(); ++i)
            check_same(back.materials[i], scene.materials[i]);
        REQUIRE(back.animations.size() == scene.animations.size());
        for (size_t i = 0; i < scene.animations.size(); ++i)
            check_same(back.animations[i], scene.animations[i]);
    }
}

TEST_CASE("skins, morph targets and animations come back from a GLB as they were") {
    Scene scene = varied_scene();
    Primitive& rigged = scene.meshes[0].primitives[0];
    rigged.influences = 8;
    for (uint32_t i = 0; i < 24; ++i) {
        rigged.joints.push_back(i % 2);
        rigged.weights.push_back(0.125f);
    }
    for (Primitive& primitive : scene.meshes[0].primitives) {
        primitive.targets.resize(2);
        primitive.targets[0].positions = {{1, 2, 3}, {-4, 5, 6}, {7, 8, -9}};
        primitive.targets[1].normals = {{0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}};
    }
    scene.meshes[0].weights = {0.25f, 0.5f};
    scene.nodes[1].weights = {1, 0};
    scene.nodes[1].skin = 0;
    scene.skins.push_back({{3, 4}, {translation({1, 2, 3}), translation({4, 5, 6})}});
    Animation animation{"dance", {}};
    animation.channels.push_back(
        {3, Path::translation, Interpolation::step, {0, 1}, {0, 0, 0, 1, 2, 3}});
    animation.channels.push_back(
        {4, Path::rotation, Interpolation::linear, {0, 1}, {0, 0, 0, 1, 0, 1, 0, 0}});
    animation.channels.push_back(
        {3, Path::scale, Interpolation::cubic_spline, {0.5f}, {0, 0, 0, 1, 1, 1, 0, 0, 0}});
    animation.channels.push_back(
        {1, Path::weights, Interpolation::linear, {0, 2, 3}, {0, 1, 1, 0, 0.5f, 0.5f}});
    scene.animations.push_back(animation);

    const Scene back = reloaded(scene);
    CHECK(back.warnings.empty());
    for (size_t i = 0; i < 2; ++i)
        check_same(back.meshes[0].primitives[i], scene.meshes[0].primitives[i]);
    CHECK(back.meshes[0].weights == scene.meshes[0].weights);
    for (size_t i = 0; i < scene.nodes.size(); ++i) check_same(back.nodes[i], scene.nodes[i]);
    REQUIRE(back.skins.size() == 1);
    CHECK(back.skins[0].joints == scene.skins[0].joints);
    CHECK(back.skins[0].inverse_bind == scene.skins[0].inverse_bind);
    REQUIRE(back.animations.size() == 1);
    check_same(back.animations[0], animation);
}

TEST_CASE("chunks of a GLB are whole words and their lengths add up") {
    Scene scene = varied_scene();
    for (int letters = 0; letters < 4; ++letters) {  // shifts the JSON through every remainder
        scene.name += "x";
        const auto glb = to_glb(scene);
        REQUIRE(glb);
        const auto word = [&](size_t at) {
            uint32_t value = 0;
            for (size_t i = 0; i < 4; ++i)
                value |= static_cast<uint32_t>((*glb)[at + i]) << (8 * i);
            return value;
        };
        CHECK(word(8) == glb->size());
        CHECK(word(12) % 4 == 0);
        CHECK(12 + 8 + word(12) + 8 + word(20 + word(12)) == glb->size());
    }
}

TEST_CASE("names that are not UTF-8 do not stop the writing") {
    Scene scene = varied_scene();
    scene.nodes[0].name = "caf\xe9";
    CHECK(reloaded(scene).nodes[0].name.starts_with("caf"));
}

TEST_CASE("an empty scene is written too") { CHECK(reloaded(Scene{}).meshes.empty()); }

TEST_CASE("luminaires come back among punctual lights") {
    Scene scene;
    scene.meshes.push_back({"mesh", {one_triangle()}, {}});
    scene.meshes[0].primitives[0].material = -1;
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    auto photometry = std::make_shared<Photometry>();
    *photometry = {"downlight", {0, 45, 90}, {0}, {300, 200, 0}};
    add_point_light(scene, {0, 3, 0}, 100);
    add_luminaire(scene, {1, 2, 3}, photometry);
    scene.lights.back().intensity = {2, 1, 0};
    add_point_light(scene, {0, 4, 0}, 200);
    add_luminaire(scene, {2, 2, 3}, photometry);

    const auto glb = to_glb(scene);
    REQUIRE(glb.has_value());
    const auto loaded = load_gltf(std::as_bytes(std::span(*glb)), "test", {});
    REQUIRE(loaded.has_value());
    for (size_t i = 1; i < scene.nodes.size(); ++i) {
        const Light& light = scene.lights[static_cast<size_t>(scene.nodes[i].light)];
        const Light& again = loaded->lights[static_cast<size_t>(loaded->nodes[i].light)];
        CHECK(again.kind == light.kind);
        check_near(again.intensity, light.intensity);
        REQUIRE((again.photometry != nullptr) == (light.photometry != nullptr));
        if (!light.photometry) continue;
        CHECK(again.photometry->name == "downlight");
        CHECK(again.photometry->candela == photometry->candela);
    }
}

TEST_CASE("what cannot be written is said and named") {
    Scene empty_primitive = varied_scene();
    empty_primitive.meshes[0].primitives[1].triangles.clear();
    const auto written = to_glb(empty_primitive);
    REQUIRE_FALSE(written);
    CHECK(written.error().code == Errc::bad_argument);
    CHECK(written.error().message == "mesh 0 \"mesh\": a primitive has no triangles");

    Scene jointless = varied_scene();
    jointless.skins.resize(1);
    CHECK(to_glb(jointless).error().message == "skin 0 has no joints");
    Scene instanced = varied_scene();
    instanced.nodes[1].instances.resize(2);
    CHECK(to_glb(instanced).error().code == Errc::unsupported);
    Scene uneven = varied_scene();
    uneven.meshes[0].primitives[0].targets.resize(1);
    CHECK(to_glb(uneven).error().code == Errc::bad_argument);
    Scene crowded = varied_scene();
    crowded.meshes[0].primitives[0].influences = 4;
    crowded.meshes[0].primitives[0].joints.assign(12, 65'536);
    crowded.meshes[0].primitives[0].weights.assign(12, 0.25f);
    CHECK(to_glb(crowded).error().code == Errc::bad_argument);

    const auto status = write_glb(varied_scene(), "/no/such/folder/x.glb");
    REQUIRE_FALSE(status);
    CHECK(status.error().code == Errc::unreadable);
    CHECK(status.error().context == "/no/such/folder/x.glb");
}
