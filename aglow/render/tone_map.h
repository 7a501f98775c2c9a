// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"

namespace aglow {

/// Exposure that maps the picture's log-average luminance to middle grey (18 %), in EV (a factor
/// of 2^EV on luminance in cd/m^2). Pixels without light are left out; pixels that are much
/// darker than the bright part (the 95th percentile) count as 1/1000 of it, so that a black
/// background does not overexpose what stands before it; and the 95th percentile itself is kept
/// at or below 4 times white. 0 for a picture without light.
float automatic_exposure(const Image& luminance);

/// Luminance in cd/m^2 to display-linear 0..1: exposure, then a filmic shoulder that keeps hue.
///
/// Colours whose largest channel stays at or below half of white pass unchanged. Above, that
/// channel follows a shoulder that reaches white only at infinity; the others follow in
/// proportion, and the colour fades to white the more it is compressed. Non-finite pixels
/// become black.
Image tone_map(const Image& luminance, float exposure_ev);

}  // namespace aglow
