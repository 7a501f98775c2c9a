// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/scene/scene.h"
#include "aglow/shared/raster.h"

#include <array>
#include <vector>

namespace aglow::render::gpu {

/// Irradiance terms of the sky, see shared::sky_irradiance(); zeros without one.
std::array<vec3, shared::kSkyTerms> sky_terms(const Scene& scene);

/// At most `most` emissive triangles that shine like all: each of them where there are no more,
/// else a stratified choice by power. Luminance is the mean over the triangle.
std::vector<shared::RasterEmitter> raster_emitters(const Scene& scene, const Surfaces& surfaces,
                                                   size_t most);

}  // namespace aglow::render::gpu
