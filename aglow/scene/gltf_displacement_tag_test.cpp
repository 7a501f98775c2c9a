// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/displacement_tag.h"
#include "aglow/scene/gltf/test_files.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::gltf_test;

namespace {

/// A primitive of two sets of texture coordinates with `extras`.
ExtrasRead read(const std::string& extras) {
    Primitive primitive;
    primitive.texcoords.resize(2);
    return read_extras(gltf::read_displacement_tag, extras, std::move(primitive));
}

}  // namespace

TEST_CASE("heights are those that extras name; all but the file has a default") {
    const ExtrasRead full = read(
        R"({"displacement": {"uri": "maps/a%20b.exr", "texCoord": 1, "scale": 2.5, "bias": -1}})");
    CHECK(full.warnings.empty());
    REQUIRE(full.primitive.displacement);
    CHECK(*full.primitive.displacement == DisplacementRef{"maps/a b.exr", 1, 2.5f, -1});
    const ExtrasRead least = read(R"({"displacement": {"uri": "h.png"}})");
    REQUIRE(least.primitive.displacement);
    CHECK(*least.primitive.displacement == DisplacementRef{"h.png", 0, 1, 0});
}

TEST_CASE("extras of other programs are not touched") {
    for (const char* extras : {"null", "[1]", "\"displacement\"", "{}", R"({"displace": 1})"}) {
        const ExtrasRead tagged = read(extras);
        CHECK(tagged.warnings.empty());
        CHECK_FALSE(tagged.primitive.displacement);
    }
}

TEST_CASE("what does not follow the format, or leaves the folder, is left out with one warning") {
    for (const char* value :
         {"1", "[]", "{}", R"({"uri": 3})", R"({"uri": ""})", R"({"uri": "../h.exr"})",
          R"({"uri": "/h.exr"})", R"({"uri": "http://a.b/h.exr"})",
          R"({"uri": "h.exr", "texCoord": 2})", R"({"uri": "h.exr", "texCoord": -1})",
          R"({"uri": "h.exr", "scale": "1"})", R"({"uri": "h.exr", "bias": 1e99})"}) {
        CAPTURE(value);
        const ExtrasRead tagged = read(std::string(R"({"displacement": )") + value + "}");
        CHECK_FALSE(tagged.primitive.displacement);
        REQUIRE(tagged.warnings.size() == 1);
        CHECK(tagged.warnings[0].starts_with("mesh 2 primitive 1"));
        CHECK(tagged.warnings[0].ends_with("the displacement is left out"));
    }
}
