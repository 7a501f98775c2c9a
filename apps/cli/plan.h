// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/transport/irradiance.h"

#include <span>
#include <vector>

namespace aglow::cli {

/// Illuminance seen from above, row 0 in the north (-Z), NaN where no sensor stands.
struct Plan {
    int width = 0, height = 0;
    std::vector<float> lux;  ///< [height * width]
};

/// Plan view of sensors that stand `spacing` metres apart. Roofs are lifted off: of several sensors
/// above each other, the highest with something over it is shown, else the highest.
/// Shapes  sensors and values have the same length, at least 1.
/// Result  the longer side has up to 1600 pixels, each sensor the same whole number of them.
Plan plan_view(std::span<const Receiver> sensors, std::span<const Irradiance> values, float spacing,
               const RayScene& rays);

}  // namespace aglow::cli
