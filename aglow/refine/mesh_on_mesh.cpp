// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/mesh_on_mesh.h"

#include "aglow/core/assert.h"

namespace aglow {
namespace {

/// Where a relief's coordinates lie on a face: origin + x * along_x + y * along_y.
struct Cell {
    vec2 origin, along_x, along_y;
};

/// The small triangles of a pattern, those that are turned as well.
std::vector<Cell> triangle_cells(int repeats) {
    const float step = 1 / static_cast<float>(repeats);
    std::vector<Cell> cells;
    for (int j = 0; j < repeats; ++j)
        for (int i = 0; i + j < repeats; ++i) {
            const vec2 at = {static_cast<float>(i) * step, static_cast<float>(j) * step};
            cells.push_back({at, {step, 0}, {0, step}});
            if (i + j + 1 < repeats)
                cells.push_back({at + vec2{step, step}, {-step, 0}, {0, -step}});
        }
    return cells;
}

std::vector<Cell> quad_cells(int repeats) {
    const float step = 1 / static_cast<float>(repeats);
    std::vector<Cell> cells;
    for (int j = 0; j < repeats; ++j)
        for (int i = 0; i < repeats; ++i)
            cells.push_back({{static_cast<float>(i) * step, static_cast<float>(j) * step},
                             {step, 0},
                             {0, step}});
    return cells;
}

void add_relief(const Patches& patches, const PatchControl& control, uint32_t face,
                const Cell& cell, const ReliefMesh& relief, float height, RaisedMesh& out) {
    const auto first = static_cast<uint32_t>(out.positions.size());
    for (size_t v = 0; v < relief.positions.size(); ++v) {
        const vec3 p = relief.positions[v], n = relief.normals[v];
        const vec2 foot = cell.origin + cell.along_x * p.x + cell.along_y * p.y;
        const PatchPlace place = patches.at(control, face, foot);
        // The columns of the map at this vertex; normals go by its cofactors.
        const vec3 by_x = place.by_x * cell.along_x.x + place.by_y * cell.along_x.y;
        const vec3 by_y = place.by_x * cell.along_y.x + place.by_y * cell.along_y.y;
        const vec3 by_z = place.direction * height;
        const vec3 normal =
            cross(by_y, by_z) * n.x + cross(by_z, by_x) * n.y + cross(by_x, by_y) * n.z;
        out.positions.push_back(place.position + by_z * p.z);
        out.normals.push_back(shared::unit_or(normal, place.normal));
        out.face.push_back(face);
        out.coordinates.push_back(foot);
    }
    for (const uvec3 t : relief.triangles)
        out.triangles.push_back({first + t.x, first + t.y, first + t.z});
}

}  // namespace

RaisedMesh raise_mesh(const Patches& patches, const PatchControl& control,
                      const ReliefMesh& on_triangles, const ReliefMesh& on_quads,
                      const ReliefOptions& options) {
    AG_ASSERT(options.repeats > 0, "at least one cell");
    const std::vector<Cell> in_triangle = triangle_cells(options.repeats);
    const std::vector<Cell> in_quad = quad_cells(options.repeats);
    RaisedMesh out;
    for (uint32_t f = 0; f < patches.topology().face_count(); ++f) {
        const bool is_triangle = patches.topology().face_size(f) == 3;
        const ReliefMesh& relief = is_triangle ? on_triangles : on_quads;
        AG_ASSERT(relief.normals.size() == relief.positions.size(), "a normal per vertex");
        if (relief.triangles.empty()) continue;
        for (const Cell& cell : is_triangle ? in_triangle : in_quad)
            add_relief(patches, control, f, cell, relief, options.height, out);
    }
    return out;
}

}  // namespace aglow
