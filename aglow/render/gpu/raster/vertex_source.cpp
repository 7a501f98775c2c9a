// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/vertex_source.h"

namespace aglow::render::gpu {

uint64_t VertexSource::triangles(Layer layer, std::span<const FaceRange> faces) const {
    uint64_t count = 0;
    for (const FaceDraw& draw : draws(layer, faces))
        count += uint64_t{draw.places.count} * draw.triangles;
    return count;
}

std::vector<FaceDraw> face_draws(std::span<const FaceRange> faces, FaceDraw like) {
    std::vector<FaceDraw> draws(faces.size(), like);
    for (size_t i = 0; i < faces.size(); ++i) draws[i].places = faces[i];
    return draws;
}

}  // namespace aglow::render::gpu
