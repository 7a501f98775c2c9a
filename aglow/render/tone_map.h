// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"

#include <optional>
#include <string>

namespace aglow {

/// Exposure that maps the picture's log-average luminance to middle grey, in EV (a factor of 2^EV
/// on luminance in cd/m^2).
float automatic_exposure(const Image& luminance);

/// Luminance in cd/m^2 to display-linear 0..1: exposure, then a filmic shoulder that keeps hue.
Image tone_map(const Image& luminance, float exposure_ev);

}  // namespace aglow
