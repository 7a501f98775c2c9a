// SPDX-License-Identifier: Apache-2.0
#include "frame_range.h"

#include <doctest/doctest.h>

using namespace aglow::cli;

TEST_CASE("frames are a first and a last one") {
    const auto range = parse_frames("3:120");
    REQUIRE(range);
    CHECK(range->first == 3);
    CHECK(range->last == 120);
    CHECK(parse_frames("7:7")->last == 7);
    for (const char* wrong : {"", "3", ":", "3:", ":3", "5:3", "-1:3", "1.5:3", "1:2:3", "a:b"}) {
        CAPTURE(wrong);
        CHECK_FALSE(parse_frames(wrong));
    }
}

TEST_CASE("numbers of frames stand before the ending") {
    CHECK(numbered("out.png", 0) == "out-0000.png");
    CHECK(numbered("a.b/shot.v2.exr", 12) == "a.b/shot.v2-0012.exr");
    CHECK(numbered("out.png", 123456) == "out-123456.png");
}
