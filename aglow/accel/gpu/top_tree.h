// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/shared/structure.h"

#include <span>
#include <vector>

namespace aglow::accel::gpu {

/// A binary tree over boxes that are not empty, by binned surface area heuristic; node 0 is the
/// root. No leaf lies deeper than shared::kTopDepth.
/// Result  no node for no box, else 2 n - 1.
/// Cost    O(n log n) on one thread: 10 000 boxes take a few milliseconds.
/// Repeat  same tree every run.
/// Source  Wald, "On Fast Construction of SAH-based Bounding Volume Hierarchies", IRT 2007.
std::vector<shared::TopNode> top_tree(std::span<const shared::Bounds> boxes);

}  // namespace aglow::accel::gpu
