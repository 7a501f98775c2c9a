// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/render/camera.h"

#include <vector>

namespace aglow {

/// The lobe of highlights.
enum class Shading : uint8_t {
    metallic_roughness,  ///< GGX facets, as glTF defines
    phong,               ///< a normalised Phong lobe as wide as these make it
};

struct RaysOptions {
    int samples = 16;     ///< rays per pixel, evenly spread over the filter
    int reflections = 2;  ///< mirror rays that follow each other; 0: no reflections or highlights
    Shading shading = Shading::metallic_roughness;
    uint64_t seed = 0;
};

/// Luminance of a white surface under KHR_materials_unlit, which has no light of its own, cd/m^2.
inline constexpr float kUnlitWhite = 100;

/// Camera rays that show baked light: luminance = emitted + albedo / pi * E, where E is looked up
/// bilinearly in `irradiance` (lux) at surfaces.lightmap_uvs. Misses show the sky. The backs of
/// surfaces show no baked light of their own: they take that of the front. The albedo shown is
/// the base colour, metals included, so that metals look lit although they reflect no diffuse light
/// in the bake. Unlit materials show base colour * kUnlitWhite.
/// Pixels are filtered by a tent that is one pixel wide at half its height.
/// Shapes  surfaces.lightmap_uvs filled (posed with its atlas), `irradiance` of the atlas' size.
/// Result  luminance, cd/m^2.
/// Errors  bad_argument (samples < 1, surfaces without lightmap_uvs), cancelled, out_of_memory.
/// Cost    O(pixels * samples) rays.   Repeat  same bits for any thread count and run.
Result<Image> render_rays(const Scene& scene, const Surfaces& surfaces, const RayScene& rays,
                          const View& view, const Image& irradiance, const RaysOptions& options,
                          const Monitor& monitor = {});

/// The baked irradiance itself: E in lux (luminance-weighted) of what stands at the middle of each
/// pixel, NaN where nothing does. For false_color_image().
/// Shapes, Errors, Repeat  as render_rays(); result [view.height * view.width].
Result<std::vector<float>> render_illuminance(const Surfaces& surfaces, const RayScene& rays,
                                              const View& view, const Image& irradiance,
                                              const Monitor& monitor = {});

}  // namespace aglow
