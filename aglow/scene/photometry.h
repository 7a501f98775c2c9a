// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace aglow {

/// Luminous intensity of a luminaire in every direction, measured far away (type C photometry).
/// Directions are told by two angles, in degrees: gamma from the axis that the luminaire is aimed
/// along, and C about that axis. Between the measured angles it is bilinear, outside the
/// measured gammas it is 0.
struct Photometry {
    std::string name;            ///< of the luminaire
    std::vector<float> gamma;    ///< ascending, within 0 to 180
    std::vector<float> c;        ///< ascending over a whole turn, its ends included; {0} where C
                                 ///< makes no difference
    std::vector<float> candela;  ///< [c.size()][gamma.size()], all factors of the file included
};

/// Reads an IES (LM-63 of 1986 to 2019) or EULUMDAT file, told apart by content. Symmetries are
/// written out, multipliers and ballast factors applied; a TILT section is left out, since it
/// is about lamps that burn otherwise than they were measured.
/// Errors  malformed (names what is wrong); unsupported: photometry of type A or B.
/// Source  ANSI/IES LM-63-19; Stockmar, "EULUMDAT - ein Leuchtendatenformat für den europäischen
///         Beleuchtungsplaner", Licht 1990.
Result<Photometry> read_photometry(std::span<const uint8_t> file);

/// Candela along a unit direction, in the frame of glTF's EXT_lights_ies: aimed along -Z, with C
/// counted from +X towards +Y.
float intensity(const Photometry& photometry, vec3 direction);

/// Flux in lumen: the integral of intensity() over the sphere, in closed form.
double luminous_flux(const Photometry& photometry);

/// The same as an LM-63-2002 file.
std::string to_lm63(const Photometry& photometry);

}  // namespace aglow
