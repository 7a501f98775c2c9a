// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/photometry/tokens.h"

#include "aglow/core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace aglow::photometry {
namespace {

constexpr std::string_view kSeparators = " \t\r\n\v\f,";

}  // namespace

std::vector<std::string_view> split_lines(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const size_t end = std::min(text.find_first_of("\r\n"), text.size());
        lines.push_back(trimmed(text.substr(0, end)));
        text.remove_prefix(end);
        if (text.starts_with("\r\n"))
            text.remove_prefix(2);
        else if (!text.empty())
            text.remove_prefix(1);
    }
    return lines;
}

Result<float> Numbers::next(const char* what) {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kSeparators), rest_.size()));
    const std::string_view word =
        rest_.substr(0, std::min(rest_.find_first_of(kSeparators), rest_.size()));
    rest_.remove_prefix(word.size());
    if (word.empty()) return fail(Errc::malformed, fmt::format("{} is missing", what));
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    float value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value))
        return fail(Errc::malformed,
                    fmt::format("{} is not a number: \"{}\"", what, word.substr(0, 20)));
    return value;
}

Result<int> Numbers::next_count(const char* what, int least, int most) {
    AG_TRY(const float value, next(what));
    if (!(value >= static_cast<float>(least) && value <= static_cast<float>(most)) ||
        value != std::floor(value))
        return fail(Errc::malformed,
                    fmt::format("{} is {}, not an integer in {}..{}", what, value, least, most));
    return static_cast<int>(value);
}

Result<std::vector<float>> Numbers::next_list(size_t count, const char* what) {
    std::vector<float> values;
    values.reserve(std::min(count, rest_.size()));
    for (size_t i = 0; i < count; ++i) {
        AG_TRY(const float value, next(what));
        values.push_back(value);
    }
    return values;
}

Status check_angles(const std::vector<float>& angles, float least, float most, const char* what) {
    for (size_t i = 0; i < angles.size(); ++i) {
        if (!(angles[i] >= least && angles[i] <= most))
            return fail(Errc::malformed, fmt::format("{} {} is not within {}..{} degrees", what,
                                                     angles[i], least, most));
        if (i > 0 && !(angles[i] > angles[i - 1]))
            return fail(Errc::malformed, fmt::format("{}s do not ascend: {} follows {}", what,
                                                     angles[i], angles[i - 1]));
    }
    return {};
}

}  // namespace aglow::photometry
