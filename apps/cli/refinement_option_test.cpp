// SPDX-License-Identifier: Apache-2.0
#include "refinement_option.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::cli;

TEST_CASE("a refinement is a kind and its level, or auto and pixels") {
    using Kind = Refinement::Kind;
    CHECK(parse_refinement("none")->kind == Kind::none);
    const auto curved = parse_refinement("pn:7");
    REQUIRE(curved);
    CHECK(curved->kind == Kind::pn);
    CHECK(curved->level == 7);
    CHECK(parse_refinement("st:0")->kind == Kind::tagged);
    CHECK(parse_refinement("loop:2")->kind == Kind::loop);
    CHECK(parse_refinement("catmull-clark:1")->kind == Kind::catmull_clark);
    CHECK(parse_refinement("auto")->tolerance == Refinement{}.tolerance);
    const auto automatic = parse_refinement("auto:0.25");
    REQUIRE(automatic);
    CHECK(automatic->kind == Kind::automatic);
    CHECK(automatic->tolerance == 0.25f);
    for (const char* wrong :
         {"", "pn", "pn:", "pn:8", "pn:-1", "pn:1.5", "catmull-clark:0", "loop:x", "none:1",
          "auto:", "auto:0", "auto:0.009", "auto:1001", "butterfly:2", ":2"}) {
        CAPTURE(wrong);
        CHECK_FALSE(parse_refinement(wrong));
    }
}
