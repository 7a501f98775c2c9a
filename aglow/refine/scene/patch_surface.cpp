// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/parallel.h"
#include "aglow/refine/patches.h"
#include "aglow/refine/pattern.h"
#include "aglow/refine/scene/pattern_choice.h"
#include "aglow/refine/scene/refined_surface.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace aglow::refine {
namespace {

constexpr size_t kGrain = 256;
// Corners whose normals are closer than this cosine (1 degree) share theirs.
constexpr float kSameNormal = 0.99985f;

/// Where the vertices of a pattern are that lie on none of its edges, in its order.
std::vector<vec2> inner_coordinates(const Pattern& pattern, uint32_t corners, uint32_t n) {
    std::vector<vec2> inner;
    for (size_t k = 0; k < pattern.steps.size(); ++k) {
        const uint32_t i = pattern.steps[k] & 0xffffu, j = pattern.steps[k] >> 16;
        const bool inside =
            corners == 3 ? i > 0 && j > 0 && i + j < n : i > 0 && j > 0 && i < n && j < n;
        if (inside) inner.push_back(pattern.coordinates[k]);
    }
    return inner;
}

/// Attributes over patches: linear along edges and in triangles, bilinear in quads.
class LinearAttributes {
public:
    LinearAttributes(const Topology& topology, const Tessellation& order)
        : topology_(topology), order_(order), n_(static_cast<uint32_t>(order.segments)) {
        triangle_ = inner_coordinates(triangle_pattern(order.segments), 3, n_);
        quad_ = inner_coordinates(quad_pattern(order.segments), 4, n_);
    }

    void evaluate(std::span<const float> control, size_t width, std::span<float> refined) const {
        std::copy_n(control.data(), topology_.vertex_count() * width, refined.data());
        parallel_for(topology_.edge_count(), kGrain, [&](size_t begin, size_t end) {
            for (size_t e = begin; e < end; ++e)
                fill_edge(control.data(), width, static_cast<uint32_t>(e), refined.data());
        });
        parallel_for(topology_.face_count(), kGrain, [&](size_t begin, size_t end) {
            for (size_t f = begin; f < end; ++f)
                fill_face(control.data(), width, static_cast<uint32_t>(f), refined.data());
        });
    }

private:
    /// a s + b t: with t in steps of a power of two the same from both ends.
    void fill_edge(const float* control, size_t width, uint32_t e, float* refined) const {
        const uint32_t h = topology_.edge_half[e];
        const float* a = control + topology_.vertex[h] * width;
        const float* b = control + topology_.end(h) * width;
        float* out = refined + order_.edge_first[e] * width;
        for (uint32_t i = 1; i < n_; ++i, out += width) {
            const float t = static_cast<float>(i) / static_cast<float>(n_);
            for (size_t c = 0; c < width; ++c) out[c] = a[c] * (1 - t) + b[c] * t;
        }
    }

    void fill_face(const float* control, size_t width, uint32_t f, float* refined) const {
        const uint32_t h = topology_.face_begin[f], corners = topology_.face_size(f);
        const auto corner = [&](uint32_t i) { return control + topology_.vertex[h + i] * width; };
        float* out = refined + order_.face_first[f] * width;
        for (const vec2 p : corners == 3 ? triangle_ : quad_) {
            for (size_t c = 0; c < width; ++c)
                out[c] =
                    corners == 3
                        ? corner(0)[c] * (1 - p.x - p.y) + corner(1)[c] * p.x + corner(2)[c] * p.y
                        : (corner(0)[c] * (1 - p.x) + corner(1)[c] * p.x) * (1 - p.y) +
                              (corner(3)[c] * (1 - p.x) + corner(2)[c] * p.x) * p.y;
            out += width;
        }
    }

    const Topology& topology_;
    const Tessellation& order_;
    uint32_t n_;
    std::vector<vec2> triangle_, quad_;  // of vertices inside
};

class PatchSurface : public RefinedSurface {
public:
    PatchSurface(const ControlMesh& control, std::vector<shared::ShapeTags> tags)
        : control_(control), tags_(std::move(tags)) {}

    Status build(const RefineOptions& options, const Shape& rest) {
        const Topology& topology = control_.topology;
        AG_TRY(patches_, Patches::create(topology, patch_options(options.scheme)));
        const std::vector<uint32_t> groups =
            corner_groups(topology, [&](uint32_t h, uint32_t other) {
                return dot(rest.corner_normals[h], rest.corner_normals[other]) > kSameNormal;
            });
        AG_TRY(cut, cut_by(topology, control_.seams.vertex, groups));
        choose_pattern(options, rest);
        AG_TRY(order, tessellation(cut, 1 << options.level));
        AG_TRY(whole_, tessellation(topology, 1 << options.level));
        AG_TRY(seams_, tessellation(control_.seams, 1 << options.level));
        order.density = density_;
        whole = refined_sources(cut, order, topology, whole_);
        seams = refined_sources(cut, order, control_.seams, seams_);
        triangles = std::move(order.triangles);
        face_triangle = std::move(order.face_triangle);
        return {};
    }

    Status place(const Shape& shape, RefinedShape& refined) const override {
        PatchControl control;
        patches_->update({shape.positions, shape.corner_normals, tags_}, control);
        refined.positions.resize(vertex_count());
        refined.normals.resize(vertex_count());
        patches_->evaluate(control, order, refined.positions);
        patches_->evaluate_normals(control, order, refined.normals);
        return {};
    }

    Status interpolate(Layer layer, std::span<const float> control, int width,
                       std::vector<float>& refined) const override {
        const bool is_whole = layer == Layer::whole;
        const Topology& topology = is_whole ? control_.topology : control_.seams;
        const Tessellation& layer_order = is_whole ? whole_ : seams_;
        const auto columns = static_cast<size_t>(width);
        refined.resize(layer_order.vertex_count() * columns);
        if (density_.empty() && levels_.empty())
            LinearAttributes(topology, layer_order).evaluate(control, columns, refined);
        else
            AG_CHECK(interpolate_flat(topology, layer, control, columns, refined));
        return {};
    }

private:
    void choose_pattern(const RefineOptions& options, const Shape& rest) {
        if (!options.pattern.irregular && !options.pattern.tolerance) return;
        PatchControl control;
        patches_->update({rest.positions, rest.corner_normals, tags_}, control);
        const Topology& topology = control_.topology;
        if (options.pattern.irregular)
            density_ = vertex_density(topology, control, options.pattern.eye);
        if (const auto& tolerance = options.pattern.tolerance)
            levels_ =
                edge_levels(topology, control, *tolerance, static_cast<float>(1 << options.level));
    }

    /// Of the control mesh, or of one cut from it.
    Result<Tessellation> tessellation(const Topology& topology, int segments) const {
        if (levels_.empty()) return Tessellation::uniform(topology, segments);
        std::vector<float> levels;
        for (const uint32_t h : topology.edge_half)
            levels.push_back(levels_[control_.topology.edge[h]]);
        return Tessellation::adaptive(topology, levels);
    }

    /// Values in place of positions, three columns at a time, over flat patches.
    Status interpolate_flat(const Topology& topology, Layer layer, std::span<const float> control,
                            size_t width, std::span<float> refined) const {
        AG_TRY(const Patches flat,
               Patches::create(topology, {PatchShape::flat, NormalField::linear}));
        Tessellation order_there = layer == Layer::whole ? whole_ : seams_;
        for (uint32_t v = 0; v < topology.vertex_count() && !density_.empty(); ++v)
            order_there.density.push_back(
                density_[layer == Layer::whole ? v : control_.seam_to_vertex[v]]);
        const std::vector<vec3> normals(topology.half_edge_count(), vec3{0, 1, 0});
        std::vector<vec3> values(topology.vertex_count()), there(order_there.vertex_count());
        PatchControl points;
        for (size_t column = 0; column < width; column += 3) {
            const size_t used = std::min<size_t>(3, width - column);
            for (size_t v = 0; v < values.size(); ++v)
                std::copy_n(control.data() + v * width + column, used, &values[v].x);
            flat.update({values, normals, {}}, points);
            flat.evaluate(points, order_there, there);
            for (size_t v = 0; v < there.size(); ++v)
                std::copy_n(&there[v].x, used, refined.data() + v * width + column);
        }
        return {};
    }

private:
    const ControlMesh& control_;
    std::vector<shared::ShapeTags> tags_;
    std::optional<Patches> patches_;
    Tessellation whole_, seams_;
    std::vector<float> density_;  ///< [vertex of the control mesh]; empty: even
    std::vector<float> levels_;   ///< [edge of the control mesh]; empty: all the same
};

}  // namespace

PatchOptions patch_options(RefineScheme scheme) {
    if (scheme == RefineScheme::flat) return {PatchShape::flat, NormalField::linear};
    PatchOptions options;
    if (scheme == RefineScheme::phong) options.shape = PatchShape::phong;
    return options;
}

Result<std::unique_ptr<RefinedSurface>> patch_surface(const ControlMesh& control,
                                                      const RefineOptions& options,
                                                      const Shape& rest,
                                                      std::vector<shared::ShapeTags> tags) {
    auto surface = std::make_unique<PatchSurface>(control, std::move(tags));
    AG_CHECK(surface->build(options, rest));
    return std::unique_ptr<RefinedSurface>(std::move(surface));
}

}  // namespace aglow::refine
