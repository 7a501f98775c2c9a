// SPDX-License-Identifier: Apache-2.0
#include "aglow/encode/lit_gltf.h"
#include "aglow/render/camera.h"
#include "aglow/render/frames.h"
#include "aglow/render/rays.h"
#include "aglow/transport/irradiance.h"
#include "command.h"
#include "frame_source.h"
#include "refinement_option.h"
#include "report.h"
#include "scene_options.h"
#include "sequence.h"
#include "solver_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace aglow::cli {
namespace {

constexpr int kLongestSide = 16384;
constexpr int kMostSamples = 1 << 20;
constexpr int kRaysSamples = 16;
constexpr int kPathSamples = 64;
constexpr int kRasterSamples = 4;
constexpr int kReflections = 2;
constexpr int kMostBudget = 1'000'000'000;

enum class Engine : uint8_t { rays, path, raster };

std::string name_of(Engine engine) {
    return engine == Engine::rays ? "rays" : engine == Engine::path ? "path" : "raster";
}

struct Options {
    std::filesystem::path input;
    Engine engine = Engine::rays;
    SequenceOptions sequence;
    std::optional<int> samples;
    std::optional<int> bounces;
    std::optional<int> reflections;
    std::optional<Shading> shading;
    std::optional<Accel> accel;
    std::optional<Refinement> refine;
    std::optional<int> budget;
    std::optional<double> crease;  // degrees
    SceneOptions scene;
};

Result<PictureSize> parse_size(const std::string& text) {
    const size_t cross = text.find('x');
    if (cross == std::string::npos)
        return fail(Errc::bad_argument, fmt::format("\"{}\" is not WIDTHxHEIGHT", text));
    AG_TRY(const int64_t width, parse_whole(text.substr(0, cross), 1, kLongestSide));
    AG_TRY(const int64_t height, parse_whole(text.substr(cross + 1), 1, kLongestSide));
    return PictureSize{static_cast<int>(width), static_cast<int>(height)};
}

Table table(Options& o) {
    Table rows = {
        {"IN", file(&o.input), "",
         "scene; --engine rays and raster show the light that `aglow bake` left in "
         "it, else light that is direct",
         Need::required},
        {"-o,--output", file(&o.sequence.output), "OUT",
         "image: .png (tone-mapped), .exr or .hdr (luminance, cd/m^2)", Need::required},
        {"--engine",
         choice<Engine>(
             &o.engine,
             {{"rays", Engine::rays}, {"path", Engine::path}, {"raster", Engine::raster}}),
         "NAME",
         "rays (default): ray tracing over baked light; path: brute-force path tracing; raster: "
         "triangles on a GPU, without shadows or reflections but those that are baked"},
        {"--camera", text(&o.sequence.camera), "N|NAME|auto",
         "camera of the scene; auto (default): the first, else one that shows all"},
        {"--size", parsed(&o.sequence.size, parse_size), "WxH", "pixels (default 1280x720)"},
        {"--samples", whole(&o.samples, 1, kMostSamples), "N",
         fmt::format("rays or paths per pixel (default {} and {}); with --engine raster samples of "
                     "edges (default {})",
                     kRaysSamples, kPathSamples, kRasterSamples)},
        {"--reflections", whole(&o.reflections, 0, kMostReflections), "N",
         fmt::format("mirrors in mirrors with --engine rays (default {}); 0: no highlights either",
                     kReflections)},
        {"--shading",
         choice<Shading>(&o.shading, {{"metallic-roughness", Shading::metallic_roughness},
                                      {"phong", Shading::phong}}),
         "NAME", "highlights of --engine rays: metallic-roughness (default) or phong"},
        {"--accel",
         choice<Accel>(&o.accel, {{"auto", Accel::automatic},
                                  {"grid", Accel::grid},
                                  {"grid2", Accel::grid2},
                                  {"bvh", Accel::bvh}}),
         "NAME", "how a GPU finds hits: auto (default), grid, grid2 (two-level) or bvh"},
        {"--refine", parsed(&o.refine, parse_refinement), "none|KIND:N|auto[:PIXELS]",
         fmt::format("finer surfaces with --engine raster, 2^N segments to an edge: pn, curved "
                     "triangles; st, the same with the file's _SHARPNESS, _TENSION and _BIAS; loop "
                     "or catmull-clark, subdivision; auto: st, each edge as fine as it takes to be "
                     "within PIXELS (default {}) of its curve (default none)",
                     Refinement{}.tolerance)},
        {"--crease", number(&o.crease, 0, 180), "DEGREES",
         "with --refine: edges whose faces meet at a larger angle stay creases"},
        {"--budget", whole(&o.budget, 1, kMostBudget), "N",
         "triangles of a frame at most with --refine auto, whose PIXELS grow until they fit; no "
         "fewer than the file has"},
        {"--bounces", parsed(&o.bounces, parse_bounces), "N|auto",
         "diffuse reflections with --engine path (default auto: all)"},
        {"--frames", parsed(&o.sequence.frames, parse_frames), "A:B",
         "frames A to B of the animation, into OUT-0000.png and so on"},
        {"--fps", number_above(&o.sequence.fps, 0), "N",
         fmt::format("frames in a second; frame 0 is at second 0 (default {})",
                     SequenceOptions::kFps)},
        {"--exposure", number(&o.sequence.exposure, -100, 100), "EV",
         "exposure of a .png in steps of two (default: by the picture, or the first frame)"},
    };
    rows += scene_table(o.scene);
    return rows;
}

/// Options of one engine that the other does not know.
Status check_engine(const Options& options) {
    if (options.engine == Engine::rays && options.bounces)
        return fail(Errc::bad_argument,
                    "--engine rays shows light that is baked; give --bounces to `aglow bake`, or "
                    "take --engine path");
    if (options.refine && options.engine != Engine::raster)
        return fail(Errc::bad_argument, "--refine belongs to --engine raster; give both");
    if (options.crease && !options.refine)
        return fail(Errc::bad_argument, "--crease belongs to --refine; give both");
    if (options.budget && (!options.refine || options.refine->kind != Refinement::Kind::automatic))
        return fail(Errc::bad_argument, "--budget belongs to --refine auto; give both");
    if (options.engine == Engine::raster && options.bounces)
        return fail(Errc::bad_argument,
                    "--engine raster shows light that is baked; give --bounces to `aglow bake`, or "
                    "take --engine path");
    if (options.engine == Engine::raster &&
        (options.reflections || options.shading || options.accel))
        return fail(Errc::bad_argument,
                    "--engine raster traces no rays; leave out --reflections, --shading and "
                    "--accel, or take --engine rays");
    if (options.engine == Engine::path && (options.reflections || options.shading || options.accel))
        return fail(Errc::bad_argument,
                    "--engine path is diffuse and runs on the CPU; leave out --reflections, "
                    "--shading and --accel, or take --engine rays");
    return {};
}

Status check_contradictions(const Options& options, const Console& console) {
    AG_CHECK(check_output(options.sequence.output, {".png", ".exr", ".hdr"}, options.input));
    if (options.sequence.exposure && options.sequence.output.extension() != ".png")
        return fail(Errc::bad_argument,
                    "--exposure belongs to a .png; .exr and .hdr hold cd/m^2 as they are");
    if (options.sequence.frames && options.scene.time)
        return fail(Errc::bad_argument,
                    "--frames and --time contradict each other; give one of them");
    if (options.sequence.fps && !options.sequence.frames)
        return fail(Errc::bad_argument, "--fps belongs to --frames; give both, or --time");
    if (options.engine == Engine::path && console.options().device.starts_with("gpu"))
        return fail(Errc::unsupported, "--engine path runs on the CPU; use --device cpu");
    return check_engine(options);
}

/// Light in the scene's file, or none.
Result<std::optional<Lit>> baked_light(Scene& scene, const Options& options, Console& console) {
    const size_t known_warnings = scene.warnings.size();
    Result<Lit> lit = read_lit_gltf(scene, options.input);
    if (!lit && lit.error().code == Errc::bad_argument) return std::nullopt;
    if (!lit) return tl::unexpected<Error>(std::move(lit).error());
    show_warnings(scene, options.input, console, known_warnings);
    const SceneOptions& added = options.scene;
    if (added.sun || added.clay || !added.lights.empty())
        return fail(
            Errc::bad_argument,
            "the scene's light is baked; give --sun, --light and --clay to `aglow bake`, or "
            "take --engine path",
            options.input.string());
    return std::move(*lit);
}

/// Does anything in the scene shine?
bool shines(const Scene& scene) {
    const auto emits = [](const Material& m) { return !m.unlit && luminance(m.emission) > 0; };
    const auto unlit = [](const Material& m) { return m.unlit; };
    return scene.sky || !scene.lights.empty() ||
           std::any_of(scene.materials.begin(), scene.materials.end(), emits) ||
           std::any_of(scene.materials.begin(), scene.materials.end(), unlit);
}

struct Source {
    std::optional<Lit> lit;  ///< in its place before a renderer refers to it
    std::unique_ptr<FrameRenderer> renderer;
};

Status open_source(const Options& options, Scene& scene, Console& console, Source& source) {
    const uint64_t seed = console.options().seed;
    if (options.engine == Engine::path) {
        source.renderer = path_renderer(scene, options.bounces.value_or(kConverged),
                                        options.samples.value_or(kPathSamples), seed);
        return {};
    }
    AG_TRY(source.lit, baked_light(scene, options, console));
    if (!source.lit && !shines(scene))
        console.warn(fmt::format(
            "{}: nothing in the scene shines; add --sky, --sun or --light, or light it with `aglow "
            "bake`",
            options.input.string()));
    if (options.engine == Engine::raster) {
        RasterOptions raster{.samples = options.samples.value_or(kRasterSamples),
                             .refinement = options.refine.value_or(Refinement{})};
        if (options.crease)
            raster.refinement.crease_angle = static_cast<float>(*options.crease) * (kPi / 180);
        raster.refinement.budget = static_cast<uint64_t>(options.budget.value_or(0));
        AG_TRY(source.renderer,
               raster_renderer({scene, source.lit ? &*source.lit : nullptr}, raster, console));
        return {};
    }
    const Footage footage{scene,
                          source.lit ? &*source.lit : nullptr,
                          {.samples = options.samples.value_or(kRaysSamples),
                           .reflections = options.reflections.value_or(kReflections),
                           .shading = options.shading.value_or(Shading::metallic_roughness),
                           .seed = seed}};
    AG_TRY(source.renderer,
           rays_renderer(footage, options.accel.value_or(Accel::automatic), console));
    return {};
}

/// As --device takes it.
std::string device_name(const FrameRenderer& renderer) {
    return renderer.device() == "cpu" ? "cpu" : "gpu:" + renderer.device();
}

Result<int> run(const Options& options, Console& console) {
    AG_CHECK(check_contradictions(options, console));
    const Stopwatch total;
    AG_TRY(Scene scene, prepare_scene(options.input, options.scene, console));
    const double load_seconds = total.seconds();
    Source source;
    AG_CHECK(open_source(options, scene, console, source));
    const double prepare_seconds = total.seconds() - load_seconds;
    Sequence sequence(options.sequence, options.scene.pose_time(), scene, *source.renderer,
                      console);
    AG_CHECK(sequence.run());

    Json report = {{"scene", options.input.string()},
                   {"device", device_name(*source.renderer)},
                   {"engine", name_of(options.engine)},
                   {"size", {options.sequence.size.width, options.sequence.size.height}}};
    sequence.tell(report);
    const double all_seconds = total.seconds();
    report["seconds"] = {{"load", rounded_seconds(load_seconds)},
                         {"prepare", rounded_seconds(prepare_seconds)},
                         {"draw", rounded_seconds(all_seconds - load_seconds - prepare_seconds)},
                         {"total", rounded_seconds(all_seconds)}};
    report["peak_memory_bytes"] = peak_memory_bytes();
    report["outputs"] = names(sequence.outputs());
    report["warnings"] = scene.warnings;
    print_report(console, report);
    return kExitDone;
}

}  // namespace

Command render_command() {
    Command result = command("render", "IN -o OUT.png [options]", "draws a scene", table, run);
    result.on_gpu = true;
    return result;
}

}  // namespace aglow::cli
