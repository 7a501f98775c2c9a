// SPDX-License-Identifier: Apache-2.0
// Pictures of engine `raster` with a level for each edge.
#include "aglow/core/random.h"
#include "aglow/core/testing/demand.h"
#include "aglow/refine/lod.h"
#include "aglow/render/compare.h"
#include "aglow/render/gpu/raster/control_scene.h"
#include "aglow/render/gpu/raster/face_bins.h"
#include "aglow/render/gpu/raster/hidden_edges.h"
#include "aglow/render/raster.h"
#include "aglow/render/testing/stage.h"
#include "aglow/scene/builtin.h"
#include "aglow/vk/testing/test_device.h"

#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <utility>
#include <vector>

using namespace aglow;
using namespace aglow::render::testing;
using namespace aglow::render::gpu;

namespace {

/// Triangles of a ball of radius 1: an octahedron with `segments` on its edges. Every vertex has
/// one normal, turned away from the ball's by up to `roughness`.
Scene ball(uint32_t segments, float roughness = 0) {
    Scene scene;
    Primitive p;
    p.material = 0;
    scene.materials.push_back(diffuse({0.8f, 0.8f, 0.8f}));
    const auto n = static_cast<int>(segments);
    std::map<std::array<int, 3>, vec3> normals;
    Pcg32 random(7);
    const auto vertex = [&](int x, int y, int z) {
        const vec3 at =
            normalize(vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
        const vec3 off = {2 * random.uniform() - 1, 2 * random.uniform() - 1,
                          2 * random.uniform() - 1};
        p.positions.push_back(at);
        p.normals.push_back(
            normals.try_emplace({x, y, z}, normalize(at + off * roughness)).first->second);
    };
    for (const int sx : {1, -1})
        for (const int sy : {1, -1})
            for (const int sz : {1, -1}) {
                const auto face = [&](int i, int j, int up) {
                    const auto first = static_cast<uint32_t>(p.positions.size());
                    for (int k = 0; k < 3; ++k) {
                        const int a = i + (k == 1 ? up : 0), b = j + (k == 2 ? up : 0);
                        vertex(sx * (n - a - b), sy * a, sz * b);
                    }
                    const bool outwards = sx * sy * sz > 0;
                    p.triangles.push_back(outwards ? uvec3{first, first + 1, first + 2}
                                                   : uvec3{first, first + 2, first + 1});
                };
                for (int j = 0; j < n; ++j)
                    for (int i = 0; i + j < n; ++i) {
                        face(i, j, 1);
                        if (i + j + 1 < n) face(i + 1, j + 1, -1);
                    }
            }
    Node node;
    node.mesh = 0;
    scene.meshes.push_back({"", {p}, {}});
    scene.nodes.push_back(node);
    add_sun(scene);
    return scene;
}

/// A perspective view from (0, 0, z) along -Z.
View from_eye(float z, float half, int size) {
    View view = from_above(z, half, size);
    view.perspective = true;
    return view;
}

RasterOptions automatic(float tolerance, uint64_t budget = 0) {
    RasterOptions options;
    options.refinement = {Refinement::Kind::automatic, 0, tolerance, budget};
    return options;
}

RasterOptions uniform(int level) {
    RasterOptions options;
    options.refinement = {Refinement::Kind::pn, level};
    return options;
}

DrawnFrame drawn(const Gpu& gpu, const Scene& scene, const View& view,
                 const RasterOptions& options) {
    const auto renderer = demand(make_raster_frame_renderer(gpu, {scene}, options));
    return demand(renderer->draw(-1, view, {}));
}

bool same_bits(const Image& a, const Image& b) {
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(vec3)) == 0;
}

ControlScene control_of(const Scene& scene) {
    return demand(control_scene(scene, pose(scene, -1)));
}

PatchControl patches_of(const ControlScene& control, const Surfaces& rest) {
    std::vector<vec3> positions, normals;
    for (const uint32_t v : control.vertex_source) positions.push_back(rest.positions[v]);
    for (const uint32_t v : control.corner_source) normals.push_back(rest.normals[v]);
    PatchControl result;
    demand(Patches::create(control.topology, {})).update({positions, normals}, result);
    return result;
}

}  // namespace

TEST_CASE("levels of edges look as the finest pattern does, with a fraction of its triangles") {
    vk::TestDevice device;
    if (!device) return;
    const Scene scene = ball(2);
    for (const View& view : {from_eye(3, 0.4f, 128), from_above(2, 1.2f, 128)}) {
        const DrawnFrame fine = drawn(device.gpu(), scene, view, uniform(7));
        CHECK(fine.triangles == 32 * 128 * 128);
        CHECK(fine.tolerance == 0);
        const DrawnFrame chosen = drawn(device.gpu(), scene, view, automatic(0.25f));
        CHECK(chosen.tolerance == 0.25f);
        CHECK(chosen.triangles < fine.triangles / 100);
        const double off = demand(difference(chosen.luminance, fine.luminance)).relative_rmse;
        CHECK(off < 0.01);
        const DrawnFrame coarse = drawn(device.gpu(), scene, view, automatic(4));
        CHECK(coarse.triangles < chosen.triangles / 2);
        CHECK(demand(difference(coarse.luminance, fine.luminance)).relative_rmse > 2 * off);
    }
}

TEST_CASE("what is nearer is finer, what is farther than that takes is the coarse mesh") {
    vk::TestDevice device;
    if (!device) return;
    const Scene scene = ball(2);
    uint64_t last = 32;
    for (const float distance : {1000.0f, 40.0f, 10.0f, 2.5f}) {
        const uint64_t triangles =
            drawn(device.gpu(), scene, from_eye(distance, 0.5f, 64), automatic(0.5f)).triangles;
        CHECK(triangles >= last);
        if (distance == 1000.0f) CHECK(triangles == 32);
        if (distance == 2.5f) CHECK(triangles > 3 * 32);
        last = triangles;
    }
}

TEST_CASE("a frame has no more triangles than its budget, and says what that cost") {
    vk::TestDevice device;
    if (!device) return;
    Scene scene = ball(3);
    for (const float x : {-2.5f, 2.5f}) {  // three placements
        Node node;
        node.mesh = 0;
        node.translation = {x, 0, -1};
        scene.nodes.push_back(node);
    }
    const View view = from_eye(5, 0.7f, 64);
    const auto frame = [&](uint64_t budget) {
        return drawn(device.gpu(), scene, view, automatic(0.01f, budget));
    };
    const DrawnFrame all = frame(0);
    CHECK(all.tolerance == 0.01f);
    for (const uint64_t budget : {500u, 2000u}) {
        const DrawnFrame fits = frame(budget);
        CHECK(fits.triangles <= budget);
        CHECK(fits.triangles > budget / 2);
        CHECK(fits.tolerance > 0.01f);
    }
    CHECK(frame(all.triangles + 10).tolerance == 0.01f);
    CHECK(frame(10).triangles == 3 * 72);  // nothing is coarser than the mesh
}

TEST_CASE("no light shines through a closed mesh whose edges have all sorts of levels") {
    vk::TestDevice device;
    if (!device) return;
    Scene scene = ball(4, 0.3f);
    Sky sky;
    sky.luminance = {1000, 1000, 1000};
    scene.sky = sky;
    // Every second triangle is drawn by another pipeline.
    scene.materials = {unlit({0, 0, 0}), unlit({0, 0, 0})};
    scene.materials[1].alpha_mode = AlphaMode::mask;
    Primitive masked = scene.meshes[0].primitives[0];
    masked.material = 1;
    masked.triangles.clear();
    std::vector<uvec3>& plain = scene.meshes[0].primitives[0].triangles;
    const std::vector<uvec3> all = std::exchange(plain, {});
    for (size_t i = 0; i < all.size(); ++i)
        (i % 2 == 0 ? plain : masked.triangles).push_back(all[i]);
    scene.meshes[0].primitives.push_back(masked);

    const ControlScene control = control_of(scene);
    REQUIRE(control.topology.face_count() == 128);
    for (const float tolerance : {0.01f, 0.05f, 0.3f}) {
        CAPTURE(tolerance);
        const View view = from_eye(4, 0.3f, 200);
        const Image image = drawn(device.gpu(), scene, view, automatic(tolerance)).luminance;
        int through = 0, outside = 0;
        for (int y = 0; y < 200; ++y)
            for (int x = 0; x < 200; ++x) {
                const float u = static_cast<float>(x) - 99.5f, v = static_cast<float>(y) - 99.5f;
                const bool bright = image.at(x, y).x > 0;
                through += u * u + v * v < 60 * 60 && bright;
                outside += bright;
            }
        CHECK(through == 0);
        CHECK(outside > 1000);
    }
}

TEST_CASE("blended faces keep their order, each with a pattern of its own") {
    vk::TestDevice device;
    if (!device) return;
    Scene scene = ball(2, 0.2f);
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].base_color.w = 0.5f;
    scene.materials[0].double_sided = true;
    const View view = from_eye(3, 0.45f, 96);
    const DrawnFrame fine = drawn(device.gpu(), scene, view, uniform(6));
    const DrawnFrame chosen = drawn(device.gpu(), scene, view, automatic(0.1f));
    CHECK(chosen.triangles < fine.triangles / 10);
    CHECK(demand(difference(chosen.luminance, fine.luminance)).relative_rmse < 0.03);
}

TEST_CASE("frames in the same order are the same, small movements change no level") {
    vk::TestDevice device;
    if (!device) return;
    const Scene scene = demand(builtin_scene("walker"));
    const View view = from_eye(6, 0.5f, 48);
    const auto frames = [&] {
        const auto renderer =
            demand(make_raster_frame_renderer(device.gpu(), {scene}, automatic(0.2f)));
        std::vector<DrawnFrame> result;
        for (const double time : {0.1, 0.5, 0.1})
            result.push_back(demand(renderer->draw(time, view, {})));
        return result;
    };
    const auto once = frames(), again = frames();
    for (size_t i = 0; i < once.size(); ++i) {
        CHECK(once[i].triangles == again[i].triangles);
        CHECK(same_bits(once[i].luminance, again[i].luminance));
    }
    const Scene still = ball(3);
    const auto renderer =
        demand(make_raster_frame_renderer(device.gpu(), {still}, automatic(0.2f)));
    std::vector<uint64_t> counts;
    for (const float z : {3.0f, 3.02f, 3.0f, 3.02f})
        counts.push_back(demand(renderer->draw(-1, from_eye(z, 0.5f, 64), {})).triangles);
    CHECK(counts[1] == counts[2]);
    CHECK(counts[2] == counts[3]);
}

TEST_CASE("mesh shaders draw the picture of vertex shaders") {
    vk::TestDevice device;
    if (!device) return;
    if (!device->physical().drawing.mesh_shader) {
        MESSAGE("skipped: the GPU has no mesh shaders");
        return;
    }
    Scene scene = ball(3, 0.2f);
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].alpha_mode = AlphaMode::blend;
    scene.materials[1].base_color.w = 0.5f;
    scene.meshes.push_back(scene.meshes[0]);
    scene.meshes[1].primitives[0].material = 1;
    Node glass;
    glass.mesh = 1;
    glass.translation = {0.5f, 0.5f, 1};
    scene.nodes.push_back(glass);
    std::vector<RasterOptions> all;
    for (const int level : {0, 1, 2, 3, 4, 5}) all.push_back(uniform(level));
    for (const float tolerance : {0.02f, 0.1f, 0.4f, 2.0f}) all.push_back(automatic(tolerance));
    for (RasterOptions options : all) {
        CAPTURE(options.refinement.level);
        CAPTURE(options.refinement.tolerance);
        const View view = from_eye(4, 0.5f, 96);
        const DrawnFrame groups = drawn(device.gpu(), scene, view, options);
        options.mesh_shaders = MeshShaders::never;
        const DrawnFrame vertices = drawn(device.gpu(), scene, view, options);
        CHECK(groups.triangles == vertices.triangles);
        // Stages may fuse products and sums otherwise, which moves edges by a rounding.
        CHECK(demand(difference(groups.luminance, vertices.luminance)).relative_rmse < 1e-3);
    }
}

TEST_CASE("tolerances that make no sense are errors") {
    vk::TestDevice device;
    if (!device) return;
    const Scene scene = ball(1);
    for (const float tolerance : {0.0f, -1.0f, 0.001f, 1e9f, kInfinity})
        CHECK(
            make_raster_frame_renderer(device.gpu(), {scene}, automatic(tolerance)).error().code ==
            Errc::bad_argument);
}

TEST_CASE("bins hold every visible face once, by size, and count as LevelOfDetail does") {
    const Scene scene = ball(5);
    const ControlScene control = control_of(scene);
    const auto count = static_cast<uint32_t>(control.patch_of.size());
    Pcg32 random(3);
    std::vector<float> levels;
    for (uint32_t e = 0; e < control.topology.edge_count(); ++e)
        levels.push_back(std::floor(1 + 127.9f * random.uniform() * random.uniform()));
    const FaceSizes sizes = face_sizes(control.topology, control.patch_of, levels);
    std::array<std::vector<FaceRange>, kSolidLayers> layers;
    layers[0] = {{0, 40}, {60, count - 60}};
    layers[2] = {{40, 20}};
    const FaceBins bins = face_bins(sizes, layers);
    CHECK(bins.triangles[0] + bins.triangles[2] ==
          triangle_count(control.topology, levels, Tessellation::Levels::discrete));
    std::vector<int> seen(count);
    for (size_t layer = 0; layer < kSolidLayers; ++layer)
        for (const FaceDraw& bin : bins.draws[layer])
            for (uint32_t i = 0; i < bin.places.count; ++i) {
                const uint32_t face = bins.faces[bin.places.first + i];
                CHECK(sizes.segments[face] == bin.segments);
                CHECK((face >= 40 && face < 60) == (layer == 2));
                ++seen[face];
            }
    CHECK(seen == std::vector<int>(count, 1));
}

TEST_CASE("edges are hidden beyond the picture and behind, never where a face shows") {
    const Scene scene = ball(8);
    const Surfaces rest = pose(scene, -1);
    const ControlScene control = control_of(scene);
    const PatchControl patches = patches_of(control, rest);
    const Topology& topology = control.topology;
    const auto hidden = [&](const View& view, bool one_sided) {
        const std::vector<uint8_t> sides(topology.face_count(), one_sided ? 1 : 0);
        const Box box{{-1, -1, -1}, {1, 1, 1}};
        return hidden_edges(topology, patches, sides, {}, projection_of(view, box));
    };
    const auto fraction = [](const std::vector<uint8_t>& edges) {
        double sum = 0;
        for (const uint8_t edge : edges) sum += edge;
        return sum / static_cast<double>(edges.size());
    };
    for (const bool perspective : {false, true}) {
        CAPTURE(perspective);
        View view = perspective ? from_eye(5, 1, 64) : from_above(5, 2, 64);
        CHECK(fraction(hidden(view, false)) == 0);
        const std::vector<uint8_t> behind = hidden(view, true);
        CHECK(fraction(behind) > 0.2);
        for (uint32_t e = 0; e < topology.edge_count(); ++e)
            if (behind[e]) CHECK(patches.positions[topology.vertex[topology.edge_half[e]]].z < 0);
        view.half_width = view.half_height = perspective ? 0.05f : 0.2f;
        CHECK(fraction(hidden(view, false)) > 0.8);
        CHECK(fraction(hidden(view, false)) < 1);
    }
}
