// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/lit_gltf.h"
#include "aglow/render/camera.h"
#include "aglow/render/rays.h"
#include "aglow/render/tone_map.h"
#include "aglow/scene/image_file.h"
#include "aglow/transport/path/path.h"
#include "command.h"
#include "report.h"
#include "scene_options.h"
#include "solver_options.h"

#include <fmt/format.h>

namespace aglow::cli {
namespace {

constexpr int kLongestSide = 16384;
constexpr int kMostSamples = 1 << 20;
constexpr int kRaysSamples = 16;
constexpr int kPathSamples = 64;

enum class Engine : uint8_t { rays, path };

struct Size {
    int width = 1280, height = 720;
};

struct Options {
    std::filesystem::path input;
    std::filesystem::path output;
    Engine engine = Engine::rays;
    std::string camera = "auto";
    Size size;
    std::optional<double> exposure;
    std::optional<int> samples;
    std::optional<int> bounces;
    SceneOptions scene;
};

Result<Size> parse_size(const std::string& text) {
    const size_t cross = text.find('x');
    if (cross == std::string::npos)
        return fail(Errc::bad_argument, fmt::format("\"{}\" is not WIDTHxHEIGHT", text));
    AG_TRY(const int64_t width, parse_whole(text.substr(0, cross), 1, kLongestSide));
    AG_TRY(const int64_t height, parse_whole(text.substr(cross + 1), 1, kLongestSide));
    return Size{static_cast<int>(width), static_cast<int>(height)};
}

Table table(Options& o) {
    Table rows = {
        {"IN", file(&o.input), "", "scene; for --engine rays one that `aglow bake` has lit",
         Need::required},
        {"-o,--output", file(&o.output), "OUT",
         "image: .png (tone-mapped), .exr or .hdr (luminance, cd/m^2)", Need::required},
        {"--engine",
         choice<Engine>(&o.engine, {{"rays", Engine::rays}, {"path", Engine::path}}, {"raster"}),
         "NAME", "rays (default): shows baked light; path: brute-force path tracing"},
        {"--camera", text(&o.camera), "N|NAME|auto",
         "camera of the scene; auto (default): the first, else one that shows all"},
        {"--size", parsed(&o.size, parse_size), "WxH", "pixels (default 1280x720)"},
        {"--samples", whole(&o.samples, 1, kMostSamples), "N",
         fmt::format("rays or paths per pixel (default {} and {})", kRaysSamples, kPathSamples)},
        {"--bounces", parsed(&o.bounces, parse_bounces), "N|auto",
         "diffuse reflections with --engine path (default auto: all)"},
        {"--exposure", number(&o.exposure, -100, 100), "EV",
         "exposure of a .png in steps of two (default: by the picture)"},
    };
    rows += scene_table(o.scene);
    return rows;
}

Status check_contradictions(const Options& options) {
    AG_CHECK(check_output(options.output, {".png", ".exr", ".hdr"}, options.input));
    if (options.exposure && options.output.extension() != ".png")
        return fail(Errc::bad_argument,
                    "--exposure belongs to a .png; .exr and .hdr hold cd/m^2 as they are");
    const SceneOptions& scene = options.scene;
    if (options.engine == Engine::rays &&
        (scene.sun || scene.clay || !scene.lights.empty() || options.bounces))
        return fail(Errc::bad_argument,
                    "--engine rays shows light that is baked; give --sun, --light, --clay and "
                    "--bounces to `aglow bake`, or take --engine path");
    return {};
}

/// Light that `aglow bake` left in the scene.
Result<Lit> baked_light(Scene& scene, const std::filesystem::path& path) {
    Result<Lit> lit = read_lit_gltf(scene, path);
    if (!lit && lit.error().code == Errc::bad_argument)
        return fail(Errc::bad_argument,
                    fmt::format("{}; light it first: `aglow bake {} -o lit.glb`, or render it with "
                                "--engine path",
                                lit.error().message, path.string()),
                    path.string());
    return lit;
}

Result<Image> draw_rays(const Options& options, Scene& scene, Console& console) {
    const size_t known_warnings = scene.warnings.size();
    AG_TRY(const Lit lit, baked_light(scene, options.input));
    show_warnings(scene, options.input, console, known_warnings);
    const Surfaces surfaces = pose(scene, options.scene.pose_time(), &lit.atlas);
    AG_TRY(const RayScene rays, RayScene::create(scene, surfaces));
    AG_TRY(const View view, choose_view(scene, surfaces, rays, options.camera, options.size.width,
                                        options.size.height, options.scene.pose_time()));
    return render_rays(
        scene, surfaces, rays, view, lit.irradiance,
        {.samples = options.samples.value_or(kRaysSamples), .seed = console.options().seed},
        console.monitor());
}

Result<Image> draw_paths(const Options& options, const Scene& scene, Console& console) {
    const double time = options.scene.pose_time();
    const Surfaces surfaces = pose(scene, time);
    AG_TRY(const RayScene rays, RayScene::create(scene, surfaces));
    const Lights lights(scene, surfaces, world_transforms(scene, time));
    AG_TRY(const View view, choose_view(scene, surfaces, rays, options.camera, options.size.width,
                                        options.size.height, time));
    return trace_image(
        {scene, surfaces, rays, lights}, view.width, view.height,
        [&](float x, float y) { return view.ray(x, y); },
        {.bounces = options.bounces.value_or(kConverged),
         .samples = options.samples.value_or(kPathSamples),
         .seed = console.options().seed},
        console.monitor());
}

Result<int> run(const Options& options, Console& console) {
    AG_CHECK(check_contradictions(options));
    const Stopwatch total;
    AG_TRY(Scene scene, prepare_scene(options.input, options.scene, console));
    const double load_seconds = total.seconds();
    const bool by_rays = options.engine == Engine::rays;
    Result<Image> drawn =
        by_rays ? draw_rays(options, scene, console) : draw_paths(options, scene, console);
    AG_TRY(Image image, std::move(drawn));
    const double draw_seconds = total.seconds() - load_seconds;

    AG_CHECK(console.go_on("write"));
    Json report = {{"scene", options.input.string()},
                   {"device", "cpu"},
                   {"engine", by_rays ? "rays" : "path"},
                   {"size", {image.width, image.height}}};
    if (options.output.extension() == ".png") {
        const float exposure =
            options.exposure ? static_cast<float>(*options.exposure) : automatic_exposure(image);
        report["exposure_ev"] = exposure;
        image = tone_map(image, exposure);
    }
    AG_CHECK(write_image(image, options.output));
    report["seconds"] = {{"load", rounded_seconds(load_seconds)},
                         {"draw", rounded_seconds(draw_seconds)},
                         {"total", rounded_seconds(total.seconds())}};
    report["peak_memory_bytes"] = peak_memory_bytes();
    report["outputs"] = names({options.output});
    report["warnings"] = scene.warnings;
    print_report(console, report);
    return kExitDone;
}

}  // namespace

Command render_command() {
    return command("render", "IN -o OUT.png [options]", "draws a scene", table, run);
}

}  // namespace aglow::cli
