// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/gpu/device_surfaces.h"
#include "aglow/core/testing/scenes.h"

#include "aglow/core/testing/demand.h"
#include "aglow/scene/builtin.h"
#include "aglow/scene/load.h"
#include "aglow/shared/ray.h"
#include "aglow/vk/testing/primitives.h"

#include <doctest/doctest.h>

#include <rapidcheck.h>
#include <cstring>
#include <filesystem>
#include <set>

using namespace aglow;
using mesh::gpu::DeviceSurfaces;
using mesh::gpu::PartMotion;

namespace {

/// What the device may differ by. Compilers there fuse products into sums, which leaves out one
/// rounding of 2^-24 for each of the about 20 terms that make up a coordinate; `kPlace` is relative
/// to the largest coordinate, before or after. A normal is a difference of products of two columns,
/// so it loses as much as these cancel.
constexpr float kPlace = 2e-6f, kNormal = 2e-5f;

struct Difference {
    float place = 0, normal = 0;
    size_t windings = 0, corners = 0;

    bool is_small() const {
        return place <= kPlace && normal <= kNormal && windings == 0 && corners == 0;
    }
    void add(const Difference& other) {
        place = std::max(place, other.place);
        normal = std::max(normal, other.normal);
        windings += other.windings, corners += other.corners;
    }
};

float largest(std::span<const vec3> points) {
    float size = 0;
    for (const vec3 p : points)
        size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return size;
}

float largest_coordinate(const Scene& scene, const Surfaces& posed) {
    float size = largest(posed.positions);
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& primitive : mesh.primitives) {
            size = std::max(size, largest(primitive.positions));
            for (const MorphTarget& target : primitive.targets)
                size = std::max(size, largest(target.positions));
        }
    return size;
}

template <class T>
std::vector<T> fetch(vk::TestStream& test, uint64_t address, size_t count) {
    const std::vector<uint32_t> words = test.download(address, count * sizeof(T) / 4);
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), words.data(), count * sizeof(T));
    return values;
}

Difference difference(vk::TestStream& test, const DeviceSurfaces& device, const Scene& scene,
                      double time) {
    const Surfaces expected = pose(scene, time);
    const auto positions = fetch<vec3>(test, device.positions(), expected.positions.size());
    const auto normals = fetch<vec3>(test, device.normals(), expected.normals.size());
    const auto indices = fetch<uvec3>(test, device.indices(), expected.triangles.size());
    const auto corners = fetch<shared::Triangle>(test, device.corners(), expected.triangles.size());
    Difference d;
    const float size = largest_coordinate(scene, expected);
    for (size_t v = 0; v < positions.size(); ++v) {
        d.place = std::max(d.place, length(positions[v] - expected.positions[v]) / size);
        d.normal = std::max(d.normal, length(normals[v] - expected.normals[v]));
    }
    for (size_t t = 0; t < indices.size(); ++t) {
        d.windings += indices[t] != expected.triangles[t];
        const uvec3 i = indices[t];
        d.corners += corners[t].a != positions[i.x] || corners[t].b != positions[i.y] ||
                     corners[t].c != positions[i.z];
    }
    return d;
}

/// The largest difference over several times, in this order.
Difference difference(vk::TestStream& test, const Scene& scene, std::span<const double> times) {
    auto device = demand(DeviceSurfaces::create(test.stream, scene, pose(scene)));
    Difference all;
    for (const double time : times) {
        test.stream.barrier();
        demand(device.pose(test.stream, time));
        all.add(difference(test, device, scene, time));
    }
    return all;
}

constexpr std::array<double, 5> kTimes = {-1, 0, 0.37, 1.21, 100};

bool is_posed(const Scene& scene) {
    return !scene.animations.empty() || !scene.skins.empty() ||
           std::any_of(scene.nodes.begin(), scene.nodes.end(),
                       [](const Node& n) { return !n.instances.empty(); }) ||
           std::any_of(scene.meshes.begin(), scene.meshes.end(),
                       [](const Mesh& m) { return !m.weights.empty(); });
}

Primitive box() {
    Primitive p;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const auto first = static_cast<uint32_t>(p.positions.size());
            const auto at = [&](float u, float v) {
                const std::array<float, 3> c = {side, u, v};
                return vec3{c[static_cast<size_t>((3 - axis) % 3)],
                            c[static_cast<size_t>((4 - axis) % 3)],
                            c[static_cast<size_t>((5 - axis) % 3)]};
            };
            for (const vec2 c : {vec2{-1, -1}, {side, -side}, {1, 1}, {-side, side}}) {
                p.positions.push_back(at(c.x, c.y));
                p.normals.push_back(at(0, 0));
            }
            p.triangles.push_back({first, first + 1, first + 2});
            p.triangles.push_back({first, first + 2, first + 3});
        }
    return p;
}

Scene one_box() {
    Scene scene;
    scene.meshes.push_back({"box", {box()}, {}});
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    scene.animations.push_back({"motion", {}});
    return scene;
}

// ---- random rigs ----

float real(float lo, float hi) {
    constexpr int kSteps = 1000;
    return lo + (hi - lo) * static_cast<float>(*rc::gen::inRange(0, kSteps + 1)) / kSteps;
}
vec3 point(float size) { return {real(-size, size), real(-size, size), real(-size, size)}; }

/// Turned by up to about 40 degrees, so that blends of joints stay far from flat.
vec4 orientation() {
    const vec3 v = point(0.2f);
    const vec4 q{v.x, v.y, v.z, 1};
    return q * (1 / std::sqrt(dot(q, q)));
}

Primitive random_primitive(int targets, int joint_count) {
    Primitive p;
    const int vertex_count = *rc::gen::inRange(3, 200);
    for (int v = 0; v < vertex_count; ++v) {
        p.positions.push_back(point(2));
        p.normals.push_back(normalize(vec3{real(-1, 1), real(-1, 1), 1.1f}));
    }
    const auto vertex = [&] { return static_cast<uint32_t>(*rc::gen::inRange(0, vertex_count)); };
    const int triangle_count = *rc::gen::inRange(1, 150);
    for (int t = 0; t < triangle_count; ++t) p.triangles.push_back({vertex(), vertex(), vertex()});
    for (int t = 0; t < targets; ++t) {
        MorphTarget& target = p.targets.emplace_back();
        const bool positions = *rc::gen::arbitrary<bool>(), normals = *rc::gen::arbitrary<bool>();
        for (int v = 0; v < vertex_count; ++v) {
            if (positions) target.positions.push_back(point(1));
            if (normals) target.normals.push_back(point(0.05f));
        }
    }
    p.influences = 4 * *rc::gen::inRange(0, 4);
    for (int i = 0; i < vertex_count * p.influences; ++i) {
        p.joints.push_back(static_cast<uint32_t>(*rc::gen::inRange(0, joint_count)));
        p.weights.push_back(*rc::gen::arbitrary<bool>() ? real(0, 1) : 0);
    }
    if (p.influences > 0)
        for (int i = 0; i < p.influences; ++i) p.weights[static_cast<size_t>(i)] = 0;
    return p;
}

std::vector<float> random_keys(Path path, size_t width, size_t keys) {
    std::vector<float> values;
    for (size_t k = 0; k < keys; ++k) {
        if (path == Path::rotation) {
            const vec4 q = orientation();
            values.insert(values.end(), {q.x, q.y, q.z, q.w});
        } else {
            const bool scale = path == Path::scale;
            for (size_t i = 0; i < width; ++i)
                values.push_back(scale ? real(0.6f, 1.5f) : real(-1, 1));
        }
    }
    return values;
}

/// A chain of nodes, some with meshes, skins, targets, instances or mirrors, and channels on them.
Scene random_rig() {
    Scene scene;
    const int node_count = *rc::gen::inRange(2, 7), targets = *rc::gen::inRange(0, 6);
    const int primitives = *rc::gen::inRange(1, 4);
    scene.meshes.resize(1);
    for (int i = 0; i < primitives; ++i)
        scene.meshes[0].primitives.push_back(random_primitive(targets, node_count));
    for (int t = 0; t < targets; ++t) scene.meshes[0].weights.push_back(real(-1, 1));
    scene.skins.resize(1);
    scene.nodes.resize(static_cast<size_t>(node_count));
    scene.animations.push_back({"motion", {}});
    for (int n = 0; n < node_count; ++n) {
        Node& node = scene.nodes[static_cast<size_t>(n)];
        if (n > 0) {
            node.parent = *rc::gen::inRange(0, n);
            scene.nodes[static_cast<size_t>(node.parent)].children.push_back(n);
        }
        node.translation = point(1);
        node.rotation = orientation();
        node.scale = {n == 0 && *rc::gen::arbitrary<bool>() ? -1.0f : 1.0f, real(0.7f, 1.4f), 1};
        if (n == 0 || *rc::gen::arbitrary<bool>()) node.mesh = 0;
        if (*rc::gen::arbitrary<bool>()) node.skin = 0;
        for (int i = *rc::gen::inRange(0, 3); i > 0; --i)
            node.instances.push_back(
                compose(point(3), orientation(), {1, i == 1 ? -1.0f : 1.0f, 1}));
        scene.skins[0].joints.push_back(n);
        scene.skins[0].inverse_bind.push_back(compose(point(1), orientation(), {1, 1, 1}));
        for (const Path path : {Path::translation, Path::rotation, Path::weights}) {
            if (!*rc::gen::arbitrary<bool>() || (path == Path::weights && targets == 0)) continue;
            const size_t width = path == Path::weights    ? static_cast<size_t>(targets)
                                 : path == Path::rotation ? 4
                                                          : 3;
            scene.animations[0].channels.push_back(
                {n, path, Interpolation::linear, {0, 1, 2}, random_keys(path, width, 3)});
        }
    }
    return scene;
}

}  // namespace

TEST_CASE("built-in scenes are posed on the device as on the host") {
    const vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    for (const std::string name : {"walker", "marbles", "toys", "forest", "scatter", "cad:5000"}) {
        CAPTURE(name);
        const Difference d = difference(test, *builtin_scene(name), kTimes);
        CAPTURE(d.place);
        CAPTURE(d.normal);
        CHECK(d.is_small());
    }
}

TEST_CASE("all animated public test models are posed on the device as on the host") {
    const std::filesystem::path folder = scenes_folder() / "khronos";
    if (!is_here(folder)) return;
    const vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    int posed = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string type = entry.path().extension().string();
        if (type != ".gltf" && type != ".glb") continue;
        const auto scene = load_scene(entry.path());
        if (!scene || !is_posed(*scene)) continue;
        const std::string model = entry.path().filename().string();
        CAPTURE(model);
        const Difference d = difference(test, *scene, kTimes);
        CAPTURE(d.place);
        CAPTURE(d.normal);
        CHECK(d.is_small());
        ++posed;
    }
    CHECK(posed >= 10);
}

TEST_CASE("random rigs are posed on the device as on the host") {
    const vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    rc::check([&] {
        const Scene scene = random_rig();
        const Difference d = difference(test, scene, std::array{0.25, -1.0, 1.5});
        RC_TAG(d.is_small());
        RC_ASSERT(d.place <= kPlace);
        RC_ASSERT(d.normal <= kNormal);
        RC_ASSERT(d.windings == 0u);
        RC_ASSERT(d.corners == 0u);
    });
}

TEST_CASE("a node that turns inside out in the course of time turns its triangles round") {
    const vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    Scene scene = one_box();
    scene.animations[0].channels.push_back(
        {0, Path::scale, Interpolation::linear, {0, 1}, {1, 1, 1, -1, 1, 1}});
    auto surfaces = demand(DeviceSurfaces::create(test.stream, scene, pose(scene)));
    for (const double time : {0.0, 1.0}) {
        test.stream.barrier();
        demand(surfaces.pose(test.stream, time));
        const auto indices = fetch<uvec3>(test, surfaces.indices(), 12);
        CHECK(indices[0] == (time == 0 ? uvec3{0, 1, 2} : uvec3{0, 2, 1}));
        CHECK(difference(test, surfaces, scene, time).is_small());
    }
}

TEST_CASE("vertices that lose their normal take their first triangle's, as on the host") {
    const vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    Scene flattened = one_box();
    flattened.nodes[0].scale = {1, 0, 1};  // four sides become lines, whose normals vanish
    CHECK(difference(test, flattened, kTimes).is_small());
    Scene shrunk = one_box();
    shrunk.nodes[0].scale = {0, 0, 0};
    CHECK(difference(test, shrunk, kTimes).is_small());
    Scene bare = one_box();
    bare.meshes[0].primitives[0].normals.clear();
    bare.meshes[0].primitives[0].triangles.insert(bare.meshes[0].primitives[0].triangles.begin(),
                                                  {{0, 0, 1}, {4, 4, 4}});
    CHECK(difference(test, bare, kTimes).is_small());
}

TEST_CASE("after the first call only what moves is posed") {
    const vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    Scene scene = one_box();
    scene.nodes.push_back(scene.nodes[0]);  // stays where it is, among parts that move
    scene.nodes.push_back(scene.nodes[0]);
    for (const int node : {0, 2})
        scene.animations[0].channels.push_back(
            {node, Path::translation, Interpolation::linear, {0, 1}, {0, 0, 0, 8, 0, 0}});
    auto surfaces = demand(DeviceSurfaces::create(test.stream, scene, pose(scene)));
    CHECK(std::vector<PartMotion>(surfaces.part_motions().begin(), surfaces.part_motions().end()) ==
          std::vector{PartMotion::rigid, PartMotion::still, PartMotion::rigid});
    const std::array before = {surfaces.vertex_count(), surfaces.triangle_count()};
    CHECK(before == std::array{72u, 36u});
    demand(surfaces.pose(test.stream, 0));
    demand(test.stream.finish());
    test.stream.take_timings();

    // A mark in the place of each position shows which are written again.
    struct CopyArgs {
        uint32_t first_group, count;
        uint64_t from, to;
    };
    const vk::Buffer marks = test.upload(std::vector<vec3>(72, vec3{77, 77, 77}));
    test.stream.barrier();
    test.stream.run(test.copy_kernel, CopyArgs{0, 3 * 72, marks.address(), surfaces.positions()},
                    vk::group_count(3 * 72, 256));
    test.stream.barrier();
    demand(surfaces.pose(test.stream, 1));
    const auto positions = fetch<vec3>(test, surfaces.positions(), 72);
    for (size_t v = 0; v < 72; ++v) CHECK((positions[v].x == 77) == (v / 24 == 1));
    CHECK(surfaces.part_transforms()[0].at(0, 3) == 8);
    CHECK(surfaces.part_transforms()[1].at(0, 3) == 0);
    CHECK(surfaces.part_transforms()[2].at(0, 3) == 8);
}

TEST_CASE("between rest and motion even parts are posed whose channels hold one value") {
    const vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    Scene scene = one_box();
    scene.animations[0].channels.push_back(
        {0, Path::translation, Interpolation::step, {0}, {5, 0, 0}});
    CHECK(difference(test, scene, std::array{-1.0, 0.0, 1.0, -1.0}).is_small());
}

TEST_CASE("a scene without triangles is posed too") {
    const vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    const Scene scene;
    auto surfaces = demand(DeviceSurfaces::create(test.stream, scene, pose(scene)));
    demand(surfaces.pose(test.stream, 0));
    demand(test.stream.finish());
    CHECK(surfaces.triangle_count() == 0);
}

TEST_CASE("whichever buffer cannot be had, the error says that memory ran out, and nothing leaks") {
    const Scene scene = *builtin_scene("walker");
    const Surfaces rest = pose(scene);
    for (int n = 0;; ++n) {
        CAPTURE(n);
        vk::DeviceOptions options;
        options.faults.fail_allocation = n;
        const vk::TestDevice device(options);
        if (!device) return;
        vk::Stream stream = device.stream();
        auto surfaces = DeviceSurfaces::create(stream, scene, rest);
        Status status = surfaces ? surfaces->pose(stream, 0) : Status();
        if (status) status = stream.finish();
        if (!surfaces) CHECK(surfaces.error().code == Errc::out_of_memory);
        if (!status) CHECK(status.error().code == Errc::out_of_memory);
        if (n < device->allocation_count()) {
            CHECK_FALSE((surfaces && status));
            continue;
        }
        CHECK((surfaces && status));
        CHECK(n > 15);
        return;
    }
}
