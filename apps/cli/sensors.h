// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/transport/irradiance.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aglow::cli {

/// Sensors of a CSV file: x,y,z,nx,ny,nz in metres, one per line; a first line of names is
/// skipped, as are empty lines and those that start with #. Normals are made unit length.
/// Errors  unreadable; malformed (names the line): not six finite numbers, or a zero normal.
Result<std::vector<Receiver>> read_sensors(const std::filesystem::path& path);

/// The same from text.
Result<std::vector<Receiver>> parse_sensors(std::string_view text);

/// x,y,z,nx,ny,nz,Er,Eg,Eb,E,direct,indirect in metres and lux, one line per sensor below a line
/// of names, nine significant digits. E, direct and indirect are photopic: the luminance of their
/// triples.
/// Shapes  sensors and values have the same length.
std::string sensor_csv(std::span<const Receiver> sensors, std::span<const Irradiance> values);

}  // namespace aglow::cli
