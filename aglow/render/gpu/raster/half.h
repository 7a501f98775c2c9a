// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>

namespace aglow::render::gpu {

/// The value of an IEEE 754 binary16 number.
inline float half_to_float(uint16_t bits) {
    const int exponent = bits >> 10 & 31;
    const int fraction = bits & 1023;
    float value = std::ldexp(static_cast<float>(fraction | (exponent > 0 ? 1024 : 0)),
                             (exponent > 0 ? exponent : 1) - 25);
    if (exponent == 31) value = fraction == 0 ? HUGE_VALF : NAN;
    return bits >> 15 ? -value : value;
}

}  // namespace aglow::render::gpu
