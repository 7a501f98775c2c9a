// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu_scene.h"
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"
#include "aglow/vk/devices.h"
#include "console.h"
#include "report.h"

#include <array>
#include <string>
#include <vector>

namespace aglow::cli {

/// What `aglow bench` is asked for.
struct BenchOptions {
    std::vector<std::string> scenes;  ///< files or built-in names; none: the table's own
    int rays = 0;                     ///< of each kind, of accel_table()
    int side = 0;                     ///< of pictures, in pixels, of rays_table()
    std::string teaset;               ///< file of patches, of refine_table(); may be empty
};

/// A table that `aglow bench` measures.
struct BenchTable {
    std::vector<std::string> scenes;  ///< that it is measured with where none are named
    Json settings;                    ///< that the report tells
    /// Measurements of a scene, each an object; an array of them.
    Result<Json> (*measure)(const Gpu& gpu, const std::string& scene, const BenchOptions& options,
                            Console& console);
    /// The report as text for people: the settings, and all measurements in "scenes".
    std::string (*text)(const Json& report);
    const char* beside = "Embree 3";  ///< what the device is compared with
};

/// Each structure built and traced on a GPU, and Embree beside it.
BenchTable accel_table(const BenchOptions& options);
/// Frames of still and moving scenes drawn with each structure on a GPU, and on the CPU: with
/// camera rays alone, with shadows, and with reflections.
BenchTable rays_table(const BenchOptions& options);
/// The objects of Concheiro et al., "Synthesis of Multiresolution Scenes ..." (2010), subdivided in
/// all forms of GpuSubdivision, and on the CPU.
BenchTable refine_table(const BenchOptions& options);

/// The structures that tables compare.
inline constexpr std::array kBenchAccels = {Accel::grid, Accel::grid2, Accel::bvh};
/// When moving scenes are measured: they have begun to move, s.
inline constexpr double kBenchTime = 0.5;

/// Scenes of like size and kind as those of Ivson et al., "Dynamic Ray Tracing ..." (2009): three
/// machines that stand still; a skinned figure, rolling and rigid bodies, and large among tiny
/// triangles.
std::vector<std::string> bench_scenes();
/// A scene file or built-in scene whose surfaces are all opaque.
Result<Scene> bench_scene(const std::string& name);

}  // namespace aglow::cli
