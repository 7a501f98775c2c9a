// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu/device_patches.h"

#include "aglow/core/assert.h"
#include "aglow/refine/gpu/patch_control.comp.h"
#include "aglow/refine/gpu/patch_edges.comp.h"
#include "aglow/refine/gpu/patch_evaluate.comp.h"
#include "aglow/refine/gpu/patch_heights.comp.h"
#include "aglow/refine/gpu/patch_normals.comp.h"
#include "aglow/refine/gpu/patch_vertices.comp.h"
#include "aglow/vk/device.h"
#include "aglow/vk/kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace aglow::refine::gpu {
namespace {

using shared::PatchEdgeEnds;
using shared::PatchFace;

struct Kernels {
    vk::Kernel vertices, edges, control, heights, normals;
    std::vector<vk::Kernel> evaluate;  ///< [2 * is quad + is adaptive]

    static Result<Kernels> create(const Gpu& gpu, uint32_t displacement) {
        AG_TRY(auto vertices,
               vk::Kernel::create(gpu, "patch vertices", shaders::patch_vertices_comp));
        AG_TRY(auto edges, vk::Kernel::create(gpu, "patch edges", shaders::patch_edges_comp));
        AG_TRY(auto control,
               vk::Kernel::create(gpu, "patch control points", shaders::patch_control_comp));
        AG_TRY(auto heights, vk::Kernel::create(gpu, "patch heights", shaders::patch_heights_comp));
        AG_TRY(auto normals, vk::Kernel::create(gpu, "patch normals", shaders::patch_normals_comp));
        std::vector<vk::Kernel> evaluate;
        for (const uint32_t corners : {3u, 4u})
            for (const uint32_t adaptive : {0u, 1u}) {
                AG_TRY(auto kernel,
                       vk::Kernel::create(gpu, "patch patterns", shaders::patch_evaluate_comp,
                                          std::array{displacement, corners, adaptive}));
                evaluate.push_back(std::move(kernel));
            }
        return Kernels{std::move(vertices), std::move(edges),   std::move(control),
                       std::move(heights),  std::move(normals), std::move(evaluate)};
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

std::vector<PatchFace> device_faces(const Topology& topology,
                                    const std::vector<uint32_t>& vertex_kind) {
    std::vector<PatchFace> faces;
    for (uint32_t f = 0; f < topology.face_count(); ++f) {
        PatchFace face = {.first = topology.face_begin[f],
                          .corners = topology.face_size(f),
                          .reversed = reversed_edges(topology, f),
                          .vertex = {},
                          .edge = {},
                          .kind = vertex_kind[topology.vertex[topology.face_begin[f]]]};
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

uint32_t number_of(PatchShape shape) {
    return shape == PatchShape::pn      ? shared::kPnPatch
           : shape == PatchShape::phong ? shared::kPhongPatch
                                        : shared::kFlatPatch;
}

/// Kinds as shaders see them, and the height maps that they have between them.
struct DeviceKinds {
    std::vector<shared::PatchKind> kinds;
    std::vector<uint32_t> of_vertex;
    std::vector<float> heights;
    std::span<const vec2> uvs;
    uint32_t displacement = shared::kNoDisplacement;  ///< kPatchDisplacement
};

DeviceKinds device_kinds(const Topology& topology, const PatchOptions& options,
                         const DevicePatchInput& input) {
    PatchKind single = {options.shape, options.normals, {}, nullptr};
    if (input.displacement) {
        single.displacement = input.displacement->settings;
        single.map = &input.displacement->map;
    }
    const bool many = !input.kinds.empty();
    DeviceKinds result;
    result.uvs = many ? input.uvs : input.displacement ? input.displacement->uvs : input.uvs;
    result.of_vertex.assign(input.kind_of.begin(), input.kind_of.end());
    result.of_vertex.resize(topology.vertex_count(), 0);
    std::map<const HeightMap*, uint32_t> first_texel;
    for (const PatchKind& kind : many ? input.kinds : std::span<const PatchKind>(&single, 1)) {
        shared::Displacement d = kind.displacement;
        if (d.kind == shared::kHeightMapDisplacement) {
            const auto next = static_cast<uint32_t>(result.heights.size());
            const auto [at, is_new] = first_texel.try_emplace(kind.map, next);
            if (is_new)
                result.heights.insert(result.heights.end(), kind.map->texels.begin(),
                                      kind.map->texels.end());
            d.map = kind.map->levels;
            d.map.first_texel = at->second;
        }
        result.displacement = result.kinds.empty() || result.displacement == d.kind
                                  ? d.kind
                                  : shared::kMixedDisplacement;
        result.kinds.push_back(
            {number_of(kind.shape), kind.normals == NormalField::quadratic ? 1u : 0u, d});
    }
    return result;
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
    vk::Buffer kinds, vertex_mips, mips;
    std::vector<shared::PatchKind> kinds_there;
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
                           const DevicePatchInput& input, const std::vector<uint32_t>& vertex_kind);
    Status upload_kinds(vk::Stream& stream, const Topology& topology, DeviceKinds made);
    Status make_frame(vk::Stream& stream);
    bool has_maps() const {
        return std::ranges::any_of(kinds_there, [](const shared::PatchKind& kind) {
            return kind.displacement.kind == shared::kHeightMapDisplacement;
        });
    }
};

Status DevicePatches::State::upload_topology(vk::Stream& stream, const Topology& topology,
                                             const DevicePatchInput& input,
                                             const std::vector<uint32_t>& vertex_kind) {
    const std::vector<uint32_t> sources =
        or_own_numbers(input.vertex_source, topology.vertex_count());
    const std::vector<uint32_t> normals =
        or_own_numbers(input.corner_normal, topology.half_edge_count());
    const Fans fans = device_fans(topology);
    AG_CHECK(upload<uint32_t>(stream, layout.vertex_source, sources, "sources of vertices"));
    AG_CHECK(upload<uint32_t>(stream, layout.corner_normal, normals, "normals of corners"));
    AG_CHECK(upload<uint32_t>(stream, layout.fan_begin, fans.begin, "fans of vertices"));
    AG_CHECK(upload<uint32_t>(stream, layout.fans, fans.half_edges, "fans"));
    AG_CHECK(upload<PatchFace>(stream, layout.faces, device_faces(topology, vertex_kind),
                               "faces of patches"));
    AG_CHECK(upload<PatchEdgeEnds>(stream, layout.edges, device_edges(topology, normals),
                                   "edges of patches"));
    AG_CHECK(upload<shared::ShapeTags>(stream, layout.tags, input.tags, "tags of vertices"));
    return {};
}

Status DevicePatches::State::upload_kinds(vk::Stream& stream, const Topology& topology,
                                          DeviceKinds made) {
    kinds_there = std::move(made.kinds);
    AG_TRY(kinds, vk::make_buffer_of(stream, std::span<const shared::PatchKind>(kinds_there),
                                     "kinds of patches"));
    layout.kinds = kinds.address();
    AG_CHECK(upload<uint32_t>(stream, layout.vertex_kind, made.of_vertex, "kinds of vertices"));
    if (!has_maps()) return {};
    AG_ASSERT(made.uvs.size() == topology.half_edge_count(), "coordinates for every corner");
    std::vector<float> at_vertices;
    for (const uint32_t kind : made.of_vertex)
        at_vertices.push_back(kinds_there[kind].displacement.level);
    std::vector<shared::PatchMips> of_faces;
    for (uint32_t f = 0; f < topology.face_count(); ++f) {
        const float level = at_vertices[topology.vertex[topology.face_begin[f]]];
        of_faces.push_back({{level, level, level, level}, level});
    }
    AG_CHECK(upload<float>(stream, layout.heights, made.heights, "height maps"));
    AG_CHECK(upload<vec2>(stream, layout.uvs, made.uvs, "coordinates in height maps"));
    AG_CHECK(upload<uvec2>(stream, layout.across, device_across(topology), "seams"));
    AG_CHECK(upload<uint32_t>(stream, layout.face_of, topology.face, "faces of half-edges"));
    AG_CHECK(make(stream, layout.raised_normals, made.uvs.size() * sizeof(vec3),
                  "normals of displaced corners"));
    AG_TRY(vertex_mips, vk::make_buffer_of(stream, std::span<const float>(at_vertices),
                                           "mip levels of vertices"));
    AG_TRY(mips, vk::make_buffer_of(stream, std::span<const shared::PatchMips>(of_faces),
                                    "mip levels of faces"));
    layout.vertex_mips = vertex_mips.address();
    layout.mips = mips.address();
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
    DeviceKinds kinds = device_kinds(topology, options, input);
    AG_TRY(auto kernels, Kernels::create(stream.gpu(), kinds.displacement));
    auto state = std::make_unique<State>(std::move(kernels));
    shared::PatchMesh& layout = state->layout;
    layout.vertex_count = topology.vertex_count();
    layout.edge_count = topology.edge_count();
    layout.face_count = topology.face_count();
    layout.tagged = input.tags.empty() ? 0 : 1;
    layout.phong_shape = options.phong_shape;
    layout.displacement_kind = kinds.displacement;
    AG_CHECK(state->upload_topology(stream, topology, input, kinds.of_vertex));
    AG_CHECK(state->upload_kinds(stream, topology, std::move(kinds)));
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
    if (s.has_maps())
        stream.run(s.kernels.heights, args,
                   vk::group_count(s.layout.vertex_count, shared::kPatchGroup));
    stream.barrier();
    stream.run(s.kernels.control, args, vk::group_count(s.layout.face_count, shared::kPatchGroup));
    if (!s.has_maps()) return;
    stream.barrier();
    stream.run(s.kernels.normals, args,
               vk::group_count(s.layout.vertex_count, shared::kPatchGroup));
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

void DevicePatches::set_displacements(vk::Stream& stream,
                                      std::span<const shared::Displacement> by_kind) {
    State& s = *state_;
    AG_ASSERT(by_kind.size() == s.kinds_there.size(), "a displacement of each kind");
    for (size_t i = 0; i < by_kind.size(); ++i) {
        shared::Displacement& there = s.kinds_there[i].displacement;
        const shared::TextureLevels map = there.map;
        there = by_kind[i];
        there.map = map;
    }
    stream.upload(std::span<const shared::PatchKind>(s.kinds_there), s.kinds);
}

void DevicePatches::set_mips(vk::Stream& stream, std::span<const float> vertices,
                             std::span<const shared::PatchMips> faces) const {
    const State& s = *state_;
    AG_ASSERT(s.has_maps(), "height maps");
    AG_ASSERT(vertices.size() == s.layout.vertex_count, "a mip level for every vertex");
    AG_ASSERT(faces.size() == s.layout.face_count, "mip levels for every face");
    stream.upload(vertices, s.vertex_mips);
    stream.upload(faces, s.mips);
    stream.barrier();
    const shared::PatchControlArgs args = {0, 0, s.mesh.address(), 0, 0};
    stream.run(s.kernels.heights, args,
               vk::group_count(s.layout.vertex_count, shared::kPatchGroup));
    stream.barrier();
    stream.run(s.kernels.normals, args,
               vk::group_count(s.layout.vertex_count, shared::kPatchGroup));
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
