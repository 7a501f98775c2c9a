// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/legend/text.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace aglow::render {
namespace {

/// Seven rows of five pixels, the leftmost in the highest of the five bits.
using Glyph = std::array<uint8_t, kGlyphHeight>;

struct Character {
    char code;
    Glyph rows;
};

constexpr Character kFont[] = {
    {'0', {0b01110, 0b10001, 0b10001, 0b10001, 0b10001, 0b10001, 0b01110}},
    {'1', {0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110}},
    {'2', {0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111}},
    {'3', {0b01110, 0b10001, 0b00001, 0b00110, 0b00001, 0b10001, 0b01110}},
    {'4', {0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010}},
    {'5', {0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110}},
    {'6', {0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110}},
    {'7', {0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000}},
    {'8', {0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110}},
    {'9', {0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100}},
    {'.', {0b00000, 0b00000, 0b00000, 0b00000, 0b00000, 0b01100, 0b01100}},
    {'-', {0b00000, 0b00000, 0b00000, 0b11111, 0b00000, 0b00000, 0b00000}},
    {'+', {0b00000, 0b00100, 0b00100, 0b11111, 0b00100, 0b00100, 0b00000}},
    {'e', {0b00000, 0b00000, 0b01110, 0b10001, 0b11111, 0b10000, 0b01110}},
    {'k', {0b10000, 0b10000, 0b10010, 0b10100, 0b11000, 0b10100, 0b10010}},
    {'l', {0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110}},
    {'x', {0b00000, 0b00000, 0b10001, 0b01010, 0b00100, 0b01010, 0b10001}},
};

void draw_glyph(Image& image, const Glyph& glyph, int x, int y, int scale, vec3 color) {
    for (int row = 0; row < kGlyphHeight; ++row)
        for (int column = 0; column < kGlyphWidth; ++column)
            if (glyph[static_cast<size_t>(row)] >> (kGlyphWidth - 1 - column) & 1)
                fill(image, x + column * scale, y + row * scale, scale, scale, color);
}

}  // namespace

int text_width(std::string_view text, int scale) {
    return text.empty() ? 0 : (static_cast<int>(text.size()) * (kGlyphWidth + 1) - 1) * scale;
}

void draw_text(Image& image, std::string_view text, int x, int y, int scale, vec3 color) {
    for (char code : text) {
        const auto found = std::find_if(std::begin(kFont), std::end(kFont),
                                        [code](const Character& c) { return c.code == code; });
        if (found != std::end(kFont)) draw_glyph(image, found->rows, x, y, scale, color);
        x += (kGlyphWidth + 1) * scale;
    }
}

void fill(Image& image, int x, int y, int width, int height, vec3 color) {
    const int right = std::min(x + width, image.width);
    const int bottom = std::min(y + height, image.height);
    for (int j = std::max(y, 0); j < bottom; ++j)
        for (int i = std::max(x, 0); i < right; ++i) image.at(i, j) = color;
}

}  // namespace aglow::render
