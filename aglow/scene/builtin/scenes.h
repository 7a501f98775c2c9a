// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/scene.h"

#include <cstdint>

namespace aglow::builtin {

Scene cornell_box();
Scene furnace();
Scene cube_tc58();
Scene corridor();
Scene living_room();

inline constexpr int64_t kMinStress = 12, kMaxStress = 20'000'000;
/// As many triangles as possible without exceeding `triangle_count`.
Scene stress(int64_t triangle_count);

}  // namespace aglow::builtin
