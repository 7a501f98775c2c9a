// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/placement.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aglow::accel::gpu {
namespace {

/// Rows of an affine map: at[row][column], column 3 is the translation.
using Rows = std::array<std::array<double, 4>, 3>;

Rows rows(const mat4& m) {
    Rows r{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j)
            r[static_cast<size_t>(i)][static_cast<size_t>(j)] = static_cast<double>(m.at(i, j));
    return r;
}

Rows product(const Rows& a, const Rows& b) {
    Rows r{};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 4; ++j) {
            r[i][j] = j == 3 ? a[i][3] : 0;
            for (size_t k = 0; k < 3; ++k) r[i][j] += a[i][k] * b[k][j];
        }
    return r;
}

double length_of_column(const Rows& m, size_t j) { return std::hypot(m[0][j], m[1][j], m[2][j]); }

/// Nothing where the columns span less than a millionth of what they would at right angles.
std::optional<Rows> inverse(const Rows& m) {
    Rows r{};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j) {
            const size_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            r[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    const double determinant = m[0][0] * r[0][0] + m[0][1] * r[1][0] + m[0][2] * r[2][0];
    const double span = length_of_column(m, 0) * length_of_column(m, 1) * length_of_column(m, 2);
    if (!std::isfinite(determinant) || !(std::abs(determinant) > 1e-6 * span)) return std::nullopt;
    for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 3; ++j) r[i][j] /= determinant;
        r[i][3] = 0;
        for (size_t j = 0; j < 3; ++j) r[i][3] -= r[i][j] * m[j][3];
        if (!std::all_of(r[i].begin(), r[i].end(), [](double x) { return std::isfinite(x); }))
            return std::nullopt;
    }
    return r;
}

shared::Affine affine(const Rows& m) {
    const auto column = [&](size_t j) {
        return vec3{static_cast<float>(m[0][j]), static_cast<float>(m[1][j]),
                    static_cast<float>(m[2][j])};
    };
    return {column(0), column(1), column(2), column(3)};
}

float magnitude(vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

std::optional<Placement> placement(const mat4& reference, const mat4& transform) {
    const auto from_reference = inverse(rows(reference));
    const auto from_transform = inverse(rows(transform));
    if (!from_reference || !from_transform) return std::nullopt;
    Placement result;
    const Rows to_world = product(rows(transform), *from_reference);
    result.to_world = affine(to_world);
    result.to_local = affine(product(rows(reference), *from_transform));
    result.stretch =
        static_cast<float>(std::hypot(length_of_column(to_world, 0), length_of_column(to_world, 1),
                                      length_of_column(to_world, 2)) /
                           std::sqrt(3.0));
    return result;
}

shared::Bounds moved_box(const shared::Bounds& box, const shared::Affine& map) {
    Box moved;
    for (const float x : {box.lower.x, box.upper.x})
        for (const float y : {box.lower.y, box.upper.y})
            for (const float z : {box.lower.z, box.upper.z})
                moved.add(shared::transform_point(map, {x, y, z}));
    // A dozen roundings of 2^-24 of the largest number that takes part.
    const float local = std::max(magnitude(box.lower), magnitude(box.upper));
    const float stretch = std::max({magnitude(map.x), magnitude(map.y), magnitude(map.z)});
    const float pad =
        0x1p-20f * std::max({magnitude(moved.lo), magnitude(moved.hi), local * stretch});
    return {moved.lo - vec3{pad, pad, pad}, moved.hi + vec3{pad, pad, pad}};
}

}  // namespace aglow::accel::gpu
