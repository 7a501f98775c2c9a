// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/mesh/unwrap.h"
#include "aglow/render/frames.h"
#include "aglow/render/rays.h"
#include "tests/quad.h"

#include <doctest/doctest.h>

#include <vector>

namespace aglow::render::testing {

inline Material diffuse(vec3 color) {
    Material m;
    m.base_color = {color.x, color.y, color.z, 1};
    m.metallic = 0;
    return m;
}

inline Material metal(float color, float roughness) {
    Material m;
    m.base_color = {color, color, color, 1};
    m.roughness = roughness;
    return m;
}

inline Material unlit(vec3 color) {
    Material m = diffuse(color);
    m.unlit = true;
    return m;
}

/// A scene made of quads, each a node of its own.
struct Quads {
    Scene scene;

    /// Corners counter-clockwise seen from the front; the whole square of the lightmap is its.
    int add(const Material& material, vec3 a, vec3 b, vec3 c, vec3 d) {
        Primitive p;
        aglow::testing::add_quad(p, a, b, c, d);
        p.material = static_cast<int>(scene.materials.size());
        p.lightmap_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        scene.materials.push_back(material);
        Node node;
        node.mesh = static_cast<int>(scene.meshes.size());
        scene.meshes.push_back({"", {p}, {}});
        scene.nodes.push_back(node);
        return static_cast<int>(scene.nodes.size()) - 1;
    }

    /// A square of side 2 half about (0, 0, z) that faces +Z.
    int floor(const Material& material, float half, float z = 0) {
        return add(material, {-half, -half, z}, {half, -half, z}, {half, half, z},
                   {-half, half, z});
    }

    /// One placement of `side` x `side` texels for each quad, side by side, two texels apart.
    Lit lit(int side, vec3 irradiance) const {
        Lit lit;
        const int step = side + 2;
        const int count = static_cast<int>(scene.meshes.size());
        lit.atlas.width = step * count;
        lit.atlas.height = step;
        const auto size = static_cast<float>(side);
        for (int i = 0; i < count; ++i)
            lit.atlas.placements.push_back(
                {i, 0, i, {size, size}, {static_cast<float>(step * i), 0}});
        lit.irradiance = Image(lit.atlas.width, lit.atlas.height);
        for (vec3& pixel : lit.irradiance.pixels) pixel = irradiance;
        return lit;
    }
};

/// Light of 1000 lx on what faces it, along -Z turned by `rotation`.
inline void add_sun(Scene& scene, vec4 rotation = {0, 0, 0, 1}) {
    Light sun;
    sun.kind = LightKind::directional;
    sun.intensity = {1000, 1000, 1000};
    Node node;
    node.light = static_cast<int>(scene.lights.size());
    node.rotation = rotation;
    scene.lights.push_back(sun);
    scene.nodes.push_back(node);
}

/// A picture of the scene at rest; `lit` may be null.
inline Image picture(const Scene& scene, const Lit* lit, const View& view,
                     const RaysOptions& options, double time = -1) {
    auto renderer = make_cpu_frame_renderer({scene, lit, options});
    REQUIRE(renderer);
    auto frame = (*renderer)->draw(time, view, {});
    REQUIRE(frame);
    return std::move(frame->luminance);
}

/// An orthographic view of [-half, half]^2 from (0, 0, z) along -Z.
inline View from_above(float z, float half, int size) {
    return {.to_world = translation({0, 0, z}),
            .perspective = false,
            .half_width = half,
            .half_height = half,
            .width = size,
            .height = size};
}

/// World position of the middle of a pixel of from_above() on the plane z = 0.
inline vec2 position_of(int x, int y, float half, int size) {
    const auto n = static_cast<float>(size);
    return {(2 * (static_cast<float>(x) + 0.5f) / n - 1) * half,
            (1 - 2 * (static_cast<float>(y) + 0.5f) / n) * half};
}

}  // namespace aglow::render::testing
