// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/mesh/topology.h"
#include "aglow/shared/displacement.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace aglow {

/// Heights on a grid over the unit square of texture coordinates, row 0 at v = 0, with mips.
struct HeightMap {
    shared::TextureLevels levels = {};
    std::vector<float> texels;  ///< of all levels
};

/// Takes heights as they are (16-bit PNG: 0..1; EXR and Radiance: any), from the red channel.
/// Errors  those of read_image().
Result<HeightMap> read_height_map(const std::filesystem::path& path);
/// Shapes  heights [height * width]. Levels are means of 2 x 2 texels of the one before.
HeightMap make_height_map(std::span<const float> heights, int width, int height);

/// Height at uv, of mip level `level`, which may lie between two.
float sample(const HeightMap& map, vec2 uv, float level);

/// The level whose texels are as far apart as the vertices of edges of so many segments: what is
/// finer would only be missed here and hit there.
/// Shapes  uvs [half-edge]
float fitting_level(const HeightMap& map, const Topology& topology, std::span<const vec2> uvs,
                    int segments);

/// How a surface is displaced.
struct DisplacementMap {
    shared::Displacement settings = {};
    HeightMap map = {};  ///< where settings.kind is kHeightMapDisplacement
    /// [half-edge] Texture coordinates where each starts, likewise. Where those of two faces differ
    /// along an edge the surface moves by the mean of both, so that it does not open.
    std::span<const vec2> uvs = {};
};

}  // namespace aglow
