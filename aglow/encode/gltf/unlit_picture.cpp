// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/gltf/unlit_picture.h"

#include "aglow/core/parallel.h"
#include "aglow/encode/gltf/light_coding.h"
#include "aglow/encode/lit_gltf.h"

#include <algorithm>
#include <cmath>

namespace aglow::encode {
namespace {

// Textures of light are looked up with bilinear filtering; two texels also survive some blur.
constexpr int kGutter = 4;

/// Look of one texel: the mean over its sample points, weighted by opacity, so that the colour
/// behind a mask does not bleed into its edge.
struct Look {
    vec3 base = {0, 0, 0};
    vec3 emitted = {0, 0, 0};
    float alpha = 0;
    bool unlit = false;
};

bool is_unlit(const Scene& scene, const Surfaces& surfaces, uint32_t triangle) {
    const int material = surfaces.part(triangle).material;
    return material >= 0 && scene.materials[static_cast<size_t>(material)].unlit;
}

Look look_of(const Scene& scene, const Surfaces& surfaces, std::span<const SurfacePoint> points) {
    Look look;
    float weights = 0;
    for (const SurfacePoint& point : points) {
        const float alpha = opacity(scene, surfaces, point);
        const float weight = std::max(alpha, 1e-4f);  // a colour even where nothing is opaque
        look.base += base_color(scene, surfaces, point) * weight;
        look.emitted += emitted_luminance(scene, surfaces, point) * weight;
        look.alpha += alpha;
        weights += weight;
    }
    if (points.empty()) return look;
    look.base *= 1 / weights;
    look.emitted *= 1 / weights;
    look.alpha /= static_cast<float>(points.size());
    look.unlit = is_unlit(scene, surfaces, points.front().triangle);
    return look;
}

std::span<const SurfacePoint> samples_of(const Texels& texels, size_t element) {
    const uint32_t begin = texels.first_sample[element];
    return std::span(texels.samples).subspan(begin, texels.first_sample[element + 1] - begin);
}

}  // namespace

Result<std::vector<uint8_t>> unlit_picture(const Scene& scene, const Surfaces& surfaces,
                                           const Texels& texels, const Lightmap& lightmap,
                                           float exposure_ev) {
    const float scale = std::exp2(exposure_ev) / kReferenceWhite;
    std::vector<vec3> shown(texels.element_count());
    std::vector<vec3> alphas(texels.element_count());
    parallel_for(shown.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Look look = look_of(scene, surfaces, samples_of(texels, i));
            const vec3 irradiance = lightmap.irradiance.pixels[texels.pixel_of[i]];
            const vec3 luminance = look.emitted + look.base * irradiance / kPi;
            shown[i] = look.unlit ? look.base : luminance * scale;
            alphas[i] = {look.alpha, 0, 0};
        }
    });
    std::vector<float> alpha;
    if (std::ranges::any_of(alphas, [](vec3 a) { return a.x < 1; })) {
        for (const vec3 a : make_lightmap(texels, alphas, kGutter).irradiance.pixels)
            alpha.push_back(a.x);
    }
    return srgb_png(make_lightmap(texels, shown, kGutter).irradiance, 1, alpha);
}

}  // namespace aglow::encode
