// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"
#include "console.h"
#include "options.h"
#include "report.h"

#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

namespace aglow::cli {

using SkyOption = std::variant<double, std::filesystem::path>;  ///< cd/m^2, or an image file

struct SunOption {
    double azimuth_degrees = 0, elevation_degrees = 0, illuminance = 0;
};

struct LightOption {
    vec3 position = {0, 0, 0};
    std::variant<double, std::filesystem::path> source;  ///< lm, or an IES or EULUMDAT file
};

/// What is put into a scene beside what its file says.
struct SceneOptions {
    std::optional<SkyOption> sky;
    std::optional<SunOption> sun;
    std::vector<LightOption> lights;
    std::optional<double> clay;
    std::optional<double> time;

    double pose_time() const { return time.value_or(-1); }  ///< as pose() takes it
};

Table scene_table(SceneOptions& options);

/// Loads the scene and adds sky, sun, lights and clay. Its warnings are shown.
/// Errors  of load_scene() and read_image(); malformed where a sky holds no finite luminance.
Result<Scene> prepare_scene(const std::filesystem::path& path, const SceneOptions& options,
                            Console& console);

/// Shows the scene's warnings from index `first` on.
void show_warnings(const Scene& scene, const std::filesystem::path& path, Console& console,
                   size_t first = 0);

/// Adds the options that were given to `settings`.
void describe(const SceneOptions& options, Json& settings);

/// Errors  unreadable    `path` lies in no folder that can be written to
///         bad_argument  its ending is none of `endings`, or it is `input`
/// Checked before hours of work, not after.
Status check_output(const std::filesystem::path& path, const std::vector<std::string>& endings,
                    const std::filesystem::path& input = {});

}  // namespace aglow::cli
