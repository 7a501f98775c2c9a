// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/render/raster.h"

#include <string>

namespace aglow::cli {

/// "none", "pn:3" or another kind with its level, "auto", "auto:0.25". Errors: bad_argument.
Result<Refinement> parse_refinement(const std::string& text);

}  // namespace aglow::cli
