// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/scene.h"

#include <vector>

namespace aglow::mesh {

/// Morph weights of every node at `time` (negative: the rest pose): the animated ones where a
/// channel drives them, else the node's, else its mesh's. Where several channels drive one node
/// the last one counts.
/// Shapes  [node_count][target count, or fewer: missing weights are zero]
std::vector<std::vector<float>> morph_weights(const Scene& scene, double time);

/// Value of an animation channel at `time`, held at its ends, `width` numbers wide.
/// Source  glTF 2.0, appendix C (interpolation modes).
std::vector<float> channel_value(const AnimationChannel& channel, double time, size_t width);

}  // namespace aglow::mesh
