// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/rays.h"

#include "aglow/core/parallel.h"
#include "aglow/core/random.h"
#include "aglow/encode/lightmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <new>

namespace aglow {
namespace {

constexpr size_t kPixels = 256;  // of one task

/// Calls draw(pixel) for every pixel of the view, on all threads.
Status for_each_pixel(const View& view, const Monitor& monitor, const auto& draw) {
    const auto count = static_cast<size_t>(view.width) * static_cast<size_t>(view.height);
    std::atomic<size_t> done = 0;
    parallel_for(count, kPixels, [&](size_t begin, size_t end) {
        for (size_t pixel = begin; pixel < end; ++pixel) {
            if (monitor.cancelled()) return;
            draw(pixel);
        }
        const size_t so_far = done.fetch_add(end - begin) + (end - begin);
        monitor("rendering", static_cast<double>(so_far) / static_cast<double>(count));
    });
    if (monitor.cancelled()) return fail(Errc::cancelled, "rendering was interrupted");
    return {};
}

Status check(const Surfaces& surfaces, const View& view) {
    if (surfaces.lightmap_uvs.size() != surfaces.positions.size())
        return fail(Errc::bad_argument, "the surfaces have no lightmap coordinates");
    if (view.width < 1 || view.height < 1)
        return fail(Errc::bad_argument,
                    fmt::format("an image of {}x{} pixels is empty", view.width, view.height));
    return {};
}

vec3 baked(const Surfaces& surfaces, const Image& irradiance, SurfacePoint at) {
    const uvec3 t = surfaces.triangles[at.triangle];
    const float b1 = at.barycentrics.x, b2 = at.barycentrics.y;
    const std::vector<vec2>& uvs = surfaces.lightmap_uvs;
    return sample_lightmap(irradiance, uvs[t.x] * (1 - b1 - b2) + uvs[t.y] * b1 + uvs[t.z] * b2);
}

/// Luminance of the sky: bilinear between pixels, wrapped around the horizon.
vec3 sky_luminance(const Scene& scene, vec3 direction) {
    if (!scene.sky) return {0, 0, 0};
    if (!scene.sky->image) return scene.sky->luminance;
    const Image& image = *scene.sky->image;
    const float turn = std::atan2(direction.x, -direction.z) / (2 * kPi);
    const float polar = std::acos(std::clamp(direction.y, -1.0f, 1.0f)) / kPi;
    const float x = (0.5f + turn) * static_cast<float>(image.width) - 0.5f;
    const float y = polar * static_cast<float>(image.height) - 0.5f;
    const float left = std::floor(x), top = std::floor(y);
    const auto pixel = [&](int i, int k) {
        const int column = ((i % image.width) + image.width) % image.width;
        return image.at(column, std::clamp(k, 0, image.height - 1));
    };
    const int i = static_cast<int>(left), k = static_cast<int>(top);
    const vec3 upper = shared::mix(pixel(i, k), pixel(i + 1, k), x - left);
    const vec3 lower = shared::mix(pixel(i, k + 1), pixel(i + 1, k + 1), x - left);
    return scene.sky->luminance * shared::mix(upper, lower, y - top);
}

/// Everything a camera ray needs to become a luminance.
struct Shader {
    const Scene& scene;
    const Surfaces& surfaces;
    const RayScene& rays;
    const Image& irradiance;

    vec3 luminance_along(const Ray& ray) const {
        const std::optional<Hit> hit = rays.intersect(ray);
        if (!hit) return sky_luminance(scene, ray.direction);
        const vec3 color = base_color(scene, surfaces, hit->at);
        const int index = surfaces.part(hit->at.triangle).material;
        const Material* material = index < 0 ? nullptr : &scene.materials[size_t(index)];
        if (material && material->unlit) return color * kUnlitWhite;
        const vec3 limit = {kMaxReflectance, kMaxReflectance, kMaxReflectance};
        vec3 result = shared::min(color, limit) * baked(surfaces, irradiance, hit->at) * (1 / kPi);
        if (material && (hit->front || material->double_sided))
            result += emitted_luminance(scene, surfaces, hit->at);
        return result;
    }
};

/// A number with a tent density on [-1, 1] from a uniform one.
float tent(float u) {
    return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(std::max(0.0f, 2 - 2 * u));
}

/// Where the rays of every pixel pass, relative to its middle: a Hammersley set, whose points are
/// spread evenly in both directions, shifted at random. All pixels share it, so that straight edges
/// look alike along their length.
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

}  // namespace

Result<Image> render_rays(const Scene& scene, const Surfaces& surfaces, const RayScene& rays,
                          const View& view, const Image& irradiance, const RaysOptions& options,
                          const Monitor& monitor) try {
    AG_CHECK(check(surfaces, view));
    if (options.samples < 1)
        return fail(Errc::bad_argument,
                    fmt::format("{} rays per pixel: at least 1 is needed", options.samples));
    const Shader shader{scene, surfaces, rays, irradiance};
    const std::vector<vec2> offsets = filter_offsets(options);
    Image image(view.width, view.height);
    const auto draw = [&](size_t pixel) {
        const auto row = static_cast<size_t>(view.width);
        const float x = static_cast<float>(pixel % row) + 0.5f;
        const float y = static_cast<float>(pixel / row) + 0.5f;
        vec3 sum = {0, 0, 0};
        for (const vec2 offset : offsets)
            sum += shader.luminance_along(view.ray(x + offset.x, y + offset.y));
        image.pixels[pixel] = sum / static_cast<float>(options.samples);
    };
    AG_CHECK(for_each_pixel(view, monitor, draw));
    return image;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory,
                fmt::format("not enough memory for {} x {} pixels", view.width, view.height));
}

Result<std::vector<float>> render_illuminance(const Surfaces& surfaces, const RayScene& rays,
                                              const View& view, const Image& irradiance,
                                              const Monitor& monitor) try {
    AG_CHECK(check(surfaces, view));
    std::vector<float> lux(static_cast<size_t>(view.width) * static_cast<size_t>(view.height));
    const auto draw = [&](size_t pixel) {
        const auto row = static_cast<size_t>(view.width);
        const float x = static_cast<float>(pixel % row), y = static_cast<float>(pixel / row);
        const std::optional<Hit> hit = rays.intersect(view.ray(x + 0.5f, y + 0.5f));
        lux[pixel] = hit ? luminance(baked(surfaces, irradiance, hit->at))
                         : std::numeric_limits<float>::quiet_NaN();
    };
    AG_CHECK(for_each_pixel(view, monitor, draw));
    return lux;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory,
                fmt::format("not enough memory for {} x {} pixels", view.width, view.height));
}

}  // namespace aglow
