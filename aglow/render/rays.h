// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/render/camera.h"

namespace aglow {

struct RaysOptions {
    int samples = 16;  ///< rays per pixel, stratified
    uint64_t seed = 0;
};

/// Camera rays that show baked light: luminance = emitted + albedo / pi * E, where E is looked up
/// bilinearly in `irradiance` (lux) at surfaces.lightmap_uvs. Misses show the sky. The backs of
/// surfaces show no baked light of their own: they take that of the front.
/// Result  luminance, cd/m^2.
Result<Image> render_rays(const Scene& scene, const Surfaces& surfaces, const RayScene& rays,
                          const View& view, const Image& irradiance, const RaysOptions& options,
                          const Monitor& monitor = {});

}  // namespace aglow
