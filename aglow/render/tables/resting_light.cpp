// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/tables/resting_light.h"

#include "aglow/accel/hidden_points.h"
#include "aglow/accel/ray_scene.h"
#include "aglow/core/parallel.h"
#include "aglow/mesh/texels.h"
#include "aglow/scene/punctual_lights.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <span>

namespace aglow::render {
namespace {

constexpr int kGutter = 2;  // texels, as `aglow bake` fills

/// The scene in its rest pose.
struct Rest {
    const Scene& scene;
    const Surfaces& surfaces;
    const RayScene& rays;
    std::vector<PlacedLight> lights;

    /// What the lights give directly on the front of a surface, lux.
    vec3 irradiance(SurfacePoint at) const {
        const vec3 g = geometric_normal(surfaces, at.triangle), n = shading_normal(surfaces, at);
        const vec3 origin =
            offset_origin(position(surfaces, at), g, coordinate_magnitude(surfaces, at.triangle));
        vec3 sum{0, 0, 0};
        for (const PlacedLight& light : lights) {
            const shared::LightArrival from = arrival(light, origin);
            const float cosine = dot(n, from.direction);
            if (!(cosine > 0) || !(dot(g, from.direction) > 0)) continue;
            sum += from.normal_irradiance *
                   (cosine * rays.visibility({origin, from.direction, from.distance}));
        }
        return sum;
    }

    /// Its mean over each texel.
    Result<std::vector<vec3>> texel_irradiance(const Texels& texels, const Monitor& monitor) const {
        std::vector<vec3> values(texels.element_count());
        std::atomic<size_t> done = 0;
        parallel_for(values.size(), 256, [&](size_t begin, size_t end) {
            for (size_t e = begin; e < end && !monitor.cancelled(); ++e) {
                const uint32_t first = texels.first_sample[e], last = texels.first_sample[e + 1];
                for (uint32_t s = first; s < last; ++s) values[e] += irradiance(texels.samples[s]);
                values[e] = values[e] / static_cast<float>(std::max(1u, last - first));
            }
            const size_t so_far = done.fetch_add(end - begin) + (end - begin);
            monitor("resting light",
                    static_cast<double>(so_far) / static_cast<double>(values.size()));
        });
        if (monitor.cancelled()) return fail(Errc::cancelled, "rendering was interrupted");
        return values;
    }
};

Image difference(const Image& all, const Image& part) {
    Image rest = all;
    for (size_t i = 0; i < rest.pixels.size(); ++i)
        rest.pixels[i] = shared::max(all.pixels[i] - part.pixels[i], vec3{0, 0, 0});
    return rest;
}

/// How much the light of neighbouring texels differs, summed over the atlas.
double unevenness(const Image& light, const Texels& texels) {
    double sum = 0;
    for (const uint32_t pixel : texels.pixel_of) {
        const size_t right = size_t{pixel} + 1;
        if (right % static_cast<size_t>(texels.width) == 0) continue;
        if (texels.element_at[right] == kNoElement) continue;
        sum += static_cast<double>(
            std::abs(luminance(light.pixels[right]) - luminance(light.pixels[pixel])));
    }
    return sum;
}

}  // namespace

Result<Image> resting_light(const Scene& scene, const Lit& lit, const Monitor& monitor) try {
    const Surfaces surfaces = pose(scene, -1, &lit.atlas);
    AG_TRY(const RayScene rays, RayScene::create(scene, surfaces));
    const Rest rest{scene, surfaces, rays, punctual_lights(scene, world_transforms(scene))};
    Image best;
    double least = 0;
    // The number of points that baking took of each texel is not told. With the same number, no
    // outlines of shadows are left: what remains is smoothest.
    for (const int points : {4, 8, 16}) {
        Texels texels = rasterize(surfaces, lit.atlas, points);
        drop_hidden_points(surfaces, scene, rays, texels);
        AG_TRY(const auto direct, rest.texel_irradiance(texels, monitor));
        Image rest_of =
            difference(lit.irradiance, make_lightmap(texels, direct, kGutter).irradiance);
        const double uneven = unevenness(rest_of, texels);
        if (!best.pixels.empty() && uneven >= least) continue;
        best = std::move(rest_of);
        least = uneven;
    }
    return best;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "not enough memory to part moving light from resting light");
}

}  // namespace aglow::render
