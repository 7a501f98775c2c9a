// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/part_list.h"

namespace aglow::render::gpu {
namespace {

Layer layer_of(const Scene& scene, int material) {
    if (material < 0) return Layer::opaque;
    const Material& m = scene.materials[static_cast<size_t>(material)];
    if (m.alpha_mode == AlphaMode::blend) return Layer::blended;
    const bool cut = m.alpha_mode == AlphaMode::mask;
    if (m.double_sided) return cut ? Layer::cut_both_sides : Layer::opaque_both_sides;
    return cut ? Layer::cut : Layer::opaque;
}

const Primitive& primitive_of(const Scene& scene, const SurfacePart& part) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(part.mesh)];
    return mesh.primitives[static_cast<size_t>(part.primitive)];
}

Box node_box(const Scene& scene, const SurfacePart& part, Reach reach) {
    Box box;
    const auto add = [&](const Primitive& primitive) {
        for (const vec3 p : primitive.positions) box.add(p);
    };
    if (reach == Reach::part) {
        add(primitive_of(scene, part));
    } else {
        for (const Primitive& p : scene.meshes[static_cast<size_t>(part.mesh)].primitives) add(p);
    }
    return box;
}

Box world_box(const Surfaces& surfaces, const SurfacePart& part) {
    Box box;
    for (uint32_t i = 0; i < part.vertex_count; ++i)
        box.add(surfaces.positions[part.first_vertex + i]);
    return box;
}

Box grown(const Box& box, float share) {
    const vec3 margin = vec3{1, 1, 1} * (length(box.size()) * share);
    return {box.lo - margin, box.hi + margin};
}

}  // namespace

PartList::PartList(const Scene& scene, const Surfaces& rest, Reach reach) {
    const auto motions = mesh::gpu::classify_parts(scene, rest.parts);
    for (size_t i = 0; i < rest.parts.size(); ++i) {
        const SurfacePart& part = rest.parts[i];
        if (part.triangle_count == 0) continue;
        Part made;
        made.faces = {part.first_triangle, part.triangle_count};
        made.layer = layer_of(scene, part.material);
        made.index = static_cast<uint32_t>(i);
        // Skins and morph targets shape a part even where nothing moves them.
        made.stiff = motions[i] != mesh::gpu::PartMotion::deforming &&
                     !mesh::gpu::is_skinned(scene, part) &&
                     primitive_of(scene, part).targets.empty();
        made.box = made.stiff ? node_box(scene, part, reach) : world_box(rest, part);
        has_[static_cast<size_t>(made.layer)] = true;
        parts_.push_back(made);
        if (made.layer != Layer::blended) continue;
        for (uint32_t face = 0; face < part.triangle_count; ++face)
            blended_.push_back(part.first_triangle + face);
    }
}

std::array<std::vector<FaceRange>, kSolidLayers> PartList::visible(std::span<const mat4> transforms,
                                                                   const Projection& projection,
                                                                   float overhang) const {
    std::array<std::vector<FaceRange>, kSolidLayers> layers;
    for (const Part& part : parts_) {
        if (part.layer == Layer::blended) continue;
        const Box box = transformed(transforms[part.index], grown(part.box, overhang));
        if (part.stiff && !projection.may_see(box)) continue;
        std::vector<FaceRange>& ranges = layers[static_cast<size_t>(part.layer)];
        if (!ranges.empty() && ranges.back().first + ranges.back().count == part.faces.first)
            ranges.back().count += part.faces.count;
        else
            ranges.push_back(part.faces);
    }
    return layers;
}

Box PartList::bounds(std::span<const mat4> transforms) const {
    Box all;
    for (const Part& part : parts_) {
        const Box box = part.stiff ? transformed(transforms[part.index], part.box) : part.box;
        if (box.empty()) continue;
        all.add(box.lo);
        all.add(box.hi);
    }
    return all;
}

}  // namespace aglow::render::gpu
