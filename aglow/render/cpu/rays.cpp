// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/rays.h"

#include "aglow/core/parallel.h"
#include "aglow/render/cpu/draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <new>

namespace aglow {
namespace render::cpu {
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

Status check_view(const Surfaces& surfaces, const View& view, const Image* irradiance) {
    if (irradiance && surfaces.lightmap_uvs.size() != surfaces.positions.size())
        return fail(Errc::bad_argument, "the surfaces have no lightmap coordinates");
    if (view.width < 1 || view.height < 1)
        return fail(Errc::bad_argument,
                    fmt::format("an image of {}x{} pixels is empty", view.width, view.height));
    return {};
}

tl::unexpected<Error> no_memory_for(const View& view) {
    return fail(Errc::out_of_memory,
                fmt::format("not enough memory for {} x {} pixels", view.width, view.height));
}

/// A ray on its way through the scene.
struct Path {
    Ray ray;
    shared::RayCone cone;
    vec3 weight = {1, 1, 1};  ///< share of its luminance that reaches the camera
};

/// Rays that all threads trace.
struct SharedTally {
    std::atomic<uint64_t> camera = 0, mirror = 0, shadow = 0;

    void add(const RayTally& more) {
        camera += more.camera;
        mirror += more.mirror;
        shadow += more.shadow;
    }
    RayTally sum() const { return {camera, mirror, shadow}; }
};

/// Follows camera rays.
struct Tracer {
    const World& world;
    const RaysOptions& options;
    RayTally tally = {};

    vec3 luminance_along(Path path, uint32_t pixel, uint32_t sample) {
        vec3 sum{0, 0, 0};
        for (uint32_t depth = 0;; ++depth) {
            ++(depth == 0 ? tally.camera : tally.mirror);
            const std::optional<Hit> hit = world.rays.intersect(path.ray);
            if (!hit) return sum + path.weight * sky_luminance(world.scene, path.ray.direction);
            path.cone = shared::advanced_cone(path.cone, hit->distance);
            const Surface surface = surface_at(world.surfaces, world.tables.materials, *hit,
                                               path.ray.direction, path.cone);
            if (surface.flags & shared::kMaterialUnlit)
                return sum + path.weight * surface.color.base_color * kUnlitWhite;
            const shared::SurfaceLook look = look_of(surface, path, depth);
            sum += path.weight * shown(surface, look, path, {pixel, sample, depth});
            if (look.mirror == vec3{0, 0, 0}) return sum;
            reflect(path, surface, look.mirror);
        }
    }

    shared::SurfaceLook look_of(const Surface& surface, const Path& path, uint32_t depth) const {
        if (options.reflections == 0) return shared::matte_look(surface.color);
        const float cosine = -dot(surface.normal, path.ray.direction) * surface.side();
        return shared::surface_look(surface.color, cosine, path.weight,
                                    depth < static_cast<uint32_t>(options.reflections) ? 1u : 0u);
    }

    /// Luminance of a surface but for its mirror image.
    vec3 shown(const Surface& surface, const shared::SurfaceLook& look, const Path& path,
               Draw draw) {
        Gloss gloss;
        gloss.wanted = options.reflections > 0;
        if (gloss.wanted) {
            gloss.kind =
                options.shading == Shading::phong ? shared::kHighlightPhong : shared::kHighlightGgx;
            gloss.f0 = shared::normal_reflectance(surface.color);
            gloss.alpha =
                shared::lobe_alpha(surface.color.roughness, surface.curvature, path.cone.width);
            gloss.to_viewer = -path.ray.direction;
        }
        const Incoming light = incoming_light(world, surface, gloss, draw, tally.shadow);
        return surface.color.emitted + look.diffuse * light.irradiance + look.mean * light.mean +
               light.highlight;
    }

    static void reflect(Path& path, const Surface& surface, vec3 mirror) {
        const float side = surface.side();
        const vec3 g = surface.geometric_normal * side;
        path.ray = {offset_origin(surface.position, g, surface.magnitude),
                    shared::mirror_direction(path.ray.direction, surface.normal * side, g)};
        path.cone = shared::reflected_cone(path.cone, surface.curvature, surface.color.roughness);
        path.weight *= mirror;
    }
};

}  // namespace

Status check(const RaysOptions& options) {
    if (options.samples < 1)
        return fail(Errc::bad_argument,
                    fmt::format("{} rays per pixel: at least 1 is needed", options.samples));
    if (options.reflections < 0 || options.reflections > kMostReflections)
        return fail(Errc::bad_argument, fmt::format("{} reflections: 0 to {} can be followed",
                                                    options.reflections, kMostReflections));
    return {};
}

SharedTables shared_tables(const Scene& scene, const Surfaces& surfaces, bool baked,
                           const RaysOptions& options) {
    SharedTables tables;
    tables.materials = material_table(scene);
    if (!baked) {
        tables.emitters = emitter_table(scene, surfaces);
        tables.sky = sky_table(scene);
    }
    tables.offsets = filter_offsets(options);
    tables.seed = draw_seed(options);
    return tables;
}

Result<Image> draw(const World& world, const View& view, const RaysOptions& options,
                   const Monitor& monitor, RayTally& tally) try {
    AG_CHECK(check_view(world.surfaces, view, world.stored.irradiance));
    const std::vector<vec2>& offsets = world.tables.offsets;
    const shared::CameraView camera = view.shared_view();
    const shared::RayCone cone =
        shared::camera_cone(camera, static_cast<uint32_t>(options.samples));
    SharedTally traced;
    Image image(view.width, view.height);
    AG_CHECK(for_each_pixel(view, monitor, [&](size_t pixel) {
        const auto row = static_cast<size_t>(view.width);
        const float x = static_cast<float>(pixel % row) + 0.5f;
        const float y = static_cast<float>(pixel / row) + 0.5f;
        Tracer tracer{world, options};
        vec3 sum = {0, 0, 0};
        for (uint32_t i = 0; i < offsets.size(); ++i) {
            const shared::CameraRay ray =
                shared::camera_ray(camera, x + offsets[i].x, y + offsets[i].y);
            sum += tracer.luminance_along({{ray.origin, ray.direction}, cone},
                                          static_cast<uint32_t>(pixel), i);
        }
        image.pixels[pixel] = sum / static_cast<float>(options.samples);
        traced.add(tracer.tally);
    }));
    tally += traced.sum();
    return image;
} catch (const std::bad_alloc&) {
    return no_memory_for(view);
}

}  // namespace render::cpu

Result<Image> render_rays(const PosedScene& posed, const View& view, const Image& irradiance,
                          const RaysOptions& options, const Monitor& monitor) try {
    AG_CHECK(render::cpu::check(options));
    const bool baked = !irradiance.pixels.empty();
    const auto tables = render::cpu::shared_tables(posed.scene, posed.surfaces, baked, options);
    const render::cpu::World world{
        posed.scene,
        posed.surfaces,
        posed.rays,
        tables,
        {baked ? &irradiance : nullptr, true},
        punctual_lights(posed.scene, world_transforms(posed.scene, posed.time))};
    RayTally uncounted;
    return render::cpu::draw(world, view, options, monitor, uncounted);
} catch (const std::bad_alloc&) {
    return render::cpu::no_memory_for(view);
}

Result<std::vector<float>> render_illuminance(const Surfaces& surfaces, const RayScene& rays,
                                              const View& view, const Image& irradiance,
                                              const Monitor& monitor) try {
    AG_CHECK(render::cpu::check_view(surfaces, view, &irradiance));
    std::vector<float> lux(static_cast<size_t>(view.width) * static_cast<size_t>(view.height));
    AG_CHECK(render::cpu::for_each_pixel(view, monitor, [&](size_t pixel) {
        const auto row = static_cast<size_t>(view.width);
        const float x = static_cast<float>(pixel % row), y = static_cast<float>(pixel / row);
        const std::optional<Hit> hit = rays.intersect(view.ray(x + 0.5f, y + 0.5f));
        lux[pixel] = hit ? luminance(render::cpu::baked_irradiance(surfaces, irradiance, hit->at))
                         : std::numeric_limits<float>::quiet_NaN();
    }));
    return lux;
} catch (const std::bad_alloc&) {
    return render::cpu::no_memory_for(view);
}

}  // namespace aglow
