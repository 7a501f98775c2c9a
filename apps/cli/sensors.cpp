// SPDX-License-Identifier: Apache-2.0
#include "sensors.h"

#include "aglow/core/assert.h"
#include "aglow/core/file.h"
#include "aglow/core/text.h"
#include "options.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace aglow::cli {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

Result<Receiver> parse_sensor(std::string_view line) {
    std::string compact;
    for (const char c : line)
        if (kBlanks.find(c) == std::string_view::npos) compact += c;
    const Result<std::vector<double>> numbers = parse_numbers(compact, 6);
    if (!numbers) return fail(Errc::malformed, numbers.error().message);
    const std::vector<double>& v = *numbers;
    const double length = std::hypot(v[3], v[4], v[5]);
    if (length == 0) return fail(Errc::malformed, "the normal has no length");
    const auto unit = [&](double part) { return static_cast<float>(part / length); };
    const vec3 position = {static_cast<float>(v[0]), static_cast<float>(v[1]),
                           static_cast<float>(v[2])};
    const vec3 normal = {unit(v[3]), unit(v[4]), unit(v[5])};
    if (!std::isfinite(position.x + position.y + position.z) ||
        !std::isfinite(normal.x + normal.y + normal.z))
        return fail(Errc::malformed, "a number is too large");
    return Receiver{position, normal, normal, 0};
}

}  // namespace

Result<std::vector<Receiver>> read_sensors(const std::filesystem::path& path) {
    AG_TRY(const std::vector<uint8_t> bytes, read_file(path));
    Result<std::vector<Receiver>> sensors =
        parse_sensors({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (sensors) return sensors;
    return fail(sensors.error().code, sensors.error().message, path.string());
}

Result<std::vector<Receiver>> parse_sensors(std::string_view text) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    std::vector<Receiver> sensors;
    for (size_t number = 1; !text.empty(); ++number) {
        const size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.empty() || line.front() == '#') continue;
        if (sensors.empty() && line.find_first_of("xX") != std::string_view::npos) continue;
        const Result<Receiver> sensor = parse_sensor(line);
        if (!sensor)
            return fail(Errc::malformed, fmt::format("line {}: {} (x,y,z,nx,ny,nz)", number,
                                                     sensor.error().message));
        sensors.push_back(*sensor);
    }
    if (sensors.empty()) return fail(Errc::malformed, "holds no sensor (x,y,z,nx,ny,nz)");
    return sensors;
}

std::string sensor_csv(std::span<const Receiver> sensors, std::span<const Irradiance> values) {
    AG_ASSERT(sensors.size() == values.size(), "one value per sensor");
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "x,y,z,nx,ny,nz,Er,Eg,Eb,E,direct,indirect\n");
    for (size_t i = 0; i < sensors.size(); ++i) {
        const vec3 p = sensors[i].position, n = sensors[i].normal, e = values[i].total();
        for (const float v : {p.x, p.y, p.z, n.x, n.y, n.z, e.x, e.y, e.z, luminance(e),
                              luminance(values[i].direct)})
            fmt::format_to(out, "{:.9g},", v);
        fmt::format_to(out, "{:.9g}\n", luminance(values[i].indirect));
    }
    return fmt::to_string(text);
}

}  // namespace aglow::cli
