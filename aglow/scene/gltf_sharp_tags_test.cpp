// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/sharp_tags.h"
#include "aglow/scene/gltf/test_files.h"
#include "aglow/scene/gltf/triangles.h"

#include <doctest/doctest.h>

using namespace aglow;
using namespace aglow::gltf_test;

namespace {

/// Four vertices and two triangles with `extras`.
ExtrasRead read(const std::string& extras) {
    Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    primitive.triangles = {{0, 1, 2}, {2, 1, 3}};
    return read_extras(gltf::read_sharp_tags, extras, std::move(primitive));
}

}  // namespace

TEST_CASE("creases and corners of extras are read; without a sharpness they stay for ever") {
    const ExtrasRead tagged =
        read(R"({"creases": [[0, 1, 2.5], [3.0, 2]], "corners": [[1], [2, 0], [3, 1e300]]})");
    CHECK(tagged.warnings.empty());
    CHECK(tagged.primitive.creases == std::vector<SharpEdge>{{0, 1, 2.5f}, {3, 2, 10}});
    REQUIRE(tagged.primitive.corners.size() == 3);
    CHECK(tagged.primitive.corners[0] == SharpVertex{1, 10});
    CHECK(tagged.primitive.corners[1] == SharpVertex{2, 0});
    CHECK(tagged.primitive.corners[2].sharpness > 1e38f);
}

TEST_CASE("extras of other programs are not touched") {
    for (const char* extras : {"null", "[1, 2]", "\"creases\"", "{}", R"({"crease": [[0, 1]]})"}) {
        const ExtrasRead tagged = read(extras);
        CHECK(tagged.warnings.empty());
        CHECK(tagged.primitive.creases.empty());
    }
}

TEST_CASE(
    "entries that are no crease are left out, with one that says why and how many there are") {
    for (const char* entry : {"[0]", "[0, 1, 2, 3]", "[0, 4]", "[0, -1]", "[0, 0.5]", "[0, 1, -1]",
                              "[0, \"1\"]", "7", "{\"a\": 0}", "[0, 1e99]", "[]", "null"}) {
        CAPTURE(entry);
        const ExtrasRead tagged =
            read(std::string(R"({"creases": [[1, 2, 3], )") + entry + ", " + entry + "]}");
        CHECK(tagged.primitive.creases == std::vector<SharpEdge>{{1, 2, 3}});
        REQUIRE(tagged.warnings.size() == 2);
        CHECK(tagged.warnings[0].starts_with("mesh 2 primitive 1: extras.creases: entry 1"));
        CHECK(tagged.warnings[1] ==
              "mesh 2 primitive 1: extras.creases: 2 of 3 entries are left out");
    }
    CHECK(read(R"({"creases": [[0, 4]]})").warnings[0] ==
          "mesh 2 primitive 1: extras.creases: entry 0: vertex 4 does not exist");
    CHECK(read(R"({"corners": [[0, -2]]})").warnings[0] ==
          "mesh 2 primitive 1: extras.corners: entry 0 has the sharpness -2");
    CHECK(read(R"({"corners": true})").warnings ==
          std::vector<std::string>{"mesh 2 primitive 1: corners must be an array"});
}

TEST_CASE("tags of vertices that flat shading splits are those of one of the copies") {
    Primitive p = read(R"({"creases": [[0, 1, 3]], "corners": [[3, 2], [1, 1]]})").primitive;
    const std::vector<vec3> positions = p.positions;
    p.positions.push_back({5, 5, 5});  // of no triangle
    p.creases.push_back({0, 4, 1});
    p.corners.push_back({4, 1});
    gltf::make_flat(p);
    REQUIRE(p.creases.size() == 1);
    CHECK(p.positions[p.creases[0].a] == positions[0]);
    CHECK(p.positions[p.creases[0].b] == positions[1]);
    CHECK(p.creases[0].sharpness == 3);
    REQUIRE(p.corners.size() == 2);
    CHECK(p.positions[p.corners[0].vertex] == positions[3]);
    CHECK(p.positions[p.corners[1].vertex] == positions[1]);
}
