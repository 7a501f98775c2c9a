// SPDX-License-Identifier: Apache-2.0
// Parts of machines, each closed and within the cube [-0.5, 0.5]^3, with +Y as its main axis. The
// triangles of a part grow about fourfold from one level of detail to the next.
#pragma once
#include "aglow/scene/builtin/geometry.h"

namespace aglow::builtin {

enum class MachinePart : uint8_t { plate, bolt, gear, pipe, ring, spring, finned_cylinder };
inline constexpr int kMachinePartCount = 7;
inline constexpr int kMaxPartLevel = 4;

/// `level` 0..kMaxPartLevel.
Shape machine_part(MachinePart part, int level);

}  // namespace aglow::builtin
