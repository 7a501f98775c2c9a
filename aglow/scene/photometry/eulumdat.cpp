// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/photometry/formats.h"
#include "aglow/scene/photometry/tokens.h"

#include <fmt/format.h>

namespace aglow::photometry {
namespace {

/// The lines of the file, one field on each.
class Fields {
public:
    explicit Fields(std::string_view text) : lines_(split_lines(text)) {}

    Result<std::string_view> line(const char* what) {
        if (next_ == lines_.size())
            return fail(Errc::malformed, fmt::format("{} is missing", what));
        return lines_[next_++];
    }
    Result<float> number(const char* what) {
        AG_TRY(const std::string_view text, line(what));
        // Some writers put the decimal comma of their language.
        std::string point(text);
        for (char& c : point)
            if (c == ',') c = '.';
        return Numbers(point).next(what);
    }
    Result<int> count(const char* what, int least, int most) {
        AG_TRY(const std::string_view text, line(what));
        return Numbers(text).next_count(what, least, most);
    }
    Result<std::vector<float>> list(size_t size, const char* what) {
        std::vector<float> values;
        for (size_t i = 0; i < size; ++i) {
            AG_TRY(const float value, number(what));
            values.push_back(value);
        }
        return values;
    }
    Status skip(int fields) {
        for (int i = 0; i < fields; ++i) {
            AG_CHECK(line("a field of the head"));
        }
        return {};
    }

private:
    std::vector<std::string_view> lines_;
    size_t next_ = 0;
};

/// The flux of the lamps that the luminaire is measured with, lm: the first set.
Result<float> lamp_flux(Fields& fields) {
    AG_TRY(const int sets, fields.count("the number of lamp sets", 1, 64));
    float flux = 0;
    for (int set = 0; set < sets; ++set) {
        AG_CHECK(fields.skip(2));  // number of lamps (negative: absolute photometry), type
        AG_TRY(const float total, fields.number("the flux of the lamps"));
        if (set == 0) flux = total;
        AG_CHECK(fields.skip(3));  // colour temperature, colour rendering, power
    }
    return flux;
}

struct Range {
    int first, count;
};

/// The C planes, of `planes` evenly spaced ones, whose intensities are in the file.
Result<Range> given_planes(int symmetry, int planes) {
    const auto whole = [&](int parts) { return planes % parts == 0; };
    switch (symmetry) {
        case 0:
            return Range{0, planes};
        case 1:
            return Range{0, 1};
        case 2:
            if (whole(2)) return Range{0, planes / 2 + 1};
            break;
        case 3:
            if (whole(4)) return Range{3 * planes / 4, planes / 2 + 1};
            break;
        default:
            if (whole(4)) return Range{0, planes / 4 + 1};
    }
    return fail(Errc::malformed,
                fmt::format("{} C planes do not fit its symmetry {}", planes, symmetry));
}

}  // namespace

Result<Photometry> read_eulumdat(std::string_view text) {
    Fields fields(text);
    AG_CHECK(fields.skip(2));  // company, type
    AG_TRY(const int symmetry, fields.count("the symmetry", 0, 4));
    AG_TRY(const int planes, fields.count("the number of C planes", 1, 721));
    AG_CHECK(fields.skip(1));
    AG_TRY(const int gammas, fields.count("the number of gamma angles", 1, 361));
    AG_CHECK(fields.skip(2));  // their distance, report number
    Photometry result;
    AG_TRY(result.name, fields.line("the luminaire's name"));
    AG_CHECK(fields.skip(14));  // number, file, date, eleven sizes and ratios up to the factor
    AG_TRY(const float factor, fields.number("the factor of intensities"));
    AG_CHECK(fields.skip(1));  // tilt when measured
    AG_TRY(const float flux, lamp_flux(fields));
    AG_CHECK(fields.skip(10));  // direct ratios
    const float candela_per_unit = flux / 1000 * (factor > 0 ? factor : 1);
    if (!(candela_per_unit >= 0)) return fail(Errc::malformed, "the flux of its lamps is negative");

    AG_TRY(const Range given, given_planes(symmetry, planes));
    AG_TRY(const std::vector<float> turn, fields.list(static_cast<size_t>(planes), "a C angle"));
    AG_CHECK(check_angles(turn, 0, 360, "C angle"));
    AG_TRY(result.gamma, fields.list(static_cast<size_t>(gammas), "a gamma angle"));
    AG_CHECK(check_angles(result.gamma, 0, 180, "gamma angle"));
    // From C270 over C0 to C90, and mirrored: turned by a quarter, so that it starts at a plane
    // of symmetry like the others.
    for (int i = 0; i < given.count; ++i) {
        const auto k = static_cast<size_t>((given.first + i) % planes);
        const float lap = given.first + i >= planes ? 360.0f : 0.0f;
        result.c.push_back(turn[k] + lap);
    }
    const size_t values = result.c.size() * result.gamma.size();
    AG_TRY(result.candela, fields.list(values, "an intensity"));
    for (float& candela : result.candela) candela *= candela_per_unit;
    return complete_turn(std::move(result));
}

}  // namespace aglow::photometry
