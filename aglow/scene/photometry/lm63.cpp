// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/photometry/formats.h"
#include "aglow/scene/photometry/tokens.h"

#include <fmt/format.h>

namespace aglow::photometry {
namespace {

/// What stands before the numbers: the luminaire's name, and where the numbers begin.
struct Head {
    std::string name;
    std::string_view tilt;  ///< NONE, INCLUDE or a file's name
    std::string_view numbers;
};

Result<Head> read_head(std::string_view text) {
    Head head;
    for (const std::string_view line : split_lines(text)) {
        constexpr std::string_view kName = "[LUMINAIRE]";
        if (line.starts_with(kName) && line.size() > kName.size() && head.name.empty())
            head.name = line.substr(kName.size() + 1);
        if (!line.starts_with("TILT=")) continue;
        head.tilt = line.substr(5);
        const auto begin = static_cast<size_t>(line.data() + line.size() - text.data());
        head.numbers = text.substr(begin);
        return head;
    }
    return fail(Errc::malformed, "has no line TILT=");
}

/// TILT=INCLUDE: the lamp's position, then pairs of angle and factor.
Status skip_tilt(Numbers& numbers) {
    AG_CHECK(numbers.next("the lamp's position"));
    AG_TRY(const int pairs, numbers.next_count("the number of tilt angles", 0, kMostAngles));
    AG_CHECK(numbers.next_list(2 * static_cast<size_t>(pairs), "a tilt factor"));
    return {};
}

}  // namespace

Result<Photometry> read_lm63(std::string_view text) {
    AG_TRY(const Head head, read_head(text));
    Numbers numbers(head.numbers);
    if (head.tilt == "INCLUDE") {
        AG_CHECK(skip_tilt(numbers));
    }
    AG_CHECK(numbers.next_list(2, "the number of lamps or their flux"));
    AG_TRY(float factor, numbers.next("the candela multiplier"));
    AG_TRY(const int gammas, numbers.next_count("the number of vertical angles", 1, kMostAngles));
    AG_TRY(const int planes, numbers.next_count("the number of horizontal angles", 1, kMostAngles));
    AG_TRY(const int type, numbers.next_count("the photometric type", 1, 3));
    if (type != 1)
        return fail(Errc::unsupported, fmt::format("is photometry of type {}; type C is supported",
                                                   type == 2 ? 'B' : 'A'));
    AG_CHECK(numbers.next_list(4, "the unit or the size of the luminous opening"));
    AG_TRY(const float ballast, numbers.next("the ballast factor"));
    AG_CHECK(numbers.next_list(2, "the ballast-lamp factor or the input power"));
    factor *= ballast;
    if (!(factor >= 0)) return fail(Errc::malformed, "the factor of its intensities is negative");

    Photometry result;
    result.name = head.name;
    const auto columns = static_cast<size_t>(gammas), rows = static_cast<size_t>(planes);
    if (columns * rows > kMostValues) return fail(Errc::malformed, "has too many intensities");
    AG_TRY(result.gamma, numbers.next_list(columns, "a vertical angle"));
    AG_CHECK(check_angles(result.gamma, 0, 180, "vertical angle"));
    AG_TRY(result.c, numbers.next_list(rows, "a horizontal angle"));
    AG_CHECK(check_angles(result.c, 0, 360, "horizontal angle"));
    AG_TRY(result.candela, numbers.next_list(columns * rows, "an intensity"));
    for (float& candela : result.candela) candela *= factor;
    return complete_turn(std::move(result));
}

}  // namespace aglow::photometry
