// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/apply.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace aglow::mesh {
namespace {

vec2 to_unit(Point2 texel, Point2 frame) {
    return {static_cast<float>(std::clamp(texel.x / frame.x, 0.0, 1.0)),
            static_cast<float>(std::clamp(texel.y / frame.y, 0.0, 1.0))};
}

/// A chart's point as it lies in its box.
Point2 in_box(Point2 uv, const Chart& chart, const PlacedBox& box) {
    double x = uv.x, y = uv.y, width = chart.width, height = chart.height;
    if (box.turned) {
        x = chart.height - uv.y;
        y = uv.x;
        std::swap(width, height);
    }
    return {box.corner.x + (width > 0 ? x / width * box.size.x : 0),
            box.corner.y + (height > 0 ? y / height * box.size.y : 0)};
}

template <class T>
void append_copies(std::vector<T>& values, const std::vector<uint32_t>& copies, size_t width = 1) {
    if (values.empty()) return;
    values.reserve(values.size() + copies.size() * width);
    for (uint32_t v : copies)
        for (size_t i = 0; i < width; ++i) values.push_back(values[v * width + i]);
}

/// Appends copies of the listed vertices.
void copy_vertices(Primitive& primitive, const std::vector<uint32_t>& copies) {
    if (copies.empty()) return;
    if (primitive.source_vertex.empty()) {
        primitive.source_vertex.resize(primitive.positions.size());
        std::iota(primitive.source_vertex.begin(), primitive.source_vertex.end(), 0u);
    }
    append_copies(primitive.source_vertex, copies);
    append_copies(primitive.positions, copies);
    append_copies(primitive.normals, copies);
    append_copies(primitive.colors, copies);
    for (auto& set : primitive.texcoords) append_copies(set, copies);
    append_copies(primitive.joints, copies, static_cast<size_t>(primitive.influences));
    append_copies(primitive.weights, copies, static_cast<size_t>(primitive.influences));
    for (auto* tag : {&primitive.sharpness, &primitive.tension, &primitive.bias})
        append_copies(*tag, copies);
    for (MorphTarget& target : primitive.targets) {
        append_copies(target.positions, copies);
        append_copies(target.normals, copies);
    }
}

void apply_to_primitive(const CornerUvs& uvs, size_t first_triangle, Primitive& primitive) {
    constexpr int32_t kUnused = -2;
    const size_t vertex_count = primitive.positions.size();
    std::vector<int32_t> chart_of(vertex_count, kUnused);
    std::unordered_map<uint64_t, uint32_t> copy_of;  // (vertex, chart) -> copy
    std::vector<uint32_t> copies;
    primitive.lightmap_uvs.assign(vertex_count, vec2{0, 0});
    for (size_t t = 0; t < primitive.triangles.size(); ++t) {
        const int32_t chart = uvs.charts[first_triangle + t];
        uvec3& triangle = primitive.triangles[t];
        size_t corner = 0;
        for (uint32_t* v : {&triangle.x, &triangle.y, &triangle.z}) {
            const vec2 uv = uvs.uvs[first_triangle + t][corner++];
            if (chart_of[*v] == kUnused) {
                chart_of[*v] = chart;
                primitive.lightmap_uvs[*v] = uv;
            }
            if (chart_of[*v] == chart) continue;
            const uint64_t key = uint64_t{*v} << 32 | static_cast<uint32_t>(chart);
            const auto next = static_cast<uint32_t>(vertex_count + copies.size());
            const auto [at, added] = copy_of.emplace(key, next);
            if (added) {
                copies.push_back(*v);
                primitive.lightmap_uvs.push_back(uv);
            }
            *v = at->second;
        }
    }
    copy_vertices(primitive, copies);
}

}  // namespace

CornerUvs corner_uvs(size_t triangle_count, const std::vector<Chart>& charts,
                     const std::vector<PlacedBox>& boxes, Point2 frame, Point2 outside) {
    const vec2 nowhere = to_unit(outside, frame);
    CornerUvs result{{triangle_count, {nowhere, nowhere, nowhere}},
                     std::vector<int32_t>(triangle_count, -1)};
    for (size_t c = 0; c < charts.size(); ++c) {
        const Chart& chart = charts[c];
        for (size_t i = 0; i < chart.triangles.size(); ++i) {
            const uint32_t t = chart.triangles[i];
            result.charts[t] = static_cast<int32_t>(c);
            for (size_t k = 0; k < 3; ++k)
                result.uvs[t][k] =
                    to_unit(in_box(chart.uvs[chart.corners[i][k]], chart, boxes[c]), frame);
        }
    }
    return result;
}

void apply_corner_uvs(const CornerUvs& uvs, Mesh& mesh) {
    size_t first_triangle = 0;
    for (Primitive& primitive : mesh.primitives) {
        const size_t count = primitive.triangles.size();
        apply_to_primitive(uvs, first_triangle, primitive);
        first_triangle += count;
    }
}

}  // namespace aglow::mesh
