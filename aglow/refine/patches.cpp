// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/patches.h"

#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"
#include "aglow/refine/cpu/general_patches.h"
#include "aglow/refine/cpu/patch_faces.h"
#include "aglow/refine/cpu/uniform_patches.h"
#include "aglow/shared/phong_tessellation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aglow {
namespace {

using shared::EdgePoints;
using shared::PatchEdge;
using shared::ShapeTags;

constexpr size_t kGrain = 1024;  // vertices, edges or faces: some 10 us of work

/// Calls one(i) for all i below `count`, on all threads.
template <class One>
void for_each(uint32_t count, const One& one) {
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) one(static_cast<uint32_t>(i));
    });
}

/// Of an edge, the half-edge that leaves its end with the lower number, and that of the other side;
/// both are the one there is where the other is not.
struct Sides {
    uint32_t low = 0, high = 0;  ///< the ends
    uint32_t left = 0, right = 0;
};

Sides sides_of(const Topology& topology, uint32_t edge) {
    const uint32_t h = topology.edge_half[edge];
    const uint32_t twin = topology.twin[h] == kNone ? h : topology.twin[h];
    const uint32_t from = topology.vertex[h], to = topology.end(h);
    return from < to ? Sides{from, to, h, twin} : Sides{to, from, twin, h};
}

/// The input normals of the half-edge's face at an end of its edge.
vec3 normal_at(const Topology& topology, std::span<const vec3> normals, uint32_t h, uint32_t v) {
    return normals[topology.vertex[h] == v ? h : topology.next(h)];
}

PatchEdge patch_edge(const Topology& topology, const PatchInput& input, uint32_t edge) {
    const Sides s = sides_of(topology, edge);
    return {input.positions[s.low],
            input.positions[s.high],
            normal_at(topology, input.normals, s.left, s.low),
            normal_at(topology, input.normals, s.left, s.high),
            normal_at(topology, input.normals, s.right, s.low),
            normal_at(topology, input.normals, s.right, s.high)};
}

ShapeTags tags_at(const PatchInput& input, uint32_t v) {
    return input.tags.empty() ? ShapeTags{} : shared::bounded_tags(input.tags[v]);
}

EdgePoints edge_points(const Topology& topology, const PatchInput& input,
                       const PatchOptions& options, uint32_t edge) {
    const PatchEdge e = patch_edge(topology, input, edge);
    if (options.shape == PatchShape::flat) return shared::phong_edge_points(e, 0);
    if (options.shape == PatchShape::phong)
        return shared::phong_edge_points(e, options.phong_shape);
    if (input.tags.empty()) return shared::pn_edge_points(e);
    const Sides s = sides_of(topology, edge);
    return shared::tagged_edge_points(e, tags_at(input, s.low), tags_at(input, s.high));
}

/// Of a triangle.
vec3 center(const Topology& topology, const PatchControl& control, uint32_t f) {
    vec3 corners = {0, 0, 0}, edge_points = {0, 0, 0};
    for (uint32_t h = topology.face_begin[f]; h < topology.face_begin[f + 1]; ++h) {
        const EdgePoints& e = control.edges[topology.edge[h]];
        corners += control.positions[topology.vertex[h]];
        edge_points += e.first + e.second;
    }
    return shared::patch_center(corners, edge_points);
}

/// The plane's normal of a face, by area; of length 1 unless the face has none.
vec3 face_normal(const Topology& topology, std::span<const vec3> positions, uint32_t f) {
    const auto corner = [&](uint32_t i) {
        return positions[topology.vertex[topology.face_begin[f] + i]];
    };
    const vec3 n = topology.face_size(f) == 4 ? cross(corner(2) - corner(0), corner(3) - corner(1))
                                              : cross(corner(1) - corner(0), corner(2) - corner(0));
    return shared::unit_or(n, n);
}

/// The half-edge that leaves the same vertex, counter-clockwise of h; kNone at a boundary.
uint32_t turned(const Topology& topology, uint32_t h) {
    return topology.twin[topology.previous(h)];
}

/// Calls one(h) for the half-edges that leave a vertex, counter-clockwise.
template <class One>
void for_each_leaving(const Topology& topology, uint32_t v, const One& one) {
    const uint32_t first = topology.vertex_half[v];
    for (uint32_t h = first; h != kNone;) {
        one(h);
        h = turned(topology, h);
        if (h == first) return;
    }
}

vec3 middle_of(NormalField field, vec3 d, vec3 a, vec3 b) {
    return field == NormalField::linear ? shared::linear_middle(a, b)
                                        : shared::quadratic_middle(d, a, b);
}

}  // namespace

Result<Patches> Patches::create(const Topology& topology, const PatchOptions& options) {
    for (uint32_t f = 0; f < topology.face_count(); ++f)
        if (topology.face_size(f) > 4)
            return fail(Errc::bad_argument,
                        fmt::format("face {} has {} corners: patches are triangles and quads", f,
                                    topology.face_size(f)));
    return Patches(topology, options);
}

void Patches::update(const PatchInput& input, PatchControl& control) const {
    const Topology& t = topology_;
    AG_ASSERT(input.positions.size() == t.vertex_count(), "a position per vertex");
    AG_ASSERT(input.normals.size() == t.half_edge_count(), "a normal per corner");
    AG_ASSERT(input.tags.empty() || input.tags.size() == t.vertex_count(), "tags per vertex");
    control.positions.assign(input.positions.begin(), input.positions.end());
    control.edges.resize(t.edge_count());
    control.centers.resize(t.face_count());
    control.normals.assign(input.normals.begin(), input.normals.end());
    control.middle_normals.resize(t.half_edge_count());
    control.directions.resize(t.vertex_count());
    control.middle_directions.resize(t.edge_count());

    for_each(t.vertex_count(), [&](uint32_t v) {
        vec3 sum = {0, 0, 0};
        for_each_leaving(t, v, [&](uint32_t h) { sum += input.normals[h]; });
        control.directions[v] = shared::unit_or(sum, sum);
    });
    for_each(t.edge_count(), [&](uint32_t e) {
        const Sides s = sides_of(t, e);
        control.edges[e] = edge_points(t, input, options_, e);
        control.middle_directions[e] =
            middle_of(options_.normals, input.positions[s.high] - input.positions[s.low],
                      control.directions[s.low], control.directions[s.high]);
    });
    for_each(t.face_count(), [&](uint32_t f) {
        if (t.face_size(f) == 3) control.centers[f] = center(t, control, f);
        const vec3 flat = face_normal(t, input.positions, f);
        const uint32_t begin = t.face_begin[f], end = t.face_begin[f + 1];
        for (uint32_t h = begin; h < end && !input.tags.empty(); ++h)
            control.normals[h] = shared::tagged_normal(input.normals[h], flat,
                                                       tags_at(input, t.vertex[h]).sharpness);
        for (uint32_t h = begin; h < end; ++h)
            control.middle_normals[h] = middle_of(
                options_.normals, input.positions[t.end(h)] - input.positions[t.vertex[h]],
                control.normals[h], control.normals[t.next(h)]);
    });
}

void Patches::evaluate(const PatchControl& control, const Tessellation& tessellation,
                       std::span<vec3> positions) const {
    AG_ASSERT(positions.size() == tessellation.vertex_count(), "room for all vertices");
    if (tessellation.segments > 0 && tessellation.density.empty())
        refine::cpu::evaluate_uniform(topology_, control, tessellation, positions);
    else
        refine::cpu::evaluate_general(topology_, control, tessellation, nullptr, false, positions,
                                      {});
}

void Patches::evaluate(const PatchControl& control, const Tessellation& tessellation,
                       const DisplacementMap& displacement, std::span<vec3> positions,
                       std::span<vec3> normals) const {
    AG_ASSERT(positions.size() == tessellation.vertex_count(), "room for all vertices");
    AG_ASSERT(normals.empty() || normals.size() == positions.size(), "room for all normals");
    refine::cpu::evaluate_general(topology_, control, tessellation, &displacement,
                                  options_.shape == PatchShape::flat, positions, normals);
}

void Patches::evaluate_normals(const PatchControl& control, const Tessellation& tessellation,
                               std::span<vec3> normals) const {
    AG_ASSERT(normals.size() == tessellation.vertex_count(), "room for all normals");
    refine::cpu::evaluate_general(topology_, control, tessellation, nullptr, false, {}, normals);
}

PatchPlace Patches::at(const PatchControl& control, uint32_t face, vec2 coordinates) const {
    using namespace refine::cpu;
    const float x = coordinates.x, y = coordinates.y, u = 1 - x - y;
    if (topology_.face_size(face) == 3) {
        const auto points = triangle_points(topology_, control, face);
        const auto normals = face_normals<shared::PatchNormals>(topology_, control, face);
        const auto directions = face_directions<shared::PatchNormals>(topology_, control, face);
        return {shared::patch_position(points, u, x, y),
                shared::patch_derivative_v(points, u, x, y),
                shared::patch_derivative_w(points, u, x, y), shared::patch_normal(normals, u, x, y),
                shared::patch_normal(directions, u, x, y)};
    }
    const auto points = quad_points(topology_, control, face);
    const auto normals = face_normals<shared::QuadNormals>(topology_, control, face);
    const auto directions = face_directions<shared::QuadNormals>(topology_, control, face);
    return {shared::quad_position(points, x, y), shared::quad_derivative_x(points, x, y),
            shared::quad_derivative_y(points, x, y), shared::quad_normal(normals, x, y),
            shared::quad_normal(directions, x, y)};
}

std::vector<vec3> corner_normals(const Topology& topology, std::span<const vec3> positions) {
    AG_ASSERT(positions.size() == topology.vertex_count(), "a position per vertex");
    std::vector<vec3> weighted(topology.half_edge_count()), result(topology.half_edge_count());
    for_each(topology.face_count(), [&](uint32_t f) {
        const vec3 n = face_normal(topology, positions, f);
        for (uint32_t h = topology.face_begin[f]; h < topology.face_begin[f + 1]; ++h) {
            const vec3 at = positions[topology.vertex[h]];
            const vec3 out = positions[topology.end(h)] - at;
            const vec3 in = positions[topology.vertex[topology.previous(h)]] - at;
            weighted[h] = n * std::atan2(length(cross(out, in)), dot(out, in));
        }
    });
    const auto is_sharp = [&](uint32_t h) {
        return topology.edge_sharpness[topology.edge[h]] >= kSharp;
    };
    for_each(topology.vertex_count(), [&](uint32_t v) {
        // Begins at a sharp edge if there is one, so that each smooth part of the fan is one run.
        uint32_t first = topology.vertex_half[v];
        for_each_leaving(topology, v, [&](uint32_t h) {
            if (is_sharp(h)) first = h;
        });
        std::vector<uint32_t> run;
        vec3 sum = {0, 0, 0};
        const auto finish = [&] {
            for (const uint32_t h : run) result[h] = shared::unit_or(sum, weighted[h]);
            run.clear();
            sum = {0, 0, 0};
        };
        uint32_t h = first == kNone || topology.on_boundary(v) ? topology.vertex_half[v] : first;
        first = h;
        while (h != kNone) {
            if (is_sharp(h)) finish();
            run.push_back(h);
            sum += weighted[h];
            h = turned(topology, h);
            if (h == first) break;
        }
        finish();
    });
    return result;
}

}  // namespace aglow
