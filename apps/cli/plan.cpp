// SPDX-License-Identifier: Apache-2.0
#include "plan.h"

#include "aglow/core/assert.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aglow::cli {
namespace {

constexpr int kLongestSide = 1600;  // pixels
constexpr int kLargestCell = 64;    // pixels

/// The grid that the sensors stand on, seen from above.
struct Floor {
    float west = 0, north = 0, spacing = 1;
    int columns = 1, rows = 1;

    Floor(const Box& box, float wanted_spacing) : west(box.lo.x), north(box.lo.z) {
        const vec3 size = box.size();
        const float longest = std::max(size.x, size.z);
        spacing = std::max(wanted_spacing, longest / static_cast<float>(kLongestSide - 1));
        columns = 1 + static_cast<int>(std::lround(size.x / spacing));
        rows = 1 + static_cast<int>(std::lround(size.z / spacing));
    }
    size_t cell(vec3 p) const {
        const auto column = static_cast<int>(std::lround((p.x - west) / spacing));
        const auto row = static_cast<int>(std::lround((p.z - north) / spacing));
        return static_cast<size_t>(std::clamp(row, 0, rows - 1)) * static_cast<size_t>(columns) +
               static_cast<size_t>(std::clamp(column, 0, columns - 1));
    }
};

/// The sensor that each cell shows, -1 for none.
std::vector<int> chosen_sensors(const Floor& floor, std::span<const Receiver> sensors,
                                const RayScene& rays) {
    std::vector<int> chosen(static_cast<size_t>(floor.columns) * static_cast<size_t>(floor.rows),
                            -1);
    std::vector<uint8_t> chosen_is_indoors(chosen.size(), 0);
    for (size_t i = 0; i < sensors.size(); ++i) {
        const vec3 p = sensors[i].position;
        const size_t cell = floor.cell(p);
        const uint8_t indoors = rays.visibility({.origin = p, .direction = {0, 1, 0}}) < 1 ? 1 : 0;
        if (chosen[cell] >= 0) {
            const float height = sensors[static_cast<size_t>(chosen[cell])].position.y;
            if (indoors < chosen_is_indoors[cell]) continue;
            if (indoors == chosen_is_indoors[cell] && p.y <= height) continue;
        }
        chosen[cell] = static_cast<int>(i);
        chosen_is_indoors[cell] = indoors;
    }
    return chosen;
}

}  // namespace

Plan plan_view(std::span<const Receiver> sensors, std::span<const Irradiance> values, float spacing,
               const RayScene& rays) {
    AG_ASSERT(!sensors.empty() && sensors.size() == values.size(), "one value per sensor");
    Box box;
    for (const Receiver& sensor : sensors) box.add(sensor.position);
    const Floor floor(box, spacing);
    const std::vector<int> chosen = chosen_sensors(floor, sensors, rays);

    const int side =
        std::clamp(kLongestSide / std::max(floor.columns, floor.rows), 1, kLargestCell);
    Plan plan{floor.columns * side, floor.rows * side, {}};
    plan.lux.reserve(static_cast<size_t>(plan.width) * static_cast<size_t>(plan.height));
    for (int y = 0; y < plan.height; ++y)
        for (int x = 0; x < plan.width; ++x) {
            const int sensor =
                chosen[static_cast<size_t>(y / side) * static_cast<size_t>(floor.columns) +
                       static_cast<size_t>(x / side)];
            plan.lux.push_back(sensor < 0 ? std::numeric_limits<float>::quiet_NaN()
                                          : luminance(values[static_cast<size_t>(sensor)].total()));
        }
    return plan;
}

}  // namespace aglow::cli
