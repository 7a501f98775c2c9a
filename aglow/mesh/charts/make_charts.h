// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/mesh/charts/chart.h"

#include <optional>

namespace aglow::mesh {

/// Cuts a mesh into charts that keep their orientation, do not overlap themselves and stretch
/// little. Starts with large segments and splits those that cannot be laid flat, down to single
/// triangles if need be. Triangles whose corners coincide are in no chart.
/// Result  nothing where the monitor asks to stop.
/// Cost    O(n log n) plus the sparse solves.   Repeat  a function of its arguments alone.
std::optional<std::vector<Chart>> make_charts(const Soup& soup, const Monitor& monitor);

}  // namespace aglow::mesh
