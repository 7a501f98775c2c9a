// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/surfaces.h"
#include "aglow/render/rays.h"
#include "aglow/scene/scene.h"
#include "aglow/shared/light.h"
#include "aglow/shared/shading.h"

#include <cstdint>
#include <vector>

// What shading reads of a scene, laid out as both backends read it.

namespace aglow::render {

/// Materials, and the textures they read with all mip levels.
struct MaterialTable {
    std::vector<shared::SurfaceMaterial>
        materials;                                ///< [scene.materials + 1], see material_index()
    std::vector<shared::TextureLevels> textures;  ///< one for each texture and coding in use
    std::vector<uint32_t> texels;                 ///< RGBA8, all levels of all textures
};

/// Mip levels are means of 2 x 2 texels, taken of linear values, and rounded to 8 bits in the
/// image's own coding; of an odd side, the middle texel counts for both neighbours.
/// Cost  O(texels) of all images in use.
MaterialTable material_table(const Scene& scene);

/// Where the table holds the material of a part; the last entry is that of parts without one.
inline uint32_t material_index(const MaterialTable& table, const SurfacePart& part) {
    return part.material < 0 ? static_cast<uint32_t>(table.materials.size() - 1)
                             : static_cast<uint32_t>(part.material);
}

/// Lights without extent, and the photometry of those that have any.
struct LightTable {
    std::vector<shared::PunctualLight> lights;  ///< in world space at one time
    std::vector<float> photometry;              ///< see shared::PunctualLight
};
/// The number, order and photometry of the lights are the same at all times.
LightTable light_table(const Scene& scene, double time);

/// Emissive triangles, to be chosen by power: number i where u lies between cumulative[i - 1] (0
/// for the first) and cumulative[i]; the difference of these floats is its probability.
struct EmitterTable {
    std::vector<uint32_t> triangles;
    std::vector<float> cumulative;  ///< ascending, the last is 1
};
/// Power is that in the pose of `surfaces`, which any other pose may use too.
EmitterTable emitter_table(const Scene& scene, const Surfaces& surfaces);

/// The sky's image as a density: row y by rows (as EmitterTable::cumulative), then a pixel of that
/// row by cells[y * width ...]. Within the pixel, all places are alike.
struct SkyTable {
    int width = 0, height = 0;  ///< 0: no image, or a black one
    std::vector<float> rows;    ///< [height]
    std::vector<float> cells;   ///< [height * width]
};
SkyTable sky_table(const Scene& scene);

/// Where the rays of every pixel pass, relative to its middle: a Hammersley set under a tent
/// filter, shifted by the seed. All pixels share it, so that straight edges look alike along their
/// length.
std::vector<vec2> filter_offsets(const RaysOptions& options);

/// RaysOptions::seed as what shared::draw_seed() takes.
uint32_t draw_seed(const RaysOptions& options);

/// Does anything move?
bool has_motion(const Scene& scene);

}  // namespace aglow::render
