// SPDX-License-Identifier: Apache-2.0
// The whole way with real charts: unwrap, rasterise, encode, write, load, look up.
#include "aglow/encode/testing/round_trip.h"
#include "aglow/scene/builtin.h"

using namespace aglow;
using namespace aglow::encode::testing;
namespace fs = std::filesystem;

namespace {

/// Light of each texel: the mean position of its sample points relative to `origin`.
std::vector<vec3> mean_positions(const Surfaces& surfaces, const Texels& texels, vec3 origin) {
    std::vector<vec3> values(texels.element_count());
    for (size_t e = 0; e < values.size(); ++e) {
        const uint32_t begin = texels.first_sample[e], end = texels.first_sample[e + 1];
        for (uint32_t s = begin; s < end; ++s)
            values[e] += position(surfaces, texels.samples[s]) - origin;
        values[e] *= 1.0f / static_cast<float>(end - begin);
    }
    return values;
}

/// Edge of a texel on a triangle at its most stretched: the larger singular value of the map
/// from texels to metres.
float texel_edge(const Surfaces& surfaces, uint32_t triangle) {
    const uvec3 t = surfaces.triangles[triangle];
    const vec3 e1 = surfaces.positions[t.y] - surfaces.positions[t.x];
    const vec3 e2 = surfaces.positions[t.z] - surfaces.positions[t.x];
    const vec2 u = surfaces.lightmap_uvs[t.y] - surfaces.lightmap_uvs[t.x];
    const vec2 v = surfaces.lightmap_uvs[t.z] - surfaces.lightmap_uvs[t.x];
    const float det = u.x * v.y - u.y * v.x;
    if (det == 0) return kInfinity;
    const vec3 dx = (e1 * v.y - e2 * u.y) / det, dy = (e2 * u.x - e1 * v.x) / det;
    const float a = dot(dx, dx), b = dot(dx, dy), c = dot(dy, dy);
    return std::sqrt((a + c) / 2 + std::sqrt((a - c) * (a - c) / 4 + b * b));
}

void check_scene(Scene scene, const fs::path& path) {
    UnwrapOptions options;
    options.resolution = 256;
    const auto atlas = unwrap(scene, options);
    REQUIRE_MESSAGE(atlas, (atlas ? "" : to_string(atlas.error())));
    const Surfaces surfaces = pose(scene, -1, &*atlas);
    const Texels texels = rasterize(surfaces, *atlas, 4);
    const vec3 origin = origin_of(surfaces);
    const Lightmap map =
        make_lightmap(texels, mean_positions(surfaces, texels, origin), options.gutter);
    const auto files = write_lit_gltf(scene, surfaces, *atlas, texels, map, path, {});
    REQUIRE_MESSAGE(files, (files ? "" : to_string(files.error())));

    Scene read = load(path);
    const auto lit = read_lit_gltf(read, path);
    REQUIRE(lit);
    const Surfaces seen = pose(read, -1, &lit->atlas);
    REQUIRE(triangle_set(seen) == triangle_set(surfaces));
    // Bilinear look-ups reach one texel far; partly covered texels hold a mean up to half a texel
    // off, and neighbouring triangles of a curved chart differ in scale.
    size_t off = 0, looked_up = 0;
    for (uint32_t t = 0; t < seen.triangles.size(); ++t) {
        const float edge = texel_edge(seen, t);
        const uvec3 tri = seen.triangles[t];
        if (!(area(seen, t) > edge * edge)) continue;  // smaller than a texel
        const vec2 uv =
            (seen.lightmap_uvs[tri.x] + seen.lightmap_uvs[tri.y] + seen.lightmap_uvs[tri.z]) *
            (1.0f / 3);
        const vec3 where = position(seen, {t, {1.0f / 3, 1.0f / 3}});
        ++looked_up;
        if (length(sample_lightmap(lit->irradiance, uv) + origin - where) > 2 * edge) ++off;
    }
    CHECK(looked_up > 0);
    CHECK(off == 0);
}

}  // namespace

TEST_CASE("with real charts a look-up finds the light of its own texel") {
    const TemporaryFolder folder;
    auto box = builtin_scene("cornell-box");
    REQUIRE(box);
    check_scene(std::move(*box), folder.path / "box.glb");
    for (const char* name :
         {"khronos/SimpleInstancing/SimpleInstancing.glb", "khronos/Box-Draco/Box.gltf",
          "khronos/NegativeScaleTest/NegativeScaleTest.glb", "khronos/MultiUVTest/MultiUVTest.glb",
          "rooms/bevy-cornellbox/CornellBox.glb", "khronos/CesiumMan/CesiumMan.glb"}) {
        CAPTURE(name);
        const fs::path path = scenes_folder() / name;
        if (!fs::exists(path)) continue;
        check_scene(load(path), folder.path / "lit.glb");
    }
}
