// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/hidden_points.h"

#include "aglow/core/parallel.h"
#include "aglow/shared/sampling.h"
#include "aglow/shared/sobol.h"
#include "aglow/transport/irradiance.h"

#include <algorithm>

namespace aglow {
namespace {

constexpr uint32_t kRays = 8;

/// Does ray `i` of the point meet a back that only the inside of something shows?
bool meets_back(const Surfaces& surfaces, const Scene& scene, const RayScene& rays, SurfacePoint at,
                uint32_t i) {
    const vec3 normal = geometric_normal(surfaces, at.triangle);
    const vec3 origin =
        offset_origin(position(surfaces, at), normal, coordinate_magnitude(surfaces, at.triangle));
    const vec3 direction = Frame(normal).to_world(
        shared::cosine_hemisphere(shared::owen_sobol_2d(i, shared::hash_bits(at.triangle))));
    const auto hit = rays.intersect({origin, direction});
    if (!hit || hit->front) return false;
    const int material = surfaces.part(hit->at.triangle).material;
    return material < 0 || !scene.materials[static_cast<size_t>(material)].double_sided;
}

enum class Sight : uint8_t { open, mixed, hidden };

/// Marks the hidden points of one element.
Sight look(const Surfaces& surfaces, const Scene& scene, const RayScene& rays, const Texels& texels,
           size_t element, std::vector<uint8_t>& hidden) {
    const uint32_t begin = texels.first_sample[element], end = texels.first_sample[element + 1];
    bool suspect = false;
    for (uint32_t s = begin; s < end && !suspect; ++s)
        suspect = meets_back(surfaces, scene, rays, texels.samples[s], 0);
    if (!suspect) return Sight::open;
    uint32_t hidden_count = 0;
    for (uint32_t s = begin; s < end; ++s) {
        uint32_t i = 0;
        while (i < kRays && meets_back(surfaces, scene, rays, texels.samples[s], i)) ++i;
        hidden[s] = i == kRays;
        hidden_count += hidden[s];
    }
    return hidden_count == 0             ? Sight::open
           : hidden_count == end - begin ? Sight::hidden
                                         : Sight::mixed;
}

bool touches_open(const Texels& texels, const std::vector<Sight>& sights, uint32_t pixel) {
    const int x = static_cast<int>(pixel) % texels.width,
              y = static_cast<int>(pixel) / texels.width;
    for (int ny = std::max(0, y - 1); ny <= std::min(texels.height - 1, y + 1); ++ny)
        for (int nx = std::max(0, x - 1); nx <= std::min(texels.width - 1, x + 1); ++nx) {
            const uint32_t e = texels.element_at[static_cast<size_t>(ny * texels.width + nx)];
            if (e != kNoElement && sights[e] != Sight::hidden) return true;
        }
    return false;
}

}  // namespace

void drop_hidden_points(const Surfaces& surfaces, const Scene& scene, const RayScene& rays,
                        Texels& texels) {
    std::vector<uint8_t> hidden(texels.samples.size(), 0);
    std::vector<Sight> sights(texels.element_count(), Sight::open);
    parallel_for(texels.element_count(), 64, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e)
            sights[e] = look(surfaces, scene, rays, texels, e, hidden);
    });
    if (std::all_of(sights.begin(), sights.end(), [](Sight s) { return s == Sight::open; })) return;

    Texels kept;
    kept.width = texels.width;
    kept.height = texels.height;
    kept.element_at.assign(texels.element_at.size(), kNoElement);
    kept.first_sample.push_back(0);
    for (size_t e = 0; e < texels.element_count(); ++e) {
        const uint32_t pixel = texels.pixel_of[e];
        if (sights[e] == Sight::hidden && touches_open(texels, sights, pixel)) continue;
        for (uint32_t s = texels.first_sample[e]; s < texels.first_sample[e + 1]; ++s)
            if (sights[e] != Sight::mixed || !hidden[s]) kept.samples.push_back(texels.samples[s]);
        kept.element_at[pixel] = static_cast<uint32_t>(kept.pixel_of.size());
        kept.pixel_of.push_back(pixel);
        kept.area.push_back(texels.area[e]);
        kept.first_sample.push_back(static_cast<uint32_t>(kept.samples.size()));
    }
    texels = std::move(kept);
}

}  // namespace aglow
