// SPDX-License-Identifier: Apache-2.0
// Refined surfaces as engine `raster` draws them, against those of refine_scene() drawn as they are
// and against closed forms.
#include "aglow/refine/refine_scene.h"
#include "aglow/render/testing/raster.h"
#include "aglow/scene/builtin.h"
#include "aglow/vk/testing/test_device.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

using namespace aglow;
using namespace aglow::render::testing;

namespace {

using Kind = Refinement::Kind;

/// The same surface, drawn refined and refined before.
struct Twins {
    Kind kind = Kind::none;
    RefineScheme scheme = RefineScheme::loop;
};

RasterOptions refined_by(Kind kind, int level) {
    return {.samples = 4, .refinement = {kind, level}};
}

/// The scene as it stands at `time`, every placement a mesh of its own that nothing moves.
Scene frozen(const Scene& scene, double time) {
    const Surfaces surfaces = pose(scene, time);
    Scene result;
    result.materials = scene.materials;
    result.lights = scene.lights;
    const SurfacePart* last = nullptr;
    for (const SurfacePart& part : surfaces.parts) {
        if (!last || last->node != part.node || last->instance != part.instance) {
            Node node;
            node.mesh = static_cast<int>(result.meshes.size());
            result.nodes.push_back(node);
            result.meshes.push_back({});
        }
        last = &part;
        const Primitive& from = scene.meshes[static_cast<size_t>(part.mesh)]
                                    .primitives[static_cast<size_t>(part.primitive)];
        Primitive p;
        p.material = part.material;
        p.creases = from.creases;
        p.corners = from.corners;
        for (uint32_t v = part.first_vertex; v < part.first_vertex + part.vertex_count; ++v) {
            p.positions.push_back(surfaces.positions[v]);
            p.normals.push_back(surfaces.normals[v]);
        }
        for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
            const uvec3 triangle = surfaces.triangles[t];
            p.triangles.push_back({triangle.x - part.first_vertex, triangle.y - part.first_vertex,
                                   triangle.z - part.first_vertex});
        }
        result.meshes.back().primitives.push_back(std::move(p));
    }
    return result;
}

/// Without textures, under a light that shows which way surfaces face.
Scene shaded(Scene scene) {
    scene.lights.clear();
    for (Node& node : scene.nodes) node.light = -1;
    for (Material& material : scene.materials) {
        material = diffuse({0.8f, 0.8f, 0.8f});
        material.double_sided = true;
    }
    scene.sky = Sky{{1, 1, 1}, nullptr};
    Image image(32, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            image.at(x, y) = {2 + std::sin(0.2f * static_cast<float>(x)),
                              2 + std::cos(0.2f * static_cast<float>(y)), 2};
    scene.sky->image = std::make_shared<const Image>(image);
    return scene;
}

Scene refined(const Scene& scene, RefineScheme scheme, int level,
              std::optional<float> crease_angle = std::nullopt) {
    RefineOptions options;
    options.scheme = scheme;
    options.level = level;
    options.control.crease_angle = crease_angle;
    options.limit = scheme == RefineScheme::loop || scheme == RefineScheme::catmull_clark;
    return demand(refine_scene(scene, options));
}

double relative_difference(const Image& a, const Image& b) {
    return demand(difference(a, b)).relative_rmse;
}

constexpr vec4 kTurned{0.2588f, 0.1294f, 0.0647f, 0.9549f};

/// An octahedron, turned, some of whose edges are creases; one of these ends inside the surface.
Scene creased_octahedron(bool mirrored) {
    Scene scene = octahedron(mirrored);
    scene.nodes[0].rotation = kTurned;
    scene.meshes[0].primitives[0].creases = {
        {0, 1, kSharp}, {3, 4, kSharp}, {6, 7, kSharp}, {1, 2, 1.5f}, {5, 3, kSharp}};
    return scene;
}

/// Pixels of the background between the first and the last of the rows' others.
int gaps(const Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        int first = image.width, last = -1;
        for (int x = 0; x < image.width; ++x)
            if (image.at(x, y).x > 0) {
                first = std::min(first, x);
                last = x;
            }
        for (int x = first; x < last; ++x) count += image.at(x, y).x == 0;
    }
    return count;
}

/// A cube of side 2 with flat normals, each side a primitive of its own.
Scene cube() {
    Scene scene;
    scene.materials.push_back(unlit({1, 1, 1}));
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const auto corner = [&](float u, float v) {
                const vec3 p{side, side * u, v};
                return axis == 0 ? p : axis == 1 ? vec3{p.z, p.x, p.y} : vec3{p.y, p.z, p.x};
            };
            Primitive p;
            p.material = 0;
            aglow::testing::add_quad(p, corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1));
            mesh.primitives.push_back(p);
        }
    scene.meshes.push_back(mesh);
    Node node;
    node.mesh = 0;
    node.rotation = kTurned;
    scene.nodes.push_back(node);
    return scene;
}

}  // namespace

TEST_CASE("subdivided surfaces are those of refine_scene at the limit") {
    vk::TestDevice device;
    if (!device) return;
    for (const bool mirrored : {false, true})
        for (const Twins twins : {Twins{Kind::loop, RefineScheme::loop},
                                  Twins{Kind::catmull_clark, RefineScheme::catmull_clark}})
            for (const int level : {1, 3}) {
                CAPTURE(mirrored);
                CAPTURE(static_cast<int>(twins.scheme));
                CAPTURE(level);
                const Scene scene = shaded(creased_octahedron(mirrored));
                const View view = from_above(4, 1.1f, 96);
                const Image wanted =
                    rastered(device.gpu(), {refined(scene, twins.scheme, level)}, view);
                const Image drawn =
                    rastered(device.gpu(), {scene}, view, -1, refined_by(twins.kind, level));
                CHECK(relative_difference(drawn, wanted) < 1e-3);
                CHECK(relative_difference(rastered(device.gpu(), {scene}, view), wanted) > 0.05);
            }
}

TEST_CASE("what moves is subdivided as it stands: skins, morph targets, and many placements") {
    vk::TestDevice device;
    if (!device) return;
    for (const char* name : {"walker", "toys"}) {
        CAPTURE(name);
        const Scene scene = shaded(demand(builtin_scene(name)));
        const View view = auto_view(scene, 0.7, 96, 72);
        const auto renderer =
            demand(make_raster_frame_renderer(device.gpu(), {scene}, refined_by(Kind::loop, 1)));
        Image before;
        for (const double time : {0.2, 0.7}) {
            CAPTURE(time);
            const Image drawn = demand(renderer->draw(time, view, {})).luminance;
            const Scene still = shaded(refined(frozen(scene, time), RefineScheme::loop, 1));
            CHECK(relative_difference(drawn, rastered(device.gpu(), {still}, view)) < 2e-3);
            if (before.width > 0) CHECK(relative_difference(drawn, before) > 0.02);
            before = drawn;
        }
    }
}

TEST_CASE("Loop's limit of an octahedron has the outline that is known") {
    vk::TestDevice device;
    if (!device) return;
    // A vertex of valence 4 has the mask 1 : 4 w, w = 1 / (4 + 3 / (8 beta)), beta = (5/8 -
    // (3/8)^2) / 4; its neighbours add up to 0.
    const double w = 1 / (4 + 3 / (8 * (0.625 - 0.140625) / 4));
    const double tip = 1 - 4 * w;
    const View view = from_above(4, 0.5f, 128);
    for (const bool blended : {false, true}) {
        CAPTURE(blended);
        Scene scene = octahedron(false);
        if (blended) {
            scene.materials[0].alpha_mode = AlphaMode::blend;
            scene.materials[0].base_color.w = 0.5f;
        }
        const auto share = [&](int level) {
            return covered(
                rastered(device.gpu(), {scene}, view, -1, refined_by(Kind::loop, level)));
        };
        CHECK(share(0) == doctest::Approx((blended ? 0.5 : 1) * 2 * tip * tip).epsilon(0.01));
        CHECK(share(4) > 1.2 * share(0));
        CHECK(share(4) < (blended ? 0.5 : 1) * kPi * tip * tip * 1.05);
    }
}

TEST_CASE("closed surfaces have no gaps: creases of normals, seams, primitives") {
    vk::TestDevice device;
    if (!device) return;
    Scene creased = creased_octahedron(false);
    creased.meshes[0].primitives[0].creases[3].sharpness = 0.5f;
    for (const Scene& scene : {cube(), creased})
        for (const Kind kind : {Kind::pn, Kind::tagged, Kind::loop, Kind::catmull_clark})
            for (const int level : {1, 4}) {
                CAPTURE(static_cast<int>(kind));
                CAPTURE(level);
                RasterOptions options = refined_by(kind, level);
                options.samples = 1;
                const Image drawn =
                    rastered(device.gpu(), {scene}, from_above(4, 1.5f, 301), -1, options);
                CHECK(covered(drawn) > 0.1);
                CHECK(gaps(drawn) == 0);
            }
}

TEST_CASE("curved triangles of a file without normals follow smooth ones") {
    vk::TestDevice device;
    if (!device) return;
    const Scene smooth = shaded(octahedron(true));
    Scene flat = smooth;
    Primitive& p = flat.meshes[0].primitives[0];
    for (size_t t = 0; t < p.triangles.size(); ++t) {
        const vec3 n = normalize(cross(p.positions[3 * t + 1] - p.positions[3 * t],
                                       p.positions[3 * t + 2] - p.positions[3 * t]));
        std::fill_n(p.normals.begin() + 3 * static_cast<std::ptrdiff_t>(t), 3, n);
    }
    const View view = from_above(4, 1.25f, 64);
    const RasterOptions curved = refined_by(Kind::pn, 3);
    const auto drawn = [&](const Scene& scene) {
        return rastered(device.gpu(), {scene}, view, -1, curved);
    };
    const Image wanted = drawn(smooth), faceted = drawn(flat);
    CHECK(relative_difference(faceted, wanted) > 0.05);
    for (uint32_t v = 0; v < p.positions.size(); ++v) p.source_vertex.push_back(v);
    CHECK(relative_difference(drawn(flat), wanted) < 1e-4);
    // Creases part them: here everywhere.
    for (const uvec3 t : p.triangles)
        for (const auto& [a, b] : {std::pair{t.x, t.y}, std::pair{t.y, t.z}, std::pair{t.z, t.x}})
            p.creases.push_back({a, b, kSharp});
    CHECK(relative_difference(drawn(flat), faceted) < 1e-4);
}

TEST_CASE("edges above the crease angle stay sharp as refine_scene keeps them") {
    vk::TestDevice device;
    if (!device) return;
    const Scene scene = shaded(cube());
    const View view = from_above(4, 1.9f, 96);
    for (const Twins twins :
         {Twins{Kind::pn, RefineScheme::pn}, Twins{Kind::loop, RefineScheme::loop}})
        for (const float angle : {kPi / 3, 2 * kPi / 3}) {  // faces meet at pi / 2
            CAPTURE(static_cast<int>(twins.kind));
            CAPTURE(angle);
            RasterOptions options = refined_by(twins.kind, 2);
            options.refinement.crease_angle = angle;
            const Image drawn = rastered(device.gpu(), {scene}, view, -1, options);
            const Image wanted =
                rastered(device.gpu(), {refined(scene, twins.scheme, 2, angle)}, view);
            CHECK(relative_difference(drawn, wanted) < 2e-3);
            const Image flat = rastered(device.gpu(), {scene}, view);
            CHECK((relative_difference(drawn, flat) < 0.01) == (angle < kPi / 2));
        }
}

TEST_CASE("levels that do not exist or do not fit are errors that say so") {
    vk::DeviceOptions small;
    small.faults.memory_bytes = uint64_t{64} << 20;
    vk::TestDevice device(small);
    if (!device) return;
    const Scene scene = octahedron(false);
    const auto made = [&](const Scene& of, Kind kind, int level) {
        return make_raster_frame_renderer(device.gpu(), {of}, refined_by(kind, level));
    };
    CHECK(made(scene, Kind::loop, kMostRefinement));
    CHECK(made(scene, Kind::loop, kMostRefinement + 1).error().code == Errc::bad_argument);
    CHECK(made(scene, Kind::loop, -1).error().code == Errc::bad_argument);
    CHECK(made(scene, Kind::catmull_clark, 1));
    CHECK(made(scene, Kind::catmull_clark, 0).error().code == Errc::bad_argument);
    const Error error = made(demand(builtin_scene("toys")), Kind::loop, 6).error();
    CHECK(error.code == Errc::out_of_memory);
    CHECK(error.message.find("refinement level 6") != std::string::npos);
    Scene empty;
    CHECK(made(empty, Kind::loop, 2));
}
