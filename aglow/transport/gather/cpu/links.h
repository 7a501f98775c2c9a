// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/transport/gather/cpu/texel_map.h"
#include "aglow/transport/gather/gather.h"

namespace aglow::transport::cpu {

/// A link that leads over one or more path vertices: `delay` of them, with the product of their
/// reflectances. To no texel (kNoElement): light that reached vertex number `delay` directly.
struct PathLink {
    uint32_t from;
    uint32_t to;
    int delay;
    vec3 weight;
};

/// The sampled transport operator between texels: texel e receives the mean over its rays of the
/// exitance of the texels they link to.
struct Links {
    int rays_per_texel = 0;
    std::vector<uint32_t> to;       ///< [element_count * rays_per_texel] front texel, or kNoElement
    std::vector<PathLink> paths;    ///< by `from`
    std::vector<vec3> direct;       ///< [element_count] direct irradiance, lux
    std::vector<vec3> reflectance;  ///< [element_count] mean diffuse reflectance
    uint64_t ray_count = 0;
};

/// Traces `options.cache_samples` rays per texel.
Result<Links> trace_links(const World& world, const Texels& texels, const TexelMap& map,
                          const GatherOptions& options, const Monitor& monitor);

/// Iterates the links: B <- rho (E_direct + G B), to convergence or for a number of bounces.
GatherCache solve_links(const Links& links, int bounces);

}  // namespace aglow::transport::cpu
