// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu/device_subdivision.h"
#include "aglow/render/gpu/device_room.h"
#include "aglow/render/gpu/raster/gather.comp.h"
#include "aglow/render/gpu/raster/subdivided_faces.h"
#include "aglow/render/gpu/raster/subdivision.vert.h"
#include "aglow/render/gpu/raster/vertex_source.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aglow::render::gpu {
namespace {

using refine::gpu::DeviceSubdivision;

/// Push constants of gather.comp.
struct GatherArgs {
    uint32_t first_group = 0;
    uint32_t count = 0;
    uint64_t from = 0, source = 0, to = 0;
};

/// A subdivision, and its control points in each frame.
struct SubdividedMesh {
    DeviceSubdivision subdivision;
    vk::Buffer source, control;

    static Result<SubdividedMesh> create(vk::Stream& stream, const Subdivision& subdivision,
                                         const std::vector<uint32_t>& source) {
        AG_TRY(auto device,
               DeviceSubdivision::create(stream, subdivision, DeviceSubdivision::Limits::with));
        AG_TRY(vk::Buffer sources, vk::make_buffer_of(stream, std::span<const uint32_t>(source),
                                                      "sources of control points"));
        AG_TRY(vk::Buffer control,
               stream.make_buffer(source.size() * sizeof(vec3), "control points"));
        return SubdividedMesh{std::move(device), std::move(sources), std::move(control)};
    }
    void gather(vk::Stream& stream, const vk::Kernel& kernel, uint64_t positions) const {
        const uint32_t count = subdivision.control_count();
        stream.run(kernel, GatherArgs{0, count, positions, source.address(), control.address()},
                   vk::group_count(count, 64));
    }
};

struct Points {
    vk::Buffer positions, normals;
};

struct Tables {
    vk::Buffer faces, normal_faces, places, barycentrics, triangles, geometry;

    static Result<Tables> create(vk::Stream& stream, const SubdividedFaces& faces,
                                 const FacePattern& pattern, const Points& points);
};

Result<Tables> Tables::create(vk::Stream& stream, const SubdividedFaces& faces,
                              const FacePattern& pattern, const Points& points) {
    const auto put = [&](const auto& values, const char* name) {
        return vk::make_buffer_of(stream, std::span(values.data(), values.size()), name);
    };
    Tables tables;
    AG_TRY(tables.faces, put(faces.positions, "subdivided faces"));
    AG_TRY(tables.normal_faces, put(faces.normals, "normals of subdivided faces"));
    AG_TRY(tables.places, put(pattern.places, "vertices of a subdivided face"));
    AG_TRY(tables.barycentrics, put(pattern.barycentrics, "vertices of a subdivided face"));
    AG_TRY(tables.triangles, put(pattern.triangles, "triangles of a subdivided face"));
    const vk::Buffer& normal_faces = faces.normals.empty() ? tables.faces : tables.normal_faces;
    const shared::RasterSubdivision geometry{
        points.positions.address(), points.normals.address(),
        tables.faces.address(),     normal_faces.address(),
        tables.places.address(),    tables.barycentrics.address(),
        pattern.edge_points,        0};
    AG_TRY(tables.geometry,
           vk::make_buffer_of(stream, std::span(&geometry, 1), "subdivided surface"));
    return tables;
}

class SubdivisionSource : public VertexSource {
public:
    SubdivisionSource(const mesh::gpu::DeviceSurfaces& surfaces, vk::Kernel gather,
                      SubdividedMesh whole, std::optional<SubdividedMesh> sides, Points points,
                      Tables tables, uint32_t face_triangles)
        : surfaces_(surfaces),
          gather_(std::move(gather)),
          whole_(std::move(whole)),
          sides_(std::move(sides)),
          points_(std::move(points)),
          tables_(std::move(tables)),
          face_triangles_(face_triangles) {}

    vk::GraphicsShaders shaders() const override { return {.vertex = shaders::subdivision_vert}; }

    Status update(vk::Stream& stream, const Shot& /*shot*/) override {
        const vk::Stream::Scope scope(stream, "refine");
        whole_.gather(stream, gather_, surfaces_.positions());
        if (sides_) sides_->gather(stream, gather_, surfaces_.positions());
        stream.barrier();
        const uint64_t normals = points_.normals.address();
        whole_.subdivision.record_limit(stream, whole_.control.address(),
                                        points_.positions.address(), normals);
        if (sides_)
            sides_->subdivision.record_limit(
                stream, sides_->control.address(), 0,
                normals + uint64_t{whole_.subdivision.vertex_count()} * sizeof(vec3));
        return {};
    }
    uint64_t geometry() const override { return tables_.geometry.address(); }
    std::vector<FaceDraw> draws(Layer /*layer*/, std::span<const FaceRange> faces) const override {
        return face_draws(faces, {.triangles = face_triangles_});
    }
    void draw(vk::Stream& stream, const SurfacePass& pass, const FaceDraw& draw) const override {
        stream.draw(
            pass.pipeline, pass.target, pass.args,
            {0, 3 * draw.triangles, draw.places.first, draw.places.count, &tables_.triangles});
    }

private:
    const mesh::gpu::DeviceSurfaces& surfaces_;
    vk::Kernel gather_;
    SubdividedMesh whole_;
    std::optional<SubdividedMesh> sides_;  ///< cut open along creases, if there are any
    Points points_;
    Tables tables_;
    uint32_t face_triangles_;
};

/// Memory for points and faces, before any is taken.
Result<Points> make_points(vk::Stream& stream, const Subdivision& whole,
                           const std::optional<Subdivision>& sides, uint64_t faces, int level) {
    const uint64_t count = whole.vertex_count(), of_sides = sides ? sides->vertex_count() : 0;
    const uint64_t positions = count * sizeof(vec3);
    const uint64_t normals = (count + of_sides) * sizeof(vec3);
    const uint64_t tables = faces * sizeof(shared::RasterSubdividedFace) * (sides ? 2 : 1);
    const std::string what = fmt::format("refinement level {}", level);
    AG_CHECK(check_room(*stream.gpu(), positions + normals + tables, what + " needs",
                        "take a lower level"));
    Points points;
    AG_TRY(points.positions, stream.make_buffer(positions, "points of " + what));
    AG_TRY(points.normals, stream.make_buffer(normals, "normals of " + what));
    return points;
}

/// [vertex of the mesh cut open] vertex of Surfaces.
std::vector<uint32_t> side_sources(const ControlScene& control, const CreaseSides& sides) {
    std::vector<uint32_t> sources;
    for (const uint32_t half : sides.mesh.vertex_half)
        sources.push_back(control.vertex_source[control.topology.vertex[half]]);
    return sources;
}

}  // namespace

Result<std::unique_ptr<VertexSource>> make_subdivision_source(
    vk::Stream& stream, const mesh::gpu::DeviceSurfaces& surfaces, const Scene& scene,
    const Surfaces& rest, const Refinement& refinement) {
    const bool loop = refinement.kind == Refinement::Kind::loop;
    const SubdivisionOptions options{loop ? Scheme::loop : Scheme::catmull_clark, refinement.level};
    AG_TRY(const ControlScene control, control_scene(scene, rest, refinement.crease_angle));
    AG_TRY(const CreaseSides sides, crease_sides(control.topology));
    AG_TRY(const Subdivision whole, Subdivision::create(control.topology, options));
    std::optional<Subdivision> of_sides;
    if (!sides.empty()) {
        AG_TRY(of_sides, Subdivision::create(sides.mesh, options));
    }
    AG_TRY(const FacePattern pattern, face_pattern(options));
    AG_TRY(Points points,
           make_points(stream, whole, of_sides, rest.triangles.size(), options.level));
    AG_TRY(Tables tables,
           Tables::create(stream, subdivided_faces(control, sides, pattern), pattern, points));
    AG_TRY(auto on_device, SubdividedMesh::create(stream, whole, control.vertex_source));
    std::optional<SubdividedMesh> sides_on_device;
    if (of_sides) {
        AG_TRY(sides_on_device,
               SubdividedMesh::create(stream, *of_sides, side_sources(control, sides)));
    }
    AG_TRY(vk::Kernel gather, vk::Kernel::create(stream.gpu(), "gather", shaders::gather_comp));
    return std::make_unique<SubdivisionSource>(
        surfaces, std::move(gather), std::move(on_device), std::move(sides_on_device),
        std::move(points), std::move(tables), static_cast<uint32_t>(pattern.triangles.size()));
}

}  // namespace aglow::render::gpu
