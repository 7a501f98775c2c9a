// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"

namespace aglow {

/// Exposure that maps the picture's log-average luminance to middle grey (18 %), in EV (a factor
/// of 2^EV on luminance in cd/m^2), as far as that leaves the bright part of the picture (the 95th
/// percentile) between 0.5 and 4 times white: a white room stays white, and a dark background does
/// not overexpose what stands before it. Pixels without light are left out; those darker than
/// 1/1000 of the bright part count as that. 0 for a picture without light.
float automatic_exposure(const Image& luminance);

/// Luminance in cd/m^2 to display-linear 0..1: exposure, then a filmic shoulder that keeps hue.
///
/// Colours whose largest channel stays at or below half of white pass unchanged. Above, that
/// channel follows a shoulder that reaches white only at infinity; the others follow in
/// proportion, and the colour fades to white the more it is compressed. Non-finite pixels
/// become black.
Image tone_map(const Image& luminance, float exposure_ev);

}  // namespace aglow
