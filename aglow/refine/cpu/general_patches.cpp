// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/cpu/general_patches.h"

#include "aglow/core/parallel.h"
#include "aglow/refine/cpu/patch_faces.h"
#include "aglow/shared/pattern.h"

#include <algorithm>

namespace aglow::refine::cpu {
namespace {

using shared::Field;
using shared::PatchNormals;
using shared::QuadNormals;

/// A place on the face of a half-edge, by coordinates of its pattern.
struct FacePlace {
    uint32_t face = 0;
    float x = 0, y = 0;
};

struct SurfacePoint {
    vec3 position, normal, direction;
};

/// Slopes of the texture coordinates' height by the face's parameters.
struct Slopes {
    float by_x = 0, by_y = 0;
};

class Evaluator {
public:
    Evaluator(const Topology& topology, const PatchControl& control,
              const Tessellation& tessellation, const DisplacementMap* displacement, bool flat,
              std::span<vec3> positions, std::span<vec3> normals)
        : topology_(topology),
          control_(control),
          tessellation_(tessellation),
          displacement_(displacement),
          flat_(flat),
          positions_(positions),
          normals_(normals) {}

    void vertex(uint32_t v) const;
    void edge(uint32_t e) const;
    void face(uint32_t f) const;

private:
    bool has_map() const {
        return displacement_ && displacement_->settings.kind == shared::kHeightMapDisplacement;
    }
    FacePlace place_on(uint32_t h, float t) const;
    vec3 densities_of(uint32_t triangle) const {
        const auto at = [&](uint32_t i) {
            return tessellation_.density[topology_.vertex[topology_.face_begin[triangle] + i]];
        };
        return {at(0), at(1), at(2)};
    }
    float map_height(vec2 uv) const;
    float map_height_on_edge(uint32_t h, float t) const;
    float map_height_at(uint32_t v) const;
    vec2 uv_at(FacePlace at) const;
    Slopes map_slopes(FacePlace at) const;
    float longest_edge(uint32_t face) const;
    Slopes flat_slopes(FacePlace at) const;
    shared::UnitField corner_directions(FacePlace at) const;
    vec3 map_normal(SurfacePoint point, float height, FacePlace at) const;
    void store(uint32_t index, SurfacePoint point, float map_height, FacePlace at) const;

    const Topology& topology_;
    const PatchControl& control_;
    const Tessellation& tessellation_;
    const DisplacementMap* displacement_;
    bool flat_;
    std::span<vec3> positions_, normals_;
};

/// On the half-edge's face, t of the way along it.
FacePlace Evaluator::place_on(uint32_t h, float t) const {
    const uint32_t f = topology_.face[h], side = h - topology_.face_begin[f];
    const float s = 1 - t;
    if (topology_.face_size(f) == 3)
        return {f, side == 0 ? t : side == 1 ? s : 0.0f, side == 0 ? 0.0f : side == 1 ? t : s};
    return {f,
            side == 0   ? t
            : side == 1 ? 1.0f
            : side == 2 ? s
                        : 0.0f,
            side == 0   ? 0.0f
            : side == 1 ? t
            : side == 2 ? 1.0f
                        : s};
}

float Evaluator::map_height(vec2 uv) const {
    const shared::Displacement& d = displacement_->settings;
    return d.amplitude * (sample(displacement_->map, uv, d.level) - d.middle);
}

/// The mean of both sides; t runs from the edge's end with the lower number.
float Evaluator::map_height_on_edge(uint32_t h, float t) const {
    const auto side = [&](uint32_t half) {
        vec2 a = displacement_->uvs[half], b = displacement_->uvs[topology_.next(half)];
        if (topology_.vertex[half] > topology_.end(half)) std::swap(a, b);
        return map_height(a * (1 - t) + b * t);
    };
    const uint32_t half = topology_.edge_half[topology_.edge[h]], twin = topology_.twin[half];
    const float height = side(half);
    return twin == kNone ? height : 0.5f * (height + side(twin));
}

/// The mean of all faces round the vertex.
float Evaluator::map_height_at(uint32_t v) const {
    const uint32_t first = topology_.vertex_half[v];
    float sum = 0, count = 0;
    for (uint32_t h = first; h != kNone;) {
        sum += map_height(displacement_->uvs[h]);
        count += 1;
        h = topology_.twin[topology_.previous(h)];
        if (h == first) break;
    }
    return sum / count;
}

vec2 Evaluator::uv_at(FacePlace at) const {
    const uint32_t first = topology_.face_begin[at.face];
    const auto uv = [&](uint32_t i) { return displacement_->uvs[first + i]; };
    if (topology_.face_size(at.face) == 3)
        return uv(0) * (1 - at.x - at.y) + uv(1) * at.x + uv(2) * at.y;
    return (uv(0) * (1 - at.x) + uv(1) * at.x) * (1 - at.y) +
           (uv(3) * (1 - at.x) + uv(2) * at.x) * at.y;
}

/// Of a height map's displacement: differences over one texel, by the chain rule.
Slopes Evaluator::map_slopes(FacePlace at) const {
    const shared::TextureLevels& levels = displacement_->map.levels;
    const float texel = std::exp2(displacement_->settings.level);
    const vec2 step = {0.5f * texel / static_cast<float>(levels.width),
                       0.5f * texel / static_cast<float>(levels.height)};
    const vec2 uv = uv_at(at);
    const float by_u =
        (map_height({uv.x + step.x, uv.y}) - map_height({uv.x - step.x, uv.y})) / (2 * step.x);
    const float by_v =
        (map_height({uv.x, uv.y + step.y}) - map_height({uv.x, uv.y - step.y})) / (2 * step.y);
    // uv is linear in x and in y, so that differences over the face are its derivatives.
    const vec2 uv_x = uv_at({at.face, 1, at.y}) - uv_at({at.face, 0, at.y});
    const vec2 uv_y = uv_at({at.face, at.x, 1}) - uv_at({at.face, at.x, 0});
    return {by_u * uv_x.x + by_v * uv_x.y, by_u * uv_y.x + by_v * uv_y.y};
}

/// Texels along it.
float Evaluator::longest_edge(uint32_t face) const {
    const shared::TextureLevels& levels = displacement_->map.levels;
    const vec2 size = {static_cast<float>(levels.width), static_cast<float>(levels.height)};
    float longest = 0;
    for (uint32_t h = topology_.face_begin[face]; h < topology_.face_begin[face + 1]; ++h) {
        const vec2 along = displacement_->uvs[topology_.next(h)] - displacement_->uvs[h];
        longest = std::max(longest, length(along * size));
    }
    return longest;
}

/// Of a height map's displacement of a flat face: see shared::slope_share().
Slopes Evaluator::flat_slopes(FacePlace at) const {
    const float share =
        shared::slope_share(std::exp2(displacement_->settings.level), longest_edge(at.face));
    const auto height = [&](vec2 corner) {
        const vec2 place = shared::slope_corner({at.x, at.y}, corner, share);
        return map_height(uv_at({at.face, place.x, place.y}));
    };
    const float a = height({0, 0}), b = height({1, 0}), top = height({0, 1});
    if (topology_.face_size(at.face) == 3) return {(b - a) / share, (top - a) / share};
    const float c = height({1, 1});
    return {((b - a) * (1 - at.y) + (c - top) * at.y) / share,
            ((top - a) * (1 - at.x) + (c - b) * at.x) / share};
}

/// The direction of displacement over a flat face: that of its corners, interpolated.
shared::UnitField Evaluator::corner_directions(FacePlace at) const {
    const uint32_t first = topology_.face_begin[at.face];
    const auto corner = [&](uint32_t i) {
        return control_.directions[topology_.vertex[first + i]];
    };
    const vec3 a = corner(0), b = corner(1), c = corner(2);
    if (topology_.face_size(at.face) == 3)
        return shared::unit_field(a * (1 - at.x - at.y) + b * at.x + c * at.y, b - a, c - a);
    const vec3 d = corner(3);
    const vec3 low = a * (1 - at.x) + b * at.x, high = d * (1 - at.x) + c * at.x;
    return shared::unit_field(low * (1 - at.y) + high * at.y, (b - a) * (1 - at.y) + (c - d) * at.y,
                              high - low);
}

vec3 Evaluator::map_normal(SurfacePoint point, float height, FacePlace at) const {
    const Slopes slopes = flat_ ? flat_slopes(at) : map_slopes(at);
    vec3 by_x, by_y;
    if (topology_.face_size(at.face) == 3) {
        const auto points = triangle_points(topology_, control_, at.face);
        by_x = shared::patch_derivative_v(points, 1 - at.x - at.y, at.x, at.y);
        by_y = shared::patch_derivative_w(points, 1 - at.x - at.y, at.x, at.y);
    } else {
        const auto points = quad_points(topology_, control_, at.face);
        by_x = shared::quad_derivative_x(points, at.x, at.y);
        by_y = shared::quad_derivative_y(points, at.x, at.y);
    }
    if (flat_)
        return shared::raised_normal(by_x, by_y, corner_directions(at), height, slopes.by_x,
                                     slopes.by_y, point.normal);
    return shared::displaced_normal(point.normal,
                                    shared::surface_gradient(by_x, by_y, slopes.by_x, slopes.by_y));
}

void Evaluator::store(uint32_t index, SurfacePoint point, float map_height, FacePlace at) const {
    Field height = {0, {0, 0, 0}};
    if (displacement_) height = shared::displacement_at(displacement_->settings, point.position);
    if (has_map()) height.value = map_height;
    if (!positions_.empty())
        positions_[index] =
            displacement_ ? point.position + point.direction * height.value : point.position;
    if (normals_.empty()) return;
    normals_[index] = has_map()       ? map_normal(point, map_height, at)
                      : displacement_ ? shared::displaced_normal(point.normal, height.gradient)
                                      : point.normal;
}

void Evaluator::vertex(uint32_t v) const {
    const uint32_t h = tessellation_.vertex_half[v];
    if (h == kNone) {  // no face has it
        if (!positions_.empty())
            positions_[v] = v < control_.positions.size() ? control_.positions[v] : vec3{0, 0, 0};
        if (!normals_.empty()) normals_[v] = {0, 0, 0};
        return;
    }
    const uint32_t from = topology_.vertex[h];
    store(v, {control_.positions[from], control_.normals[h], control_.directions[from]},
          has_map() ? map_height_at(from) : 0, place_on(h, 0));
}

void Evaluator::edge(uint32_t e) const {
    const uint32_t h = tessellation_.edge_half[e];
    const uint32_t own = topology_.edge[h], next = topology_.next(h);
    const bool forward = topology_.vertex[h] < topology_.end(h);
    const uint32_t low = forward ? topology_.vertex[h] : topology_.end(h);
    const uint32_t high = forward ? topology_.end(h) : topology_.vertex[h];
    const float level = tessellation_.edge_level[e];
    const auto continuous = static_cast<uint32_t>(tessellation_.levels);
    const uint32_t segments = shared::edge_segments(level, continuous);
    for (uint32_t i = 1; i < segments; ++i) {
        float t = shared::edge_parameter(forward ? i : segments - i, level, continuous);
        if (!tessellation_.density.empty())
            t = shared::dense_parameter(t, tessellation_.density[low], tessellation_.density[high]);
        const float along = forward ? t : 1 - t;
        SurfacePoint point;
        point.position = shared::edge_position(control_.positions[low], control_.edges[own],
                                               control_.positions[high], t);
        point.normal = shared::edge_normal(control_.normals[h], control_.middle_normals[h],
                                           control_.normals[next], along);
        point.direction =
            shared::edge_normal(control_.directions[low], control_.middle_directions[own],
                                control_.directions[high], t);
        store(tessellation_.edge_first[e] + i - 1, point, has_map() ? map_height_on_edge(h, t) : 0,
              place_on(h, along));
    }
}

void Evaluator::face(uint32_t f) const {
    const bool is_triangle = topology_.face_size(f) == 3;
    const uint32_t n = tessellation_.face_segments[f];
    shared::PatchPoints triangle;
    shared::QuadPoints quad;
    PatchNormals triangle_normals, triangle_directions;
    QuadNormals quad_normals, quad_directions;
    if (is_triangle) {
        triangle = triangle_points(topology_, control_, f);
        triangle_normals = face_normals<PatchNormals>(topology_, control_, f);
        triangle_directions = face_directions<PatchNormals>(topology_, control_, f);
    } else {
        quad = quad_points(topology_, control_, f);
        quad_normals = face_normals<QuadNormals>(topology_, control_, f);
        quad_directions = face_directions<QuadNormals>(topology_, control_, f);
    }
    const shared::PatchLevels levels = levels_of(topology_, tessellation_, f);
    const uint32_t reversed = reversed_edges(topology_, f);
    uint32_t next = tessellation_.face_first[f];
    for (uint32_t j = 1; j < n; ++j)
        for (uint32_t i = 1; is_triangle ? i + j < n : i < n; ++i) {
            shared::PatternPoint at =
                is_triangle ? shared::triangle_pattern_point(i, j, n, levels, reversed)
                            : shared::quad_pattern_point(i, j, n, levels, reversed);
            if (is_triangle && !tessellation_.density.empty()) {
                const vec2 drawn = shared::dense_coordinates({at.x, at.y}, densities_of(f));
                at.x = drawn.x;
                at.y = drawn.y;
            }
            const float u = 1 - at.x - at.y;
            const SurfacePoint point =
                is_triangle ? SurfacePoint{shared::patch_position(triangle, u, at.x, at.y),
                                           shared::patch_normal(triangle_normals, u, at.x, at.y),
                                           shared::patch_normal(triangle_directions, u, at.x, at.y)}
                            : SurfacePoint{shared::quad_position(quad, at.x, at.y),
                                           shared::quad_normal(quad_normals, at.x, at.y),
                                           shared::quad_normal(quad_directions, at.x, at.y)};
            const FacePlace place = {f, at.x, at.y};
            store(next++, point, has_map() ? map_height(uv_at(place)) : 0, place);
        }
}

}  // namespace

void evaluate_general(const Topology& topology, const PatchControl& control,
                      const Tessellation& tessellation, const DisplacementMap* displacement,
                      bool flat, std::span<vec3> positions, std::span<vec3> normals) {
    const Evaluator evaluator(topology, control, tessellation, displacement, flat, positions,
                              normals);
    const auto run = [](size_t count, size_t grain, const auto& one) {
        parallel_for(count, grain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) one(static_cast<uint32_t>(i));
        });
    };
    run(tessellation.vertex_half.size(), 1024, [&](uint32_t v) { evaluator.vertex(v); });
    run(tessellation.edge_half.size(), 64, [&](uint32_t e) { evaluator.edge(e); });
    run(tessellation.face_segments.size(), 16, [&](uint32_t f) { evaluator.face(f); });
}

}  // namespace aglow::refine::cpu
