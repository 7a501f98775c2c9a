// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/refine_scene.h"

#include "aglow/mesh/surfaces.h"
#include "aglow/refine/splats.h"
#include "aglow/render/camera.h"
#include "aglow/scene/load.h"
#include "aglow/scene/rewrite_gltf.h"
#include "command.h"
#include "report.h"
#include "scene_options.h"

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace aglow::cli {
namespace {

constexpr uint32_t kNoiseOctaves = 5;
constexpr int kMostRepeats = 64;

/// A height map, or a function of place.
using DisplaceOption = std::variant<std::filesystem::path, shared::Displacement>;

struct Options {
    std::filesystem::path input, output;
    std::optional<RefineScheme> scheme;
    int level = 2;
    bool limit = false;
    std::optional<double> crease;
    bool creases_at_normals = false;
    bool quads = false;
    bool round_corners = false;
    std::filesystem::path model;
    std::optional<int> model_repeats;
    bool splats = false, share = false;
    bool irregular = false;
    std::string camera;
    std::optional<double> tolerance;
    DisplaceOption displace;
    std::optional<double> displace_scale, displace_bias;
};

/// "sin:0.1,0,20,0": the amplitude and a wave vector.
Result<DisplaceOption> parse_sine(const std::string& numbers) {
    AG_TRY(const std::vector<double> n, parse_numbers(numbers, 4));
    shared::Displacement field{};
    field.kind = shared::kSineDisplacement;
    field.amplitude = static_cast<float>(n[0]);
    field.frequency = {static_cast<float>(n[1]), static_cast<float>(n[2]),
                       static_cast<float>(n[3])};
    return field;
}

/// "noise:0.1,5": the amplitude of the coarsest octave and its cells to a metre.
Result<DisplaceOption> parse_noise(const std::string& numbers) {
    AG_TRY(const std::vector<double> n, parse_numbers(numbers, 2));
    const auto frequency = static_cast<float>(n[1]);
    shared::Displacement field{};
    field.kind = shared::kNoiseDisplacement;
    field.amplitude = static_cast<float>(n[0]);
    field.frequency = {frequency, frequency, frequency};
    field.octaves = kNoiseOctaves;
    field.lacunarity = 2;
    field.gain = 0.5f;
    return field;
}

Result<DisplaceOption> parse_displace(const std::string& text) {
    if (text.starts_with("sin:")) return parse_sine(text.substr(4));
    if (text.starts_with("noise:")) return parse_noise(text.substr(6));
    return std::filesystem::path(text);
}

Table table(Options& o) {
    return {
        {"IN", file(&o.input), "", "scene: .gltf, .glb or .obj", Need::required},
        {"-o,--output", file(&o.output), "OUT", "refined scene to write: .glb or .gltf",
         Need::required},
        {"--scheme",
         choice<RefineScheme>(&o.scheme, {{"loop", RefineScheme::loop},
                                          {"catmull-clark", RefineScheme::catmull_clark},
                                          {"pn", RefineScheme::pn},
                                          {"st", RefineScheme::tagged},
                                          {"phong", RefineScheme::phong}}),
         "NAME", "loop (default) or catmull-clark: subdivision; pn, st or phong: curved triangles"},
        {"--level", whole(&o.level, 1, kDeepestLevel), "N",
         "2^N segments to an edge, 4^N triangles to each (default 2)"},
        {"--limit", flag(&o.limit), "", "subdivision: put vertices on the limit surface"},
        {"--crease", number(&o.crease, 0, 180), "DEGREES",
         "keep edges sharp whose faces meet at a larger angle"},
        {"--creases-at-normals", flag(&o.creases_at_normals), "",
         "keep edges sharp across which the file's normals differ"},
        {"--quads", flag(&o.quads), "", "join pairs of triangles to quads first; not with loop"},
        {"--round-corners", flag(&o.round_corners), "",
         "subdivision: round the corners of open meshes too"},
        {"--share", flag(&o.share), "",
         "store closed meshes once that are turned and moved copies, and place them by nodes"},
        {"--pattern", choice<bool>(&o.irregular, {{"even", false}, {"irregular", true}}), "NAME",
         "pn, st, phong: vertices lie evenly (default), or irregular: denser where it bends"},
        {"--camera", text(&o.camera), "N|NAME|auto",
         "--pattern irregular: denser near this camera of the scene, too"},
        {"--tolerance", number_above(&o.tolerance, 0), "METRES",
         "pn, st, phong: no more segments to an edge than keep it this near to the curve"},
        {"--mesh-on-mesh", file(&o.model), "FILE",
         "pn, st, phong: set the triangles of this scene onto every face, +Y upwards"},
        {"--mesh-repeats", whole(&o.model_repeats, 1, kMostRepeats), "N",
         "so many of them along an edge of a face (default 1)"},
        {"--splats", flag(&o.splats), "",
         "write points with NORMAL and _RADIUS in place of triangles"},
        {"--displace", parsed(&o.displace, parse_displace), "HEIGHTS",
         "height map over TEXCOORD_0: .png (16 bit: 0..1), .exr or .hdr; or by place, "
         "sin:A,FX,FY,FZ or noise:A,F"},
        {"--displace-scale", number(&o.displace_scale, -kNoBound), "METRES",
         "how far a height of 1 moves the surface (default 1)"},
        {"--displace-bias", number(&o.displace_bias, -kNoBound), "METRES",
         "moves all of it, beside the map (default 0)"},
    };
}

bool has_map(const Options& o) {
    const auto* map = std::get_if<std::filesystem::path>(&o.displace);
    return map && !map->empty();
}

Status check(const Options& o) {
    if (!has_map(o) && (o.displace_scale || o.displace_bias))
        return fail(Errc::bad_argument,
                    "--displace-scale and --displace-bias go with --displace FILE");
    if (!o.camera.empty() && !o.irregular)
        return fail(Errc::bad_argument, "--camera goes with --pattern irregular");
    if (o.model_repeats && o.model.empty())
        return fail(Errc::bad_argument, "--mesh-repeats goes with --mesh-on-mesh FILE");
    return check_output(o.output, {".glb", ".gltf"}, o.input);
}

/// All triangles of a scene, at rest.
Result<SurfaceModel> read_model(const std::filesystem::path& path, int repeats) {
    AG_TRY(const Scene scene, load_scene(path));
    Surfaces surfaces = pose(scene);
    if (surfaces.triangles.empty())
        return fail(Errc::bad_argument, "the model has no triangles", path.string());
    return SurfaceModel{std::move(surfaces.positions), std::move(surfaces.normals),
                        std::move(surfaces.triangles), repeats};
}

/// Where the camera is at rest.
Result<vec3> eye_of(const Scene& scene, const std::string& camera) {
    AG_TRY(const std::optional<View> view, camera_view(scene, camera, 1, 1, -1));
    if (view) return transform_point(view->to_world, {0, 0, 0});
    return fail(Errc::bad_argument, "--camera auto: the scene has no camera");
}

Result<RefineOptions> refine_options(const Options& o) {
    RefineOptions options;
    options.scheme = o.scheme.value_or(RefineScheme::loop);
    options.level = o.level;
    options.limit = o.limit;
    options.corners = o.round_corners ? Corners::smooth : Corners::sharp;
    if (o.crease) options.control.crease_angle = static_cast<float>(*o.crease) * (kPi / 180);
    options.control.crease_at_normals = o.creases_at_normals;
    options.control.quads = o.quads;
    options.share = o.share;
    options.pattern.irregular = o.irregular;
    if (o.tolerance) options.pattern.tolerance = static_cast<float>(*o.tolerance);
    if (!o.model.empty()) {
        AG_TRY(options.model, read_model(o.model, o.model_repeats.value_or(1)));
    }
    if (const auto* field = std::get_if<shared::Displacement>(&o.displace)) options.field = *field;
    if (!has_map(o)) return options;
    AG_TRY(HeightMap map, read_height_map(std::get<std::filesystem::path>(o.displace)));
    options.displacement = {std::move(map), static_cast<float>(o.displace_scale.value_or(1)),
                            static_cast<float>(o.displace_bias.value_or(0))};
    return options;
}

/// Of all meshes, each once.
Json counts(const Scene& scene) {
    size_t triangles = 0, vertices = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives) {
            triangles += p.triangles.size();
            vertices += p.positions.size();
        }
    return {{"triangles", triangles}, {"vertices", vertices}};
}

Result<int> run(const Options& options, Console& console) {
    AG_CHECK(check(options));
    const Stopwatch total;
    AG_CHECK(console.go_on("load"));
    AG_TRY(RefineOptions refine, refine_options(options));
    AG_TRY(const Scene scene, load_scene(options.input));
    if (!options.camera.empty()) {
        AG_TRY(refine.pattern.eye, eye_of(scene, options.camera));
    }
    const double loaded = total.seconds();
    auto refined = refine_scene(scene, refine, console.monitor());
    if (!refined && refined.error().context.empty())
        refined.error().context = options.input.string();
    AG_TRY(const Scene result, std::move(refined));
    const double made = total.seconds();
    show_warnings(result, options.input, console);
    AG_CHECK(console.go_on("write"));
    AG_TRY(
        const RewrittenFiles files,
        rewrite_gltf(result, options.output, options.splats ? splat_radii(result) : SplatRadii()));
    for (const std::string& warning : files.warnings)
        console.warn(options.input.string() + ": " + warning);
    print_report(console, {{"scene", options.input.string()},
                           {"level", options.level},
                           {"coarse", counts(scene)},
                           {"refined", counts(result)},
                           {"placed_copies", result.nodes.size() - scene.nodes.size()},
                           {"seconds",
                            {{"load", rounded_seconds(loaded)},
                             {"refine", rounded_seconds(made - loaded)},
                             {"write", rounded_seconds(total.seconds() - made)},
                             {"total", rounded_seconds(total.seconds())}}},
                           {"outputs", names(files.outputs)}});
    return kExitDone;
}

}  // namespace

Command refine_command() {
    return command("refine", "IN -o OUT [options]", "writes a scene with finer, smooth meshes",
                   table, run);
}

}  // namespace aglow::cli
