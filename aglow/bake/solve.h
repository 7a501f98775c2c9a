// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/bake/bake.h"
#include "aglow/transport/gather/gather.h"
#include "aglow/transport/path/path.h"

namespace aglow {

/// What receives light: many texels, which want an even picture, or few sensors, which want digits.
enum class Target : uint8_t { texels, sensors };

/// Sample points per texel that a quality asks for.
int sample_points(Quality quality);

/// The solvers' own options for what the user asked.
GatherOptions gather_options(const SolveOptions& options, Target target);
PathOptions path_options(const SolveOptions& options, Target target);

}  // namespace aglow
