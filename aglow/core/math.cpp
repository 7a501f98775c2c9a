// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/math.h"

#include <cmath>

namespace aglow {

mat4 operator*(const mat4& a, const mat4& b) {
    mat4 product;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) {
            float sum = 0;
            for (int k = 0; k < 4; ++k) sum += a.at(row, k) * b.at(k, column);
            product.m[static_cast<size_t>(4 * column + row)] = sum;
        }
    return product;
}

vec3 transform_point(const mat4& t, vec3 p) {
    return transform_direction(t, p) + vec3{t.at(0, 3), t.at(1, 3), t.at(2, 3)};
}

vec3 transform_direction(const mat4& t, vec3 d) {
    return {t.at(0, 0) * d.x + t.at(0, 1) * d.y + t.at(0, 2) * d.z,
            t.at(1, 0) * d.x + t.at(1, 1) * d.y + t.at(1, 2) * d.z,
            t.at(2, 0) * d.x + t.at(2, 1) * d.y + t.at(2, 2) * d.z};
}

namespace {

struct Columns {
    vec3 x, y, z;
    explicit Columns(const mat4& t)
        : x{t.at(0, 0), t.at(1, 0), t.at(2, 0)},
          y{t.at(0, 1), t.at(1, 1), t.at(2, 1)},
          z{t.at(0, 2), t.at(1, 2), t.at(2, 2)} {}
};

}  // namespace

vec3 transform_normal(const mat4& t, vec3 n) {
    const Columns c(t);
    const vec3 image = cross(c.y, c.z) * n.x + cross(c.z, c.x) * n.y + cross(c.x, c.y) * n.z;
    return determinant3(t) < 0 ? -image : image;
}

float determinant3(const mat4& t) {
    const Columns c(t);
    return dot(c.x, cross(c.y, c.z));
}

mat4 inverse_affine(const mat4& t) {
    const Columns c(t);
    const float determinant = determinant3(t);
    if (determinant == 0 || !std::isfinite(1 / determinant)) return {};
    const vec3 row0 = cross(c.y, c.z) / determinant;
    const vec3 row1 = cross(c.z, c.x) / determinant;
    const vec3 row2 = cross(c.x, c.y) / determinant;
    const vec3 offset{t.at(0, 3), t.at(1, 3), t.at(2, 3)};
    mat4 inverse;
    inverse.m = {row0.x,
                 row1.x,
                 row2.x,
                 0,
                 row0.y,
                 row1.y,
                 row2.y,
                 0,
                 row0.z,
                 row1.z,
                 row2.z,
                 0,
                 -dot(row0, offset),
                 -dot(row1, offset),
                 -dot(row2, offset),
                 1};
    return inverse;
}

mat4 compose(vec3 t, vec4 q, vec3 s) {
    const float xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    const float xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
    const float wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    mat4 result;
    result.m = {(1 - 2 * (yy + zz)) * s.x,
                2 * (xy + wz) * s.x,
                2 * (xz - wy) * s.x,
                0,
                2 * (xy - wz) * s.y,
                (1 - 2 * (xx + zz)) * s.y,
                2 * (yz + wx) * s.y,
                0,
                2 * (xz + wy) * s.z,
                2 * (yz - wx) * s.z,
                (1 - 2 * (xx + yy)) * s.z,
                0,
                t.x,
                t.y,
                t.z,
                1};
    return result;
}

mat4 translation(vec3 offset) { return compose(offset, {0, 0, 0, 1}, {1, 1, 1}); }

Frame::Frame(vec3 n) : normal(n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
}

}  // namespace aglow
