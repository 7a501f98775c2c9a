// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu/device_patches.h"

#include "aglow/core/assert.h"
#include "aglow/refine/gpu/patch_control.comp.h"
#include "aglow/refine/gpu/patch_edges.comp.h"
#include "aglow/refine/gpu/patch_evaluate.comp.h"
#include "aglow/refine/gpu/patch_vertices.comp.h"
#include "aglow/vk/device.h"
#include "aglow/vk/kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace aglow::refine::gpu {
namespace {

using shared::PatchEdgeEnds;
using shared::PatchFace;

struct Kernels {
    vk::Kernel vertices, edges, control;
    std::vector<vk::Kernel> evaluate;  ///< [2 * is quad + is adaptive]

    static Result<Kernels> create(const Gpu& gpu, uint32_t displacement) {
        const std::array constants = {displacement};
        AG_TRY(auto vertices,
               vk::Kernel::create(gpu, "patch vertices", shaders::patch_vertices_comp, constants));
        AG_TRY(auto edges, vk::Kernel::create(gpu, "patch edges", shaders::patch_edges_comp));
        AG_TRY(auto control,
               vk::Kernel::create(gpu, "patch control points", shaders::patch_control_comp));
        std::vector<vk::Kernel> evaluate;
        for (const uint32_t corners : {3u, 4u})
            for (const uint32_t adaptive : {0u, 1u}) {
                AG_TRY(auto kernel,
                       vk::Kernel::create(gpu, "patch patterns", shaders::patch_evaluate_comp,
                                          std::array{displacement, corners, adaptive}));
                evaluate.push_back(std::move(kernel));
            }
        return Kernels{std::move(vertices), std::move(edges), std::move(control),
                       std::move(evaluate)};
    }
};

std::vector<uint32_t> or_own_numbers(std::span<const uint32_t> given, uint32_t count) {
    std::vector<uint32_t> result(given.begin(), given.end());
    if (given.empty()) {
        result.resize(count);
        std::iota(result.begin(), result.end(), 0u);
    }
    AG_ASSERT(result.size() == count, "one number for each");
    return result;
}

std::vector<PatchFace> device_faces(const Topology& topology) {
    std::vector<PatchFace> faces;
    for (uint32_t f = 0; f < topology.face_count(); ++f) {
        PatchFace face = {
            topology.face_begin[f], topology.face_size(f), reversed_edges(topology, f), {}, {}};
        for (uint32_t i = 0; i < face.corners; ++i) {
            face.vertex[i] = topology.vertex[face.first + i];
            face.edge[i] = topology.edge[face.first + i];
        }
        faces.push_back(face);
    }
    return faces;
}

/// `normal` says which incoming normal belongs to a corner.
std::vector<PatchEdgeEnds> device_edges(const Topology& topology,
                                        const std::vector<uint32_t>& normal) {
    std::vector<PatchEdgeEnds> edges;
    for (const uint32_t h : topology.edge_half) {
        const uint32_t twin = topology.twin[h] == kNone ? h : topology.twin[h];
        const bool forward = topology.vertex[h] < topology.end(h);
        const uint32_t low = forward ? topology.vertex[h] : topology.end(h);
        const uint32_t high = forward ? topology.end(h) : topology.vertex[h];
        const uint32_t left = forward ? h : twin, right = forward ? twin : h;
        const auto at = [&](uint32_t half, uint32_t v) {
            return normal[topology.vertex[half] == v ? half : topology.next(half)];
        };
        edges.push_back(
            {low, high, at(left, low), at(left, high), at(right, low), at(right, high)});
    }
    return edges;
}

struct Fans {
    std::vector<uint32_t> begin = {0}, half_edges;
};

/// The half-edges that leave each vertex, counter-clockwise.
Fans device_fans(const Topology& topology) {
    Fans fans;
    for (const uint32_t first : topology.vertex_half) {
        for (uint32_t h = first; h != kNone;) {
            fans.half_edges.push_back(h);
            h = topology.twin[topology.previous(h)];
            if (h == first) break;
        }
        fans.begin.push_back(static_cast<uint32_t>(fans.half_edges.size()));
    }
    return fans;
}

/// For each half-edge where it starts and ends, the corners of the face beyond; its own at a
/// boundary.
std::vector<uvec2> device_across(const Topology& topology) {
    std::vector<uvec2> across;
    for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
        const uint32_t twin = topology.twin[h];
        across.push_back(twin == kNone ? uvec2{h, topology.next(h)}
                                       : uvec2{topology.next(twin), twin});
    }
    return across;
}

Result<DevicePattern> upload_pattern(vk::Stream& stream, const Pattern& pattern, int segments,
                                     uint32_t corners) {
    DevicePattern device;
    device.segments = segments;
    device.corners = corners;
    device.vertex_count = static_cast<uint32_t>(pattern.steps.size());
    device.triangle_count = static_cast<uint32_t>(pattern.triangles.size());
    AG_TRY(device.steps, vk::make_buffer_of(stream, std::span<const uint32_t>(pattern.steps),
                                            "vertices of a pattern"));
    AG_TRY(device.triangles, vk::make_buffer_of(stream, std::span<const uvec3>(pattern.triangles),
                                                "triangles of a pattern"));
    return device;
}

}  // namespace

uint32_t reversed_edges(const Topology& topology, uint32_t face) {
    uint32_t bits = 0;
    const uint32_t first = topology.face_begin[face];
    for (uint32_t i = 0; i < topology.face_size(face); ++i)
        if (topology.vertex[first + i] > topology.end(first + i)) bits |= 1u << i;
    return bits;
}

Result<DevicePattern> upload_triangle_pattern(vk::Stream& stream, int segments) {
    return upload_pattern(stream, triangle_pattern(segments), segments, 3);
}

Result<DevicePattern> upload_quad_pattern(vk::Stream& stream, int segments) {
    return upload_pattern(stream, quad_pattern(segments), segments, 4);
}

Result<DevicePattern> upload_nested_pattern(vk::Stream& stream, int segments) {
    return upload_pattern(stream, nested_triangle_pattern(segments), segments, 3);
}

struct DevicePatches::State {
    explicit State(Kernels made) : kernels(std::move(made)) {}

    Kernels kernels;
    shared::PatchMesh layout = {};
    std::vector<vk::Buffer> buffers;  ///< what `layout` points to
    vk::Buffer mesh, levels;
    vk::Buffer control;  ///< positions, directions and edge_points of `layout`, in this order

    template <class T>
    Status upload(vk::Stream& stream, uint64_t& address, std::span<const T> values,
                  const char* name) {
        AG_TRY(vk::Buffer buffer, vk::make_buffer_of(stream, values, name));
        address = buffer.address();
        buffers.push_back(std::move(buffer));
        return {};
    }
    Status make(vk::Stream& stream, uint64_t& address, uint64_t bytes, const char* name) {
        AG_TRY(vk::Buffer buffer, stream.make_buffer(bytes, name));
        address = buffer.address();
        buffers.push_back(std::move(buffer));
        return {};
    }
    Status upload_topology(vk::Stream& stream, const Topology& topology,
                           const DevicePatchInput& input);
    Status upload_displacement(vk::Stream& stream, const Topology& topology,
                               const DisplacementMap& displacement);
    Status make_frame(vk::Stream& stream);
};

Status DevicePatches::State::upload_topology(vk::Stream& stream, const Topology& topology,
                                             const DevicePatchInput& input) {
    const std::vector<uint32_t> sources =
        or_own_numbers(input.vertex_source, topology.vertex_count());
    const std::vector<uint32_t> normals =
        or_own_numbers(input.corner_normal, topology.half_edge_count());
    const Fans fans = device_fans(topology);
    AG_CHECK(upload<uint32_t>(stream, layout.vertex_source, sources, "sources of vertices"));
    AG_CHECK(upload<uint32_t>(stream, layout.corner_normal, normals, "normals of corners"));
    AG_CHECK(upload<uint32_t>(stream, layout.fan_begin, fans.begin, "fans of vertices"));
    AG_CHECK(upload<uint32_t>(stream, layout.fans, fans.half_edges, "fans"));
    AG_CHECK(upload<PatchFace>(stream, layout.faces, device_faces(topology), "faces of patches"));
    AG_CHECK(upload<PatchEdgeEnds>(stream, layout.edges, device_edges(topology, normals),
                                   "edges of patches"));
    AG_CHECK(upload<shared::ShapeTags>(stream, layout.tags, input.tags, "tags of vertices"));
    return {};
}

Status DevicePatches::State::upload_displacement(vk::Stream& stream, const Topology& topology,
                                                 const DisplacementMap& displacement) {
    shared::Displacement settings = displacement.settings;
    settings.map = displacement.map.levels;
    AG_CHECK(upload<shared::Displacement>(stream, layout.displacement, {&settings, 1},
                                          "a displacement"));
    if (settings.kind != shared::kHeightMapDisplacement) return {};
    AG_CHECK(upload<float>(stream, layout.heights, displacement.map.texels, "a height map"));
    AG_CHECK(upload<vec2>(stream, layout.uvs, displacement.uvs, "coordinates in a height map"));
    AG_CHECK(upload<uvec2>(stream, layout.across, device_across(topology), "seams"));
    return make(stream, layout.vertex_heights, uint64_t{4} * layout.vertex_count,
                "heights of vertices");
}

Status DevicePatches::State::make_frame(vk::Stream& stream) {
    const uint64_t v = layout.vertex_count, e = layout.edge_count, f = layout.face_count;
    const uint64_t displaced = layout.displacement_kind != shared::kNoDisplacement ? f : 0;
    AG_TRY(control, stream.make_buffer(2 * v * sizeof(vec3) + e * sizeof(shared::EdgePoints),
                                       "control points"));
    layout.positions = control.address();
    layout.directions = layout.positions + v * sizeof(vec3);
    layout.edge_points = layout.directions + v * sizeof(vec3);
    AG_CHECK(make(stream, layout.edge_directions, e * sizeof(vec3), "directions of edges"));
    AG_CHECK(make(stream, layout.patches, f * sizeof(shared::DevicePatch), "patches"));
    AG_CHECK(make(stream, layout.patch_directions, displaced * sizeof(shared::PatchDirections),
                  "directions of patches"));
    AG_TRY(levels, stream.make_buffer(f * sizeof(shared::PatchLevels), "levels of edges"));
    AG_TRY(mesh, vk::make_buffer_of(stream, std::span<const shared::PatchMesh>(&layout, 1),
                                    "addresses of patches"));
    return {};
}

DevicePatches::DevicePatches(std::unique_ptr<State> state) : state_(std::move(state)) {}
DevicePatches::DevicePatches(DevicePatches&&) noexcept = default;
DevicePatches& DevicePatches::operator=(DevicePatches&&) noexcept = default;
DevicePatches::~DevicePatches() = default;

Result<DevicePatches> DevicePatches::create(vk::Stream& stream, const Topology& topology,
                                            const PatchOptions& options,
                                            const DevicePatchInput& input) {
    for (uint32_t f = 0; f < topology.face_count(); ++f)
        if (topology.face_size(f) > 4)
            return fail(Errc::bad_argument,
                        fmt::format("face {} has {} corners: patches are triangles and quads", f,
                                    topology.face_size(f)));
    const uint32_t kind =
        input.displacement ? input.displacement->settings.kind : shared::kNoDisplacement;
    AG_TRY(auto kernels, Kernels::create(stream.gpu(), kind));
    auto state = std::make_unique<State>(std::move(kernels));
    shared::PatchMesh& layout = state->layout;
    layout.vertex_count = topology.vertex_count();
    layout.edge_count = topology.edge_count();
    layout.face_count = topology.face_count();
    layout.shape = options.shape == PatchShape::pn      ? shared::kPnPatch
                   : options.shape == PatchShape::phong ? shared::kPhongPatch
                                                        : shared::kFlatPatch;
    layout.quadratic = options.normals == NormalField::quadratic ? 1 : 0;
    layout.tagged = input.tags.empty() ? 0 : 1;
    layout.phong_shape = options.phong_shape;
    layout.displacement_kind = kind;
    AG_CHECK(state->upload_topology(stream, topology, input));
    if (input.displacement)
        AG_CHECK(state->upload_displacement(stream, topology, *input.displacement));
    AG_CHECK(state->make_frame(stream));
    AG_CHECK(stream.finish());
    return DevicePatches(std::move(state));
}

void DevicePatches::update(vk::Stream& stream, uint64_t positions, uint64_t normals) const {
    const State& s = *state_;
    const shared::PatchControlArgs args = {0, 0, s.mesh.address(), positions, normals};
    stream.run(s.kernels.vertices, args,
               vk::group_count(s.layout.vertex_count, shared::kPatchGroup));
    stream.barrier();
    stream.run(s.kernels.edges, args, vk::group_count(s.layout.edge_count, shared::kPatchGroup));
    stream.barrier();
    stream.run(s.kernels.control, args, vk::group_count(s.layout.face_count, shared::kPatchGroup));
}

Result<PatchControl> DevicePatches::download_control(vk::Stream& stream) const {
    const State& s = *state_;
    const size_t v = s.layout.vertex_count;
    AG_TRY(const auto points,
           stream.download<vec3>(s.control, 2 * v + 2 * uint64_t{s.layout.edge_count}));
    PatchControl control;
    control.positions.assign(points.begin(), points.begin() + static_cast<ptrdiff_t>(v));
    control.directions.assign(points.begin() + static_cast<ptrdiff_t>(v),
                              points.begin() + static_cast<ptrdiff_t>(2 * v));
    for (size_t i = 2 * v; i < points.size(); i += 2)
        control.edges.push_back({points[i], points[i + 1]});
    return control;
}

void DevicePatches::set_levels(vk::Stream& stream,
                               std::span<const shared::PatchLevels> levels) const {
    AG_ASSERT(levels.size() == state_->layout.face_count, "levels for every face");
    stream.upload(levels, state_->levels);
}

void DevicePatches::evaluate(vk::Stream& stream, const DevicePattern& pattern, Levels levels,
                             uint32_t first_face, uint32_t face_count, uint64_t positions,
                             uint64_t normals) const {
    const State& s = *state_;
    AG_ASSERT(first_face + face_count <= s.layout.face_count, "faces of the mesh");
    const vk::Kernel& kernel =
        s.kernels.evaluate[(pattern.corners == 4 ? 2 : 0) + (levels == Levels::adaptive ? 1 : 0)];
    // Invocations have numbers of 32 bits.
    const uint32_t most = std::max(1u, (1u << 31) / pattern.vertex_count);
    for (uint32_t done = 0; done < face_count;) {
        const uint32_t count = std::min(most, face_count - done);
        const uint64_t offset = uint64_t{done} * pattern.vertex_count * sizeof(vec3);
        const shared::PatchEvaluateArgs args = {.first_group = 0,
                                                .segments = static_cast<uint32_t>(pattern.segments),
                                                .vertex_count = pattern.vertex_count,
                                                .first_face = first_face + done,
                                                .face_count = count,
                                                .unused = 0,
                                                .mesh = s.mesh.address(),
                                                .steps = pattern.steps.address(),
                                                .levels = s.levels.address(),
                                                .positions = positions + offset,
                                                .normals = normals + offset};
        stream.run(kernel, args,
                   vk::group_count(uint64_t{count} * pattern.vertex_count, shared::kPatchGroup));
        done += count;
    }
}

uint64_t DevicePatches::mesh() const { return state_->mesh.address(); }
uint64_t DevicePatches::levels() const { return state_->levels.address(); }
uint32_t DevicePatches::face_count() const { return state_->layout.face_count; }
uint32_t DevicePatches::displacement() const { return state_->layout.displacement_kind; }

}  // namespace aglow::refine::gpu
