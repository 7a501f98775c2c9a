// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/mesh/texels.h"
#include "aglow/transport/irradiance.h"

#include <span>

namespace aglow {

struct GatherOptions {
    int bounces = kConverged;
    int cache_samples = 32;      ///< hemisphere rays per texel for the light between texels
    int64_t cache_rays = 0;      ///< ... or more, until the whole scene has so many
    int min_samples = 64;        ///< hemisphere rays per receiver in the last gather ...
    int max_samples = 1024;      ///< ... and at most
    float target_error = 0.01f;  ///< stop sampling a receiver at this relative standard error
    uint64_t seed = 0;
};

/// Light in equilibrium between the texels of a scene.
struct GatherCache {
    std::vector<vec3>
        exitance;  ///< [element_count] reflected light that leaves each texel's front, lm/m^2
    std::vector<std::vector<vec3>>
        exitance_by_bounces;  ///< for a finite bounce count: [n] after n reflections or fewer
    uint64_t ray_count = 0;
    int bounces = 0;  ///< reflections accounted for (iterations until < 1e-4 of the flux remained)
};

/// Solves diffuse light transport between texels: finds the irradiance E with
///
///     E = E_direct + G (rho E)
///
/// where (G B)(x) = 1/pi times the cosine-weighted hemispherical integral of what is seen from x.
/// G is estimated once, with `cache_samples` rays per texel; each ray links the texel to the
/// one it hits, and the system of links is then iterated without tracing another ray. A ray
/// that meets the back of a surface goes on from there as a path, since texels hold the light of
/// fronts.
///
/// Shapes    texels of world.surfaces, rasterised with `surfaces.lightmap_uvs`.
/// Units     lux, lm/m^2.
/// Errors    cancelled, out_of_memory.
/// Cost      O(element_count * cache_samples) rays and links.
/// Repeat    same bits for any thread count and run, for one seed.
/// Source    Goral et al., SIGGRAPH 1984 (radiosity); final gather after Lischinski, Tampieri &
///           Greenberg, "Combining Hierarchical Radiosity and Discontinuity Meshing", SIGGRAPH
///           1993.
Result<GatherCache> solve_gather(const World& world, const Texels& texels,
                                 const GatherOptions& options, const Monitor& monitor = {});

/// Last gather: irradiance of every texel (mean over its sample points) or of free receivers, from
/// lights and from the cached exitance, with as many rays as `target_error` asks for.
/// Errors, Repeat as above.   Cost  O(receivers * samples) rays.
Result<IrradianceField> gather_texels(const World& world, const Texels& texels,
                                      const GatherCache& cache, const GatherOptions& options,
                                      const Monitor& monitor = {});
Result<IrradianceField> gather_receivers(const World& world, const Texels& texels,
                                         const GatherCache& cache,
                                         std::span<const Receiver> receivers,
                                         const GatherOptions& options, const Monitor& monitor = {});

}  // namespace aglow
