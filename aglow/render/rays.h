// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/render/camera.h"

#include <cstdint>
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

inline constexpr int kMostReflections = 64;

/// Luminance of a white surface under KHR_materials_unlit, which has no light of its own, cd/m^2.
inline constexpr float kUnlitWhite = 100;

/// Rays traced, by what they look for.
struct RayTally {
    uint64_t camera = 0;  ///< what a pixel shows
    uint64_t mirror = 0;  ///< what a surface mirrors
    uint64_t shadow = 0;  ///< what stands before a light: a lamp, the sky, an emissive triangle

    uint64_t total() const { return camera + mirror + shadow; }
    RayTally& operator+=(const RayTally& more) {
        camera += more.camera;
        mirror += more.mirror;
        shadow += more.shadow;
        return *this;
    }
};

/// A scene as it stands at one time. The parts must outlive it.
struct PosedScene {
    const Scene& scene;
    const Surfaces& surfaces;
    const RayScene& rays;
    double time = -1;  ///< that the surfaces were posed at, s; negative: the rest pose
};

/// Ray tracing in the manner of Whitted: each camera ray is followed by one mirror ray after the
/// other, and light is looked up where they hit. shared/shading.h says how a surface looks.
///
/// Without reflections, luminance = emitted + base colour / pi * E: metals show their base colour,
/// so that they look lit although they reflect no diffuse light in the bake. With reflections,
/// smooth surfaces (roughness below 0.5) mirror what stands around, rough metals and coats show the
/// mean of what reaches them, and lights without extent add highlights, each behind a shadow ray.
/// Misses show the sky. Unlit materials show base colour * kUnlitWhite.
///
/// E is looked up bilinearly in `irradiance` (lux) at surfaces.lightmap_uvs; the backs of surfaces
/// take that of their front. Where `irradiance` is empty, E is direct light computed on the spot,
/// for the side that is seen: all punctual lights, and from the sky and the emissive triangles one
/// sample for every ray of a pixel (the only noise there is).
///
/// Pixels are filtered by a tent that is one pixel wide at half its height. Textures are read at
/// the mip level that matches the width of a ray (shared/camera.h, shared/texture_lookup.h); alpha
/// masks at full resolution.
///
/// Shapes  surfaces.lightmap_uvs filled (posed with its atlas) and `irradiance` of the atlas' size,
///         or `irradiance` empty.
/// Result  luminance, cd/m^2.
/// Errors  bad_argument (samples < 1, reflections out of range, surfaces without lightmap_uvs),
///         cancelled, out_of_memory.
/// Cost    O(pixels * samples * (1 + reflections)) rays, times the lights for shadow rays.
/// Repeat  same bits for any thread count and run.
/// Source  Whitted, "An Improved Illumination Model for Shaded Display", CACM 1980.
Result<Image> render_rays(const PosedScene& posed, const View& view, const Image& irradiance,
                          const RaysOptions& options, const Monitor& monitor = {});

/// The baked irradiance itself: E in lux (luminance-weighted) of what stands at the middle of each
/// pixel, NaN where nothing does. For false_color_image().
/// Shapes, Errors, Repeat  as render_rays(); result [view.height * view.width].
Result<std::vector<float>> render_illuminance(const Surfaces& surfaces, const RayScene& rays,
                                              const View& view, const Image& irradiance,
                                              const Monitor& monitor = {});

}  // namespace aglow
