// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/testing/scenes.h"
#include "aglow/mesh/testing/layout_check.h"
#include "aglow/mesh/testing/meshes.h"
#include "aglow/mesh/unwrap.h"
#include "aglow/scene/builtin.h"
#include "aglow/scene/load.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::mesh::testing;

namespace {

struct Laid {
    Atlas atlas;
    Surfaces surfaces;
};

Laid lay_out_scene(Scene& scene, int resolution) {
    UnwrapOptions options;
    options.resolution = resolution;
    Result<Atlas> atlas = unwrap(scene, options);
    REQUIRE_MESSAGE(atlas.has_value(), (atlas ? "" : to_string(atlas.error())));
    Surfaces surfaces = pose(scene, -1, &*atlas);
    return {std::move(*atlas), std::move(surfaces)};
}

double surface_area(const Surfaces& s) {
    double total = 0;
    for (uint32_t t = 0; t < s.triangles.size(); ++t) total += double(area(s, t));
    return total;
}

}  // namespace

TEST_CASE("the Cornell box covers more than 200 000 texels of an atlas of 512 x 512") {
    Result<Scene> scene = builtin_scene("cornell-box");
    REQUIRE(scene.has_value());
    const Laid laid = lay_out_scene(*scene, 512);
    const Texels texels = rasterize(laid.surfaces, laid.atlas, 1);
    CHECK(laid.atlas.width == 512);
    CHECK(laid.atlas.height <= 512);
    CHECK(texels.element_count() >= 200'000);
    CHECK(find_faults(laid.surfaces, laid.atlas, 2).none());
}

TEST_CASE("real scenes are laid out without overlap or loss") {
    if (!is_here(scenes_folder())) return;
    for (const char* name :
         {"khronos/NegativeScaleTest/NegativeScaleTest.glb", "khronos/Suzanne/Suzanne.gltf",
          "khronos/SimpleInstancing/SimpleInstancing.glb", "khronos/CesiumMan/CesiumMan.glb",
          "khronos/MeshPrimitiveModes/MeshPrimitiveModes.gltf",
          "rooms/godot-living-room/living_room.glb"}) {
        CAPTURE(name);
        Result<Scene> scene = load_scene(scenes_folder() / name);
        REQUIRE_MESSAGE(scene.has_value(), (scene ? "" : to_string(scene.error())));
        const Laid laid = lay_out_scene(*scene, 256);
        const LayoutFaults faults = find_faults(laid.surfaces, laid.atlas, 2);
        CHECK(faults.out_of_range == 0);
        CHECK(faults.lost == 0);
        CHECK(faults.overlaps == 0);
        CHECK(faults.near == 0);
        double covered = 0;
        for (float a : rasterize(laid.surfaces, laid.atlas, 1).area) covered += double(a);
        CHECK(covered == doctest::Approx(surface_area(laid.surfaces)).epsilon(1e-4));
    }
}

TEST_CASE("a room made with lightmap UVs keeps them") {
    const auto path = scenes_folder() / "rooms/bevy-cornellbox/CornellBox.glb";
    if (!is_here(path)) return;
    Result<Scene> scene = load_scene(path);
    REQUIRE(scene.has_value());
    const Laid laid = lay_out_scene(*scene, 256);
    for (const Placement& p : laid.atlas.placements)
        CHECK(laid.atlas.origins[size_t(p.mesh)] == UvOrigin::file);
    CHECK(laid.atlas.chart_count == 18);  // 5 walls, 2 boxes of 6 faces, 1 lamp
}
