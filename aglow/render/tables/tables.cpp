// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/tables/tables.h"

#include "aglow/core/random.h"
#include "aglow/scene/photometry.h"
#include "aglow/scene/punctual_lights.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace aglow::render {
namespace {

/// Running sums of `weights` over their total, in float; empty where that is 0.
std::vector<float> cumulative(const std::vector<double>& weights) {
    double total = 0;
    for (const double w : weights) total += w;
    std::vector<float> result;
    if (!(total > 0)) return result;
    double sum = 0;
    for (const double w : weights) {
        sum += w;
        result.push_back(static_cast<float>(sum / total));
    }
    return result;
}

/// Mean luminance that leaves a triangle, over an even pattern of 3 x 3 points.
float mean_emission(const Scene& scene, const Surfaces& surfaces, uint32_t triangle) {
    float sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const float root = std::sqrt((static_cast<float>(i) + 0.5f) / 3);
            const float v = (static_cast<float>(k) + 0.5f) / 3;
            const SurfacePoint at{triangle, {root * (1 - v), root * v}};
            sum += luminance(emitted_luminance(scene, surfaces, at));
        }
    return sum / 9;
}

/// A number with a tent density on [-1, 1] from a uniform one.
float tent(float u) {
    return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(std::max(0.0f, 2 - 2 * u));
}

}  // namespace

LightTable light_table(const Scene& scene, double time) {
    LightTable table;
    std::map<const Photometry*, uint32_t> first_of;
    for (const PlacedLight& placed : punctual_lights(scene, world_transforms(scene, time))) {
        shared::PunctualLight light = placed.light;
        if (const Photometry* p = placed.photometry) {
            const auto [first, fresh] =
                first_of.try_emplace(p, static_cast<uint32_t>(table.photometry.size()));
            if (fresh)
                for (const std::vector<float>* part : {&p->gamma, &p->c, &p->candela})
                    table.photometry.insert(table.photometry.end(), part->begin(), part->end());
            light.photometry = first->second;
            light.gamma_count = static_cast<uint32_t>(p->gamma.size());
            light.c_count = static_cast<uint32_t>(p->c.size());
        }
        table.lights.push_back(light);
    }
    return table;
}

EmitterTable emitter_table(const Scene& scene, const Surfaces& surfaces) {
    EmitterTable table;
    std::vector<double> powers;
    for (uint32_t triangle = 0; triangle < surfaces.triangles.size(); ++triangle) {
        const int index = surfaces.part(triangle).material;
        const Material* m = index < 0 ? nullptr : &scene.materials[static_cast<size_t>(index)];
        if (!m || m->unlit || !(luminance(m->emission) > 0)) continue;
        // Where the pattern meets only dark texels, others may still shine.
        const float emission =
            shared::max(mean_emission(scene, surfaces, triangle), 0.02f * luminance(m->emission));
        const float power = area(surfaces, triangle) * emission;
        if (!(power > 0)) continue;
        table.triangles.push_back(triangle);
        powers.push_back(static_cast<double>(power) * (m->double_sided ? 2 : 1));
    }
    table.cumulative = cumulative(powers);
    return table;
}

SkyTable sky_table(const Scene& scene) {
    SkyTable table;
    if (!scene.sky || !scene.sky->image || !(luminance(scene.sky->luminance) > 0)) return table;
    const Image& image = *scene.sky->image;
    std::vector<double> rows;
    for (int y = 0; y < image.height; ++y) {
        std::vector<double> pixels;
        double sum = 0;
        for (int x = 0; x < image.width; ++x) {
            pixels.push_back(static_cast<double>(luminance(image.at(x, y))));
            sum += pixels.back();
        }
        const double polar = (y + 0.5) / image.height * static_cast<double>(kPi);
        rows.push_back(sum * std::sin(polar));
        std::vector<float> cells = cumulative(pixels);
        cells.resize(static_cast<size_t>(image.width), 1);
        table.cells.insert(table.cells.end(), cells.begin(), cells.end());
    }
    table.rows = cumulative(rows);
    if (table.rows.empty()) return {};
    table.width = image.width;
    table.height = image.height;
    return table;
}

std::vector<vec2> filter_offsets(const RaysOptions& options) {
    Pcg32 random(options.seed);
    const float shift_x = random.uniform(), shift_y = random.uniform();
    const auto wrap = [](float v) { return v < 1 ? v : v - 1; };
    std::vector<vec2> offsets;
    for (int i = 0; i < options.samples; ++i) {
        float mirrored = 0, digit = 0.5f;  // the bits of i behind the binary point
        for (int bits = i; bits > 0; bits >>= 1, digit /= 2)
            if (bits & 1) mirrored += digit;
        const float even = static_cast<float>(i) / static_cast<float>(options.samples);
        offsets.push_back({tent(wrap(even + shift_x)), tent(wrap(mirrored + shift_y))});
    }
    return offsets;
}

uint32_t draw_seed(const RaysOptions& options) {
    return static_cast<uint32_t>(mix_bits(options.seed) >> 32);
}

bool has_motion(const Scene& scene) {
    return std::any_of(scene.animations.begin(), scene.animations.end(), [](const Animation& a) {
        return std::any_of(a.channels.begin(), a.channels.end(),
                           [](const AnimationChannel& c) { return !c.times.empty(); });
    });
}

}  // namespace aglow::render
