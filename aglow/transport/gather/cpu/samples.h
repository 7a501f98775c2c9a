// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/random.h"

namespace aglow::transport::cpu {

/// Samples of one receiver that are drawn, traced and judged together.
inline constexpr uint32_t kBatch = 16;

/// The stratified numbers of a batch, each in [0, 1). Hemisphere, emitter and sky estimates are
/// summed, so they share Sobol coordinates under different scrambles.
struct Draws {
    enum Dimension : uint32_t {
        hemisphere_x,
        hemisphere_y,
        point,  ///< which of the receiver's points: stratified together with the others
        emitter_choice,
        emitter_x,
        emitter_y,
        sky_x,
        sky_y,
        kDimensions
    };
    float values[kDimensions][kBatch];

    vec2 hemisphere(uint32_t i) const { return {values[hemisphere_x][i], values[hemisphere_y][i]}; }
    vec3 emitter(uint32_t i) const {
        return {values[emitter_choice][i], values[emitter_x][i], values[emitter_y][i]};
    }
    vec2 sky(uint32_t i) const { return {values[sky_x][i], values[sky_y][i]}; }
};

/// The random numbers of one receiver: stratified ones for its own samples, a plain stream for
/// the rare paths that go on behind a surface.
class Samples {
public:
    Samples(uint64_t seed, uint32_t receiver, uint32_t purpose);

    /// Samples [first, first + kBatch); `first` is a multiple of kBatch.
    void draw(uint32_t first, Draws& draws) const;

    Pcg32 path(uint32_t i) const { return Pcg32(seed_, i); }

private:
    uint32_t seed_;
    uint32_t scrambles_[Draws::kDimensions];
};

}  // namespace aglow::transport::cpu
