// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/assert.h"
#include "aglow/refine/scene/refined_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace aglow::refine {
namespace {

/// How sharp a vertex is by the edges that meet there: while a third of them is sharp it stays.
std::vector<float> sharpness_by_edges(const Topology& t) {
    std::vector<std::array<float, 3>> sharpest(t.vertex_count(), {0, 0, 0});
    const auto add = [&](uint32_t vertex, float sharpness) {
        std::array<float, 3>& three = sharpest[vertex];
        for (float& s : three)
            if (sharpness > s) std::swap(s, sharpness);
    };
    for (uint32_t e = 0; e < t.edge_count(); ++e) {
        const uint32_t h = t.edge_half[e];
        const float sharpness = t.twin[h] == kNone ? kSharp : t.edge_sharpness[e];
        add(t.vertex[h], sharpness);
        add(t.end(h), sharpness);
    }
    std::vector<float> third;
    for (const auto& three : sharpest) third.push_back(three[2]);
    return third;
}

/// Boundaries of a mesh of texture coordinates stay straight: its corners are sharp along them.
Topology with_straight_boundaries(Topology mesh) {
    for (uint32_t v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.on_boundary(v)) mesh.vertex_sharpness[v] = kSharp;
    return mesh;
}

// A boundary that turns by more than this (75 degrees) has a corner there. Faces do not tell: a
// square of two triangles has corners of one and of two.
constexpr float kTurn = 75 * kPi / 180;

/// By how much the boundary turns at a vertex of it, radians.
float boundary_turn(const Topology& mesh, std::span<const vec3> positions, uint32_t v) {
    uint32_t h = mesh.vertex_half[v];
    const vec3 out = positions[mesh.end(h)] - positions[v];
    while (mesh.twin[mesh.previous(h)] != kNone) h = mesh.twin[mesh.previous(h)];
    const vec3 in = positions[v] - positions[mesh.vertex[mesh.previous(h)]];
    return std::atan2(length(cross(in, out)), dot(in, out));
}

Topology with_corners(Topology mesh, std::span<const vec3> positions, Corners corners) {
    for (uint32_t v = 0; v < mesh.vertex_count() && corners == Corners::sharp; ++v)
        if (mesh.on_boundary(v) && boundary_turn(mesh, positions, v) > kTurn)
            mesh.vertex_sharpness[v] = kSharp;
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
        AG_CHECK(build_creases(groups, whole_order));
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

    /// What gives the normals on both sides of creases: the mesh cut open there. Its boundaries
    /// follow the same curves as the creases, so that only normals are taken from it.
    Status build_creases(std::span<const uint32_t> groups, const Tessellation& whole_order) {
        const Topology& topology = topology_;
        if (std::ranges::none_of(topology.edge_sharpness, [](float s) { return s >= kSharp; }))
            return {};
        AG_TRY(Topology creased, cut_by(topology, topology.vertex, groups));
        const std::vector<float> third = sharpness_by_edges(topology);
        std::vector<uint32_t> copies(topology.vertex_count(), 0);
        for (uint32_t v = 0; v < creased.vertex_count(); ++v) {
            const uint32_t of = topology.vertex[creased.vertex_half[v]];
            creased.vertex_sharpness[v] = std::max(creased.vertex_sharpness[v], third[of]);
            ++copies[of];
        }
        AG_TRY(creases_, Subdivision::create(creased, subdivision_));
        of_crease_ = refined_sources(cut, order, creased, order_of(creased));
        // A crease that ends inside the surface fades: there the surface has one normal.
        std::vector<bool> parted(whole_order.vertex_count(), false);
        for (uint32_t v = 0; v < topology.vertex_count(); ++v) parted[v] = copies[v] > 1;
        for (uint32_t e = 0; e < topology.edge_count(); ++e)
            for (uint32_t v = whole_order.edge_first[e]; v < whole_order.edge_first[e + 1]; ++v)
                parted[v] = topology.edge_sharpness[e] >= kSharp;
        for (uint32_t v = 0; v < vertex_count(); ++v)
            if (parted[whole[v]]) parted_.push_back(v);
        creased_half_ = creased.vertex_half;
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
