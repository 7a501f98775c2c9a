// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/photometry.h"
#include "aglow/core/testing/scenes.h"

#include "aglow/core/file.h"
#include "aglow/core/random.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

using namespace aglow;

namespace {

constexpr double kDegree = kPi / 180;
using Distribution = std::function<double(double c, double gamma)>;  // degrees to candela

std::vector<double> steps(double from, double to, double step) {
    std::vector<double> angles;
    for (double a = from; a <= to + 1e-9; a += step) angles.push_back(a);
    return angles;
}

std::string table(const std::vector<double>& c, const std::vector<double>& gamma,
                  const Distribution& candela) {
    std::string out;
    for (const double plane : c)
        for (const double g : gamma) out += fmt::format("{}\r\n", candela(plane, g));
    return out;
}

std::string lm63(const std::vector<double>& c, const std::vector<double>& gamma,
                 const Distribution& candela, const std::string& before = "TILT=NONE\r\n1 -1 1") {
    return fmt::format(
               "IESNA:LM-63-2002\r\n[LUMINAIRE] test\r\n{} {} {} 1 2 0 0 0\r\n1.0 1.0 15\r\n",
               before, gamma.size(), c.size()) +
           fmt::format("{}\r\n{}\r\n", fmt::join(gamma, " "), fmt::join(c, "\r\n")) +
           table(c, gamma, candela);
}

/// `given` are the planes of the whole turn by `step` degrees whose intensities are told.
std::string eulumdat(int symmetry, double step, const std::vector<double>& given,
                     const std::vector<double>& gamma, const Distribution& candela) {
    const std::vector<double> turn = steps(0, 360 - step, step);
    std::string out = fmt::format("maker\n1\n{}\n{}\n{}\n{}\n0\nreport\ntest\n", symmetry,
                                  turn.size(), step, gamma.size());
    for (int i = 0; i < 14; ++i) out += "0\n";
    out += "1.0\n0\n1\n1\nlamp\n2000\n3000\n80\n20\n";  // candela per klm of 2000 lm
    for (int i = 0; i < 10; ++i) out += "0,5\n";
    out += fmt::format("{}\n{}\n", fmt::join(turn, "\n"), fmt::join(gamma, "\n"));
    return out + table(given, gamma, [&](double c, double g) { return candela(c, g) / 2; });
}

Result<Photometry> read(const std::string& text) {
    return read_photometry({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

vec3 direction(double c, double gamma) {
    return {static_cast<float>(std::sin(gamma * kDegree) * std::cos(c * kDegree)),
            static_cast<float>(std::sin(gamma * kDegree) * std::sin(c * kDegree)),
            static_cast<float>(-std::cos(gamma * kDegree))};
}

void check_same(const Photometry& a, const Photometry& b) {
    Pcg32 random(4);
    for (int i = 0; i < 300; ++i) {
        const vec3 d = direction(static_cast<double>(random.uniform()) * 360,
                                 static_cast<double>(random.uniform()) * 180);
        CHECK(intensity(a, d) == doctest::Approx(intensity(b, d)).epsilon(2e-4));
    }
}

}  // namespace

TEST_CASE("the flux of known distributions is their integral") {
    const auto even = read(lm63({0}, {0, 180}, [](double, double) { return 100; }));
    REQUIRE(even.has_value());
    CHECK(luminous_flux(*even) == doctest::Approx(400 * double(kPi)));
    const auto lambert = read(lm63({0}, steps(0, 90, 1), [](double, double gamma) {
        return 500 * std::cos(gamma * kDegree);
    }));
    REQUIRE(lambert.has_value());
    CHECK(lambert->name == "test");
    CHECK(luminous_flux(*lambert) == doctest::Approx(500 * double(kPi)).epsilon(1e-4));
    CHECK(intensity(*lambert, direction(77, 60)) == doctest::Approx(250));
    CHECK(intensity(*lambert, direction(10, 120)) == 0);
}

TEST_CASE("angles are those of EXT_lights_ies: aimed along -Z, C from +X to +Y") {
    const auto p = read(lm63(steps(0, 360, 90), {0, 90, 180}, [](double c, double gamma) {
        return gamma == 0 ? 1000 : gamma == 180 ? 2000 : 1 + std::fmod(c, 360);
    }));
    REQUIRE(p.has_value());
    CHECK(intensity(*p, {0, 0, -1}) == doctest::Approx(1000));
    CHECK(intensity(*p, {0, 0, 1}) == doctest::Approx(2000));
    CHECK(intensity(*p, {1, 0, 0}) == doctest::Approx(1));
    CHECK(intensity(*p, {0, 1, 0}) == doctest::Approx(91));
    CHECK(intensity(*p, {-1, 0, 0}) == doctest::Approx(181));
    CHECK(intensity(*p, {0, -1, 0}) == doctest::Approx(271));
    CHECK(intensity(*p, direction(45, 90)) == doctest::Approx(46));
    CHECK(intensity(*p, direction(90, 45)) == doctest::Approx((1000 + 91) / 2.0));
}

TEST_CASE("multiplier, ballast factor and a tilt section are understood") {
    std::string text = lm63(
        {0}, {0, 180}, [](double, double) { return 10; },
        "TILT=INCLUDE\n1\n3\n0 45 90\n1 .9 .8\n1 500 2.5");
    text.replace(text.find("1.0 1.0 15"), 10, "0.8 1.0 15");
    const auto p = read(text);
    REQUIRE(p.has_value());
    CHECK(intensity(*p, {0, 0, -1}) == doctest::Approx(20));
}

TEST_CASE("planes that symmetry leaves out are mirrored, in IES and EULUMDAT") {
    const std::vector<double> gamma = steps(0, 120, 10);
    // Symmetric about C0-C180 and C90-C270.
    const Distribution both = [](double c, double g) {
        return 100 + 30 * std::cos(2 * c * kDegree) * std::sin(g * kDegree);
    };
    const Photometry whole = *read(lm63(steps(0, 360, 15), gamma, both));
    check_same(whole, *read(lm63(steps(0, 90, 15), gamma, both)));
    check_same(whole, *read(lm63(steps(0, 180, 15), gamma, both)));
    check_same(whole, *read(lm63(steps(90, 270, 15), gamma, both)));
    check_same(whole, *read(lm63(steps(0, 345, 15), gamma, both)));
    check_same(whole, *read(eulumdat(0, 15, steps(0, 345, 15), gamma, both)));
    check_same(whole, *read(eulumdat(2, 15, steps(0, 180, 15), gamma, both)));
    check_same(whole, *read(eulumdat(3, 15, steps(270, 450, 15), gamma, both)));
    check_same(whole, *read(eulumdat(4, 15, steps(0, 90, 15), gamma, both)));

    // About C90-C270 alone, and about nothing.
    const Distribution one = [](double c, double g) {
        return 100 + 30 * std::sin(c * kDegree) * std::sin(g * kDegree);
    };
    const Photometry half = *read(lm63(steps(0, 360, 15), gamma, one));
    check_same(half, *read(lm63(steps(90, 270, 15), gamma, one)));
    check_same(half, *read(eulumdat(3, 15, steps(270, 450, 15), gamma, one)));
    const Distribution none = [&](double c, double g) { return one(c + 20, g); };
    check_same(*read(lm63(steps(0, 360, 15), gamma, none)),
               *read(eulumdat(0, 15, steps(0, 345, 15), gamma, none)));
    check_same(*read(lm63({0}, gamma, [](double, double g) { return g; })),
               *read(eulumdat(1, 15, {0}, gamma, [](double, double g) { return g; })));
}

TEST_CASE("a photometry written as LM-63 reads back the same") {
    const std::vector<double> gamma = steps(0, 90, 15);
    const Distribution turned = [](double c, double g) {
        return 100 + 30 * std::sin((c + 50) * kDegree) * std::sin(g * kDegree);
    };
    for (const std::string& text :
         {lm63(steps(0, 360, 30), gamma, turned), lm63(steps(90, 270, 30), gamma, turned),
          lm63({0}, gamma, turned), eulumdat(3, 30, steps(270, 450, 30), gamma, turned)}) {
        const auto p = read(text);
        REQUIRE(p.has_value());
        const auto again = read(to_lm63(*p));
        REQUIRE(again.has_value());
        CHECK(again->name == p->name);
        check_same(*p, *again);
        CHECK(luminous_flux(*again) == doctest::Approx(luminous_flux(*p)).epsilon(1e-5));
    }
}

TEST_CASE("what is wrong with a file is named") {
    const Distribution even = [](double, double) { return 1; };
    const auto message = [](const std::string& text) {
        const auto p = read(text);
        return p ? std::string("reads") : p.error().message;
    };
    CHECK(message("") == "a field of the head is missing");
    CHECK(message("IESNA:LM-63-2002\nnothing") == "has no line TILT=");
    CHECK(message(lm63({0}, {0, 90, 60}, even)) == "vertical angles do not ascend: 60 follows 90");
    CHECK(message(lm63({0}, {-90, 90}, even)) == "vertical angle -90 is not within 0..180 degrees");
    CHECK(message(lm63({0, 50}, {0, 90}, even)) ==
          "its horizontal angles go from 0 to 50 degrees, which no symmetry completes to a turn");
    CHECK(message(lm63({0}, {0, 90}, [](double, double) { return NAN; })) ==
          "an intensity is not a number: \"nan\"");
    std::string type_b = lm63({0}, {0, 90}, even);
    type_b.replace(type_b.find(" 2 1 1 2 "), 9, " 2 1 2 2 ");
    CHECK(message(type_b) == "is photometry of type B; type C is supported");
    CHECK(read(type_b).error().code == Errc::unsupported);
    CHECK(message(lm63({0}, {0, 90}, even, "TILT=NONE\n1 -1 1 1e9")) ==
          "the number of vertical angles is 1000000000, not an integer in 1..16384");
    CHECK(message(eulumdat(4, 36, {0}, {0, 90}, even)) == "10 C planes do not fit its symmetry 4");
}

TEST_CASE("files cut anywhere end in an error or read what is whole") {
    const Distribution even = [](double, double) { return 1; };
    for (const std::string& text : {lm63(steps(0, 90, 45), {0, 45, 90}, even),
                                    eulumdat(4, 45, steps(0, 90, 45), {0, 45, 90}, even)})
        for (size_t length = 0; length < text.size(); ++length) {
            const auto p = read(text.substr(0, length));
            if (!p) {
                CHECK(p.error().code == Errc::malformed);
                continue;
            }
            CHECK(length + 4 >= text.size());  // the last number's digits and the line's end
            CHECK(p->candela.size() == p->c.size() * p->gamma.size());
        }
}

TEST_CASE("published IES and EULUMDAT files load") {
    const std::filesystem::path folder = scenes_folder() / "photometry";
    if (!is_here(folder)) return;
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string();
        if (ending != ".ies" && ending != ".ldt") continue;
        const auto p = read_photometry(*read_file(entry.path()));
        INFO(entry.path().string());
        REQUIRE_MESSAGE(p.has_value(), p.error().message);
        CHECK(luminous_flux(*p) > 0);
        ++count;
    }
    CHECK(count == 34);
}
