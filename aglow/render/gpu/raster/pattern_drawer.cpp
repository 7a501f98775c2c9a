// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/pattern_drawer.h"

#include "aglow/shared/pattern_group.h"
#include "aglow/vk/device.h"

#include <utility>

namespace aglow::render::gpu {

Result<PatternDrawer> PatternDrawer::create(vk::Stream& stream, int segments,
                                            MeshShaders mesh_shaders) {
    AG_TRY(refine::gpu::DevicePattern pattern,
           refine::gpu::upload_nested_pattern(stream, segments));
    const bool by_groups =
        mesh_shaders == MeshShaders::where_offered && stream.gpu()->physical().drawing.mesh_shader;
    return PatternDrawer(std::move(pattern), by_groups);
}

vk::GraphicsShaders PatternDrawer::shaders(std::span<const uint32_t> vertex,
                                           std::span<const uint32_t> mesh) const {
    vk::GraphicsShaders shaders;
    (by_groups_ ? shaders.mesh : shaders.vertex) = by_groups_ ? mesh : vertex;
    return shaders;
}

void PatternDrawer::draw(vk::Stream& stream, const SurfacePass& pass, const FaceDraw& draw) const {
    const uint32_t n = draw.segments;
    shared::RasterArgs args = pass.args;
    args.segments = n;
    if (!by_groups_) {
        stream.draw(pass.pipeline, pass.target, args,
                    {0, 3 * n * n, draw.places.first, draw.places.count, &pattern_.triangles});
        return;
    }
    args.first_face = draw.places.first;
    args.face_count = draw.places.count;
    const shared::PatternGroups groups = shared::pattern_groups(n);
    const uint64_t tiles = uint64_t{draw.places.count} * groups.sides * groups.sides;
    stream.draw_groups(pass.pipeline, pass.target, args, vk::group_count(tiles, groups.tiles));
}

}  // namespace aglow::render::gpu
