// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu/device_patches.h"

#include "aglow/refine/testing/control_meshes.h"
#include "aglow/refine/testing/patch_meshes.h"
#include "aglow/vk/testing/primitives.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <set>

using namespace aglow;
using namespace aglow::refine::testing;
using refine::gpu::DevicePatches;
using refine::gpu::DevicePattern;
using shared::PatchLevels;

namespace {

/// Devices fuse products into sums and have sines and roots of their own.
constexpr float kAgreement = 1e-5f;  // of the mesh's diagonal

float diagonal(const PatchMesh& mesh) {
    Box box;
    for (const vec3 p : mesh.positions) box.add(p);
    return length(box.size());
}

/// Which refined vertex each vertex of a face's pattern is.
std::vector<uint32_t> pattern_vertices(const Topology& topology, const Tessellation& t,
                                       uint32_t f) {
    const uint32_t n = t.face_segments[f], corners = topology.face_size(f);
    const auto continuous = static_cast<uint32_t>(t.levels);
    const Pattern pattern =
        corners == 3 ? triangle_pattern(static_cast<int>(n)) : quad_pattern(static_cast<int>(n));
    uint32_t inside = t.face_first[f];
    std::vector<uint32_t> result;
    for (const uint32_t steps : pattern.steps) {
        const uint32_t i = steps & 0xffffu, j = steps >> 16;
        if (corners == 3 ? shared::inside_triangle(i, j, n) : shared::inside_quad(i, j, n)) {
            result.push_back(inside++);
            continue;
        }
        uint32_t side = 0, k = i;
        if (corners == 3) {
            if (j > 0) side = i == 0 ? 2 : 1, k = i == 0 ? n - j : j;
        } else if (j > 0) {
            side = i == n ? 1 : j == n ? 2 : 3;
            k = i == n ? j : j == n ? n - i : n - j;
        }
        const uint32_t h = topology.face_begin[f] + side, e = topology.edge[h];
        const uint32_t own = shared::edge_segments(t.edge_level[e], continuous);
        const bool forward = topology.vertex[h] < topology.end(h);
        const uint32_t from_low = shared::snapped(forward ? k : n - k, n, own, continuous);
        const uint32_t start = topology.vertex[t.edge_half[e]], end = topology.end(t.edge_half[e]);
        const uint32_t at = start < end ? from_low : own - from_low;
        result.push_back(at == 0 ? start : at == own ? end : t.edge_first[e] + at - 1);
    }
    return result;
}

PatchLevels levels_of(const Topology& topology, const Tessellation& t, uint32_t f) {
    PatchLevels levels = {{1, 1, 1, 1}, t.face_inner[f], static_cast<uint32_t>(t.levels)};
    for (uint32_t i = 0; i < topology.face_size(f); ++i)
        levels.edge[i] = t.edge_level[topology.edge[topology.face_begin[f] + i]];
    return levels;
}

struct Difference {
    float place = 0, normal = 0;
    size_t cracks = 0;
};

class Comparison {
public:
    explicit Comparison(const vk::TestDevice& device) : test_(device) {}

    /// Evaluates all faces with the patterns that the tessellation has for them.
    Difference compare(const PatchMesh& mesh, const PatchOptions& options, bool tagged,
                       const DisplacementMap* displacement, const Tessellation& t) {
        const Patches host = demand(Patches::create(mesh.topology, options));
        PatchControl control;
        host.update(tagged ? mesh.tagged_input() : mesh.input(), control);
        std::vector<vec3> positions(t.vertex_count()), normals_there(t.vertex_count());
        if (displacement)
            host.evaluate(control, t, *displacement, positions, normals_there);
        else
            host.evaluate(control, t, positions), host.evaluate_normals(control, t, normals_there);

        refine::gpu::DevicePatchInput input;
        if (tagged) input.tags = mesh.tags;
        input.displacement = displacement;
        const DevicePatches patches =
            demand(DevicePatches::create(test_.stream, mesh.topology, options, input));
        const vk::Buffer in_positions = test_.upload(mesh.positions);
        const vk::Buffer in_normals = test_.upload(mesh.normals);
        std::vector<PatchLevels> levels;
        for (uint32_t f = 0; f < mesh.topology.face_count(); ++f)
            levels.push_back(levels_of(mesh.topology, t, f));
        patches.set_levels(test_.stream, levels);
        test_.stream.barrier();
        patches.update(test_.stream, in_positions.address(), in_normals.address());
        test_.stream.barrier();

        Difference worst;
        std::map<uint32_t, vec3> known;
        for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) {
            const DevicePattern& pattern =
                pattern_of(mesh.topology.face_size(f), t.face_segments[f]);
            const vk::Buffer out = test_.make<vec3>(pattern.vertex_count);
            const vk::Buffer normals = test_.make<vec3>(pattern.vertex_count);
            test_.stream.barrier();
            patches.evaluate(test_.stream, pattern, DevicePatches::Levels::adaptive, f, 1,
                             out.address(), normals.address());
            const auto places = test_.download<vec3>(out, pattern.vertex_count);
            const auto directions = test_.download<vec3>(normals, pattern.vertex_count);
            const std::vector<uint32_t> vertices = pattern_vertices(mesh.topology, t, f);
            for (size_t v = 0; v < vertices.size(); ++v) {
                worst.place = std::max(worst.place, length(places[v] - positions[vertices[v]]));
                // On edges faces may have normals of their own: the host has one of them.
                if (vertices[v] >= t.face_first.front())
                    worst.normal =
                        std::max(worst.normal, length(directions[v] - normals_there[vertices[v]]));
                const vec3 first = known.try_emplace(vertices[v], places[v]).first->second;
                worst.cracks += std::memcmp(&first, &places[v], sizeof first) == 0 ? 0 : 1;
            }
        }
        CHECK(known.size() == t.vertex_count());
        return worst;
    }

private:
    const DevicePattern& pattern_of(uint32_t corners, int segments) {
        auto found = patterns_.find({corners, segments});
        if (found == patterns_.end()) {
            found =
                patterns_
                    .emplace(
                        std::pair(corners, segments),
                        demand(corners == 3
                                   ? refine::gpu::upload_triangle_pattern(test_.stream, segments)
                                   : refine::gpu::upload_quad_pattern(test_.stream, segments)))
                    .first;
        }
        return found->second;
    }

    vk::TestStream test_;
    std::map<std::pair<uint32_t, int>, DevicePattern> patterns_;
};

void check_small(const Difference& d, const PatchMesh& mesh) {
    CHECK(d.place <= kAgreement * diagonal(mesh));
    CHECK(d.normal <= 2e-5f);
    CHECK(d.cracks == 0);
}

TEST_CASE("patterns on the device lie where those of the host do, and faces meet bitwise") {
    vk::TestDevice device;
    if (!device) return;
    Comparison comparison(device);
    for (uint64_t seed = 0; seed < 4; ++seed) {
        PatchMesh mesh = random_sheet(seed, 3, 2, 0.3f);
        if (seed % 2 == 1) roughen_normals(mesh, seed);
        const auto kind = static_cast<Tessellation::Levels>(seed / 2);
        const Tessellation t = demand(Tessellation::adaptive(
            mesh.topology, random_levels(mesh.topology, seed, 12, seed % 2 == 0), kind));
        const PatchShape shape = seed == 3 ? PatchShape::phong : PatchShape::pn;
        check_small(comparison.compare(mesh, {.shape = shape}, seed % 2 == 0, nullptr, t), mesh);
    }
}

TEST_CASE("displaced patches on the device lie where those of the host do, without cracks") {
    vk::TestDevice device;
    if (!device) return;
    Comparison comparison(device);
    PatchMesh mesh = random_sheet(5, 3, 2, 0.3f);
    roughen_normals(mesh, 5);
    DisplacementMap displacement;
    displacement.map = make_height_map(std::array{0.0f, 1.0f, 0.5f, 0.25f, 0.3f, 0.9f}, 3, 2);
    displacement.uvs = mesh.uvs;
    displacement.settings.amplitude = 0.2f;
    displacement.settings.frequency = {3, 2, 1};
    displacement.settings.octaves = 2;
    displacement.settings.lacunarity = 2;
    displacement.settings.gain = 0.5f;
    displacement.settings.level = 0.3f;
    displacement.settings.map = displacement.map.levels;
    const Tessellation t =
        demand(Tessellation::adaptive(mesh.topology, random_levels(mesh.topology, 5, 9, true)));
    for (const uint32_t kind :
         {shared::kSineDisplacement, shared::kNoiseDisplacement, shared::kHeightMapDisplacement}) {
        displacement.settings.kind = kind;
        check_small(comparison.compare(mesh, {}, true, &displacement, t), mesh);
    }
    const PatchOptions flat = {PatchShape::flat, NormalField::linear};
    check_small(comparison.compare(mesh, flat, false, &displacement, t), mesh);
}

TEST_CASE("parts of a mesh have shapes, height maps and mip levels of their own") {
    vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    // Two sheets that do not touch.
    const PatchMesh one = random_sheet(5, 2, 2, 0);
    PolygonList polygons;
    PatchMesh mesh;
    std::vector<uint32_t> kind_of;
    for (uint32_t copy = 0; copy < 2; ++copy) {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (const uint32_t v : one.topology.vertex) polygons.corners.push_back(first + v);
        for (const vec3 p : one.positions) mesh.positions.push_back(p);
        for (const vec3 n : one.normals) mesh.normals.push_back(n);
        for (const vec2 uv : one.uvs) mesh.uvs.push_back(uv);
        kind_of.resize(mesh.positions.size(), copy);
        for (uint32_t f = 0; f < one.topology.face_count(); ++f)
            polygons.face_begin.push_back(polygons.face_begin.back() + 3);
    }
    polygons.vertex_count = static_cast<uint32_t>(mesh.positions.size());
    mesh.topology = topology_of(polygons);
    DisplacementMap map;
    map.map = make_height_map(std::array{0.0f, 1.0f, 0.5f, 0.25f, 0.3f, 0.9f, 0.1f, 0.2f}, 4, 2);
    map.uvs = one.uvs;
    map.settings.kind = shared::kHeightMapDisplacement;
    map.settings.amplitude = 0.3f;
    map.settings.map = map.map.levels;
    const HeightMap other = make_height_map(std::array{0.0f, 1.0f}, 2, 1);
    const std::array kinds = {
        refine::gpu::PatchKind{PatchShape::pn, NormalField::quadratic, {}, nullptr},
        refine::gpu::PatchKind{PatchShape::flat, NormalField::linear, map.settings, &map.map},
        refine::gpu::PatchKind{PatchShape::flat, NormalField::linear, map.settings, &other}};
    std::vector<uint32_t> device_kind;
    for (const uint32_t copy : kind_of) device_kind.push_back(copy);
    DevicePatches patches = demand(DevicePatches::create(
        test.stream, mesh.topology, {}, {.kinds = kinds, .kind_of = device_kind, .uvs = mesh.uvs}));
    CHECK(patches.displacement() == shared::kMixedDisplacement);
    const vk::Buffer in_positions = test.upload(mesh.positions);
    const vk::Buffer in_normals = test.upload(mesh.normals);
    const DevicePattern pattern = demand(refine::gpu::upload_triangle_pattern(test.stream, 4));
    const uint32_t faces = one.topology.face_count();
    const vk::Buffer out = test.make<vec3>(2 * faces * pattern.vertex_count);
    const vk::Buffer normals = test.make<vec3>(2 * faces * pattern.vertex_count);
    const Tessellation t = demand(Tessellation::uniform(one.topology, 4));
    for (const float level : {0.0f, 0.7f}) {
        CAPTURE(level);
        map.settings.level = level;
        map.settings.amplitude = 0.3f + level;
        test.stream.barrier();
        patches.set_displacements(test.stream,
                                  std::array{shared::Displacement{}, map.settings, map.settings});
        const std::vector<float> vertex_mips(mesh.positions.size(), level);
        const std::vector<shared::PatchMips> mips(2 * faces, {{level, level, level, level}, level});
        test.stream.barrier();
        patches.update(test.stream, in_positions.address(), in_normals.address());
        test.stream.barrier();
        patches.set_mips(test.stream, vertex_mips, mips);
        test.stream.barrier();
        patches.evaluate(test.stream, pattern, DevicePatches::Levels::uniform, 0, 2 * faces,
                         out.address(), normals.address());
        const auto places = test.download<vec3>(out, 2 * faces * pattern.vertex_count);
        for (uint32_t copy = 0; copy < 2; ++copy) {
            const Patches host =
                demand(Patches::create(one.topology, {kinds[copy].shape, kinds[copy].normals}));
            PatchControl control;
            host.update(one.input(), control);
            std::vector<vec3> expected(t.vertex_count());
            if (copy == 0)
                host.evaluate(control, t, expected);
            else
                host.evaluate(control, t, map, expected, {});
            float worst = 0;
            for (uint32_t f = 0; f < faces; ++f) {
                const std::vector<uint32_t> vertices = pattern_vertices(one.topology, t, f);
                for (size_t v = 0; v < vertices.size(); ++v) {
                    const size_t place = (copy * faces + f) * size_t{pattern.vertex_count} + v;
                    worst = std::max(worst, length(places[place] - expected[vertices[v]]));
                }
            }
            CHECK(worst <= kAgreement * diagonal(one));
        }
    }
}

TEST_CASE("control points come back from the device as the host makes them") {
    vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    const PatchMesh mesh = random_sheet(8, 3, 2, 0.3f);
    PatchControl control;
    demand(Patches::create(mesh.topology, {})).update(mesh.input(), control);
    const DevicePatches patches = demand(DevicePatches::create(test.stream, mesh.topology, {}));
    const vk::Buffer positions = test.upload(mesh.positions), normals = test.upload(mesh.normals);
    test.stream.barrier();
    patches.update(test.stream, positions.address(), normals.address());
    const PatchControl there = demand(patches.download_control(test.stream));
    REQUIRE(there.edges.size() == control.edges.size());
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        CHECK(length(there.positions[v] - mesh.positions[v]) == 0);
        CHECK(length(there.directions[v] - control.directions[v]) < 1e-6f);
    }
    for (size_t e = 0; e < control.edges.size(); ++e) {
        CHECK(length(there.edges[e].first - control.edges[e].first) < 1e-5f);
        CHECK(length(there.edges[e].second - control.edges[e].second) < 1e-5f);
    }
}

TEST_CASE("twelve coarse triangles become 786 432 that a sine displaces") {
    vk::TestDevice device;
    if (!device) return;
    vk::TestStream test(device);
    const CoarseMesh cube = cube_of_triangles();
    PatchMesh mesh{topology_of(cube), cube.positions, {}, {}, {}};
    mesh.normals = normals_from_origin(mesh.topology, mesh.positions);
    DisplacementMap displacement;
    displacement.settings.kind = shared::kSineDisplacement;
    displacement.settings.amplitude = 0.05f;
    displacement.settings.frequency = {20, 30, 25};
    const DevicePatches patches = demand(
        DevicePatches::create(test.stream, mesh.topology, {}, {.displacement = &displacement}));
    const DevicePattern pattern = demand(refine::gpu::upload_triangle_pattern(test.stream, 256));
    CHECK(12 * pattern.triangle_count == 786432);
    const size_t count = size_t{12} * pattern.vertex_count;
    const vk::Buffer in_positions = test.upload(mesh.positions);
    const vk::Buffer in_normals = test.upload(mesh.normals);
    const vk::Buffer positions = test.make<vec3>(count), normals = test.make<vec3>(count);
    test.stream.barrier();
    patches.update(test.stream, in_positions.address(), in_normals.address());
    test.stream.barrier();
    patches.evaluate(test.stream, pattern, DevicePatches::Levels::uniform, 0, 12,
                     positions.address(), normals.address());
    const std::vector<vec3> refined = test.download<vec3>(positions, count);

    const Tessellation t = demand(Tessellation::uniform(mesh.topology, 256));
    const Patches host = demand(Patches::create(mesh.topology, {}));
    PatchControl control;
    host.update(mesh.input(), control);
    std::vector<vec3> expected(t.vertex_count());
    host.evaluate(control, t, displacement, expected, {});
    float worst = 0;
    size_t cracks = 0;
    std::vector<std::optional<vec3>> known(t.vertex_count());
    for (uint32_t f = 0; f < 12; ++f) {
        const std::vector<uint32_t> vertices = pattern_vertices(mesh.topology, t, f);
        for (size_t v = 0; v < vertices.size(); ++v) {
            const vec3 p = refined[f * vertices.size() + v];
            worst = std::max(worst, length(p - expected[vertices[v]]));
            std::optional<vec3>& first = known[vertices[v]];
            if (!first) first = p;
            cracks += std::memcmp(&*first, &p, sizeof p) == 0 ? 0 : 1;
        }
    }
    CHECK(worst <= kAgreement * diagonal(mesh));
    CHECK(cracks == 0);
}

TEST_CASE("faces of more than four corners are refused") {
    vk::TestDevice device;
    if (!device) return;
    vk::Stream stream = device.stream();
    PolygonList pentagon;
    pentagon.corners = {0, 1, 2, 3, 4};
    pentagon.face_begin = {0, 5};
    pentagon.vertex_count = 5;
    const auto made = DevicePatches::create(stream, topology_of(pentagon), {});
    REQUIRE(!made);
    CHECK(made.error().code == Errc::bad_argument);
}

}  // namespace
