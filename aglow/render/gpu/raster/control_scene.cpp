// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/control_scene.h"

#include "aglow/refine/creases.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace aglow::render::gpu {
namespace {

/// The parts of one placement of a mesh, which follow each other.
struct Placement {
    size_t first_part = 0;
    std::vector<uint32_t> first_vertex;    // [primitive] in Surfaces
    std::vector<uint32_t> first_triangle;  // likewise
};

bool same_placement(const SurfacePart& a, const SurfacePart& b) {
    return a.node == b.node && a.instance == b.instance;
}

std::vector<Placement> placements_of(const Scene& scene, const Surfaces& rest) {
    std::vector<Placement> placements;
    for (size_t i = 0; i < rest.parts.size(); ++i) {
        const SurfacePart& part = rest.parts[i];
        if (i == 0 || !same_placement(rest.parts[i - 1], part)) {
            const size_t count = scene.meshes[static_cast<size_t>(part.mesh)].primitives.size();
            placements.push_back({i, std::vector<uint32_t>(count), std::vector<uint32_t>(count)});
        }
        placements.back().first_vertex[static_cast<size_t>(part.primitive)] = part.first_vertex;
        placements.back().first_triangle[static_cast<size_t>(part.primitive)] = part.first_triangle;
    }
    return placements;
}

/// Does the placement turn the mesh's triangles about?
bool is_mirrored(const Scene& scene, const Surfaces& rest, const SurfacePart& part) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(part.mesh)];
    const Primitive& primitive = mesh.primitives[static_cast<size_t>(part.primitive)];
    if (part.triangle_count == 0) return false;
    return rest.triangles[part.first_triangle].y != part.first_vertex + primitive.triangles[0].y;
}

Mesh turned_about(Mesh mesh) {
    for (Primitive& primitive : mesh.primitives)
        for (uvec3& triangle : primitive.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

void append(std::vector<uint32_t>& all, const std::vector<uint32_t>& more, size_t offset) {
    for (const uint32_t value : more)
        all.push_back(value == kNone ? kNone : value + static_cast<uint32_t>(offset));
}

/// Appends a topology that touches nothing that is there.
void append(Topology& all, const Topology& more) {
    const size_t faces = all.face_count(), halves = all.half_edge_count();
    const size_t edges = all.edge_count(), vertices = all.vertex_count();
    for (uint32_t f = 0; f < more.face_count(); ++f)
        all.face_begin.push_back(more.face_begin[f + 1] + static_cast<uint32_t>(halves));
    append(all.vertex, more.vertex, vertices);
    append(all.twin, more.twin, halves);
    append(all.edge, more.edge, edges);
    append(all.face, more.face, faces);
    append(all.edge_half, more.edge_half, halves);
    append(all.vertex_half, more.vertex_half, halves);
    append(all.source_vertex, more.source_vertex, vertices);
    append(all.source_face, more.source_face, faces);
    all.edge_sharpness.insert(all.edge_sharpness.end(), more.edge_sharpness.begin(),
                              more.edge_sharpness.end());
    all.vertex_sharpness.insert(all.vertex_sharpness.end(), more.vertex_sharpness.begin(),
                                more.vertex_sharpness.end());
}

shared::ShapeTags tags_of(const Mesh& mesh, VertexOf at) {
    const Primitive& primitive = mesh.primitives[at.primitive];
    const auto value = [&](const std::vector<float>& values) {
        return values.empty() ? 0.0f : values[at.vertex];
    };
    return {value(primitive.sharpness), value(primitive.tension), value(primitive.bias)};
}

bool has_tags(const Mesh& mesh) {
    for (const Primitive& p : mesh.primitives)
        if (!p.sharpness.empty() || !p.tension.empty() || !p.bias.empty()) return true;
    return false;
}

/// Which triangle of Surfaces each face of a placement is: faces count through all primitives.
void map_faces(const Mesh& mesh, const Placement& placement, const Topology& topology,
               uint32_t first_face, std::vector<uint32_t>& patch_of) {
    std::vector<uint32_t> triangle_of;
    for (size_t p = 0; p < mesh.primitives.size(); ++p)
        for (uint32_t t = 0; t < mesh.primitives[p].triangles.size(); ++t)
            triangle_of.push_back(placement.first_triangle[p] + t);
    for (uint32_t f = 0; f < topology.face_count(); ++f)
        patch_of[triangle_of[topology.source_face[f]]] = first_face + f;
}

/// The height map of a mesh, which all its primitives that have triangles must name.
Result<const DisplacementRef*> displacement_of(const Mesh& mesh) {
    const DisplacementRef* found = nullptr;
    bool is_first = true;
    for (const Primitive& p : mesh.primitives) {
        if (p.triangles.empty()) continue;
        const DisplacementRef* own = p.displacement ? &*p.displacement : nullptr;
        const bool same = own && found ? *own == *found : own == found;
        if (!is_first && !same)
            return fail(Errc::unsupported,
                        fmt::format("mesh \"{}\": its primitives name several displacement maps, "
                                    "which --refine cannot draw; give each a mesh of its own",
                                    mesh.name));
        found = own;
        is_first = false;
    }
    return found;
}

double area(std::span<const vec3> positions, std::span<const uvec3> triangles) {
    double sum = 0;
    for (const uvec3 t : triangles)
        sum += 0.5 * static_cast<double>(length(
                         cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x])));
    return sum;
}

/// By how much longer than in the mesh lengths are where it is placed in the rest pose.
float scale_of(const Mesh& mesh, const Placement& placement, const Surfaces& rest) {
    double in_mesh = 0, in_world = 0;
    for (size_t p = 0; p < mesh.primitives.size(); ++p) {
        const Primitive& primitive = mesh.primitives[p];
        in_mesh += area(primitive.positions, primitive.triangles);
        in_world += area(rest.positions,
                         std::span(rest.triangles)
                             .subspan(placement.first_triangle[p], primitive.triangles.size()));
    }
    return in_mesh > 0 ? static_cast<float>(std::sqrt(in_world / in_mesh)) : 1.0f;
}

}  // namespace

Result<ControlScene> control_scene(const Scene& scene, const Surfaces& rest,
                                   std::optional<float> crease_angle) {
    const ControlOptions options{.crease_angle = crease_angle};
    ControlScene result;
    result.patch_of.assign(rest.triangles.size(), kNone);
    std::map<std::pair<int, bool>, ControlMesh> controls;  // of a mesh, as it is and turned about
    bool tagged = false;
    for (const Placement& placement : placements_of(scene, rest)) {
        const SurfacePart& part = rest.parts[placement.first_part];
        const Mesh& mesh = scene.meshes[static_cast<size_t>(part.mesh)];
        const bool mirrored = is_mirrored(scene, rest, part);
        auto known = controls.find({part.mesh, mirrored});
        if (known == controls.end()) {
            AG_TRY(ControlMesh made,
                   make_control_mesh(mirrored ? turned_about(mesh) : mesh, options));
            made.topology = with_corners(std::move(made.topology), made.positions, Corners::sharp);
            known = controls.emplace(std::pair{part.mesh, mirrored}, std::move(made)).first;
        }
        const ControlMesh& control = known->second;
        map_faces(mesh, placement, control.topology, result.topology.face_count(), result.patch_of);
        for (const VertexOf at : control.vertices) {
            result.vertex_source.push_back(placement.first_vertex[at.primitive] + at.vertex);
            result.tags.push_back(tags_of(mesh, at));
        }
        AG_TRY(const DisplacementRef* const heights, displacement_of(mesh));
        if (heights)
            result.displaced.push_back({*heights, static_cast<uint32_t>(placement.first_part),
                                        scale_of(mesh, placement, rest)});
        const auto kind = heights ? static_cast<uint32_t>(result.displaced.size()) : 0u;
        result.kind_of.resize(result.kind_of.size() + control.vertices.size(), kind);
        for (const VertexOf at : control.corners) {
            result.corner_source.push_back(placement.first_vertex[at.primitive] + at.vertex);
            const auto& sets = mesh.primitives[at.primitive].texcoords;
            result.uvs.push_back(heights ? sets[static_cast<size_t>(heights->texcoord)][at.vertex]
                                         : vec2{0, 0});
        }
        append(result.topology, control.topology);
        result.lacks_normals.resize(result.topology.face_count(),
                                    crease_angle || !has_own_normals(mesh));
        tagged = tagged || has_tags(mesh);
    }
    if (!tagged) result.tags.clear();
    return result;
}

}  // namespace aglow::render::gpu
