// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu/geometry/geometry_subdivision.h"

#include "aglow/refine/gpu/geometry/fans.h"
#include "aglow/refine/gpu/geometry/loop.vert.h"
#include "aglow/refine/gpu/geometry/nitm.geom.h"
#include "aglow/refine/gpu/geometry/ta.geom.h"
#include "aglow/refine/gpu/geometry/vs_output.geom.h"
#include "aglow/refine/gpu/geometry/vs_output.vert.h"
#include "aglow/refine/tables/face_points.h"
#include "aglow/refine/tables/split.h"
#include "aglow/refine/tables/state.h"
#include "aglow/vk/device.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace aglow::refine::gpu {
namespace {

constexpr uint32_t kLevelsAtOnce = 2;
/// Triangles of one draw: few enough that it takes no noticeable time on any device.
constexpr uint32_t kDrawTriangles = 1 << 14;

Status check(const Topology& mesh, const SubdivisionOptions& options) {
    const auto fades = [](float s) { return s > 0 && s < kSharp; };
    if (options.scheme != Scheme::loop || options.level < 1)
        return fail(Errc::unsupported,
                    "geometry shaders subdivide by Loop's scheme, from level 1 on: use the compute "
                    "form");
    if (std::ranges::any_of(mesh.edge_sharpness, [](float s) { return s > 0; }) ||
        std::ranges::any_of(mesh.vertex_sharpness, fades))
        return fail(Errc::unsupported,
                    "geometry shaders subdivide without creases: use the compute form");
    return {};
}

/// A copy in which corners that are to stay are sharp.
Topology with_corners(Topology mesh, Corners corners) {
    if (corners == Corners::smooth) return mesh;
    for (uint32_t v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.on_boundary(v) && mesh.twin[mesh.previous(mesh.vertex_half[v])] == kNone)
            mesh.vertex_sharpness[v] = kSharp;
    return mesh;
}

Result<vk::GraphicsPipeline> make_pipeline(const Gpu& gpu, uint32_t levels, SubdivisionForm form) {
    vk::GraphicsShaders code;
    vk::GraphicsState state;
    code.vertex = shaders::loop_vert;
    code.geometry = shaders::nitm_geom;
    if (form == SubdivisionForm::triangle_adjacency) {
        code.geometry = shaders::ta_geom;
        state.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY;
    } else if (form == SubdivisionForm::neighbours_in_vertices) {
        code.vertex = shaders::vs_output_vert;
        code.geometry = shaders::vs_output_geom;
    }
    state.constants = std::span(&levels, 1);
    return vk::GraphicsPipeline::create(gpu, name(form), code, state);
}

LatticePoint middle(LatticePoint a, LatticePoint b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2}; }

/// The columns of the corners of the triangles that a-b-c is split into, in the order of split().
void add_corners(const FacePoints& face, LatticePoint a, LatticePoint b, LatticePoint c,
                 uint32_t segments, std::vector<uint32_t>& columns) {
    if (segments == 1) {
        for (const LatticePoint p : {a, b, c}) columns.push_back(face.at(p));
        return;
    }
    const LatticePoint ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    add_corners(face, a, ab, ca, segments / 2, columns);
    add_corners(face, b, bc, ab, segments / 2, columns);
    add_corners(face, c, ca, bc, segments / 2, columns);
    add_corners(face, ab, bc, ca, segments / 2, columns);
}

}  // namespace

std::vector<uint32_t> captured_vertices(const Subdivision& subdivision) {
    const uint32_t n = subdivision.state().faces.segments;
    const FacePoints face = face_points(3, n);
    std::vector<uint32_t> columns, numbers(face.count()), result;
    add_corners(face, {0, 0}, {n, 0}, {0, n}, n, columns);
    const std::vector<uvec3> triangles = subdivision.triangles();
    for (size_t first = 0; first < triangles.size(); first += face.faces.size()) {
        for (size_t i = 0; i < face.faces.size(); ++i) {
            const uvec3 t = triangles[first + i];
            numbers[face.faces[i][0]] = t.x;
            numbers[face.faces[i][1]] = t.y;
            numbers[face.faces[i][2]] = t.z;
        }
        for (const uint32_t column : columns) result.push_back(numbers[column]);
    }
    return result;
}

Result<GeometrySubdivision::Pass> GeometrySubdivision::make_pass(vk::Stream& stream,
                                                                 const Topology& mesh,
                                                                 std::span<const uint32_t> points,
                                                                 uint32_t levels,
                                                                 SubdivisionForm form) {
    const bool adjacency = form == SubdivisionForm::triangle_adjacency;
    const LoopFans fans = loop_fans(mesh, points);
    const std::vector<uint32_t> corners = loop_indices(mesh, adjacency);
    const uint32_t children = levels == 1 ? 4 : 16;
    const uint64_t bytes = uint64_t{mesh.half_edge_count()} * children * sizeof(vec3);
    AG_TRY(vk::Buffer indices,
           vk::make_buffer_of(stream, std::span(corners), "triangles to subdivide"));
    AG_TRY(vk::Buffer vertices,
           vk::make_buffer_of(stream, std::span(fans.vertices), "vertices to subdivide"));
    AG_TRY(vk::Buffer neighbours,
           vk::make_buffer_of(stream, std::span(fans.fans), "neighbours of vertices"));
    AG_TRY(vk::Buffer starts,
           vk::make_buffer_of(stream, std::span(fans.starts), "corners in fans"));
    AG_TRY(vk::Buffer made, stream.make_buffer(bytes, "subdivided triangles"));
    AG_TRY(vk::GraphicsPipeline pipeline, make_pipeline(stream.gpu(), levels, form));
    return Pass{mesh.face_count(),     children,          std::move(indices), std::move(vertices),
                std::move(neighbours), std::move(starts), std::move(made),    std::move(pipeline)};
}

Result<GeometrySubdivision> GeometrySubdivision::create(vk::Stream& stream,
                                                        const Topology& topology,
                                                        const SubdivisionOptions& options,
                                                        SubdivisionForm form) {
    AG_CHECK(check(topology, options));
    AG_CHECK(stream.gpu()->check_drawing());
    GeometrySubdivision result;
    result.form_ = form;
    Topology mesh = with_corners(topology, options.corners);
    std::vector<uint32_t> points(mesh.vertex_count());
    std::iota(points.begin(), points.end(), 0u);
    for (auto left = static_cast<uint32_t>(options.level); left > 0;) {
        const uint32_t levels = std::min(left, kLevelsAtOnce);
        AG_TRY(Pass pass, make_pass(stream, mesh, points, levels, form));
        result.passes_.push_back(std::move(pass));
        for (uint32_t i = 0; i < levels; ++i) mesh = split(mesh, Scheme::loop);
        // Corners of the triangles that a pass makes have the numbers of their half-edges.
        points = mesh.vertex_half;
        left -= levels;
    }
    AG_CHECK(stream.finish());
    return result;
}

void GeometrySubdivision::record_pass(vk::Stream& stream, const Pass& pass, uint64_t from) const {
    const uint32_t vertices = form_ == SubdivisionForm::triangle_adjacency ? 6 : 3;
    const uint64_t bytes = uint64_t{pass.children} * 3 * sizeof(vec3);
    for (uint32_t first = 0; first < pass.triangle_count; first += kDrawTriangles) {
        const uint32_t count = std::min(pass.triangle_count - first, kDrawTriangles);
        const shared::LoopArgs args{first, from, pass.vertices.address(), pass.fans.address(),
                                    pass.starts.address()};
        vk::Draw draw;
        draw.first_vertex = first * vertices;
        draw.vertex_count = count * vertices;
        draw.indices = &pass.indices;
        draw.whole = true;  // the shaders count primitives
        stream.capture(pass.pipeline, args, draw, {pass.points, first * bytes, bytes});
    }
}

void GeometrySubdivision::record(vk::Stream& stream, uint64_t control) const {
    uint64_t from = control;
    for (const Pass& pass : passes_) {
        if (from != control) stream.barrier();
        record_pass(stream, pass, from);
        from = pass.points.address();
    }
}

}  // namespace aglow::refine::gpu
