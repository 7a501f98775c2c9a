// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"
#include "aglow/vk/devices.h"
#include "console.h"
#include "report.h"

#include <string>
#include <vector>

namespace aglow::cli {

/// What `aglow bench` is asked for.
struct BenchOptions {
    std::vector<std::string> scenes;  ///< files or built-in names; none: the table's own
    int rays = 0;                     ///< of each kind, of bench_accel()
    int side = 0;                     ///< of pictures, in pixels, of bench_rays()
};

/// A table as JSON, and the same as text for people.
struct BenchTable {
    Json json;
    std::string text;
};

/// A scene file or built-in scene whose surfaces are all opaque.
Result<Scene> bench_scene(const std::string& name);
/// The GPU that --device names; the best there is unless it names one.
Result<Gpu> bench_gpu(const Console& console);

/// Builds and traces each structure on the device that was asked for, and Embree beside it.
Result<BenchTable> bench_accel(const BenchOptions& options, Console& console);

/// Draws frames of still and moving scenes with each structure on the device that was asked for,
/// and on the CPU: with camera rays alone, with shadows, and with reflections.
Result<BenchTable> bench_rays(const BenchOptions& options, Console& console);

}  // namespace aglow::cli
