// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/light.h"

#include "aglow/render/tables/tables.h"
#include "aglow/shared/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aglow::render::gpu {
namespace {

/// Mean over an even pattern of 4 x 4 points.
vec3 mean_luminance(const Scene& scene, const Surfaces& surfaces, uint32_t triangle) {
    vec3 sum = {0, 0, 0};
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 4; ++k) {
            const float root = std::sqrt((static_cast<float>(i) + 0.5f) / 4);
            const float v = (static_cast<float>(k) + 0.5f) / 4;
            const SurfacePoint at{triangle, {root * (1 - v), root * v}};
            sum += emitted_luminance(scene, surfaces, at) * opacity(scene, surfaces, at);
        }
    }
    return sum * (1.0f / 16);
}

bool shines_both_ways(const Scene& scene, const Surfaces& surfaces, uint32_t triangle) {
    return scene.materials[static_cast<size_t>(surfaces.part(triangle).material)].double_sided;
}

/// Of one pixel in row y of a sky, sr.
float pixel_solid_angle(const Image& image, int y) {
    const auto polar = [&](int row) { return std::cos(std::numbers::pi * row / image.height); };
    return static_cast<float>(2 * std::numbers::pi * (polar(y) - polar(y + 1)) / image.width);
}

}  // namespace

std::array<vec3, shared::kSkyTerms> sky_terms(const Scene& scene) {
    std::array<vec3, shared::kSkyTerms> terms{};
    if (!scene.sky) return terms;
    const Image plain = [] {
        Image white(64, 32);
        for (vec3& pixel : white.pixels) pixel = {1, 1, 1};
        return white;
    }();
    const Image& image = scene.sky->image ? *scene.sky->image : plain;
    std::array<std::array<double, 3>, shared::kSkyTerms> sums{};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const vec3 direction = shared::sky_direction(
                {(static_cast<float>(x) + 0.5f) / static_cast<float>(image.width),
                 (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height)});
            const vec3 pixel = image.at(x, y) * pixel_solid_angle(image, y);
            for (uint32_t i = 0; i < shared::kSkyTerms; ++i) {
                const vec3 part = pixel * shared::harmonic(i, direction);
                sums[i][0] += static_cast<double>(part.x);
                sums[i][1] += static_cast<double>(part.y);
                sums[i][2] += static_cast<double>(part.z);
            }
        }
    }
    for (uint32_t i = 0; i < shared::kSkyTerms; ++i) {
        const vec3 sum{static_cast<float>(sums[i][0]), static_cast<float>(sums[i][1]),
                       static_cast<float>(sums[i][2])};
        terms[i] = sum * scene.sky->luminance * shared::cosine_term(i);
    }
    return terms;
}

std::vector<shared::RasterEmitter> raster_emitters(const Scene& scene, const Surfaces& surfaces,
                                                   size_t most) {
    const EmitterTable table = emitter_table(scene, surfaces);
    std::vector<shared::RasterEmitter> emitters;
    const auto add = [&](size_t i, float scale) {
        const uint32_t triangle = table.triangles[i];
        emitters.push_back({triangle, mean_luminance(scene, surfaces, triangle) * scale,
                            shines_both_ways(scene, surfaces, triangle) ? 1u : 0u});
    };
    if (table.triangles.size() <= most) {
        for (size_t i = 0; i < table.triangles.size(); ++i) add(i, 1);
        return emitters;
    }
    // Every stratum of power is shone by the triangle in its middle, at 1 / (most p) of its own.
    size_t last = table.triangles.size();
    for (size_t k = 0; k < most; ++k) {
        const float u = (static_cast<float>(k) + 0.5f) / static_cast<float>(most);
        const auto found = std::upper_bound(table.cumulative.begin(), table.cumulative.end(), u);
        const size_t i = std::min(static_cast<size_t>(found - table.cumulative.begin()),
                                  table.triangles.size() - 1);
        const float p = table.cumulative[i] - (i > 0 ? table.cumulative[i - 1] : 0.0f);
        const float scale = 1 / (static_cast<float>(most) * p);
        if (i == last)
            emitters.back().luminance +=
                mean_luminance(scene, surfaces, table.triangles[i]) * scale;
        else
            add(i, scale);
        last = i;
    }
    return emitters;
}

}  // namespace aglow::render::gpu
