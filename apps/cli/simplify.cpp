// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/fair_mesh.h"
#include "aglow/scene/load.h"
#include "command.h"
#include "report.h"
#include "scene_options.h"

#include <fmt/format.h>

namespace aglow::cli {
namespace {

struct Options {
    std::filesystem::path input, output;
    std::optional<double> ratio, max_error;
    std::optional<int> map_size;
    bool no_compare = false;
};

Table table(Options& o) {
    return {
        {"IN", file(&o.input), "", "scene: .gltf, .glb, .obj", Need::required},
        {"-o,--output", file(&o.output), "OUT", "file to write: .glb", Need::required},
        {"--ratio", number_above(&o.ratio, 0), "R", "share of the triangles to keep (0.02)"},
        {"--max-error", number(&o.max_error, 0), "X",
         "keep more where the coarse surface would move by more than X of a mesh's diagonal"},
        {"--map-size", whole(&o.map_size, 16, 16384), "N",
         "width of the maps in texels (4 texels for every dense vertex)"},
        {"--no-compare", flag(&o.no_compare), "", "do not refine and measure the result"},
    };
}

Json describe(const FairMesh& mesh, const Options& options) {
    Json row = {
        {"mesh", mesh.mesh},           {"dense_triangles", mesh.dense_triangles},
        {"triangles", mesh.triangles}, {"map", fmt::format("{} x {}", mesh.width, mesh.height)},
        {"missed", mesh.missed},       {"diagonal", mesh.diagonal}};
    if (options.no_compare) return row;
    const double diagonal = mesh.diagonal;
    const auto share = [&](double d) { return diagonal > 0 ? d / diagonal : 0; };
    row["level"] = mesh.level;
    row["refined_triangles"] = mesh.refined_triangles;
    row["rms"] = mesh.rms;
    row["rms_of_diagonal"] = share(mesh.rms);
    row["hausdorff"] = mesh.hausdorff;
    row["hausdorff_of_diagonal"] = share(mesh.hausdorff);
    return row;
}

FairOptions settings(const Options& options) {
    FairOptions s;
    if (options.ratio) s.ratio = static_cast<float>(*options.ratio);
    if (options.max_error) s.max_error = static_cast<float>(*options.max_error);
    s.map_size = options.map_size.value_or(0);
    if (options.no_compare) s.samples = 0;
    return s;
}

Result<int> run(const Options& options, Console& console) {
    if (options.ratio.value_or(1) > 1)
        return fail(Errc::bad_argument, "--ratio is a share: above 0, at most 1");
    AG_CHECK(check_output(options.output, {".glb"}, options.input));
    AG_CHECK(console.go_on("load"));
    const Stopwatch watch;
    AG_TRY(Scene scene, load_scene(options.input));
    show_warnings(scene, options.input, console);
    AG_TRY(FairScene fair, make_fair(std::move(scene), settings(options), console.monitor()));
    if (fair.meshes.empty())
        return fail(Errc::malformed, "has no triangles to simplify", options.input.string());
    AG_CHECK(console.go_on("write"));
    AG_TRY(const std::vector<std::filesystem::path> files, write_fair(fair, options.output));

    size_t dense = 0, coarse = 0;
    Json meshes = Json::array();
    for (const FairMesh& mesh : fair.meshes) {
        dense += mesh.dense_triangles;
        coarse += mesh.triangles;
        meshes.push_back(describe(mesh, options));
    }
    print_report(console, {{"scene", options.input.string()},
                           {"dense_triangles", dense},
                           {"triangles", coarse},
                           {"ratio", static_cast<double>(coarse) / static_cast<double>(dense)},
                           {"meshes", meshes},
                           {"seconds", rounded_seconds(watch.seconds())},
                           {"outputs", names(files)}});
    return kExitDone;
}

}  // namespace

Command simplify_command() {
    return command("simplify", "IN -o OUT.glb [options]",
                   "makes dense meshes coarse, with displacement and normal maps of what they lost",
                   table, run);
}

}  // namespace aglow::cli
