// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/bake.h"

#include "aglow/accel/hidden_points.h"
#include "aglow/bake/solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>

namespace aglow {
namespace {

/// Seconds since it was made or last read.
class Stopwatch {
public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> since = now - start_;
        start_ = now;
        return since.count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::vector<vec3> totals(const IrradianceField& field) {
    std::vector<vec3> result;
    result.reserve(field.values.size());
    for (const Irradiance& value : field.values) result.push_back(value.total());
    return result;
}

Result<IrradianceField> solve_texels(const World& world, const Texels& texels,
                                     const SolveOptions& options, const Monitor& monitor) {
    if (options.method == Method::path)
        return trace_texels(world, texels, path_options(options, Target::texels), monitor);
    const GatherOptions gather = gather_options(options, Target::texels);
    AG_TRY(const auto cache, solve_gather(world, texels, gather, monitor));
    return gather_texels(world, texels, cache, gather, monitor);
}

/// The scene unwrapped, posed and cut into texels: all that comes before light.
struct Prepared {
    Atlas atlas;
    Surfaces surfaces;
    Texels texels;
};

Result<Prepared> prepare(Scene& scene, const BakeOptions& options, const Monitor& monitor) {
    AG_TRY(auto atlas, unwrap(scene, options.unwrap, monitor));
    auto surfaces = pose(scene, options.solve.time, &atlas);
    if (surfaces.triangles.empty())
        return fail(Errc::bad_argument, "the scene has no triangles, so there is nothing to light");
    auto texels = rasterize(surfaces, atlas, sample_points(options.solve.quality));
    return Prepared{std::move(atlas), std::move(surfaces), std::move(texels)};
}

/// All that sensors lit by free paths need.
Result<Prepared> prepare_surfaces(const Scene& scene, const BakeOptions& options) {
    return Prepared{{}, pose(scene, options.solve.time), {}};
}

/// Sensors that may lie on any surface of the scene, to within the rounding of its coordinates.
std::vector<Receiver> lift(std::span<const Receiver> sensors, const Surfaces& surfaces) {
    float magnitude = 0;
    for (const vec3 p : surfaces.positions)
        magnitude = std::max({magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    std::vector<Receiver> lifted(sensors.begin(), sensors.end());
    for (Receiver& sensor : lifted) sensor.magnitude = std::max(sensor.magnitude, magnitude);
    return lifted;
}

}  // namespace

Result<Baked> bake(Scene scene, const BakeOptions& options, const Monitor& monitor) try {
    Stopwatch watch;
    Baked baked;
    baked.scene = std::move(scene);
    AG_TRY(auto prepared, prepare(baked.scene, options, monitor));
    baked.atlas = std::move(prepared.atlas);
    baked.surfaces = std::move(prepared.surfaces);
    baked.texels = std::move(prepared.texels);
    baked.seconds.unwrap = watch.lap();

    AG_TRY(const auto rays, RayScene::create(baked.scene, baked.surfaces));
    const Lights lights(baked.scene, baked.surfaces,
                        world_transforms(baked.scene, options.solve.time));
    const World world{baked.scene, baked.surfaces, rays, lights};
    drop_hidden_points(baked.surfaces, baked.scene, rays, baked.texels);
    AG_TRY(baked.field, solve_texels(world, baked.texels, options.solve, monitor));
    baked.seconds.solve = watch.lap();

    baked.lightmap = make_lightmap(baked.texels, totals(baked.field), options.unwrap.gutter);
    baked.seconds.encode = watch.lap();
    return baked;
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "not enough memory to bake; use a lower --resolution");
}

Result<IrradianceField> measure(Scene scene, std::span<const Receiver> sensors,
                                const BakeOptions& options, const Monitor& monitor) try {
    const bool paths = options.solve.method == Method::path;
    AG_TRY(auto prepared,
           paths ? prepare_surfaces(scene, options) : prepare(scene, options, monitor));
    AG_TRY(const auto rays, RayScene::create(scene, prepared.surfaces));
    const Lights lights(scene, prepared.surfaces, world_transforms(scene, options.solve.time));
    const World world{scene, prepared.surfaces, rays, lights};
    const std::vector<Receiver> lifted = lift(sensors, prepared.surfaces);
    if (paths)
        return trace_receivers(world, lifted, path_options(options.solve, Target::sensors),
                               monitor);

    drop_hidden_points(prepared.surfaces, scene, rays, prepared.texels);
    const GatherOptions gather = gather_options(options.solve, Target::sensors);
    AG_TRY(const auto cache, solve_gather(world, prepared.texels, gather, monitor));
    return gather_receivers(world, prepared.texels, cache, lifted, gather, monitor);
} catch (const std::bad_alloc&) {
    return fail(Errc::out_of_memory, "not enough memory to measure; use a lower --resolution");
}

}  // namespace aglow
