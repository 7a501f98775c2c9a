// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"
#include "aglow/render/gpu/raster/part_list.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::render::gpu {

/// How finely each face of the scene is drawn.
struct FaceSizes {
    std::vector<uint8_t> segments;    ///< [face] of its pattern; 0: it has no patch
    std::vector<uint32_t> triangles;  ///< [face] of it that have an area
};

/// `levels` are LevelOfDetail's, discrete, of `topology`'s edges; `patch_of` as in ControlScene.
FaceSizes face_sizes(const Topology& topology, std::span<const uint32_t> patch_of,
                     std::span<const float> levels);

/// The visible faces of solid layers, by layer and by the size of their patterns.
struct FaceBins {
    std::vector<uint32_t> faces;
    std::array<std::vector<FaceDraw>, kSolidLayers> draws;
    std::array<uint64_t, kSolidLayers> triangles = {};
};

FaceBins face_bins(const FaceSizes& sizes,
                   std::span<const std::vector<FaceRange>, kSolidLayers> layers);

}  // namespace aglow::render::gpu
