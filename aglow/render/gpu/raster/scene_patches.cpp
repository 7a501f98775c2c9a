// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/scene_patches.h"

#include "aglow/mesh/gpu/part_motion.h"
#include "aglow/scene/gltf_source.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace aglow::render::gpu {
namespace {

using refine::gpu::DevicePatches;
using refine::gpu::PatchKind;

const Mesh& mesh_of(const Scene& scene, const SurfacePart& part) {
    return scene.meshes[static_cast<size_t>(part.mesh)];
}

/// By how much a transform makes lengths longer, in the mean of all directions.
float scale_of(const mat4& m) {
    const vec3 x = transform_direction(m, {1, 0, 0}), y = transform_direction(m, {0, 1, 0}),
               z = transform_direction(m, {0, 0, 1});
    return std::cbrt(std::fabs(dot(cross(x, y), z)));
}

/// The heights of `source` in metres of the mesh.
Result<std::shared_ptr<const HeightMap>> heights_of(const Scene& scene,
                                                    const DisplacementRef& source) {
    const std::filesystem::path folder = scene.source ? scene.source->folder : "";
    AG_TRY(HeightMap map, read_height_map(folder / source.file));
    for (float& height : map.texels) height = source.bias + source.scale * height;
    return std::make_shared<const HeightMap>(std::move(map));
}

float diagonal(const Mesh& mesh) {
    Box box;
    for (const Primitive& p : mesh.primitives)
        for (const vec3 at : p.positions) box.add(at);
    return length(box.size());
}

/// Mip level on which texels are as far apart as vertices.
float mip_of(float texels, float segments) { return std::log2(std::max(texels / segments, 1.0f)); }

}  // namespace

Status ScenePatches::read_heights(const Scene& scene) {
    std::map<std::tuple<std::filesystem::path, float, float>, std::shared_ptr<const HeightMap>>
        known;
    for (const DisplacedPlacement& placement : control_.displaced) {
        const DisplacementRef& source = placement.source;
        auto& map = known[{source.file, source.scale, source.bias}];
        if (!map) {
            AG_TRY(map, heights_of(scene, source));
        }
        maps_.push_back(map);
        float highest = 0;
        for (const float height : map->texels) highest = std::max(highest, std::fabs(height));
        highest_.push_back(highest);
    }
    return {};
}

void ScenePatches::find_kinds(const Scene& scene, const Surfaces& rest, int segments) {
    kinds_.emplace_back();
    std::vector<double> sums(1 + maps_.size()), counts(1 + maps_.size());
    if (is_displaced())
        texels_ = edge_texels(control_.topology, control_.uvs, control_.kind_of, sources());
    for (size_t e = 0; e < texels_.size(); ++e) {
        const uint32_t h = control_.topology.edge_half[e];
        const uint32_t kind = control_.kind_of[control_.topology.vertex[h]];
        sums[kind] += static_cast<double>(texels_[e]);
        ++counts[kind];
    }
    for (size_t i = 0; i < maps_.size(); ++i) {
        const DisplacedPlacement& placement = control_.displaced[i];
        const SurfacePart& part = rest.parts[placement.part];
        stiff_.push_back(!mesh::gpu::is_skinned(scene, part));
        const float size = diagonal(mesh_of(scene, part));
        if (size > 0) overhang_ = std::max(overhang_, highest_[i] / size);
        PatchKind kind{PatchShape::flat, NormalField::linear, {}, maps_[i].get()};
        kind.displacement.kind = shared::kHeightMapDisplacement;
        kind.displacement.amplitude = placement.scale;
        kind.displacement.level =
            mip_of(static_cast<float>(sums[i + 1] / std::max(counts[i + 1], 1.0)),
                   static_cast<float>(segments));
        kinds_.push_back(kind);
    }
}

Result<ScenePatches> ScenePatches::create(vk::Stream& stream, const Scene& scene,
                                          const Surfaces& rest, const Refinement& refinement,
                                          int segments) {
    ScenePatches made;
    AG_TRY(made.control_, control_scene(scene, rest, refinement.crease_angle));
    AG_CHECK(made.read_heights(scene));
    made.find_kinds(scene, rest, segments);
    refine::gpu::DevicePatchInput input;
    input.vertex_source = made.control_.vertex_source;
    AG_TRY(made.normals_, CornerNormals::create(stream, made.control_));
    input.corner_normal = made.normals_->number();
    if (refinement.kind != Refinement::Kind::pn) input.tags = made.control_.tags;
    input.kinds = made.kinds_;
    input.kind_of = made.control_.kind_of;
    input.uvs = made.control_.uvs;
    AG_TRY(made.patches_,
           DevicePatches::create(stream, made.control_.topology, PatchOptions{}, input));
    return made;
}

void ScenePatches::update(vk::Stream& stream, const mesh::gpu::DeviceSurfaces& surfaces) {
    if (is_displaced()) {
        std::vector<shared::Displacement> by_kind;
        for (size_t i = 0; i < kinds_.size(); ++i) {
            by_kind.push_back(kinds_[i].displacement);
            if (i > 0 && stiff_[i - 1])
                by_kind[i].amplitude =
                    scale_of(surfaces.part_transforms()[control_.displaced[i - 1].part]);
        }
        patches_->set_displacements(stream, by_kind);
        stream.barrier();
    }
    const uint64_t normals = normals_->update(stream, surfaces.positions(), surfaces.normals());
    patches_->update(stream, surfaces.positions(), normals);
}

void ScenePatches::set_levels(vk::Stream& stream, std::span<const float> levels) const {
    const Topology& topology = control_.topology;
    std::vector<shared::PatchLevels> of_faces(topology.face_count());
    for (size_t f = 0; f < of_faces.size(); ++f) {
        const uint32_t first = topology.face_begin[f];
        of_faces[f].inner = 1;
        for (uint32_t i = 0; i < 3; ++i) of_faces[f].edge[i] = levels[topology.edge[first + i]];
        of_faces[f].edge[3] = 1;
    }
    patches_->set_levels(stream, of_faces);
    if (is_displaced()) set_mips(stream, levels);
}

/// Edges are as fine as their own segments take; vertices and insides as the mean of the edges
/// that meet there.
void ScenePatches::set_mips(vk::Stream& stream, std::span<const float> levels) const {
    const Topology& topology = control_.topology;
    std::vector<float> of_edges(topology.edge_count());
    std::vector<float> of_vertices(topology.vertex_count()), counts(topology.vertex_count());
    for (uint32_t e = 0; e < topology.edge_count(); ++e) {
        of_edges[e] = mip_of(texels_[e], levels[e]);
        const uint32_t h = topology.edge_half[e];
        for (const uint32_t v : {topology.vertex[h], topology.end(h)}) {
            of_vertices[v] += of_edges[e];
            ++counts[v];
        }
    }
    for (size_t v = 0; v < of_vertices.size(); ++v) of_vertices[v] /= std::max(counts[v], 1.0f);
    std::vector<shared::PatchMips> of_faces(topology.face_count());
    for (uint32_t f = 0; f < topology.face_count(); ++f) {
        for (uint32_t i = 0; i < 3; ++i) {
            of_faces[f].edge[i] = of_edges[topology.edge[topology.face_begin[f] + i]];
            of_faces[f].inner += of_faces[f].edge[i] / 3;
        }
        of_faces[f].edge[3] = 0;
    }
    patches_->set_mips(stream, of_vertices, of_faces);
}

std::vector<DetailSource> ScenePatches::sources() const {
    std::vector<DetailSource> sources = {{nullptr, 0}};
    for (size_t i = 0; i < maps_.size(); ++i)
        sources.push_back({maps_[i].get(), control_.displaced[i].scale});
    return sources;
}

std::vector<EdgeDetail> ScenePatches::details() const {
    if (!is_displaced()) return {};
    return edge_details(control_.topology, control_.uvs, control_.kind_of, sources());
}

std::vector<float> ScenePatches::reach() const {
    std::vector<float> reach;
    if (!is_displaced()) return reach;
    for (uint32_t f = 0; f < control_.topology.face_count(); ++f) {
        const uint32_t v = control_.topology.vertex[control_.topology.face_begin[f]];
        const uint32_t kind = control_.kind_of[v];
        reach.push_back(kind > 0 ? highest_[kind - 1] * control_.displaced[kind - 1].scale : 0.0f);
    }
    return reach;
}

}  // namespace aglow::render::gpu
