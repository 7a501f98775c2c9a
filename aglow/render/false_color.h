// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"

#include <span>

namespace aglow {

/// Display-linear colour of a value in [0, 1] (clamped to it; 0 for NaN) on a perceptually ordered
/// scale from dark blue over green to yellow: lightness rises in equal steps, so that the scale
/// also reads in grey and with any kind of colour vision.
/// Source  Ottosson, "A perceptual color space for image processing", 2020 (Oklab).
vec3 false_color(float value);

/// The upper end of a scale for `lux`: the least of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of
/// ten that is at or above the 99th percentile of the finite values; 1 where none is above zero.
float false_color_maximum(std::span<const float> lux);

/// `lux` (height x width, NaN where there is nothing to show: dark grey) in false colour with a
/// legend in lux at its right side. The scale runs from 0 to false_color_maximum(). Maps less
/// than 240 pixels high are magnified by a whole number.
/// Result  display-linear RGB, ready for a PNG.
Image false_color_image(std::span<const float> lux, int width, int height);

}  // namespace aglow
