// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/scene/relief.h"

#include <algorithm>
#include <numbers>

namespace aglow::refine {
namespace {

constexpr float kRoot3 = std::numbers::sqrt3_v<float>;
// A circle of diameter 1 becomes the one inside a triangle of unit edges.
constexpr float kInTriangle = 1 / kRoot3;

/// The model over the unit square: upright, its middle in the middle, its foot at height 0.
ReliefMesh over_square(const SurfaceModel& model) {
    Box box;
    for (const vec3 p : model.positions) box.add(p);
    const vec3 size = box.hi - box.lo, middle = (box.lo + box.hi) * 0.5f;
    const float width = std::max(size.x, size.z), scale = width > 0 ? 1 / width : 1;
    ReliefMesh relief;
    for (const vec3 p : model.positions)
        relief.positions.push_back({0.5f + (p.x - middle.x) * scale,
                                    0.5f - (p.z - middle.z) * scale, (p.y - box.lo.y) * scale});
    for (const vec3 n : model.normals) relief.normals.push_back({n.x, -n.z, n.y});
    relief.triangles = model.triangles;
    return relief;
}

/// The same over the coordinates of a triangle, which are slanted: those of an equilateral one.
ReliefMesh over_triangle(ReliefMesh relief) {
    constexpr float kSlant = kInTriangle / kRoot3;  // of both coordinates by y
    for (vec3& p : relief.positions) {
        const float x = p.x - 0.5f, y = p.y - 0.5f;
        p = {1 / 3.0f + kInTriangle * x - kSlant * y, 1 / 3.0f + 2 * kSlant * y, kInTriangle * p.z};
    }
    // By the inverse of that map, transposed.
    for (vec3& n : relief.normals)
        n = {n.x / kInTriangle, (n.x / kInTriangle + n.y / kSlant) / 2, n.z / kInTriangle};
    return relief;
}

float mean_edge(const ControlMesh& control) {
    const Topology& t = control.topology;
    double sum = 0;
    for (const uint32_t h : t.edge_half)
        sum += static_cast<double>(
            length(control.positions[t.vertex[h]] - control.positions[t.end(h)]));
    return static_cast<float>(sum / std::max<double>(t.edge_count(), 1));
}

}  // namespace

Result<RaisedMesh> raise_model(const ControlMesh& control, const Shape& rest,
                               std::span<const shared::ShapeTags> tags, RefineScheme scheme,
                               const SurfaceModel& model) {
    AG_TRY(const Patches patches, Patches::create(control.topology, patch_options(scheme)));
    PatchControl points;
    patches.update({rest.positions, rest.corner_normals, tags}, points);
    const ReliefMesh on_quads = over_square(model);
    const float height = mean_edge(control) / static_cast<float>(model.repeats);
    return raise_mesh(patches, points, over_triangle(on_quads), on_quads, {model.repeats, height});
}

}  // namespace aglow::refine
