// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"

#include <span>
#include <vector>

namespace aglow {

/// Display colour of a value in [0, 1] on a perceptually ordered scale (dark blue to yellow).
vec3 false_color(float value);

/// `lux` (height x width, NaN where there is nothing to show) in false colour with a legend in
/// lux at its right side. The scale runs from 0 to a round number at or above the 99th percentile.
/// Result  display-linear RGB, ready for a PNG.
Image false_color_image(std::span<const float> lux, int width, int height);

}  // namespace aglow
