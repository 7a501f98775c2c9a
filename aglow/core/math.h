// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/shared/glsl.h"

#include <array>
#include <limits>

namespace aglow {

using shared::uvec2;
using shared::uvec3;
using shared::vec2;
using shared::vec3;
using shared::vec4;

inline constexpr float kPi = 3.14159265358979f;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Luminance weights of linear Rec. 709: a photometric triple to its one photopic value.
inline float luminance(vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// 4 x 4 matrix, column-major as in glTF: at(row, column) = m[4 * column + row].
struct mat4 {
    std::array<float, 16> m = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    float at(int row, int column) const { return m[static_cast<size_t>(4 * column + row)]; }
    bool operator==(const mat4&) const = default;
};

mat4 operator*(const mat4& a, const mat4& b);
vec3 transform_point(const mat4& t, vec3 p);      ///< affine part only
vec3 transform_direction(const mat4& t, vec3 d);  ///< upper 3 x 3
/// Multiplies by the cofactors of the upper 3 x 3: keeps normals perpendicular, and pointing to
/// the same side, under any affine map including mirrors. Not normalised.
vec3 transform_normal(const mat4& t, vec3 n);
float determinant3(const mat4& t);  ///< of the upper 3 x 3; negative for a mirror
/// Inverse of an affine map; the identity if it is singular.
mat4 inverse_affine(const mat4& t);
/// Translation * rotation (quaternion x, y, z, w) * scale, glTF 2.0 section 3.5.3.
mat4 compose(vec3 translation, vec4 rotation, vec3 scale);
mat4 translation(vec3 offset);

/// Axis-aligned box; empty when lo > hi.
struct Box {
    vec3 lo = {kInfinity, kInfinity, kInfinity};
    vec3 hi = {-kInfinity, -kInfinity, -kInfinity};
    bool empty() const { return lo.x > hi.x; }
    void add(vec3 p) {
        lo = shared::min(lo, p);
        hi = shared::max(hi, p);
    }
    vec3 size() const { return hi - lo; }
    vec3 center() const { return (lo + hi) * 0.5f; }
};

/// Two unit vectors that make a right-handed frame (tangent, bitangent, n) with unit n.
/// Source  Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017.
struct Frame {
    vec3 tangent, bitangent, normal;
    explicit Frame(vec3 n);
    vec3 to_world(vec3 v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }
};

}  // namespace aglow
