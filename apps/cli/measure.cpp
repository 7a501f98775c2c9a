// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/bake.h"
#include "aglow/core/file.h"
#include "aglow/render/false_color.h"
#include "aglow/scene/image_file.h"
#include "command.h"
#include "plan.h"
#include "report.h"
#include "scene_options.h"
#include "sensors.h"
#include "solver_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace aglow::cli {
namespace {

constexpr double kMostSensors = 2e7;

struct Options {
    std::filesystem::path input;
    std::filesystem::path output;
    std::optional<std::filesystem::path> points;
    std::optional<double> grid;
    std::optional<std::filesystem::path> image;
    SceneOptions scene;
    SolverOptions solver;
};

Result<std::filesystem::path> parse_path(const std::string& text) {
    if (text.empty()) return fail(Errc::bad_argument, "the file name is empty");
    return std::filesystem::path(text);
}

Table table(Options& o) {
    Table rows = {
        {"IN", file(&o.input), "", "scene: .gltf, .glb or .obj", Need::required},
        {"-o,--output", file(&o.output), "OUT.csv", "illuminance at the sensors, lux",
         Need::required},
        {"--points", parsed(&o.points, parse_path), "P.csv",
         "sensors: x,y,z,nx,ny,nz per line, metres"},
        {"--grid", number_above(&o.grid, 0), "M",
         "sensors on all upward faces, so many metres apart"},
        {"--image", parsed(&o.image, parse_path), "OUT.png",
         "with --grid: plan view in false colour, with a legend in lux"},
    };
    rows += solver_table(o.solver);
    rows += scene_table(o.scene);
    return rows;
}

Status check_contradictions(const Options& options) {
    if (options.points.has_value() == options.grid.has_value())
        return fail(Errc::bad_argument, "give sensors by --points or by --grid, one of them");
    if (options.image && !options.grid)
        return fail(Errc::bad_argument,
                    "--image draws a plan of --grid; give that instead of --points");
    if (options.solver.method == Method::path &&
        (options.solver.texel_size || options.solver.resolution))
        return fail(Errc::bad_argument,
                    "--texel-size and --resolution belong to --method gather; --method path has "
                    "no texels");
    AG_CHECK(check_output(options.output, {".csv"}, options.input));
    if (options.image) AG_CHECK(check_output(*options.image, {".png"}, options.input));
    if (options.points) AG_CHECK(check_output(options.output, {".csv"}, *options.points));
    return {};
}

Result<std::vector<Receiver>> find_sensors(const Options& options, const Scene& scene) {
    if (options.points) return read_sensors(*options.points);
    const Surfaces surfaces = pose(scene, options.scene.pose_time());
    double upward_area = 0;
    for (uint32_t t = 0; t < surfaces.triangles.size(); ++t)
        upward_area += static_cast<double>(area(surfaces, t)) *
                       static_cast<double>(std::max(0.0f, geometric_normal(surfaces, t).y));
    const double expected = upward_area / (*options.grid * *options.grid);
    if (!(expected <= kMostSensors))
        return fail(Errc::bad_argument,
                    fmt::format("--grid {} would make {:.3g} sensors; the limit is {:.3g}",
                                *options.grid, expected, kMostSensors));
    std::vector<Receiver> sensors =
        grid_sensors(scene, static_cast<float>(*options.grid), options.scene.pose_time());
    if (sensors.empty())
        return fail(Errc::bad_argument,
                    "no upward face holds a sensor; take a smaller --grid, or --points",
                    options.input.string());
    return sensors;
}

Status write_image_of(const Options& options, const Scene& scene, std::span<const Receiver> sensors,
                      const IrradianceField& field) {
    const Surfaces surfaces = pose(scene, options.scene.pose_time());
    AG_TRY(const RayScene rays, RayScene::create(scene, surfaces));
    const Plan plan = plan_view(sensors, field.values, static_cast<float>(*options.grid), rays);
    return write_image(false_color_image(plan.lux, plan.width, plan.height), *options.image);
}

struct Range {
    double lowest = 0, mean = 0, highest = 0;
};

Range range_of(const std::vector<Irradiance>& values) {
    Range range{1e300, 0, 0};
    for (const Irradiance& value : values) {
        const auto e = static_cast<double>(luminance(value.total()));
        range.lowest = std::min(range.lowest, e);
        range.highest = std::max(range.highest, e);
        range.mean += e / static_cast<double>(values.size());
    }
    return range;
}

double mean(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) sum += static_cast<double>(value);
    return sum / static_cast<double>(values.size());
}

Json report(const Options& options, const IrradianceField& field) {
    const Range range = range_of(field.values);
    Json report = {{"scene", options.input.string()},
                   {"device", "cpu"},
                   {"method", name(options.solver.method)},
                   {"sensors", field.values.size()},
                   {"samples", field.samples},
                   {"bounces", field.bounces},
                   {"rays", field.ray_count},
                   {"mean_irradiance_lux", range.mean},
                   {"min_irradiance_lux", range.lowest},
                   {"max_irradiance_lux", range.highest}};
    if (range.mean > 0) report["uniformity"] = range.lowest / range.mean;
    if (!field.standard_error.empty())
        report["mean_standard_error_lux"] = mean(field.standard_error);
    return report;
}

Result<int> run(const Options& options, Console& console) {
    AG_CHECK(check_contradictions(options));
    AG_TRY(const BakeOptions settings,
           bake_options(options.solver, options.scene.pose_time(), console.options().seed));
    const Stopwatch total;
    AG_TRY(const Scene scene, prepare_scene(options.input, options.scene, console));
    AG_TRY(const std::vector<Receiver> sensors, find_sensors(options, scene));
    const double load_seconds = total.seconds();
    const Stopwatch solve;
    AG_TRY(const IrradianceField field, measure(scene, sensors, settings, console.monitor()));
    const double solve_seconds = solve.seconds();

    AG_CHECK(console.go_on("write"));
    AG_CHECK(write_file(options.output, sensor_csv(sensors, field.values)));
    std::vector<std::filesystem::path> outputs = {options.output};
    if (options.image) {
        AG_CHECK(write_image_of(options, scene, sensors, field));
        outputs.push_back(*options.image);
    }
    Json result = report(options, field);
    result["seconds"] = {{"load", rounded_seconds(load_seconds)},
                         {"solve", rounded_seconds(solve_seconds)},
                         {"total", rounded_seconds(total.seconds())}};
    result["peak_memory_bytes"] = peak_memory_bytes();
    result["outputs"] = names(outputs);
    result["warnings"] = scene.warnings;
    print_report(console, result);
    return kExitDone;
}

}  // namespace

Command measure_command() {
    return command("measure", "IN -o OUT.csv --points P.csv | --grid M [options]",
                   "computes illuminance at sensor points, in lux", table, run);
}

}  // namespace aglow::cli
