// SPDX-License-Identifier: Apache-2.0
#include "sensors.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <string>

using namespace aglow;
using namespace aglow::cli;

namespace {

const std::string kTwoSensors =
    "x,y,z,nx,ny,nz\n"
    "1,2.5,-3,0,2,0\n"
    "\n"
    "# by the window\n"
    "0.1, 0.2, 0.3, 3, 0, 4\n";

}  // namespace

TEST_CASE("sensors are read line by line, normals made unit length") {
    const auto sensors = parse_sensors(kTwoSensors);
    REQUIRE(sensors.has_value());
    REQUIRE(sensors->size() == 2);
    CHECK((*sensors)[0].position == vec3{1, 2.5f, -3});
    CHECK((*sensors)[0].normal == vec3{0, 1, 0});
    CHECK((*sensors)[1].normal == vec3{0.6f, 0, 0.8f});
    CHECK((*sensors)[1].geometric_normal == vec3{0.6f, 0, 0.8f});
}

TEST_CASE("an error names the line") {
    for (const char* line : {"1,2,3,0,1", "1,2,3,0,1,0,5", "1,2,3,0,0,0", "a,2,3,0,1,0",
                             "1e60,2,3,0,1,0", "nan,2,3,0,1,0"}) {
        CAPTURE(line);
        const auto sensors = parse_sensors(kTwoSensors + line + "\n");
        REQUIRE_FALSE(sensors.has_value());
        CHECK(sensors.error().code == Errc::malformed);
        CHECK(sensors.error().message.find("line 6") != std::string::npos);
    }
}

TEST_CASE("a file cut at any length is read or refused, never misread as more sensors") {
    for (size_t length = 0; length <= kTwoSensors.size(); ++length) {
        const auto sensors = parse_sensors(std::string_view(kTwoSensors).substr(0, length));
        if (sensors) CHECK(sensors->size() <= 2);
    }
}

TEST_CASE("what is written in nine digits reads back as the same bits") {
    rc::check([](float x, float y, float z) {
        const Receiver sensor{{x, y, z}, {0, 1, 0}, {0, 1, 0}, 0};
        const Irradiance value{{x, y, z}, {0, 0, 0}};
        const std::string csv = sensor_csv({&sensor, 1}, {&value, 1});
        std::string line = csv.substr(csv.find('\n') + 1);
        for (int column = 0; column < 6; ++column) line.erase(line.rfind(','));
        const auto back = parse_sensors(line);
        RC_ASSERT(back.has_value());
        RC_ASSERT((*back)[0].position == (vec3{x, y, z}));
    });
}

TEST_CASE("E is the sum of direct and indirect, weighted as luminance") {
    const Receiver sensor{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 0};
    const Irradiance value{{10, 20, 30}, {1, 2, 3}};
    const std::string csv = sensor_csv({&sensor, 1}, {&value, 1});
    // 0.2126 * 11 + 0.7152 * 22 + 0.0722 * 33 = 20.4556, of which 10/11 is direct.
    CHECK(csv.find("\n0,0,0,0,0,1,11,22,33,20.45") != std::string::npos);
    CHECK(csv.find(",18.59") != std::string::npos);
    CHECK(csv.find(",1.859") != std::string::npos);
}
