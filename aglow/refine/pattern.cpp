// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/pattern.h"

#include "aglow/core/assert.h"

namespace aglow {
namespace {

/// a / n, exact where a is 0 or n, so that corners are corners.
float fraction(uint32_t a, uint32_t n) { return static_cast<float>(a) / static_cast<float>(n); }

void add_vertex(Pattern& pattern, uint32_t i, uint32_t j, uint32_t n) {
    pattern.coordinates.push_back({fraction(i, n), fraction(j, n)});
    pattern.steps.push_back(i + (j << 16));
}

uint32_t checked(int segments) {
    AG_ASSERT(segments >= 1 && segments <= kMostSegments, "segments in 1..kMostSegments");
    return static_cast<uint32_t>(segments);
}

}  // namespace

Pattern triangle_pattern(int segments) {
    const uint32_t n = checked(segments);
    Pattern pattern;
    for (uint32_t row = 0; row <= n; ++row)
        for (uint32_t i = 0; i + row <= n; ++i) add_vertex(pattern, i, row, n);
    uint32_t first = 0;
    for (uint32_t row = 0; row < n; ++row) {
        const uint32_t above = first + n - row + 1;
        for (uint32_t i = 0; i + row < n; ++i) {
            pattern.triangles.push_back({first + i, first + i + 1, above + i});
            if (i + row + 1 < n)
                pattern.triangles.push_back({first + i + 1, above + i + 1, above + i});
        }
        first = above;
    }
    return pattern;
}

Pattern quad_pattern(int segments) {
    const uint32_t n = checked(segments);
    Pattern pattern;
    for (uint32_t row = 0; row <= n; ++row)
        for (uint32_t i = 0; i <= n; ++i) add_vertex(pattern, i, row, n);
    for (uint32_t row = 0; row < n; ++row)
        for (uint32_t i = 0; i < n; ++i) {
            const uint32_t a = row * (n + 1) + i;
            pattern.triangles.push_back({a, a + 1, a + n + 2});
            pattern.triangles.push_back({a, a + n + 2, a + n + 1});
        }
    return pattern;
}

Pattern nested_triangle_pattern(int segments) {
    const uint32_t n = checked(segments);
    Pattern pattern;
    uint32_t first = 0;  // vertex of a diagonal, on which i + j is the same
    for (uint32_t diagonal = 0; diagonal <= n; ++diagonal) {
        for (uint32_t j = 0; j <= diagonal; ++j)
            pattern.steps.push_back((diagonal - j) + (j << 16));
        const uint32_t before = first - diagonal;  // first vertex of the diagonal before
        for (uint32_t j = 0; j < diagonal; ++j) {
            if (j > 0) pattern.triangles.push_back({before + j - 1, first + j, before + j});
            pattern.triangles.push_back({before + j, first + j, first + j + 1});
        }
        first += diagonal + 1;
    }
    return pattern;
}

}  // namespace aglow
