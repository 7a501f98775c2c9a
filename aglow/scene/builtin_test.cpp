// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin.h"

#include "aglow/scene/builtin/geometry.h"
#include "aglow/scene/write.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

using namespace aglow;

namespace {

struct Triangle {
    vec3 a, b, c;
    int material;

    vec3 area_normal() const { return cross(b - a, c - a) * 0.5f; }
    vec3 center() const { return (a + b + c) / 3; }
};

Scene make(const std::string& name) {
    auto scene = builtin_scene(name);
    REQUIRE(scene);
    return std::move(*scene);
}

std::vector<Triangle> triangles_of(const Mesh& mesh) {
    std::vector<Triangle> triangles;
    for (const Primitive& p : mesh.primitives)
        for (const uvec3 t : p.triangles)
            triangles.push_back({p.positions[t.x], p.positions[t.y], p.positions[t.z], p.material});
    return triangles;
}

/// Objects stand in the scenes without transforms.
std::vector<Triangle> triangles_of(const Scene& scene) {
    std::vector<Triangle> all;
    for (const Mesh& mesh : scene.meshes) {
        const std::vector<Triangle> more = triangles_of(mesh);
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

const Mesh& mesh_named(const Scene& scene, const std::string& name) {
    const auto at = std::find_if(scene.meshes.begin(), scene.meshes.end(),
                                 [&](const Mesh& mesh) { return mesh.name == name; });
    REQUIRE(at != scene.meshes.end());
    return *at;
}

const Material& material_named(const Scene& scene, const std::string& name) {
    const auto at = std::find_if(scene.materials.begin(), scene.materials.end(),
                                 [&](const Material& m) { return m.name == name; });
    REQUIRE(at != scene.materials.end());
    return *at;
}

double area(const std::vector<Triangle>& triangles) {
    double sum = 0;
    for (const Triangle& t : triangles) sum += static_cast<double>(length(t.area_normal()));
    return sum;
}

/// Positive for a closed surface that faces outward, negative for one that faces inward.
double signed_volume(const std::vector<Triangle>& triangles) {
    double sum = 0;
    for (const Triangle& t : triangles) sum += static_cast<double>(dot(t.a, cross(t.b, t.c))) / 6;
    return sum;
}

/// Every edge is run along as often in one direction as in the other: no rim is left open.
bool is_watertight(const std::vector<Triangle>& triangles) {
    using Point = std::tuple<float, float, float>;
    const auto key = [](vec3 p) { return Point(p.x, p.y, p.z); };
    std::map<std::pair<Point, Point>, std::pair<int, int>> uses;  // forward, backward
    for (const Triangle& t : triangles)
        for (const auto& [from, to] : {std::pair(t.a, t.b), {t.b, t.c}, {t.c, t.a}}) {
            const bool forward = key(from) < key(to);
            const auto edge =
                forward ? std::pair(key(from), key(to)) : std::pair(key(to), key(from));
            ++(forward ? uses[edge].first : uses[edge].second);
        }
    return std::all_of(uses.begin(), uses.end(),
                       [](const auto& e) { return e.second.first == e.second.second; });
}

double flux(const Scene& scene, const Mesh& mesh) {
    double sum = 0;
    for (const Triangle& t : triangles_of(mesh)) {
        const Material& m = scene.materials[static_cast<size_t>(t.material)];
        sum += M_PI * static_cast<double>(luminance(m.emission) * length(t.area_normal()));
    }
    return sum;
}

/// Does something of the scene lie between two points?
bool blocked(const std::vector<Triangle>& triangles, vec3 from, vec3 to) {
    const vec3 d = to - from;
    for (const Triangle& t : triangles) {
        const vec3 u = t.b - t.a, v = t.c - t.a, p = cross(d, v), s = from - t.a, q = cross(s, u);
        const float det = dot(u, p);
        if (std::abs(det) < 1e-9f) continue;
        const float x = dot(s, p) / det, y = dot(d, q) / det, at = dot(v, q) / det;
        if (x >= 0 && y >= 0 && x + y <= 1 && at > 1e-4f && at < 1 - 1e-4f) return true;
    }
    return false;
}

vec3 random_point(const Triangle& t, builtin::Dice& dice) {
    float x = dice.next(), y = dice.next();
    if (x + y > 1) x = 1 - x, y = 1 - y;
    return t.a + (t.b - t.a) * x + (t.c - t.a) * y;
}

bool sees(const std::vector<Triangle>& scene, const Triangle& from, vec3 p, const Triangle& to,
          vec3 q) {
    return dot(from.area_normal(), q - p) > 0 && dot(to.area_normal(), p - q) > 0 &&
           !blocked(scene, p, q);
}

}  // namespace

TEST_CASE("the built-in scenes are those of the command line, and each can be made") {
    std::vector<std::string> names;
    for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
    CHECK(names == std::vector<std::string>{"cornell-box", "furnace", "cube-tc58", "corridor",
                                            "living-room", "chess", "walker", "marbles", "toys",
                                            "forest", "scatter", "stress:N", "cad:N",
                                            "sculpture:N"});
    for (const std::string& name : names)
        if (!name.ends_with(":N")) CHECK(make(name).name == name);
}

TEST_CASE("names that are no scene are bad arguments, and the error says which there are") {
    const auto scene = builtin_scene("cornell");
    REQUIRE_FALSE(scene);
    CHECK(scene.error().code == Errc::bad_argument);
    CHECK(scene.error().message.find("cornell-box, furnace") != std::string::npos);
    for (const char* name : {"stress:", "stress:11", "stress:20000001", "stress:-12", "stress:12x",
                             "stress:99999999999999999999", "stress:N", "cad:", "cad:11",
                             "cad:20000001", "cadx:12", ""})
        CHECK(builtin_scene(name).error().code == Errc::bad_argument);
}

TEST_CASE("the closed scenes are watertight rooms seen from inside, of the size they claim") {
    struct Room {
        const char* name;
        double volume, surface;
    };
    // The corridor: 2 m wide and 2.5 m high, legs of 10 m and a passage of 6 m between them.
    constexpr double kPlan = 2 * 10 * 2 + 6 * 2, kOutline = 2 * (10 + 10) + 2 * 8;
    for (const Room& room : {Room{"furnace", 8, 24},
                             {"cube-tc58", 64, 96},
                             {"corridor", kPlan * 2.5, 2 * kPlan + kOutline * 2.5}}) {
        CAPTURE(room.name);
        const std::vector<Triangle> triangles = triangles_of(make(room.name));
        CHECK(is_watertight(triangles));
        CHECK(signed_volume(triangles) == doctest::Approx(-room.volume).epsilon(1e-5));
        CHECK(area(triangles) == doctest::Approx(room.surface).epsilon(1e-5));
    }
}

TEST_CASE("every wall of the furnace emits 100 cd/m2 and reflects half") {
    const Scene scene = make("furnace");
    REQUIRE(scene.materials.size() == 1);
    CHECK(scene.materials[0].emission == vec3{100, 100, 100});
    CHECK(scene.materials[0].base_color == vec4{0.5f, 0.5f, 0.5f, 1});
    CHECK(scene.materials[0].metallic == 0);
}

TEST_CASE("the cube's lamp emits 10 000 lm from the centre") {
    const Scene scene = make("cube-tc58");
    REQUIRE(scene.lights.size() == 1);
    CHECK(scene.lights[0].kind == LightKind::point);
    CHECK(4 * M_PI * static_cast<double>(luminance(scene.lights[0].intensity)) ==
          doctest::Approx(10'000));
    const auto node = std::find_if(scene.nodes.begin(), scene.nodes.end(),
                                   [](const Node& n) { return n.light == 0; });
    REQUIRE(node != scene.nodes.end());
    CHECK(node->translation == vec3{0, 0, 0});
}

TEST_CASE("the Cornell box has the published measures") {
    const Scene scene = make("cornell-box");
    const std::vector<Triangle> all = triangles_of(scene);
    CHECK(all.size() == 32);
    CHECK(area(triangles_of(mesh_named(scene, "lamp"))) == doctest::Approx(0.130 * 0.105));
    CHECK(area(triangles_of(mesh_named(scene, "ceiling"))) == doctest::Approx(0.556 * 0.5592));
    // A trapezium: 552.8 mm at the front, 549.6 mm at the back.
    CHECK(area(triangles_of(mesh_named(scene, "floor"))) ==
          doctest::Approx((0.5528 + 0.5496) / 2 * 0.5592));
    CHECK(area(triangles_of(mesh_named(scene, "right wall"))) == doctest::Approx(0.5488 * 0.5592));
    const vec3 e = material_named(scene, "lamp").emission;
    CHECK(luminance(e) == doctest::Approx(10'000));
    CHECK(e.x / e.z == doctest::Approx(18.4 / 8.0));
    CHECK(e.y / e.z == doctest::Approx(15.6 / 8.0));
}

TEST_CASE("in the Cornell box walls face the room, blocks face away from themselves") {
    const Scene scene = make("cornell-box");
    const vec3 middle{0.278f, 0.274f, 0.28f};
    for (const char* name : {"floor", "ceiling", "back wall", "left wall", "right wall", "lamp"})
        for (const Triangle& t : triangles_of(mesh_named(scene, name))) {
            CAPTURE(name);
            CHECK(dot(t.area_normal(), middle - t.center()) > 0);
        }
    // Blocks are open below, at height 0, where they add nothing to the volume integral.
    CHECK(signed_volume(triangles_of(mesh_named(scene, "short block"))) ==
          doctest::Approx(0.165 * 0.167 * 0.160).epsilon(0.02));
    CHECK(signed_volume(triangles_of(mesh_named(scene, "tall block"))) ==
          doctest::Approx(0.330 * 0.165 * 0.167).epsilon(0.02));
}

TEST_CASE("the Cornell box shows red on the left and green on the right, as published") {
    const Scene scene = make("cornell-box");
    const auto camera = std::find_if(scene.nodes.begin(), scene.nodes.end(),
                                     [](const Node& n) { return n.camera >= 0; });
    REQUIRE(camera != scene.nodes.end());
    const mat4 to_world = compose(camera->translation, camera->rotation, camera->scale);
    const vec3 right = transform_direction(to_world, {1, 0, 0});
    const vec3 ahead = transform_direction(to_world, {0, 0, -1});
    const auto across = [&](const char* name) {
        return dot(triangles_of(mesh_named(scene, name))[0].center() - camera->translation, right);
    };
    CHECK(across("left wall") < 0);
    CHECK(across("right wall") > 0);
    CHECK(ahead.z == doctest::Approx(1));
    CHECK(material_named(scene, "red").base_color.x > 0.6f);
    CHECK(material_named(scene, "green").base_color.y > 0.4f);
    // The opening, 552.8 mm wide 800 mm ahead, fills the published square picture.
    const float half = std::tan(scene.cameras[0].y_fov / 2) * 0.8f;
    CHECK(half == doctest::Approx(0.8 * 12.5 / 35).epsilon(1e-3));
}

TEST_CASE("light reaches the corridor's end after two reflections at least") {
    const Scene scene = make("corridor");
    const std::vector<Triangle> all = triangles_of(scene);
    std::vector<Triangle> lamp, end;
    for (const Triangle& t : all) {
        if (luminance(scene.materials[static_cast<size_t>(t.material)].emission) > 0)
            lamp.push_back(t);
        if (t.center().x > 3 && t.center().z < -4) end.push_back(t);
    }
    REQUIRE(lamp.size() == 2);
    REQUIRE(end.size() >= 8);
    builtin::Dice dice(1);
    int lit_places = 0, places_before_end = 0, both = 0;
    for (int round = 0; round < 6; ++round)
        for (const Triangle& t : all) {
            const vec3 p = random_point(t, dice);
            bool lit = false, before_end = false;
            for (int i = 0; i < 6; ++i) {
                const Triangle& l = lamp[static_cast<size_t>(i) % lamp.size()];
                const Triangle& e = end[static_cast<size_t>(i) % end.size()];
                lit = lit || sees(all, t, p, l, random_point(l, dice));
                before_end = before_end || sees(all, t, p, e, random_point(e, dice));
            }
            lit_places += lit;
            places_before_end += before_end;
            both += lit && before_end;
        }
    CHECK(lit_places > 50);
    CHECK(places_before_end > 50);
    CHECK(both == 0);
}

TEST_CASE("stress scenes have as many triangles as a closed mesh can without exceeding N") {
    for (const size_t n : {12, 13, 14, 15, 16, 17, 18, 20, 27, 28, 29, 100, 999, 1000, 12'345}) {
        CAPTURE(n);
        const Scene scene = make("stress:" + std::to_string(n));
        const std::vector<Triangle> all = triangles_of(scene);
        // Closed surfaces have an even number of triangles, and none has two.
        const size_t expected = n < 16 ? 12 : n / 2 * 2;
        CHECK(all.size() == expected);
        CHECK(is_watertight(all));
        for (const Mesh& mesh : scene.meshes)
            if (mesh.name != "room") CHECK(signed_volume(triangles_of(mesh)) > 0);
        CHECK(signed_volume(triangles_of(mesh_named(scene, "room"))) == doctest::Approx(-400));
    }
}

TEST_CASE("chess pieces are closed, stand on the board and keep within their squares") {
    const Scene scene = make("chess");
    const std::vector<mat4> transforms = world_transforms(scene);
    std::set<std::pair<float, float>> squares;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.name.starts_with("white") && !node.name.starts_with("black")) continue;
        CAPTURE(node.name);
        const std::vector<Triangle> piece =
            triangles_of(scene.meshes[static_cast<size_t>(node.mesh)]);
        CHECK(is_watertight(piece));
        CHECK(signed_volume(piece) > 0);
        Box box;
        for (const Triangle& t : piece)
            for (const vec3 p : {t.a, t.b, t.c}) box.add(transform_point(transforms[i], p));
        CHECK(box.lo.y == 0);
        CHECK(box.hi.y < 0.1f);
        const vec3 middle = (box.lo + box.hi) * 0.5f;
        CHECK(std::max(std::abs(middle.x), std::abs(middle.z)) < 0.22f);
        CHECK(std::max(box.hi.x - box.lo.x, box.hi.z - box.lo.z) < 0.055f);
        CHECK(squares.emplace(std::round(middle.x * 1000), std::round(middle.z * 1000)).second);
    }
    CHECK(squares.size() == 19);
}

TEST_CASE("a chess piece has as many triangles as its profile says, and no vertex twice") {
    // Rings of 16, each but the first and last with two triangles to a side; the king's cross has 2
    // boxes.
    for (const auto& [piece, triangles] : {std::pair{ChessPiece::pawn, 288},
                                           {ChessPiece::bishop, 352},
                                           {ChessPiece::queen, 352},
                                           {ChessPiece::king, 344}}) {
        const CoarseShape shape = chess_piece(piece);
        CHECK(shape.triangles.size() == static_cast<size_t>(triangles));
        std::set<std::tuple<float, float, float>> places;
        for (const vec3 p : shape.positions) places.emplace(p.x, p.y, p.z);
        CHECK(places.size() == shape.positions.size());
    }
}

TEST_CASE("the living room is as large as promised and closed where it must be") {
    const Scene scene = make("living-room");
    const std::vector<Triangle> all = triangles_of(scene);
    CHECK(all.size() >= 20'000);
    CHECK(all.size() <= 60'000);

    std::vector<Triangle> shell = triangles_of(mesh_named(scene, "walls"));
    const std::vector<Triangle> floor = triangles_of(mesh_named(scene, "floor"));
    shell.insert(shell.end(), floor.begin(), floor.end());
    CHECK(is_watertight(shell));
    // Outer block less the room and the two windows' openings.
    CHECK(signed_volume(shell) ==
          doctest::Approx(5.5 * 4.5 * 3.2 - 5 * 4 * 2.7 - 2 * 1.8 * 1.85 * 0.25).epsilon(1e-4));
    CHECK(area(floor) == doctest::Approx(20));
}

TEST_CASE("what is solid in the living room is closed and faces outward") {
    const Scene scene = make("living-room");
    const std::set<std::string> not_closed_alone = {"walls",
                                                    "floor",
                                                    "plant",
                                                    "blanket",
                                                    "books on the table",
                                                    "books under the table",
                                                    "book pages",
                                                    "picture of hills",
                                                    "picture of discs",
                                                    "picture of leaves"};
    size_t closed = 0;
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.name.starts_with("curtain ") && mesh.name != "curtain rod") continue;
        if (not_closed_alone.count(mesh.name)) continue;
        CAPTURE(mesh.name);
        const std::vector<Triangle> triangles = triangles_of(mesh);
        CHECK(is_watertight(triangles));
        CHECK(signed_volume(triangles) > 0);
        ++closed;
    }
    CHECK(closed >= 30);
}

TEST_CASE("the living room's lamps emit the flux of the bulbs they stand for") {
    const Scene scene = make("living-room");
    CHECK(flux(scene, mesh_named(scene, "floor lamp bulb")) == doctest::Approx(1200));
    CHECK(flux(scene, mesh_named(scene, "table lamp bulb")) == doctest::Approx(800));
    CHECK(flux(scene, mesh_named(scene, "pendant globe")) == doctest::Approx(1500));
    for (const char* name : {"floor lamp bulb", "table lamp bulb", "pendant globe"})
        CHECK(triangles_of(mesh_named(scene, name)).size() <= 200);
}

TEST_CASE("the living room's sun comes from the south-south-west, 33 degrees high") {
    const Scene scene = make("living-room");
    REQUIRE(scene.lights.size() == 1);
    CHECK(scene.lights[0].kind == LightKind::directional);
    CHECK(luminance(scene.lights[0].intensity) == doctest::Approx(20'000));
    const auto node = std::find_if(scene.nodes.begin(), scene.nodes.end(),
                                   [](const Node& n) { return n.light == 0; });
    REQUIRE(node != scene.nodes.end());
    const vec3 to_sun = transform_direction(compose({}, node->rotation, {1, 1, 1}), {0, 0, 1});
    CHECK(std::asin(to_sun.y) == doctest::Approx(33 * M_PI / 180).epsilon(1e-4));
    CHECK(std::atan2(to_sun.x, -to_sun.z) ==
          doctest::Approx((206 - 360) * M_PI / 180).epsilon(1e-4));
}

TEST_CASE("normals are unit vectors on the front side of their triangles") {
    for (const char* name :
         {"cornell-box", "furnace", "cube-tc58", "corridor", "living-room", "chess", "walker",
          "marbles", "toys", "forest", "scatter", "stress:5000", "cad:5000"}) {
        const std::string scene_name = name;
        CAPTURE(scene_name);
        const Scene scene = make(name);
        size_t bad_length = 0, behind = 0, degenerate = 0, bad_texcoords = 0;
        for (const Mesh& mesh : scene.meshes)
            for (const Primitive& p : mesh.primitives) {
                REQUIRE(p.normals.size() == p.positions.size());
                for (const vec3 n : p.normals) bad_length += std::abs(length(n) - 1) > 1e-4f;
                for (const uvec3 t : p.triangles) {
                    const vec3 a = p.positions[t.x], b = p.positions[t.y], c = p.positions[t.z];
                    const vec3 n = cross(b - a, c - a);
                    degenerate += !(length(n) > 0);
                    for (const uint32_t v : {t.x, t.y, t.z}) behind += dot(n, p.normals[v]) <= 0;
                }
                const auto& material = scene.materials[static_cast<size_t>(p.material)];
                if (material.base_color_texture.texture >= 0)
                    bad_texcoords +=
                        p.texcoords.size() != 1 || p.texcoords[0].size() != p.positions.size();
            }
        CHECK(bad_length == 0);
        CHECK(degenerate == 0);
        CHECK(behind == 0);
        CHECK(bad_texcoords == 0);
    }
}

TEST_CASE("scenes have a camera, materials with names, and reflect less than they receive") {
    for (const char* name :
         {"cornell-box", "furnace", "cube-tc58", "corridor", "living-room", "stress:500"}) {
        const std::string scene_name = name;
        CAPTURE(scene_name);
        const Scene scene = make(name);
        CHECK(scene.cameras.size() == 1);
        std::set<std::string> names;
        for (const Material& m : scene.materials) {
            CHECK_FALSE(m.name.empty());
            CHECK(names.insert(m.name).second);
            CHECK(std::max({m.base_color.x, m.base_color.y, m.base_color.z}) <=
                  (m.base_color_texture.texture >= 0 ? 1.0f : 0.85f));
            CHECK(m.metallic == 0);
        }
        for (const Mesh& mesh : scene.meshes) CHECK_FALSE(mesh.name.empty());
    }
}

TEST_CASE("a scene is the same bytes every time") {
    for (const char* name : {"cornell-box", "living-room", "chess", "walker", "marbles", "forest",
                             "stress:3000", "cad:3000"}) {
        const auto first = to_glb(make(name)), second = to_glb(make(name));
        REQUIRE(first);
        REQUIRE(second);
        CHECK(*first == *second);
    }
}
