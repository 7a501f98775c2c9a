// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/edge_detail.h"

#include "aglow/refine/testing/patch_meshes.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

constexpr int kSize = 512;

HeightMap map_of(const std::function<float(float, float)>& height) {
    std::vector<float> heights;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            heights.push_back(height((static_cast<float>(x) + 0.5f) / kSize,
                                     (static_cast<float>(y) + 0.5f) / kSize));
    return make_height_map(heights, kSize, kSize);
}

/// One triangle, over a part of the map with 128 texels to two of its edges.
PatchMesh corner() {
    PatchMesh mesh;
    mesh.topology = topology_of({{0, 3}, {0, 1, 2}, 3});
    mesh.uvs = {{0.25f, 0.25f}, {0.5f, 0.25f}, {0.25f, 0.5f}};
    return mesh;
}

EdgeDetail detail_of(const HeightMap& map, float scale) {
    const PatchMesh mesh = corner();
    const std::array sources = {DetailSource{}, DetailSource{&map, scale}};
    const std::vector<EdgeDetail> details =
        edge_details(mesh.topology, mesh.uvs, std::array{1u, 1u, 1u}, sources);
    CHECK(details[0] == details[1]);
    CHECK(details[0] == details[2]);
    return details[0];
}

TEST_CASE("a slope is shown by the corners alone") {
    const EdgeDetail detail = detail_of(map_of([](float x, float y) { return 3 * x - y; }), 1);
    for (const float error : detail) CHECK(error < 1e-5f);
}

TEST_CASE("a parabola is off by what it bends between vertices, whose mean a texel is") {
    const EdgeDetail detail = detail_of(map_of([](float x, float) { return x * x; }), 100);
    for (size_t k = 2; k < 5; ++k) {  // coarser texels mix in what lies about
        const double step = 0.25 / static_cast<double>(1u << k);
        // Texels that are as wide as the step lie by step^2 / 12 too high.
        const double between = 100 * step * step / 4, at_vertices = 100 * step * step / 12;
        CHECK(static_cast<double>(detail[k]) ==
              doctest::Approx(between + at_vertices).epsilon(0.2));
    }
}

TEST_CASE("errors fall as vertices come closer, and scale with the heights") {
    Pcg32 random(5);
    std::vector<float> noise;
    for (int i = 0; i < kSize * kSize; ++i) noise.push_back(random.uniform());
    const HeightMap map = make_height_map(noise, kSize, kSize);
    const EdgeDetail one = detail_of(map, 1), five = detail_of(map, 5);
    CHECK(one[0] > 0.3f);
    for (size_t k = 0; k + 1 < one.size(); ++k) CHECK(one[k] >= one[k + 1]);
    for (size_t k = 0; k < one.size(); ++k)
        CHECK(five[k] == doctest::Approx(5 * double(one[k])).epsilon(1e-5));
}

TEST_CASE("what nothing displaces has no detail and no texels; edges know their length in them") {
    const PatchMesh mesh = corner();
    const HeightMap map = map_of([](float x, float) { return x * x; });
    const std::array sources = {DetailSource{}, DetailSource{&map, 1}};
    const std::array none = {0u, 0u, 0u}, all = {1u, 1u, 1u};
    for (const EdgeDetail& detail : edge_details(mesh.topology, mesh.uvs, none, sources))
        CHECK(detail == EdgeDetail{});
    for (const float texels : edge_texels(mesh.topology, mesh.uvs, none, sources))
        CHECK(texels == 0);
    const std::vector<float> texels = edge_texels(mesh.topology, mesh.uvs, all, sources);
    for (uint32_t i = 0; i < 3; ++i)
        CHECK(texels[mesh.topology.edge[i]] ==
              doctest::Approx(i == 1 ? 128 * std::sqrt(2.0) : 128.0));
}

}  // namespace
