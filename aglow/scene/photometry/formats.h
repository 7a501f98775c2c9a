// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/photometry.h"

#include <string_view>

namespace aglow::photometry {

Result<Photometry> read_lm63(std::string_view text);
Result<Photometry> read_eulumdat(std::string_view text);

/// A photometry of C planes over a part of the turn, mirrored to the whole of it. `planes` ascend
/// and begin and end on planes of symmetry, unless they go round once.
/// Errors  malformed: the planes cover no such part.
Result<Photometry> complete_turn(Photometry planes);

}  // namespace aglow::photometry
