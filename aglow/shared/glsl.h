// SPDX-License-Identifier: Apache-2.0
// Makes one header readable by two compilers. C++ side: the slice of GLSL that the shared
// formulas use. GLSL side: six macros and nothing else.
#ifndef AGLOW_SHARED_GLSL_H
#define AGLOW_SHARED_GLSL_H
#ifdef __cplusplus
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#define AG_FN inline
#define AG_CONST inline constexpr
#define AG_PRECISE
// T##Ptr is the device address of a T[]; an opaque integer on the CPU.
#define AG_BUFFER_OF(T) using T##Ptr = std::uint64_t
#define AG_NAMESPACE_BEGIN namespace aglow::shared {
#define AG_NAMESPACE_END }
namespace aglow::shared {
using uint = std::uint32_t;
struct vec2 {
    float x, y;
    bool operator==(const vec2&) const = default;
};
struct vec3 {
    float x, y, z;
    bool operator==(const vec3&) const = default;
};
struct vec4 {
    float x, y, z, w;
    bool operator==(const vec4&) const = default;
};
struct uvec2 {
    uint x, y;
    bool operator==(const uvec2&) const = default;
};
struct uvec3 {
    uint x, y, z;
    bool operator==(const uvec3&) const = default;
};
struct uvec4 {
    uint x, y, z, w;
    bool operator==(const uvec4&) const = default;
};

inline vec2 operator+(vec2 a, vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline vec2 operator-(vec2 a, vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline vec2 operator*(vec2 a, vec2 b) { return {a.x * b.x, a.y * b.y}; }
inline vec2 operator*(vec2 a, float s) { return {a.x * s, a.y * s}; }
inline vec2 operator/(vec2 a, float s) { return {a.x / s, a.y / s}; }
inline float dot(vec2 a, vec2 b) { return a.x * b.x + a.y * b.y; }
inline float length(vec2 a) { return std::sqrt(dot(a, a)); }

inline vec3 operator+(vec3 a, vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline vec3 operator-(vec3 a, vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline vec3 operator-(vec3 a) { return {-a.x, -a.y, -a.z}; }
inline vec3 operator*(vec3 a, vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline vec3 operator*(vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline vec3 operator*(float s, vec3 a) { return a * s; }
inline vec3 operator/(vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
inline vec3& operator+=(vec3& a, vec3 b) { return a = a + b; }
inline vec3& operator*=(vec3& a, vec3 b) { return a = a * b; }
inline vec3& operator*=(vec3& a, float s) { return a = a * s; }
inline float dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline vec3 cross(vec3 a, vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(vec3 a) { return std::sqrt(dot(a, a)); }
inline vec3 normalize(vec3 a) { return a * (1.0f / length(a)); }

inline vec4 operator+(vec4 a, vec4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
inline vec4 operator-(vec4 a, vec4 b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
inline vec4 operator*(vec4 a, vec4 b) { return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w}; }
inline vec4 operator*(vec4 a, float s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }
inline float dot(vec4 a, vec4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

inline float min(float a, float b) { return std::min(a, b); }
inline float max(float a, float b) { return std::max(a, b); }
inline uint min(uint a, uint b) { return std::min(a, b); }
inline uint max(uint a, uint b) { return std::max(a, b); }
inline float clamp(float v, float lo, float hi) { return std::clamp(v, lo, hi); }
inline vec3 min(vec3 a, vec3 b) { return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; }
inline vec3 max(vec3 a, vec3 b) { return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; }
inline float mix(float a, float b, float t) { return a * (1.0f - t) + b * t; }
inline vec3 mix(vec3 a, vec3 b, float t) { return a * (1.0f - t) + b * t; }
inline vec4 mix(vec4 a, vec4 b, float t) { return a * (1.0f - t) + b * t; }
inline float abs(float v) { return std::fabs(v); }
inline float sqrt(float v) { return std::sqrt(v); }
inline float sin(float v) { return std::sin(v); }
inline float cos(float v) { return std::cos(v); }
inline float acos(float v) { return std::acos(v); }
inline float floor(float v) { return std::floor(v); }
inline float pow(float v, float e) { return std::pow(v, e); }
inline float log2(float v) { return std::log2(v); }
inline float atan(float y, float x) { return std::atan2(y, x); }
}  // namespace aglow::shared
#else
#define AG_FN
#define AG_CONST const
// A value whose products are not fused into sums, as they are not in C++ here.
#define AG_PRECISE precise
#define AG_BUFFER_OF(T) \
    layout(buffer_reference, buffer_reference_align = 4, scalar) buffer T##Ptr { T at[]; }
#define AG_NAMESPACE_BEGIN
#define AG_NAMESPACE_END
#endif
#endif
