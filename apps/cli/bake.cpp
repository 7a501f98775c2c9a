// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/bake.h"

#include "aglow/encode/lit_gltf.h"
#include "command.h"
#include "report.h"
#include "scene_options.h"
#include "solver_options.h"

#include <algorithm>
#include <cmath>

namespace aglow::cli {
namespace {

struct Options {
    std::filesystem::path input;
    std::filesystem::path output;
    SceneOptions scene;
    SolverOptions solver;
    std::string encode = "lightmap";
    LitForm form = LitForm::lightmap;
    std::optional<double> exposure;
};

Table table(Options& o) {
    Table rows = {
        {"IN", file(&o.input), "", "scene: .gltf, .glb or .obj", Need::required},
        {"-o,--output", file(&o.output), "OUT", "lit scene to write: .glb or .gltf",
         Need::required},
    };
    rows += solver_table(o.solver);
    rows += scene_table(o.scene);
    rows += {
        {"--encode", choice<std::string>(&o.encode, {{"lightmap", "lightmap"}}, {"vertex", "hce"}),
         "NAME", "how light is stored: lightmap (default)"},
        {"--as",
         choice<LitForm>(&o.form, {{"lightmap", LitForm::lightmap}, {"unlit", LitForm::unlit}}),
         "NAME",
         "lightmap (default): MOZ_lightmap materials; unlit: base colour x light, for any viewer"},
        {"--exposure", number(&o.exposure, -100, 100), "EV",
         "exposure of --as unlit in steps of two (default: the median texel at middle brightness)"},
    };
    return rows;
}

/// Illuminance averaged over the covered surface, lux.
double mean_irradiance(const Baked& baked) {
    double flux = 0, area = 0;
    for (size_t i = 0; i < baked.field.values.size(); ++i) {
        const double texel_area = static_cast<double>(baked.texels.area[i]);
        flux += texel_area * static_cast<double>(luminance(baked.field.values[i].total()));
        area += texel_area;
    }
    return area > 0 ? flux / area : 0;
}

/// Exposure that shows a surface of reflectance 1/2 at 0.4 under the median light of the texels
/// that have any.
float middle_exposure(const Baked& baked) {
    std::vector<float> lux;
    for (const Irradiance& value : baked.field.values)
        if (const float e = luminance(value.total()); e > 0) lux.push_back(e);
    if (lux.empty()) return 0;
    const auto middle = lux.begin() + static_cast<std::ptrdiff_t>(lux.size() / 2);
    std::nth_element(lux.begin(), middle, lux.end());
    return std::log2(0.4f * kReferenceWhite / (0.5f * *middle / kPi));
}

size_t black_texels(const Baked& baked) {
    const auto black = [](const Irradiance& e) { return e.total() == vec3{0, 0, 0}; };
    return static_cast<size_t>(
        std::count_if(baked.field.values.begin(), baked.field.values.end(), black));
}

Json report(const Options& options, const Baked& baked, const LitFiles& files, Json seconds) {
    return {{"scene", options.input.string()},
            {"device", "cpu"},
            {"method", name(options.solver.method)},
            {"encode", options.encode},
            {"triangles", baked.surfaces.triangles.size()},
            {"texels", baked.texels.element_count()},
            {"atlas", {baked.atlas.width, baked.atlas.height}},
            {"texel_size", baked.atlas.texel_size},
            {"charts", baked.atlas.chart_count},
            {"samples", baked.field.samples},
            {"bounces", baked.field.bounces},
            {"rays", baked.field.ray_count},
            {"mean_irradiance_lux", mean_irradiance(baked)},
            {"black_texels", black_texels(baked)},
            {"clipped_share", files.clipped_share},
            {"seconds", std::move(seconds)},
            {"peak_memory_bytes", peak_memory_bytes()},
            {"outputs", names(files.outputs)},
            {"warnings", baked.scene.warnings}};
}

Result<int> run(const Options& options, Console& console) {
    if (options.exposure && options.form != LitForm::unlit)
        return fail(Errc::bad_argument,
                    "--exposure belongs to --as unlit; add that or leave it out");
    AG_CHECK(check_output(options.output, {".glb", ".gltf"}, options.input));
    AG_TRY(const BakeOptions bake_settings,
           bake_options(options.solver, options.scene.pose_time(), console.options().seed));
    const Stopwatch total;
    AG_TRY(Scene scene, prepare_scene(options.input, options.scene, console));
    const double load_seconds = total.seconds();
    const size_t known_warnings = scene.warnings.size();
    AG_TRY(const Baked baked, bake(std::move(scene), bake_settings, console.monitor()));
    show_warnings(baked.scene, options.input, console, known_warnings);

    AG_CHECK(console.go_on("write"));
    const Stopwatch write;
    Json settings;
    describe(bake_settings, settings);
    describe(options.scene, settings);
    AG_TRY(const LitFiles files,
           write_lit_gltf(baked.scene, baked.surfaces, baked.atlas, baked.texels, baked.lightmap,
                          options.output,
                          {.form = options.form,
                           .exposure_ev = options.exposure ? static_cast<float>(*options.exposure)
                                                           : middle_exposure(baked),
                           .method = name(options.solver.method),
                           .json_settings = to_text(settings)}));
    const Json seconds = {{"load", rounded_seconds(load_seconds)},
                          {"unwrap", rounded_seconds(baked.seconds.unwrap)},
                          {"solve", rounded_seconds(baked.seconds.solve)},
                          {"encode", rounded_seconds(baked.seconds.encode)},
                          {"write", rounded_seconds(write.seconds())},
                          {"total", rounded_seconds(total.seconds())}};
    print_report(console, report(options, baked, files, seconds));
    return kExitDone;
}

}  // namespace

Command bake_command() {
    return command("bake", "IN -o OUT [options]", "computes the light of a scene and writes it lit",
                   table, run);
}

}  // namespace aglow::cli
