// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/mesh/texels.h"
#include "aglow/transport/irradiance.h"

#include <functional>
#include <span>

namespace aglow {

struct PathOptions {
    int bounces = kConverged;  ///< kConverged: Russian roulette ends paths without bias
    int samples = 1024;        ///< paths per receiver, texel or camera ray
    uint64_t seed = 0;
};

/// Brute-force path tracing: the slow reference of every other solver. Each path samples every
/// kind of light at each vertex and goes on by a cosine-distributed ray; nothing is cached,
/// interpolated or clamped. Shares with the solvers only the ray scene and the light formulas.
/// Path i of a texel starts from its sample point i modulo their number.
///
/// Result    standard_error is filled (from the spread of independent batches of paths) unless
///           options.samples is 1; `bounces` is the number of reflections of the longest path.
/// Errors    cancelled; bad_argument (samples < 1, bounces < kConverged); out_of_memory.
/// Cost      O(receivers * samples * path length) rays.
/// Repeat    same bits for any thread count and run, for one seed.
/// Source    Kajiya, "The Rendering Equation", SIGGRAPH 1986; combination of sky sampling and
///           cosine sampling by the balance heuristic of Veach & Guibas, "Optimally Combining
///           Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995.
Result<IrradianceField> trace_texels(const World& world, const Texels& texels,
                                     const PathOptions& options, const Monitor& monitor = {});
Result<IrradianceField> trace_receivers(const World& world, std::span<const Receiver> receivers,
                                        const PathOptions& options, const Monitor& monitor = {});

/// Luminance seen along camera rays, cd/m^2: `samples` paths per pixel, jittered inside it.
/// Pixel (x, y) of the result is the mean over rays camera(x + jx, y + jy), 0 <= jx, jy < 1.
/// Surfaces show emission and diffusely reflected light; the light that the first surface receives
/// counts on its interpolated normal, as in a baked texel. Misses show the sky.
/// Errors, Cost, Repeat as above; `camera` is called from several threads.
Result<Image> trace_image(const World& world, int width, int height,
                          const std::function<Ray(float x, float y)>& camera,
                          const PathOptions& options, const Monitor& monitor = {});

}  // namespace aglow
