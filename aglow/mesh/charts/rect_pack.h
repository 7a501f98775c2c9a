// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aglow::mesh {

/// A rectangle to pack, in texels. Its size may depend on how it is turned.
struct PackItem {
    int width = 0, height = 0;                ///< upright
    int turned_width = 0, turned_height = 0;  ///< turned by 90 degrees; 0: may not be turned
};

struct PackedItem {
    int x = 0, y = 0;
    bool turned = false;
};

struct Packing {
    std::vector<PackedItem> items;
    int height = 0;  ///< rows used
};

/// How hard to look for a tight packing.
enum class PackEffort : uint8_t { quick, thorough };

/// Packs all items without overlap into `width` columns and at most `max_height` rows, in several
/// orders and ways, and keeps the lowest packing. An empty result (height -1) where none fits.
/// Cost    O(n^2) for up to some hundred items; O(n * width) at worst for more.
/// Repeat  a function of its arguments alone.
/// Source  Jylanki, "A Thousand Ways to Pack the Bin", 2010 (maximal rectangles, skyline).
Packing pack(const std::vector<PackItem>& items, int width, int max_height, PackEffort effort);

}  // namespace aglow::mesh
