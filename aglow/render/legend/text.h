// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"

#include <string_view>

namespace aglow::render {

inline constexpr int kGlyphWidth = 5;   ///< pixels at scale 1
inline constexpr int kGlyphHeight = 7;  ///< pixels at scale 1

/// Width in pixels of `text`, one free column between glyphs.
int text_width(std::string_view text, int scale);

/// Draws numbers and "lx" (the characters 0-9 . - + e k l x) with the top left corner at (x, y).
/// Other characters leave a gap; what lies outside the image is cut off.
void draw_text(Image& image, std::string_view text, int x, int y, int scale, vec3 color);

/// Fills the rectangle, cut off at the image's edges.
void fill(Image& image, int x, int y, int width, int height, vec3 color);

}  // namespace aglow::render
