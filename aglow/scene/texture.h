// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/scene.h"

namespace aglow {

enum class ColorCoding { linear, srgb };

/// RGBA of a texture at `uv` (before KHR_texture_transform), wrapped and filtered at its full
/// resolution as the sampler says; (1, 1, 1, 1) where the reference is empty. Alpha is always
/// linear.
vec4 sample(const Scene& scene, const TextureRef& reference, vec2 uv, ColorCoding coding);

}  // namespace aglow
