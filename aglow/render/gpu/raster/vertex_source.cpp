// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/vertex_source.h"

namespace aglow::render::gpu {

uint64_t VertexSource::triangles(Layer layer, std::span<const FaceRange> faces) const {
    uint64_t count = 0;
    for (const vk::Draw& draw : draws(layer, faces))
        count += uint64_t{draw.vertex_count / 3} * draw.instance_count;
    return count;
}

}  // namespace aglow::render::gpu
