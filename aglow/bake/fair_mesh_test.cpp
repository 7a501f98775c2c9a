// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/fair_mesh.h"

#include "aglow/accel/surface_distance.h"
#include "aglow/bake/fair/bake_maps.h"
#include "aglow/bake/fair/chart_texels.h"
#include "aglow/mesh/control_mesh.h"
#include "aglow/refine/refine_scene.h"
#include "aglow/scene/builtin.h"
#include "aglow/scene/load.h"
#include "tests/temporary_folder.h"

#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <cmath>

using namespace aglow;
using namespace aglow::bake::fair;

namespace {

/// The faces of an octahedron with n segments to an edge, on the unit sphere.
Primitive sphere(int n) {
    Primitive p;
    const auto point = [&](vec3 sign, int i, int j) {
        const float x = float(i), y = float(j), z = float(n - i - j);
        return normalize(vec3{sign.x * x, sign.y * y, sign.z * z});
    };
    for (int octant = 0; octant < 8; ++octant) {
        const vec3 sign = {octant & 1 ? -1.0f : 1.0f, octant & 2 ? -1.0f : 1.0f,
                           octant & 4 ? -1.0f : 1.0f};
        const bool mirrored = sign.x * sign.y * sign.z < 0;
        const auto add = [&](vec3 a, vec3 b, vec3 c) {
            const auto first = static_cast<uint32_t>(p.positions.size());
            for (const vec3 v : {a, mirrored ? c : b, mirrored ? b : c}) {
                p.positions.push_back(v + vec3{0, 0, 0});  // -0 and 0 are one place
                p.normals.push_back(v);
            }
            p.triangles.push_back({first, first + 1, first + 2});
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                add(point(sign, i, j), point(sign, i + 1, j), point(sign, i, j + 1));
                if (i + j + 1 < n)
                    add(point(sign, i + 1, j), point(sign, i + 1, j + 1), point(sign, i, j + 1));
            }
    }
    return p;
}

Mesh mesh_of(Primitive primitive) {
    Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    return mesh;
}

Scene scene_of(Primitive primitive) {
    Scene scene;
    Material grey;
    grey.base_color = {0.5f, 0.5f, 0.5f, 1};
    scene.materials.push_back(grey);
    primitive.material = 0;
    scene.meshes.push_back(mesh_of(std::move(primitive)));
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

/// A square of edge 2 at the height z, raised by `slope` along x, seen from above unless turned.
Primitive square(float z, float slope = 0, bool turned = false) {
    Primitive p;
    for (const vec2 at : {vec2{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        p.positions.push_back({at.x, at.y, z + slope * at.x});
    p.normals.assign(4, normalize(vec3{-slope, 0, 1}) * (turned ? -1.0f : 1.0f));
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (turned) p.triangles = {{0, 2, 1}, {0, 3, 2}};
    return p;
}

/// Maps of a square in the plane z = 0 that has become of these.
struct BakedSquare {
    CoarseSurface coarse;
    Maps maps;
    int width = 0, height = 0;
};

BakedSquare baked_square(std::vector<Primitive> dense) {
    BakedSquare result;
    Mesh mesh = mesh_of(square(0));
    auto coarse = make_coarse_surface(mesh, 32, result.width, result.height);
    REQUIRE(coarse);
    result.coarse = std::move(*coarse);
    Mesh layers;
    layers.primitives = std::move(dense);
    auto maps = bake_maps(result.coarse, layers, result.width, result.height, 1, {});
    REQUIRE(maps);
    result.maps = std::move(*maps);
    return result;
}

}  // namespace

TEST_CASE("heights are those of the nearest front, on either side") {
    const auto check = [](std::vector<Primitive> dense, float height) {
        const BakedSquare baked = baked_square(std::move(dense));
        CHECK(baked.maps.missed == 0);
        for (const float h : baked.maps.heights) CHECK(h == doctest::Approx(height).epsilon(1e-4));
    };
    check({square(0.3f), square(-0.1f)}, -0.1f);
    check({square(0.1f), square(-0.3f)}, 0.1f);
    check({square(0.05f, 0, true), square(0.2f)}, 0.2f);  // the first is seen from behind
    check({square(-0.05f, 0, true), square(-0.2f)}, -0.2f);
}

TEST_CASE("a dense slope is its normal in every texel, as the coarse triangle's axes have it") {
    const BakedSquare baked = baked_square({square(0, 0.5f)});
    const vec3 n = normalize(vec3{-0.5f, 0, 1});
    const vec4 tangent = baked.coarse.tangents[0];
    const vec3 along{tangent.x, tangent.y, tangent.z}, up = cross(vec3{0, 0, 1}, along) * tangent.w;
    const std::array expected = {dot(n, along), dot(n, up), n.z};
    size_t slopes = 0;
    for (size_t i = 0; i < baked.maps.heights.size(); ++i) {
        const uint8_t* texel = &baked.maps.normals[3 * i];
        if (texel[2] == 255) continue;  // beside the chart
        ++slopes;
        for (size_t c = 0; c < 3; ++c)
            CHECK(std::fabs(float(texel[c]) - 127.5f * (1 + expected[c])) < 0.501f);
    }
    CHECK(slopes > baked.maps.heights.size() / 2);
}

TEST_CASE("where rays meet nothing, heights are those of the texels around") {
    Primitive frame;  // a square with a square hole of half its edge
    for (const float size : {1.0f, 0.5f})
        for (const vec2 at : {vec2{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
            frame.positions.push_back({size * at.x, size * at.y, 0.1f});
    frame.normals.assign(8, {0, 0, 1});
    for (uint32_t i = 0; i < 4; ++i) {
        const uint32_t j = (i + 1) % 4;
        frame.triangles.push_back({i, j, 4 + j});
        frame.triangles.push_back({i, 4 + j, 4 + i});
    }
    const BakedSquare baked = baked_square({frame});
    CHECK(baked.maps.missed == doctest::Approx(0.25).epsilon(0.1));
    for (const float h : baked.maps.heights) CHECK(h == doctest::Approx(0.1).epsilon(1e-4));
}

TEST_CASE("tangents run along u, and with the normal they give what points up in the image") {
    Mesh mesh = mesh_of(sphere(1));
    int width = 0, height = 0;
    const auto coarse = make_coarse_surface(mesh, 128, width, height);
    REQUIRE(coarse);
    const Topology& topology = coarse->control.topology;
    for (uint32_t h = 0; h < topology.half_edge_count(); h += 3) {
        const auto at = [&](uint32_t i) {
            return coarse->control.positions[topology.vertex[h + i]];
        };
        const vec3 ab = at(1) - at(0), ac = at(2) - at(0), normal = normalize(cross(ab, ac));
        const vec2 b = coarse->uvs[h + 1] - coarse->uvs[h], c = coarse->uvs[h + 2] - coarse->uvs[h];
        const float area = b.x * c.y - b.y * c.x;
        const vec3 by_u = (ab * c.y - ac * b.y) / area, by_v = (ac * b.x - ab * c.x) / area;
        for (uint32_t i = 0; i < 3; ++i) {
            const vec4 t = coarse->tangents[h + i];
            const vec3 along{t.x, t.y, t.z};
            CHECK(dot(along, by_u) > 0);
            CHECK(dot(cross(normal, along) * t.w, by_v) < 0);
        }
    }
}

TEST_CASE("heights reach as far as the coarse surface has moved") {
    // A ball of four to eight triangles: the middles of its faces have moved by far more than a
    // tenth of the diagonal.
    const auto fair =
        make_fair(scene_of(sphere(20)), {.ratio = 1e-3f, .map_size = 64, .samples = 0});
    REQUIRE(fair);
    const FairMesh& mesh = fair->meshes.at(0);
    CHECK(mesh.triangles <= 8);
    float highest = 0;
    for (const vec3 texel : mesh.displacement.pixels) highest = std::max(highest, texel.x);
    CHECK(highest > 0.12f * mesh.diagonal);
    CHECK(mesh.missed < 0.01);
}

TEST_CASE("maps have four texels for every dense vertex, at a power of two") {
    // 8 n^2 triangles: 124 and 130 texels wide, before they are rounded up.
    for (const auto& [n, width] : {std::pair(22, 128), std::pair(23, 256)}) {
        const auto fair = make_fair(scene_of(sphere(n)), {.ratio = 0.1f, .samples = 0});
        REQUIRE(fair);
        CHECK(fair->meshes.at(0).width == width);
    }
}

TEST_CASE("heights from an octahedron to the sphere round it have their closed form") {
    const Mesh dense = mesh_of(sphere(96));
    Mesh mesh = mesh_of(sphere(1));
    int width = 0, height = 0;
    const auto coarse = make_coarse_surface(mesh, 128, width, height);
    REQUIRE(coarse);
    const auto maps = bake_maps(*coarse, dense, width, height, 2, {});
    REQUIRE(maps);
    CHECK(maps->missed == 0);

    const Topology& topology = coarse->control.topology;
    CHECK(topology.vertex_count() == 6);
    std::vector<ChartTriangle> charts;
    const vec2 size = {float(width), float(height)};
    for (uint32_t h = 0; h < topology.half_edge_count(); h += 3)
        charts.push_back(
            {coarse->uvs[h] * size, coarse->uvs[h + 1] * size, coarse->uvs[h + 2] * size});
    const auto texels = chart_texels(charts, width, height, 0);
    size_t checked = 0;
    float worst = 0, worst_normal = 0;
    for (size_t i = 0; i < texels.size(); ++i) {
        if (!texels[i].inside) continue;
        const uint32_t h = 3 * texels[i].triangle;
        const float x = texels[i].barycentrics.x, y = texels[i].barycentrics.y;
        const auto blend = [&](auto at) {
            return at(h) * (1 - x - y) + at(h + 1) * x + at(h + 2) * y;
        };
        const vec3 p =
            blend([&](uint32_t c) { return coarse->control.positions[topology.vertex[c]]; });
        const vec3 n = normalize(p);  // of an octahedron, whose normals are its corners
        const float exact = 1 - length(p);
        worst = std::max(worst, std::fabs(maps->heights[i] - exact));
        // Sphere and interpolated normal agree: the normal map is flat.
        worst_normal = std::max(worst_normal, 1 - (float(maps->normals[3 * i + 2]) / 127.5f - 1));
        CHECK(dot(n, normalize(blend([&](uint32_t c) {
                      return coarse->directions[topology.vertex[c]];
                  }))) > 0.9999f);
        ++checked;
    }
    CHECK(checked > 4000);
    CHECK(worst < 4e-4f);  // how far chords of the dense sphere lie inside it
    CHECK(worst_normal < 0.02f);
}

TEST_CASE("an octahedron that is refined and displaced gives the sphere back") {
    Mesh mesh = mesh_of(sphere(1));
    int width = 0, height = 0;
    const auto coarse = make_coarse_surface(mesh, 256, width, height);
    REQUIRE(coarse);
    const auto maps = bake_maps(*coarse, mesh_of(sphere(96)), width, height, 2, {});
    REQUIRE(maps);
    const auto refined = displaced(*coarse, make_height_map(maps->heights, width, height), 5);
    REQUIRE(refined);
    CHECK(refined->triangles.size() == 8 * 1024);
    // At the corners heights fall by 0.7 m a metre: half a texel of 0.012 m away.
    for (const vec3 p : refined->positions) CHECK(std::fabs(length(p) - 1) < 0.006f);
}

TEST_CASE("a rough shape at 2 % of its triangles comes back within 0.1 % of its diagonal") {
    auto dense = builtin_scene("sculpture:50000");
    REQUIRE(dense);
    const auto fair = make_fair(*dense, {});
    REQUIRE(fair);
    REQUIRE(fair->meshes.size() == 1);
    const FairMesh& mesh = fair->meshes[0];
    CHECK(mesh.triangles <= 0.02 * static_cast<double>(mesh.dense_triangles));
    CHECK(mesh.rms < 1e-3 * mesh.diagonal);
    CHECK(mesh.missed < 0.01);
    CHECK(mesh.hausdorff >= mesh.rms);
}

TEST_CASE("at ratio 1 nothing is lost and heights are 0") {
    const auto fair = make_fair(scene_of(sphere(8)), {.ratio = 1, .map_size = 128});
    REQUIRE(fair);
    const FairMesh& mesh = fair->meshes.at(0);
    CHECK(mesh.triangles == 512);
    CHECK(mesh.level == 0);
    CHECK(mesh.rms < 1e-6);
    CHECK(mesh.hausdorff < 1e-6);
    for (const vec3 texel : mesh.displacement.pixels) CHECK(std::fabs(texel.x) < 2e-3f);
}

TEST_CASE("what is written loads again, with the heights that were baked") {
    const testing::TemporaryFolder temporary;
    const std::filesystem::path& folder = temporary.path;
    auto fair = make_fair(scene_of(sphere(20)), {.ratio = 0.1f, .map_size = 64, .samples = 0});
    REQUIRE(fair);
    const auto files = write_fair(*fair, folder / "a b.glb");
    REQUIRE(files);
    REQUIRE(files->size() == 2);
    CHECK(files->at(0) == folder / "a b.displacement.exr");
    const auto loaded = load_scene(folder / "a b.glb");
    REQUIRE(loaded);
    CHECK(loaded->warnings == std::vector<std::string>());
    const Primitive& primitive = loaded->meshes.at(0).primitives.at(0);
    REQUIRE(primitive.displacement);
    CHECK(primitive.displacement->file == "a b.displacement.exr");
    CHECK(primitive.displacement->texcoord == 0);
    CHECK(primitive.displacement->scale == 1);
    CHECK(primitive.displacement->bias == 0);
    const auto heights = read_height_map(files->at(0));
    REQUIRE(heights);
    for (size_t i = 0; i < fair->meshes[0].displacement.pixels.size(); ++i)
        CHECK(heights->texels[i] == fair->meshes[0].displacement.pixels[i].x);
}

TEST_CASE("the file is refined to the dense shape by its own heights, and stays closed") {
    const testing::TemporaryFolder temporary;
    const auto dense = builtin_scene("sculpture:20000");
    REQUIRE(dense);
    auto fair = make_fair(*dense, {.ratio = 0.03f, .samples = 20'000});
    REQUIRE(fair);
    REQUIRE(write_fair(*fair, temporary.path / "fair.glb"));
    const auto loaded = load_scene(temporary.path / "fair.glb");
    REQUIRE(loaded);
    RefineOptions options;
    options.level = 3;
    const auto refined = refine_scene(*loaded, options);
    REQUIRE(refined);
    const Mesh& mesh = refined->meshes.at(0);
    CHECK(mesh.primitives.at(0).triangles.size() == 64 * fair->meshes[0].triangles);
    CHECK_FALSE(mesh.primitives.at(0).displacement);

    const auto surface = make_control_mesh(mesh);
    REQUIRE(surface);
    CHECK(surface->repairs.none());
    size_t open = 0;
    for (const uint32_t twin : surface->topology.twin) open += twin == kNone;
    CHECK(open == 0);

    const Primitive& from = dense->meshes.at(0).primitives.at(0);
    const Primitive& to = mesh.primitives.at(0);
    const auto difference =
        surface_difference({from.positions, from.triangles}, {to.positions, to.triangles}, 20'000);
    REQUIRE(difference);
    CHECK(difference->rms < 1e-3 * fair->meshes[0].diagonal);
}

TEST_CASE("heights that cannot be read are told, with the file's name") {
    const testing::TemporaryFolder temporary;
    auto fair = make_fair(scene_of(sphere(8)), {.ratio = 0.5f, .map_size = 64, .samples = 0});
    REQUIRE(fair);
    REQUIRE(write_fair(*fair, temporary.path / "fair.glb"));
    std::filesystem::remove(temporary.path / "fair.displacement.exr");
    const auto loaded = load_scene(temporary.path / "fair.glb");
    REQUIRE(loaded);
    const auto refined = refine_scene(*loaded, {});
    REQUIRE_FALSE(refined);
    CHECK(refined.error().code == Errc::unreadable);
    CHECK(to_string(refined.error()).find("fair.displacement.exr") != std::string::npos);
}

TEST_CASE(
    "the maps' coordinates come after those of the file, and every primitive has a material") {
    Primitive textured = sphere(10);
    textured.texcoords = {std::vector<vec2>(textured.positions.size(), vec2{0.5f, 0.5f}),
                          std::vector<vec2>(textured.positions.size(), vec2{0, 1})};
    const auto fair = make_fair(scene_of(textured), {.ratio = 0.2f, .map_size = 64, .samples = 0});
    REQUIRE(fair);
    const Primitive& primitive = fair->scene.meshes.at(0).primitives.at(0);
    REQUIRE(primitive.texcoords.size() == 3);
    CHECK(primitive.displacement->texcoord == 2);
    CHECK(primitive.tangents.size() == primitive.positions.size());
    CHECK(primitive.texcoords[2].size() == primitive.positions.size());
    for (const vec2 uv : primitive.texcoords[0]) CHECK(uv.x == 0.5f);
    for (const vec2 uv : primitive.texcoords[2]) {
        CHECK(uv.x > 0);
        CHECK(uv.x < 1);
        CHECK(uv.y > 0);
        CHECK(uv.y < 1);
    }
    for (size_t v = 0; v < primitive.positions.size(); ++v) {
        const vec4 t = primitive.tangents[v];
        CHECK(std::fabs(dot(vec3{t.x, t.y, t.z}, primitive.normals[v])) < 1e-5f);
        CHECK(std::fabs(t.w) == 1);
    }
    const Material& material = fair->scene.materials.at(static_cast<size_t>(primitive.material));
    CHECK(material.normal_texture.texture == 0);
    CHECK(material.normal_texture.texcoord == 2);
}

TEST_CASE("scenes of nothing stay so, triangles without area do no harm") {
    CHECK(make_fair(Scene(), {})->meshes.empty());
    CHECK(make_fair(scene_of(Primitive()), {})->meshes.empty());
    Primitive flat = sphere(6);
    flat.triangles.push_back({0, 0, 1});
    flat.triangles.push_back({2, 2, 2});
    const auto fair = make_fair(scene_of(flat), {.ratio = 0.5f, .map_size = 64, .samples = 1000});
    REQUIRE(fair);
    CHECK(std::isfinite(fair->meshes.at(0).rms));
}

TEST_CASE("options out of range are bad arguments, and what is stopped is cancelled") {
    const Scene scene = scene_of(sphere(2));
    for (const FairOptions& options :
         {FairOptions{.ratio = 0}, FairOptions{.ratio = 2}, FairOptions{.max_error = -1},
          FairOptions{.map_size = 3}, FairOptions{.map_size = 1 << 20}}) {
        const auto result = make_fair(scene, options);
        REQUIRE_FALSE(result);
        CHECK(result.error().code == Errc::bad_argument);
    }
    const std::atomic<bool> stop = true;
    Monitor monitor;
    monitor.cancel = &stop;
    const auto result = make_fair(scene, {}, monitor);
    REQUIRE_FALSE(result);
    CHECK(result.error().code == Errc::cancelled);
}
