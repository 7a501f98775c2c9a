// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/compare.h"

#include "aglow/encode/lit_gltf.h"
#include "aglow/mesh/texels.h"
#include "aglow/scene/image_file.h"
#include "aglow/scene/load.h"
#include "command.h"
#include "report.h"
#include "scene_options.h"

#include <fmt/format.h>

namespace aglow::cli {
namespace {

/// A bound on the root mean square error: of the values, or relative to those of B.
struct Bound {
    double value = 0;
    bool relative = false;
};

struct Options {
    std::filesystem::path a;
    std::filesystem::path b;
    std::optional<Bound> max_rmse;
};

Result<Bound> parse_bound(const std::string& text) {
    const bool relative = text.ends_with('%');
    AG_TRY(const double number, parse_number(relative ? text.substr(0, text.size() - 1) : text));
    if (number < 0) return fail(Errc::bad_argument, fmt::format("{} is negative", text));
    return Bound{relative ? number / 100 : number, relative};
}

Table table(Options& o) {
    return {
        {"A", file(&o.a), "",
         "image (.exr, .hdr, .png), lightmap (.exr) or lit scene (.glb, .gltf)", Need::required},
        {"B", file(&o.b), "", "what A is compared with", Need::required},
        {"--max-rmse", parsed(&o.max_rmse, parse_bound), "X|X%",
         "exit with 7 where the RMSE (with %: the relative RMSE) is above X"},
    };
}

/// Pixels to compare; of a lit scene, with the texels that lie on surfaces.
struct Side {
    Image image;
    std::vector<uint8_t> covered;  ///< empty for images
};

Result<Side> load_side(const std::filesystem::path& path, Console& console) {
    AG_CHECK(console.go_on("load"));
    const std::string ending = path.extension().string();
    if (ending != ".glb" && ending != ".gltf") {
        AG_TRY(Image image, read_image(path));
        return Side{std::move(image), {}};
    }
    AG_TRY(Scene scene, load_scene(path));
    AG_TRY(Lit lit, read_lit_gltf(scene, path));
    const Texels texels = rasterize(pose(scene, -1, &lit.atlas), lit.atlas, 1);
    Side side{std::move(lit.irradiance), {}};
    for (const uint32_t element : texels.element_at)
        side.covered.push_back(element != kNoElement ? 1 : 0);
    return side;
}

/// The texels that both sides have, or why there are none to speak of.
Result<std::vector<uint8_t>> common_mask(const Side& a, const Side& b) {
    if (!a.covered.empty() && !b.covered.empty() && a.covered != b.covered)
        return fail(Errc::bad_argument,
                    "the lit scenes have different lightmap charts; bake both at one resolution");
    const std::vector<uint8_t>& mask = a.covered.empty() ? b.covered : a.covered;
    const auto size = static_cast<size_t>(a.image.width) * static_cast<size_t>(a.image.height);
    const bool same_size = a.image.width == b.image.width && a.image.height == b.image.height;
    return same_size && mask.size() == size ? mask : std::vector<uint8_t>{};
}

Result<int> run(const Options& options, Console& console) {
    AG_TRY(const Side a, load_side(options.a, console));
    AG_TRY(const Side b, load_side(options.b, console));
    AG_TRY(const std::vector<uint8_t> mask, common_mask(a, b));
    AG_TRY(const Difference found, difference(a.image, b.image, mask));
    if (found.count == 0)
        return fail(Errc::malformed, "there is no pixel with finite values to compare");

    Json report = {{"a", options.a.string()},
                   {"b", options.b.string()},
                   {"pixels", found.count},
                   {"rmse", found.rmse},
                   {"relative_rmse", found.relative_rmse},
                   {"mean_relative", found.mean_relative},
                   {"median_relative", found.median_relative},
                   {"max", found.max},
                   {"non_finite", found.non_finite}};
    bool within = true;
    if (const auto& bound = options.max_rmse) {
        const double error = bound->relative ? found.relative_rmse : found.rmse;
        within = error <= bound->value && found.non_finite == 0;
        report["within_bound"] = within;
    }
    print_report(console, report);
    return within ? kExitDone : kExitDiffers;
}

}  // namespace

Command compare_command() {
    return command("compare", "A B [options]",
                   "tells how far image, lightmap or lit scene A is from B", table, run);
}

}  // namespace aglow::cli
