// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/photometry.h"

#include "aglow/scene/photometry/formats.h"
#include "aglow/shared/light.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace aglow {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

/// Where an angle lies between measured ones: the lower of the two, and how far to the next.
struct Place {
    size_t below;
    float share;
};

/// `angle` is within the first and the last.
Place place_of(const std::vector<float>& angles, float angle) {
    if (angles.size() == 1) return {0, 0};
    const auto above = std::upper_bound(angles.begin(), angles.end() - 1, angle);
    const auto i = static_cast<size_t>(std::max<std::ptrdiff_t>(1, above - angles.begin()));
    return {i - 1, std::clamp((angle - angles[i - 1]) / (angles[i] - angles[i - 1]), 0.0f, 1.0f)};
}

/// Bilinear intensity at measured gamma number `g` and any C within a turn from the first.
float along_c(const Photometry& p, size_t g, const Place& c) {
    const size_t row = p.gamma.size();
    const float a = p.candela[c.below * row + g];
    return c.share == 0 ? a : a + (p.candela[(c.below + 1) * row + g] - a) * c.share;
}

/// `c` by whole turns into [first, first + 360].
float into_turn(const std::vector<float>& angles, float c) {
    const float first = angles.front();
    while (c < first) c += 360;
    while (c > first + 360) c -= 360;
    return c;
}

/// Integral of sin(g) times the line from (g0, a) to (g1, b), angles in degrees.
double weighted_line(double g0, double g1, double a, double b) {
    const double from = g0 * kDegree, to = g1 * kDegree, slope = (b - a) / (to - from);
    return a * std::cos(from) - b * std::cos(to) + slope * (std::sin(to) - std::sin(from));
}

}  // namespace

Result<Photometry> read_photometry(std::span<const uint8_t> file) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    if (text.find('\0') != std::string_view::npos)
        return fail(Errc::malformed, "is neither an IES nor an EULUMDAT file");
    const bool lm63 = text.starts_with("IES") || text.find("TILT=") != std::string_view::npos;
    return lm63 ? photometry::read_lm63(text) : photometry::read_eulumdat(text);
}

float intensity(const Photometry& photometry, vec3 direction) {
    const auto [gamma, turned] = shared::photometric_angles(direction);
    if (gamma < photometry.gamma.front() || gamma > photometry.gamma.back()) return 0;
    const Place c = place_of(photometry.c, into_turn(photometry.c, turned));
    const Place g = place_of(photometry.gamma, gamma);
    const float a = along_c(photometry, g.below, c);
    return g.share == 0 ? a : a + (along_c(photometry, g.below + 1, c) - a) * g.share;
}

double luminous_flux(const Photometry& p) {
    // The mean over C of each gamma, then along gamma.
    std::vector<double> mean(p.gamma.size(), 0.0);
    for (size_t g = 0; g < mean.size(); ++g) {
        if (p.c.size() == 1) mean[g] = static_cast<double>(p.candela[g]);
        for (size_t k = 0; k + 1 < p.c.size(); ++k)
            mean[g] += static_cast<double>(p.c[k + 1] - p.c[k]) / 720 *
                       (static_cast<double>(p.candela[k * mean.size() + g]) +
                        static_cast<double>(p.candela[(k + 1) * mean.size() + g]));
    }
    double flux = 0;
    for (size_t g = 0; g + 1 < mean.size(); ++g)
        flux += weighted_line(static_cast<double>(p.gamma[g]), static_cast<double>(p.gamma[g + 1]),
                              mean[g], mean[g + 1]);
    return flux * 360 * kDegree;
}

std::string to_lm63(const Photometry& p) {
    std::vector<float> turn;
    if (p.c.size() > 1) turn = {0, 360};
    for (const float c : p.c) turn.push_back(c < 360 ? c : c - 360);
    std::sort(turn.begin(), turn.end());
    turn.erase(std::unique(turn.begin(), turn.end()), turn.end());
    std::string name;
    for (const char c : p.name.substr(0, 200))
        if (static_cast<unsigned char>(c) >= ' ') name += c;

    std::string out = fmt::format(
        "IESNA:LM-63-2002\r\n[TEST] none\r\n[TESTLAB] none\r\n[ISSUEDATE] none\r\n"
        "[MANUFAC] none\r\n[LUMINAIRE] {}\r\nTILT=NONE\r\n1 -1 1 {} {} 1 2 0 0 0\r\n1 1 0\r\n",
        name, p.gamma.size(), turn.size());
    out += fmt::format("{}\r\n{}\r\n", fmt::join(p.gamma, "\r\n"), fmt::join(turn, "\r\n"));
    for (const float c : turn) {
        const Place place = place_of(p.c, into_turn(p.c, c));
        for (size_t g = 0; g < p.gamma.size(); ++g)
            out += fmt::format("{}\r\n", along_c(p, g, place));
    }
    return out;
}

namespace photometry {

Result<Photometry> complete_turn(Photometry planes) {
    std::vector<float>& c = planes.c;
    const size_t row = planes.gamma.size();
    if (c.size() == 1) {
        c = {0};
        return planes;
    }
    constexpr float kTolerance = 0.01f;  // of what writers round
    const auto spans = [&](float degrees) {
        return std::abs(c.back() - c.front() - degrees) < kTolerance;
    };
    // Mirrored at the last plane, a quarter of the turn becomes a half and a half the whole.
    while (spans(90) || spans(180)) {
        const float mirror = 2 * c.back();
        for (size_t i = c.size() - 1; i-- > 0;) {
            c.push_back(mirror - c[i]);
            for (size_t g = 0; g < row; ++g) planes.candela.push_back(planes.candela[i * row + g]);
        }
    }
    const float last = c.front() + 360;
    if (c.back() - c.front() > 180 && last - c.back() >= kTolerance) {
        c.push_back(last);
        for (size_t g = 0; g < row; ++g) planes.candela.push_back(planes.candela[g]);
    }
    if (!spans(360))
        return fail(Errc::malformed, fmt::format("its horizontal angles go from {} to {} degrees, "
                                                 "which no symmetry completes to a turn",
                                                 c.front(), c.back()));
    c.back() = last;
    return planes;
}

}  // namespace photometry

}  // namespace aglow
