// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin.h"
#include "aglow/scene/builtin/machine_parts.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>

using namespace aglow;

namespace {

constexpr const char* kMoving[] = {"walker", "marbles", "toys", "forest", "scatter"};

Scene make(const std::string& name) {
    auto scene = builtin_scene(name);
    REQUIRE(scene);
    return std::move(*scene);
}

/// Triangles of all nodes, meshes that several share counted for each.
size_t placed_triangles(const Scene& scene) {
    size_t count = 0;
    for (const Node& node : scene.nodes) {
        if (node.mesh < 0) continue;
        for (const Primitive& p : scene.meshes[static_cast<size_t>(node.mesh)].primitives)
            count += p.triangles.size();
    }
    return count;
}

size_t node_named(const Scene& scene, const std::string& name) {
    const auto at = std::find_if(scene.nodes.begin(), scene.nodes.end(),
                                 [&](const Node& node) { return node.name == name; });
    REQUIRE(at != scene.nodes.end());
    return static_cast<size_t>(at - scene.nodes.begin());
}

vec3 place(const mat4& world) { return transform_point(world, {0, 0, 0}); }

/// Cosine of half the angle between two orientations.
float half_angle_cosine(const float* a, const float* b) {
    return std::abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
}

double signed_volume(const builtin::Shape& shape) {
    double sum = 0;
    for (const uvec3 t : shape.triangles) {
        const auto& p = shape.positions;
        sum += static_cast<double>(dot(p[t.x], cross(p[t.y], p[t.z]))) / 6;
    }
    return sum;
}

bool is_watertight(const builtin::Shape& shape) {
    using Point = std::tuple<float, float, float>;
    std::map<std::pair<Point, Point>, int> balance;
    const auto key = [&](uint32_t v) {
        const vec3 p = shape.positions[v];
        return Point(p.x, p.y, p.z);
    };
    for (const uvec3 t : shape.triangles)
        for (const auto& [from, to] : {std::pair(t.x, t.y), {t.y, t.z}, {t.z, t.x}}) {
            ++balance[{key(from), key(to)}];
            --balance[{key(to), key(from)}];
        }
    return std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

}  // namespace

TEST_CASE("the moving scenes have the sizes of those that they stand in for") {
    const std::map<std::string, size_t> sizes = {{"walker", 16'000},
                                                 {"marbles", 9'000},
                                                 {"toys", 11'000},
                                                 {"forest", 174'000},
                                                 {"scatter", 13'000}};
    for (const auto& [scene_name, size] : sizes) {
        const std::string name = scene_name;
        CAPTURE(name);
        const auto count = static_cast<double>(placed_triangles(make(name)));
        CHECK(count == doctest::Approx(static_cast<double>(size)).epsilon(0.04));
    }
}

TEST_CASE("every channel of a moving scene ends as it starts, all at one time") {
    for (const std::string name : kMoving) {
        CAPTURE(name);
        const Scene scene = make(name);
        REQUIRE(scene.animations.size() == 1);
        REQUIRE_FALSE(scene.animations[0].channels.empty());
        const float end = scene.animations[0].channels[0].times.back();
        CHECK(end > 1);
        CHECK(end <= 5);
        for (const AnimationChannel& channel : scene.animations[0].channels) {
            CHECK(channel.times.front() == 0);
            CHECK(channel.times.back() == end);
            CHECK(std::is_sorted(channel.times.begin(), channel.times.end()));
            const size_t width = channel.values.size() / channel.times.size();
            CHECK(channel.values.size() == width * channel.times.size());
            const float *first = channel.values.data(),
                        *last = first + channel.values.size() - width;
            if (channel.path == Path::rotation)
                CHECK(half_angle_cosine(first, last) == doctest::Approx(1));
            else
                CHECK(std::equal(first, first + width, last));
        }
    }
}

TEST_CASE("moving scenes have a camera, a light that casts shadows and something that reflects") {
    for (const std::string name : kMoving) {
        CAPTURE(name);
        const Scene scene = make(name);
        CHECK(scene.cameras.size() == 1);
        CHECK(scene.lights.size() == 1);
        CHECK(std::any_of(scene.materials.begin(), scene.materials.end(),
                          [](const Material& m) { return m.roughness <= 0.2f; }));
    }
}

TEST_CASE("a machine has as many triangles as asked for, give or take a box") {
    for (const size_t n : {12, 19, 20, 31, 100, 777, 5'000, 50'000, 112'000, 470'000}) {
        CAPTURE(n);
        const size_t count = placed_triangles(make("cad:" + std::to_string(n)));
        CHECK(count <= n);
        CHECK(count + 12 > n);
    }
}

TEST_CASE("parts of machines are closed, face outward and stay in their cell") {
    for (int kind = 0; kind < builtin::kMachinePartCount; ++kind)
        for (int level = 0; level < 3; ++level) {
            CAPTURE(kind);
            CAPTURE(level);
            const builtin::Shape shape =
                builtin::machine_part(static_cast<builtin::MachinePart>(kind), level);
            CHECK(is_watertight(shape));
            CHECK(signed_volume(shape) > 0);
            for (const vec3 p : shape.positions)
                CHECK(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 0.5001f);
        }
}

TEST_CASE("machines mix triangles whose areas differ ten thousandfold") {
    const Scene scene = make("cad:112000");
    std::vector<float> areas;
    for (const Node& node : scene.nodes) {
        if (node.mesh < 0 || !node.name.starts_with("part")) continue;
        for (const Primitive& p : scene.meshes[static_cast<size_t>(node.mesh)].primitives)
            for (const uvec3 t : p.triangles)
                areas.push_back(length(cross((p.positions[t.y] - p.positions[t.x]) * node.scale,
                                             (p.positions[t.z] - p.positions[t.x]) * node.scale)));
    }
    std::sort(areas.begin(), areas.end());
    CHECK(areas.back() > 1e4f * areas[areas.size() / 100]);
}

TEST_CASE("the walker's vertices follow up to four joints, with weights that add up to one") {
    const Scene scene = make("walker");
    REQUIRE(scene.skins.size() == 1);
    const Node& node = scene.nodes[node_named(scene, "mannequin")];
    REQUIRE(node.skin == 0);
    for (const Primitive& p : scene.meshes[static_cast<size_t>(node.mesh)].primitives) {
        REQUIRE(p.influences == 4);
        REQUIRE(p.weights.size() == 4 * p.positions.size());
        for (size_t v = 0; v < p.positions.size(); ++v) {
            float sum = 0;
            for (size_t i = 4 * v; i < 4 * v + 4; ++i) {
                sum += p.weights[i];
                CHECK(p.joints[i] < scene.skins[0].joints.size());
                CHECK((p.weights[i] > 0 || p.joints[i] == 0));
            }
            CHECK(sum == doctest::Approx(1).epsilon(1e-5));
        }
    }
}

TEST_CASE("the walker's skin is in its rest pose where no joint has turned") {
    const Scene scene = make("walker");
    const std::vector<mat4> world = world_transforms(scene);
    const Skin& skin = scene.skins[0];
    for (size_t j = 0; j < skin.joints.size(); ++j) {
        const mat4 m = world[static_cast<size_t>(skin.joints[j])] * skin.inverse_bind[j];
        for (size_t k = 0; k < 16; ++k) CHECK(m.m[k] == doctest::Approx(mat4{}.m[k]).epsilon(1e-5));
    }
}

TEST_CASE("one foot of the walker is always on the floor while the other is lifted") {
    const Scene scene = make("walker");
    const size_t left = node_named(scene, "foot left"), right = node_named(scene, "foot right");
    float highest = 0;
    for (int i = 0; i < 24; ++i) {
        const std::vector<mat4> world = world_transforms(scene, 1.2 * i / 24);
        const float a = place(world[left]).y, b = place(world[right]).y;
        CHECK(std::min(a, b) == doctest::Approx(0.1).epsilon(0.1));  // ankles are 10 cm high
        highest = std::max({highest, a, b});
    }
    CHECK(highest > 0.15f);
}

TEST_CASE("marbles stay in their tray, keep out of each other and roll without slip") {
    constexpr float kRadius = 0.05f;
    const Scene scene = make("marbles");
    const auto& channels = scene.animations[0].channels;
    const size_t keys = channels[0].times.size();
    std::vector<const AnimationChannel*> moves, turns;
    for (const AnimationChannel& channel : channels)
        (channel.path == Path::translation ? moves : turns).push_back(&channel);
    REQUIRE(moves.size() == 16);
    const auto at = [&](size_t marble, size_t key) {
        const float* v = &moves[marble]->values[3 * key];
        return vec3{v[0], v[1], v[2]};
    };
    double slip = 0, way = 0;
    for (size_t m = 0; m < moves.size(); ++m)
        for (size_t k = 0; k < keys; ++k) {
            CHECK(std::abs(at(m, k).x) < 0.42f - kRadius + 0.002f);
            CHECK(std::abs(at(m, k).z) < 0.30f - kRadius + 0.002f);
            CHECK(at(m, k).y == kRadius);
            for (size_t n = 0; n < m; ++n) CHECK(length(at(m, k) - at(n, k)) > 1.95f * kRadius);
            if (k == 0) continue;
            const float cosine =
                half_angle_cosine(&turns[m]->values[4 * (k - 1)], &turns[m]->values[4 * k]);
            const double angle = 2 * std::acos(std::min(1.0, double(cosine)));
            const double straight = double(length(at(m, k) - at(m, k - 1)));
            way += straight;
            slip += std::abs(angle * double(kRadius) - straight);
        }
    CHECK(way > 10);
    CHECK(slip < 0.05 * way);  // between keys a marble may turn round a corner
}

TEST_CASE("triangles of the scattered ball share no vertex and keep their shape in the clouds") {
    const Scene scene = make("scatter");
    const Mesh& mesh =
        scene.meshes[static_cast<size_t>(scene.nodes[node_named(scene, "shell")].mesh)];
    for (const Primitive& p : mesh.primitives) {
        CHECK(p.positions.size() == 3 * p.triangles.size());
        REQUIRE(p.targets.size() == 3);
        for (const size_t target : {size_t{0}, size_t{2}})
            for (const uvec3 t : p.triangles) {
                const auto edge = [&](uint32_t a, uint32_t b) {
                    return p.positions[b] - p.positions[a];
                };
                const auto moved = [&](uint32_t a, uint32_t b) {
                    const auto& d = p.targets[target].positions;
                    return edge(a, b) + d[b] - d[a];
                };
                CHECK(length(moved(t.x, t.y)) ==
                      doctest::Approx(length(edge(t.x, t.y))).epsilon(1e-3));
                CHECK(length(moved(t.x, t.z)) ==
                      doctest::Approx(length(edge(t.x, t.z))).epsilon(1e-3));
            }
    }
}

TEST_CASE("the scattered ball's triangles cross each other's ways") {
    // Neighbours on the ball end up far apart: the mean distance of two random points in a ball of
    // radius r is 36/35 r, and the cloud's is flattened to 0.8 of it along one axis.
    const Scene scene = make("scatter");
    const Mesh& mesh =
        scene.meshes[static_cast<size_t>(scene.nodes[node_named(scene, "shell")].mesh)];
    const Primitive& p = mesh.primitives[0];
    double sum = 0;
    for (size_t t = 1; t < p.triangles.size(); ++t) {
        const auto at = [&](size_t i) {
            return p.positions[3 * i] + p.targets[0].positions[3 * i];
        };
        sum += double(length(at(t) - at(t - 1)));
    }
    CHECK(sum / double(p.triangles.size() - 1) == doctest::Approx(36.0 / 35 * 1.05).epsilon(0.1));
}
