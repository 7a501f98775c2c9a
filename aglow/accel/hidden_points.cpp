// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/hidden_points.h"

#include "aglow/core/parallel.h"
#include "aglow/shared/sampling.h"
#include "aglow/shared/sobol.h"

#include <algorithm>

namespace aglow {
namespace {

constexpr uint32_t kPointRays = 8;   // decide on one point of a texel that has others
constexpr uint32_t kTexelRays = 64;  // from each point decide on a whole texel

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

/// Looks at the texels of one scene.
struct Watch {
    const Surfaces& surfaces;
    const Scene& scene;
    const RayScene& rays;
    const Texels& texels;

    bool hidden(uint32_t sample, uint32_t ray_count) const {
        uint32_t i = 0;
        while (i < ray_count && meets_back(surfaces, scene, rays, texels.samples[sample], i)) ++i;
        return i == ray_count;
    }

    /// Does nothing stand between two points of a texel, seen from a quarter of their distance
    /// above the surface?
    bool see_each_other(uint32_t a, uint32_t b) const {
        const SurfacePoint from = texels.samples[a], to = texels.samples[b];
        const vec3 p = position(surfaces, from), q = position(surfaces, to);
        const float lift = length(q - p) / 4;
        const vec3 origin = p + geometric_normal(surfaces, from.triangle) * lift;
        const vec3 line = q + geometric_normal(surfaces, to.triangle) * lift - origin;
        const float distance = length(line);
        return !(distance > 0) || rays.visibility({origin, line / distance, distance}) > 0;
    }

    /// A wall through a texel puts its points on two sides: marks those of the lesser side.
    Sight leave_far_side(uint32_t begin, uint32_t end, std::vector<uint8_t>& hidden_points) const {
        const auto first = static_cast<uint32_t>(
            std::find(hidden_points.begin() + begin, hidden_points.begin() + end, 0) -
            hidden_points.begin());
        std::vector<uint32_t> near, far;
        for (uint32_t s = first; s < end; ++s)
            if (!hidden_points[s]) (see_each_other(first, s) ? near : far).push_back(s);
        for (const uint32_t s : far.size() > near.size() ? near : far) hidden_points[s] = 1;
        return far.empty() ? Sight::open : Sight::mixed;
    }

    /// Sight of one element; marks its hidden points.
    Sight look(size_t element, std::vector<uint8_t>& hidden_points) const {
        const uint32_t begin = texels.first_sample[element], end = texels.first_sample[element + 1];
        const auto any = [&](uint32_t ray_count) {
            for (uint32_t s = begin; s < end; ++s)
                if (hidden(s, ray_count)) return true;
            return false;
        };
        if (!any(1)) return leave_far_side(begin, end, hidden_points);
        uint32_t hidden_count = 0;
        for (uint32_t s = begin; s < end; ++s)
            hidden_count += hidden_points[s] = hidden(s, kPointRays);
        if (hidden_count < end - begin) {
            const Sight sight = leave_far_side(begin, end, hidden_points);
            return hidden_count > 0 ? Sight::mixed : sight;
        }
        for (uint32_t s = begin; s < end; ++s)
            if (!hidden(s, kTexelRays)) return Sight::open;
        return Sight::hidden;
    }
};

/// Hidden elements that hang together, pixel by pixel, with elements that are not.
std::vector<uint8_t> attached(const Texels& texels, const std::vector<Sight>& sights) {
    std::vector<uint8_t> reached(sights.size(), 0);
    std::vector<uint32_t> front;
    for (uint32_t e = 0; e < sights.size(); ++e)
        if (sights[e] != Sight::hidden) front.push_back(e);
    while (!front.empty()) {
        const auto pixel = static_cast<int>(texels.pixel_of[front.back()]);
        front.pop_back();
        const int x = pixel % texels.width, y = pixel / texels.width;
        for (int ny = std::max(0, y - 1); ny <= std::min(texels.height - 1, y + 1); ++ny)
            for (int nx = std::max(0, x - 1); nx <= std::min(texels.width - 1, x + 1); ++nx) {
                const uint32_t e = texels.element_at[static_cast<size_t>(ny * texels.width + nx)];
                if (e == kNoElement || reached[e] || sights[e] != Sight::hidden) continue;
                reached[e] = 1;
                front.push_back(e);
            }
    }
    return reached;
}

}  // namespace

void drop_hidden_points(const Surfaces& surfaces, const Scene& scene, const RayScene& rays,
                        Texels& texels) {
    std::vector<uint8_t> hidden(texels.samples.size(), 0);
    const Watch watch{surfaces, scene, rays, texels};
    std::vector<Sight> sights(texels.element_count(), Sight::open);
    parallel_for(texels.element_count(), 64, [&](size_t begin, size_t end) {
        for (size_t e = begin; e < end; ++e) sights[e] = watch.look(e, hidden);
    });
    if (std::all_of(sights.begin(), sights.end(), [](Sight s) { return s == Sight::open; })) return;

    const std::vector<uint8_t> given_up = attached(texels, sights);
    Texels kept;
    kept.width = texels.width;
    kept.height = texels.height;
    kept.element_at.assign(texels.element_at.size(), kNoElement);
    kept.first_sample.push_back(0);
    for (size_t e = 0; e < texels.element_count(); ++e) {
        const uint32_t pixel = texels.pixel_of[e];
        if (given_up[e]) continue;
        for (uint32_t s = texels.first_sample[e]; s < texels.first_sample[e + 1]; ++s)
            if (sights[e] != Sight::mixed || !hidden[s]) kept.samples.push_back(texels.samples[s]);
        kept.element_at[pixel] = static_cast<uint32_t>(kept.pixel_of.size());
        kept.pixel_of.push_back(pixel);
        kept.area.push_back(texels.area[e]);
        kept.divided.push_back(sights[e] == Sight::mixed);
        kept.first_sample.push_back(static_cast<uint32_t>(kept.samples.size()));
    }
    texels = std::move(kept);
}

}  // namespace aglow
