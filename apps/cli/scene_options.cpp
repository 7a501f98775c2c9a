// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

#include "aglow/core/file.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/scene/image_file.h"
#include "aglow/scene/load.h"
#include "aglow/scene/photometry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <unistd.h>

namespace aglow::cli {
namespace {

namespace fs = std::filesystem;

Result<SkyOption> parse_sky(const std::string& text) {
    const Result<double> luminance = parse_number(text);
    if (!luminance) return SkyOption(std::filesystem::path(text));
    if (*luminance < 0)
        return fail(Errc::bad_argument, fmt::format("the luminance {} is negative", text));
    return SkyOption(*luminance);
}

Result<SunOption> parse_sun(const std::string& text) {
    AG_TRY(const std::vector<double> v, parse_numbers(text, 3));
    if (std::abs(v[1]) > 90)
        return fail(Errc::bad_argument,
                    fmt::format("the elevation {} is not between -90 and 90 degrees", v[1]));
    if (v[2] < 0) return fail(Errc::bad_argument, fmt::format("{} lux is negative", v[2]));
    return SunOption{v[0], v[1], v[2]};
}

Result<LightOption> parse_light(const std::string& text) {
    const size_t last = text.rfind(',');
    const std::string source = last == std::string::npos ? "" : text.substr(last + 1);
    const bool is_file = !source.empty() && !parse_number(source);
    AG_TRY(const std::vector<double> v,
           is_file ? parse_numbers(text.substr(0, last), 3) : parse_numbers(text, 4));
    const vec3 position{static_cast<float>(v[0]), static_cast<float>(v[1]),
                        static_cast<float>(v[2])};
    if (is_file) return LightOption{position, fs::path(source)};
    if (v[3] < 0) return fail(Errc::bad_argument, fmt::format("{} lumen is negative", v[3]));
    return LightOption{position, v[3]};
}

/// Luminance below zero is what filters of image editors leave behind; nothing else may be wrong.
Result<Image> read_sky(const std::filesystem::path& path, Console& console) {
    AG_TRY(Image image, read_image(path));
    bool negative = false;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        vec3& p = image.pixels[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            const auto width = static_cast<size_t>(image.width);
            return fail(Errc::malformed,
                        fmt::format("pixel ({}, {}) is not finite", i % width, i / width),
                        path.string());
        }
        negative |= std::min({p.x, p.y, p.z}) < 0;
        p = shared::max(p, vec3{0, 0, 0});
    }
    if (negative) console.warn(path.string() + ": negative luminance counts as 0");
    return image;
}

Result<Photometry> read_luminaire(const fs::path& path) {
    AG_TRY(const std::vector<uint8_t> bytes, read_file(path));
    auto photometry = read_photometry(bytes);
    if (!photometry)
        return fail(photometry.error().code, photometry.error().message, path.string());
    return photometry;
}

}  // namespace

Table scene_table(SceneOptions& o) {
    constexpr double kLongest = 1e9;  // s; what a float still resolves to a minute
    return {
        {"--sky", parsed(&o.sky, parse_sky), "FILE|CD_M2",
         "sky: an equirectangular .hdr or .exr in cd/m^2, or one luminance"},
        {"--sun", parsed(&o.sun, parse_sun), "AZ,EL,LUX",
         "sun: azimuth clockwise from north (-Z), elevation, degrees; lux facing it"},
        {"--light", parsed_each(&o.lights, parse_light), "X,Y,Z,LUMEN|FILE",
         "isotropic point light, or a luminaire (.ies, .ldt) aimed down; may be repeated"},
        {"--clay", number(&o.clay, 0, static_cast<double>(kMaxReflectance)), "RHO",
         "make every surface a diffuse grey of this reflectance; emission is kept"},
        {"--time", number(&o.time, 0, kLongest), "S",
         "pose animations at this second (default: the rest pose)"},
    };
}

Result<Scene> prepare_scene(const std::filesystem::path& path, const SceneOptions& options,
                            Console& console) {
    AG_CHECK(console.go_on("load"));
    AG_TRY(Scene scene, load_scene(path));
    show_warnings(scene, path, console);
    if (options.sky) {
        Sky sky;
        if (const double* luminance = std::get_if<double>(&*options.sky)) {
            const auto l = static_cast<float>(*luminance);
            sky.luminance = {l, l, l};
        } else {
            AG_TRY(Image image, read_sky(std::get<std::filesystem::path>(*options.sky), console));
            sky = {{1, 1, 1}, std::make_shared<const Image>(std::move(image))};
        }
        scene.sky = std::move(sky);
    }
    if (const auto& sun = options.sun)
        add_sun(scene, static_cast<float>(sun->azimuth_degrees),
                static_cast<float>(sun->elevation_degrees), static_cast<float>(sun->illuminance));
    for (const LightOption& light : options.lights) {
        if (const double* flux = std::get_if<double>(&light.source)) {
            add_point_light(scene, light.position, static_cast<float>(*flux));
            continue;
        }
        AG_TRY(Photometry photometry, read_luminaire(std::get<fs::path>(light.source)));
        add_luminaire(scene, light.position,
                      std::make_shared<const Photometry>(std::move(photometry)));
    }
    if (options.clay) apply_clay(scene, static_cast<float>(*options.clay));
    return scene;
}

void show_warnings(const Scene& scene, const std::filesystem::path& path, Console& console,
                   size_t first) {
    for (size_t i = first; i < scene.warnings.size(); ++i)
        console.warn(fmt::format("{}: {}", path.string(), scene.warnings[i]));
}

void describe(const SceneOptions& options, Json& settings) {
    if (options.sky) {
        if (const double* luminance = std::get_if<double>(&*options.sky))
            settings["sky"] = *luminance;
        else
            settings["sky"] = std::get<std::filesystem::path>(*options.sky).filename().string();
    }
    if (const auto& sun = options.sun)
        settings["sun"] = {sun->azimuth_degrees, sun->elevation_degrees, sun->illuminance};
    for (const auto& [p, source] : options.lights) {
        Json light = {p.x, p.y, p.z};
        if (const double* flux = std::get_if<double>(&source))
            light.push_back(*flux);
        else
            light.push_back(std::get<fs::path>(source).filename().string());
        settings["lights"].push_back(std::move(light));
    }
    if (options.clay) settings["clay"] = *options.clay;
    if (options.time) settings["time"] = *options.time;
}

Status check_output(const std::filesystem::path& path, const std::vector<std::string>& endings,
                    const std::filesystem::path& input) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (std::find(endings.begin(), endings.end(), ending) == endings.end())
        return fail(Errc::bad_argument,
                    fmt::format("the output must end in {}", fmt::join(endings, ", ")),
                    path.string());
    std::error_code ignored;
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (std::filesystem::is_directory(path, ignored))
        return fail(Errc::unreadable, "is a folder", path.string());
    if (!std::filesystem::is_directory(folder, ignored))
        return fail(Errc::unreadable, "the folder does not exist", folder.string());
    if (access(folder.c_str(), W_OK) != 0)
        return fail(Errc::unreadable, "the folder cannot be written to", folder.string());
    if (!input.empty() && std::filesystem::equivalent(path, input, ignored))
        return fail(Errc::bad_argument, "is the input; give the output another name",
                    path.string());
    return {};
}

}  // namespace aglow::cli
