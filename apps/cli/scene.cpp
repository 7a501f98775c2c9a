// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/scene.h"

#include "aglow/scene/builtin.h"
#include "aglow/scene/write.h"
#include "command.h"
#include "report.h"
#include "scene_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace aglow::cli {
namespace {

struct Options {
    std::string name;
    std::filesystem::path output;
    bool list = false;
};

Table table(Options& o) {
    return {
        {"NAME", text(&o.name), "", "built-in scene; see --list"},
        {"-o,--output", file(&o.output), "OUT", "file to write: .glb"},
        {"--list", flag(&o.list), "", "list the built-in scenes"},
    };
}

int list(Console& console) {
    const std::vector<BuiltinScene> scenes = builtin_scenes();
    if (console.json()) {
        Json report = {{"scenes", Json::array()}};
        for (const BuiltinScene& scene : scenes)
            report["scenes"].push_back({{"name", scene.name}, {"description", scene.description}});
        print_report(console, report);
        return kExitDone;
    }
    size_t width = 0;
    for (const BuiltinScene& scene : scenes) width = std::max(width, scene.name.size());
    std::string text;
    for (const BuiltinScene& scene : scenes)
        text += fmt::format("{:<{}}  {}\n", scene.name, width, scene.description);
    console.result(text);
    return kExitDone;
}

Result<int> run(const Options& options, Console& console) {
    const bool named = !options.name.empty() || !options.output.empty();
    if (options.list && named) return fail(Errc::bad_argument, "--list takes neither NAME nor -o");
    if (options.list) return list(console);
    if (options.name.empty() || options.output.empty())
        return fail(Errc::bad_argument, "give NAME and -o OUT.glb, or --list");
    AG_CHECK(check_output(options.output, {".glb"}));
    AG_CHECK(console.go_on("make"));
    AG_TRY(const Scene scene, builtin_scene(options.name));
    AG_CHECK(console.go_on("write"));
    AG_CHECK(write_glb(scene, options.output));

    size_t triangles = 0;
    for (const Node& node : scene.nodes) {
        if (node.mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[static_cast<size_t>(node.mesh)].primitives)
            triangles += primitive.triangles.size();
    }
    print_report(
        console,
        {{"scene", options.name}, {"triangles", triangles}, {"outputs", names({options.output})}});
    return kExitDone;
}

}  // namespace

Command scene_command() {
    return command("scene", "NAME -o OUT.glb [options] | --list", "writes a built-in scene", table,
                   run);
}

}  // namespace aglow::cli
