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
Scene chess();
Scene walker();
Scene marbles();
Scene toys();
Scene forest();
Scene scatter();

/// Sizes of the families.
inline constexpr int64_t kMinTriangles = 12, kMaxTriangles = 20'000'000;
/// As many triangles as possible without exceeding `triangle_count`.
Scene stress(int64_t triangle_count);
/// At most `triangle_count` triangles, and more than `triangle_count` - 12.
Scene cad(int64_t triangle_count);
/// 8 n^2 triangles, the most that do not exceed `triangle_count`, but at least 8.
Scene sculpture(int64_t triangle_count);

}  // namespace aglow::builtin
