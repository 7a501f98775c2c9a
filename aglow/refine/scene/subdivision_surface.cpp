// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/assert.h"
#include "aglow/refine/creases.h"
#include "aglow/refine/scene/refined_surface.h"

#include <algorithm>
#include <array>
#include <optional>

namespace aglow::refine {
namespace {

/// Boundaries of a mesh of texture coordinates stay straight: its corners are sharp along them.
Topology with_straight_boundaries(Topology mesh) {
    for (uint32_t v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.on_boundary(v)) mesh.vertex_sharpness[v] = kSharp;
    return mesh;
}

class SubdivisionSurface : public RefinedSurface {
public:
    SubdivisionSurface(const ControlMesh& control, const RefineOptions& options)
        : control_(control),
          topology_(with_corners(control.topology, control.positions, options.corners)),
          limit_(options.limit) {
        subdivision_.scheme =
            options.scheme == RefineScheme::loop ? Scheme::loop : Scheme::catmull_clark;
        subdivision_.level = options.level;
    }

    Status build() {
        const Topology& topology = topology_;
        AG_TRY(whole_, Subdivision::create(topology, subdivision_));
        AG_TRY(seams_, Subdivision::create(with_straight_boundaries(control_.seams), subdivision_));
        const std::vector<uint32_t> groups = corner_groups(topology, [&](uint32_t h, uint32_t) {
            return topology.edge_sharpness[topology.edge[h]] < kSharp;
        });
        AG_TRY(cut, cut_by(topology, control_.seams.vertex, groups));
        order = order_of(cut);
        const Tessellation whole_order = order_of(topology);
        AG_ASSERT(whole_order.vertex_count() == whole_->vertex_count(), "the order of Subdivision");
        whole = refined_sources(cut, order, topology, whole_order);
        seams = refined_sources(cut, order, control_.seams, order_of(control_.seams));
        AG_CHECK(build_creases(whole_order));
        number_faces(CutNumbers(cut, order, topology, whole_order));
        return {};
    }

    Status place(const Shape& shape, RefinedShape& refined) const override {
        std::vector<vec3> positions(whole_->vertex_count()), normals(whole_->vertex_count());
        AG_CHECK(whole_->evaluate_limit(shape.positions, positions, normals));
        if (!limit_) AG_CHECK(whole_->evaluate(shape.positions, positions));
        refined.positions.resize(vertex_count());
        refined.normals.resize(vertex_count());
        for (uint32_t v = 0; v < vertex_count(); ++v) {
            refined.positions[v] = positions[whole[v]];
            refined.normals[v] = normals[whole[v]];
        }
        return creases_ ? place_creases(shape, refined) : Status();
    }

    Status interpolate(Layer layer, std::span<const float> control, int width,
                       std::vector<float>& refined) const override {
        const Subdivision& subdivision = layer == Layer::whole ? *whole_ : *seams_;
        refined.resize(size_t{subdivision.vertex_count()} * static_cast<size_t>(width));
        if (!limit_) return subdivision.evaluate(control, width, refined);
        return limit_columns(subdivision, control, static_cast<size_t>(width), refined);
    }

private:
    Tessellation order_of(const Topology& topology) const {
        return subdivided_order(topology, subdivision_.scheme, subdivision_.level);
    }

    /// What gives the normals on both sides of creases.
    Status build_creases(const Tessellation& whole_order) {
        const Topology& topology = topology_;
        AG_TRY(const CreaseSides sides, crease_sides(topology));
        if (sides.empty()) return {};
        AG_TRY(creases_, Subdivision::create(sides.mesh, subdivision_));
        of_crease_ = refined_sources(cut, order, sides.mesh, order_of(sides.mesh));
        std::vector<bool> parted = sides.parted;
        parted.resize(whole_order.vertex_count(), false);
        for (uint32_t e = 0; e < topology.edge_count(); ++e)
            for (uint32_t v = whole_order.edge_first[e]; v < whole_order.edge_first[e + 1]; ++v)
                parted[v] = topology.edge_sharpness[e] >= kSharp;
        for (uint32_t v = 0; v < vertex_count(); ++v)
            if (parted[whole[v]]) parted_.push_back(v);
        creased_half_ = sides.mesh.vertex_half;
        return {};
    }

    Status place_creases(const Shape& shape, RefinedShape& refined) const {
        std::vector<vec3> control;
        for (const uint32_t h : creased_half_)
            control.push_back(shape.positions[topology_.vertex[h]]);
        std::vector<vec3> positions(creases_->vertex_count()), normals(creases_->vertex_count());
        AG_CHECK(creases_->evaluate_limit(control, positions, normals));
        for (const uint32_t v : parted_) refined.normals[v] = normals[of_crease_[v]];
        return {};
    }

    /// The limit is known for points alone: three columns at a time.
    static Status limit_columns(const Subdivision& subdivision, std::span<const float> control,
                                size_t width, std::vector<float>& refined) {
        const uint32_t count = subdivision.vertex_count();
        std::vector<vec3> points(subdivision.control_count()), limits(count), normals(count);
        for (size_t column = 0; column < width; column += 3) {
            const size_t used = std::min<size_t>(3, width - column);
            for (size_t v = 0; v < points.size(); ++v) {
                std::array<float, 3> p = {0, 0, 0};
                std::copy_n(control.data() + v * width + column, used, p.data());
                points[v] = {p[0], p[1], p[2]};
            }
            AG_CHECK(subdivision.evaluate_limit(points, limits, normals));
            for (size_t v = 0; v < count; ++v)
                std::copy_n(&limits[v].x, used, refined.data() + v * width + column);
        }
        return {};
    }

    void number_faces(const CutNumbers& number) {
        const Topology& topology = topology_;
        if (subdivision_.scheme == Scheme::loop) {
            const std::vector<uvec3> all = whole_->triangles();
            const size_t each = size_t{1} << 2 * subdivision_.level;
            for (uint32_t f = 0; f < topology.face_count(); ++f) {
                for (const uvec3 t : std::span(all).subspan(f * each, each))
                    triangles.push_back({number(f, t.x), number(f, t.y), number(f, t.z)});
                face_triangle.push_back(static_cast<uint32_t>(triangles.size()));
            }
            return;
        }
        const auto all = whole_->quads();
        const size_t of_corner = size_t{1} << 2 * (subdivision_.level - 1);
        for (uint32_t f = 0; f < topology.face_count(); ++f) {
            const size_t first = topology.face_begin[f] * of_corner;
            for (const auto& q : std::span(all).subspan(first, topology.face_size(f) * of_corner)) {
                const uint32_t a = number(f, q[0]), b = number(f, q[1]), c = number(f, q[2]),
                               d = number(f, q[3]);
                triangles.push_back({a, b, c});
                triangles.push_back({a, c, d});
            }
            face_triangle.push_back(static_cast<uint32_t>(triangles.size()));
        }
    }

    const ControlMesh& control_;
    const Topology topology_;  ///< of the control mesh, with its corners
    SubdivisionOptions subdivision_;
    bool limit_ = false;
    std::optional<Subdivision> whole_, seams_, creases_;
    std::vector<uint32_t> creased_half_;  ///< [vertex of the mesh cut open at creases]
    std::vector<uint32_t> of_crease_;     ///< [refined vertex] that of creases_
    std::vector<uint32_t> parted_;        ///< refined vertices on creases
};

}  // namespace

Result<std::unique_ptr<RefinedSurface>> subdivision_surface(const ControlMesh& control,
                                                            const RefineOptions& options) {
    auto surface = std::make_unique<SubdivisionSurface>(control, options);
    AG_CHECK(surface->build());
    return std::unique_ptr<RefinedSurface>(std::move(surface));
}

}  // namespace aglow::refine
