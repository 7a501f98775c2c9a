// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/surfaces.h"

#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"
#include "aglow/mesh/pose/placement_pose.h"
#include "aglow/mesh/unwrap.h"

#include <algorithm>

namespace aglow {
namespace {

struct Layout {
    size_t vertex_count = 0, triangle_count = 0, texcoord_sets = 0;
    bool has_colors = false;
};

const Primitive& primitive_of(const Scene& scene, const SurfacePart& part) {
    return scene.meshes[static_cast<size_t>(part.mesh)]
        .primitives[static_cast<size_t>(part.primitive)];
}

/// Lists the parts in order and gives each its run of vertices and triangles.
Layout lay_out_parts(const Scene& scene, const std::vector<mesh::PlacedMesh>& placed,
                     const Atlas* atlas, std::vector<SurfacePart>& parts) {
    Layout layout;
    for (size_t p = 0; p < placed.size(); ++p) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(placed[p].mesh)];
        for (size_t i = 0; i < mesh.primitives.size(); ++i) {
            const Primitive& primitive = mesh.primitives[i];
            SurfacePart part;
            part.node = placed[p].node;
            part.instance = placed[p].instance;
            part.mesh = placed[p].mesh;
            part.primitive = static_cast<int>(i);
            part.material = primitive.material;
            part.placement = atlas ? static_cast<int>(p) : -1;
            part.first_vertex = static_cast<uint32_t>(layout.vertex_count);
            part.vertex_count = static_cast<uint32_t>(primitive.positions.size());
            part.first_triangle = static_cast<uint32_t>(layout.triangle_count);
            part.triangle_count = static_cast<uint32_t>(primitive.triangles.size());
            parts.push_back(part);
            layout.vertex_count += primitive.positions.size();
            layout.triangle_count += primitive.triangles.size();
            layout.texcoord_sets = std::max(layout.texcoord_sets, primitive.texcoords.size());
            layout.has_colors = layout.has_colors || !primitive.colors.empty();
        }
    }
    return layout;
}

Surfaces allocate(const Layout& layout, std::vector<SurfacePart> parts, bool with_lightmap) {
    Surfaces s;
    s.positions.resize(layout.vertex_count);
    s.normals.resize(layout.vertex_count);
    s.texcoords.assign(layout.texcoord_sets, std::vector<vec2>(layout.vertex_count, vec2{0, 0}));
    if (layout.has_colors) s.colors.assign(layout.vertex_count, vec4{1, 1, 1, 1});
    if (with_lightmap) s.lightmap_uvs.assign(layout.vertex_count, vec2{0, 0});
    s.triangles.resize(layout.triangle_count);
    s.part_of.resize(layout.triangle_count);
    s.parts = std::move(parts);
    return s;
}

/// A vertex that no normal could be found for takes that of its first triangle.
void repair_normals(Surfaces& s, const SurfacePart& part) {
    for (uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
        const uvec3 corners = s.triangles[t];
        for (uint32_t v : {corners.x, corners.y, corners.z})
            if (s.normals[v] == vec3{0, 0, 0}) s.normals[v] = geometric_normal(s, t);
    }
}

void fill_part(const Scene& scene, const mesh::NodePoses& poses, const Atlas* atlas, Surfaces& s,
               uint32_t part_index) {
    const SurfacePart& part = s.parts[part_index];
    const Primitive& primitive = primitive_of(scene, part);
    const mesh::PosedVertices posed =
        mesh::pose_primitive(scene, poses, {part.node, part.instance, part.mesh}, primitive);
    const auto to = [&](auto& all) { return all.begin() + part.first_vertex; };
    std::copy(posed.positions.begin(), posed.positions.end(), to(s.positions));
    std::copy(posed.normals.begin(), posed.normals.end(), to(s.normals));
    std::copy(primitive.colors.begin(), primitive.colors.end(), to(s.colors));
    for (size_t set = 0; set < primitive.texcoords.size(); ++set)
        std::copy(primitive.texcoords[set].begin(), primitive.texcoords[set].end(),
                  to(s.texcoords[set]));
    if (atlas) {
        const Placement& place = atlas->placements[static_cast<size_t>(part.placement)];
        for (size_t v = 0; v < primitive.lightmap_uvs.size(); ++v)
            s.lightmap_uvs[part.first_vertex + v] =
                place.offset + place.scale * primitive.lightmap_uvs[v];
    }
    for (size_t t = 0; t < primitive.triangles.size(); ++t) {
        const uvec3 local = primitive.triangles[t];
        uvec3 world{local.x + part.first_vertex, local.y + part.first_vertex,
                    local.z + part.first_vertex};
        // The determinant's sign decides which winding is the front (glTF 2.0 section 3.7.4).
        if (posed.mirrored[local.x]) std::swap(world.y, world.z);
        s.triangles[part.first_triangle + t] = world;
        s.part_of[part.first_triangle + t] = part_index;
    }
    repair_normals(s, part);
}

}  // namespace

Surfaces pose(const Scene& scene, double time, const Atlas* atlas) {
    const std::vector<mesh::PlacedMesh> placed = mesh::placed_meshes(scene);
    AG_ASSERT(!atlas || atlas->placements.size() == placed.size(),
              "the atlas was made for this scene");
    std::vector<SurfacePart> parts;
    const Layout layout = lay_out_parts(scene, placed, atlas, parts);
    Surfaces surfaces = allocate(layout, std::move(parts), atlas != nullptr);
    const mesh::NodePoses poses = mesh::node_poses(scene, time);
    parallel_for(surfaces.parts.size(), 1, [&](size_t begin, size_t end) {
        for (size_t p = begin; p < end; ++p)
            fill_part(scene, poses, atlas, surfaces, static_cast<uint32_t>(p));
    });
    return surfaces;
}

}  // namespace aglow
