// SPDX-License-Identifier: Apache-2.0
// Helpers of the round-trip tests: bake fake light, write, load, compare.
#pragma once
#include "aglow/core/file.h"
#include "aglow/core/testing/scenes.h"
#include "aglow/encode/lit_gltf.h"
#include "aglow/encode/testing/cell_layout.h"
#include "aglow/scene/load.h"
#include "tests/temporary_folder.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <array>
#include <random>
#include <string>

namespace aglow::encode::testing {

using aglow::testing::TemporaryFolder;

inline Scene load(const std::filesystem::path& path) {
    const auto bytes = read_file(path);
    REQUIRE_MESSAGE(bytes, path.string());
    auto scene =
        load_gltf(std::as_bytes(std::span(*bytes)), path.filename().string(), path.parent_path());
    REQUIRE_MESSAGE(scene, (scene ? "" : to_string(scene.error())));
    return std::move(*scene);
}

/// A scene with fake light on it: everything write_lit_gltf() asks for.
struct FakeBake {
    Scene scene;
    Atlas atlas;
    Surfaces surfaces;
    Texels texels;
    Lightmap lightmap;

    explicit FakeBake(Scene original) : scene(std::move(original)) {
        atlas = lay_out(scene);
        surfaces = pose(scene, -1, &atlas);
        texels = empty_texels(atlas);
        lightmap = position_light(surfaces, atlas);
    }
    Result<LitFiles> write(const std::filesystem::path& path, LitForm form = LitForm::lightmap) {
        LitOptions options;
        options.form = form;
        return write_lit_gltf(scene, surfaces, atlas, texels, lightmap, path, options);
    }
};

inline LitFiles written(FakeBake& bake, const std::filesystem::path& path,
                        LitForm form = LitForm::lightmap) {
    auto files = bake.write(path, form);
    REQUIRE_MESSAGE(files, (files ? "" : to_string(files.error())));
    return std::move(*files);
}

/// Largest distance between where the light says its surface is and where the surface is, relative
/// to the size of the scene; with `tolerance` for the numbers that the coding of light rounds.
inline double light_error(const Surfaces& surfaces, const Image& light, vec3 origin) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    double worst = 0, size = 1e-30;
    for (const vec3 p : surfaces.positions)
        size = std::max(size, static_cast<double>(length(p - origin)));
    for (uint32_t t = 0; t < surfaces.triangles.size(); ++t) {
        const uvec3 tri = surfaces.triangles[t];
        for (int i = 0; i < 4; ++i) {
            float b = i < 3 ? (i == 1 ? 1.0f : 0.0f) : unit(random);
            float c = i < 3 ? (i == 2 ? 1.0f : 0.0f) : unit(random);
            if (b + c > 1) b = 1 - b, c = 1 - c;
            const vec2 uv = surfaces.lightmap_uvs[tri.x] * (1 - b - c) +
                            surfaces.lightmap_uvs[tri.y] * b + surfaces.lightmap_uvs[tri.z] * c;
            const vec3 seen = sample_lightmap(light, uv) + origin;
            worst = std::max(worst,
                             static_cast<double>(length(seen - position(surfaces, {t, {b, c}}))));
        }
    }
    return worst / size;
}

/// World-space corners of all triangles, sorted: what is left of a scene when the order of nodes
/// and vertices is forgotten.
inline std::vector<std::array<float, 9>> triangle_set(const Surfaces& surfaces) {
    std::vector<std::array<float, 9>> set;
    for (uint32_t t = 0; t < surfaces.triangles.size(); ++t) {
        const vec3 a = surfaces.corner(t, 0), b = surfaces.corner(t, 1), c = surfaces.corner(t, 2);
        set.push_back({a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z});
    }
    std::ranges::sort(set);
    return set;
}

/// Runs the Khronos validator where it is installed. True where it found no error.
inline bool validator_agrees(const std::vector<std::filesystem::path>& files) {
    const std::filesystem::path root = AGLOW_SOURCE_DIR;
    if (!std::filesystem::exists(root / "node_modules" / "gltf-validator")) {
        MESSAGE("gltf-validator is not installed (npm ci); validation is skipped");
        return true;
    }
    std::string command = "node '" + (root / "tools" / "validate_gltf.mjs").string() + "'";
    for (const auto& file : files) command += " '" + file.string() + "'";
    return std::system(command.c_str()) == 0;
}

}  // namespace aglow::encode::testing
