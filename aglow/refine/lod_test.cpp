// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/lod.h"

#include "aglow/refine/testing/patch_meshes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace aglow;
using namespace aglow::refine::testing;

namespace {

struct Curved {
    PatchMesh mesh;
    PatchControl control;
};

Curved curved(PatchMesh mesh) {
    Curved r{std::move(mesh), {}};
    demand(Patches::create(r.mesh.topology, {})).update(r.mesh.input(), r.control);
    return r;
}

Viewpoint eye_at(vec3 position) {
    Viewpoint view;
    view.position = position;
    view.pixels_per_metre = 1000;
    return view;
}

uint64_t triangles_of(const Curved& c, const LevelOfDetail::Choice& choice,
                      Tessellation::Levels kind) {
    return demand(Tessellation::adaptive(c.mesh.topology, choice.levels, kind)).triangles.size();
}

/// The largest distance between an edge's cubic and what its segments make of it, m.
double deviation(const Curved& c, uint32_t edge, float level) {
    const Topology& topology = c.mesh.topology;
    const uint32_t h = topology.edge_half[edge];
    const uint32_t v = topology.vertex[h], w = topology.end(h);
    const vec3 a = c.control.positions[std::min(v, w)], b = c.control.positions[std::max(v, w)];
    const auto at = [&](float t) {
        const float s = 1 - t;
        return a * (s * s * s) + c.control.edges[edge].first * (3 * s * s * t) +
               c.control.edges[edge].second * (3 * s * t * t) + b * (t * t * t);
    };
    const int segments = static_cast<int>(std::ceil(level));
    double worst = 0;
    for (int i = 0; i < segments; ++i) {
        const vec3 p = at(static_cast<float>(i) / static_cast<float>(segments));
        const vec3 q = at(static_cast<float>(i + 1) / static_cast<float>(segments));
        const vec3 along = normalize(q - p);
        for (int k = 1; k < 16; ++k) {
            const vec3 d = at((static_cast<float>(i) + static_cast<float>(k) / 16) /
                              static_cast<float>(segments)) -
                           p;
            worst = std::max(worst, double(length(d - along * dot(d, along))));
        }
    }
    return worst;
}

TEST_CASE("edges are within the tolerance of the curves, and not much finer than that takes") {
    const Curved ball = curved(sphere(2));
    for (const float tolerance : {0.1f, 0.5f, 4.0f}) {
        LodOptions options;
        options.tolerance = tolerance;
        options.silhouette = 1;
        const vec3 eye = {0, 0, 5};
        const LevelOfDetail::Choice choice =
            LevelOfDetail(options).choose(ball.mesh.topology, ball.control, eye_at(eye));
        CHECK(choice.tolerance == tolerance);
        for (uint32_t e = 0; e < ball.mesh.topology.edge_count(); ++e) {
            const uint32_t h = ball.mesh.topology.edge_half[e];
            const vec3 a = ball.mesh.positions[ball.mesh.topology.vertex[h]],
                       b = ball.mesh.positions[ball.mesh.topology.end(h)];
            const double nearest = std::min(length(a - eye), length(b - eye));
            CHECK(deviation(ball, e, choice.levels[e]) * 1000 / nearest < 1.01 * double(tolerance));
            const double coarser = choice.levels[e] - 1.0f;
            if (coarser >= 2)
                CHECK(deviation(ball, e, float(coarser)) * 1000 / nearest >
                      0.4 * double(tolerance));
        }
    }
}

TEST_CASE("triangles are counted as they will be") {
    const Curved sheet = curved(random_sheet(5, 6, 5, 0.5f));
    const Topology& topology = sheet.mesh.topology;
    for (const auto kind : {Tessellation::Levels::discrete, Tessellation::Levels::continuous})
        for (uint64_t seed = 0; seed < 5; ++seed) {
            const std::vector<float> levels = random_levels(topology, seed, 20, false);
            CHECK(triangle_count(topology, levels, kind) ==
                  demand(Tessellation::adaptive(topology, levels, kind)).triangles.size());
        }
}

TEST_CASE("a budget is kept, and used") {
    const Curved ball = curved(sphere(3));
    for (const auto kind : {Tessellation::Levels::discrete, Tessellation::Levels::continuous})
        for (const uint64_t budget : {100u, 1000u, 20000u, 300000u}) {
            LodOptions options;
            options.tolerance = 1e-5f;
            options.budget = budget;
            options.levels = kind;
            LevelOfDetail lod(options);
            for (const float distance : {3.0f, 2.9f, 10.0f, 1.2f}) {
                const LevelOfDetail::Choice choice = lod.choose(
                    ball.mesh.topology, ball.control, eye_at({0, distance * 0.6f, distance}));
                CHECK(choice.triangles == triangles_of(ball, choice, kind));
                CHECK(choice.triangles <= budget);
                CHECK(choice.tolerance > options.tolerance);
                if (budget >= 1000 && kind == Tessellation::Levels::discrete)
                    CHECK(choice.triangles > budget / 2);
            }
        }
}

TEST_CASE("a budget that nothing fits leaves the coarse mesh") {
    const Curved ball = curved(sphere(3));
    LodOptions options;
    options.budget = 10;
    const LevelOfDetail::Choice choice =
        LevelOfDetail(options).choose(ball.mesh.topology, ball.control, eye_at({0, 0, 2}));
    CHECK(choice.triangles == ball.mesh.topology.face_count());
}

TEST_CASE("what is nearer is finer") {
    const Curved ball = curved(sphere(2));
    uint64_t last = 0;
    for (const float distance : {100.0f, 30.0f, 10.0f, 3.0f, 1.5f}) {
        const LevelOfDetail::Choice choice = LevelOfDetail({}).choose(
            ball.mesh.topology, ball.control, eye_at({distance, 0.1f, 0.2f}));
        CHECK(choice.triangles > last);
        last = choice.triangles;
    }
}

TEST_CASE("an orthographic view sees the same from everywhere") {
    const Curved ball = curved(sphere(2));
    Viewpoint view;
    view.perspective = false;
    view.pixels_per_metre = 200;
    view.direction = {1, 0, 0};
    const auto levels = [&](vec3 position) {
        view.position = position;
        return LevelOfDetail({}).choose(ball.mesh.topology, ball.control, view).levels;
    };
    CHECK(levels({0, 0, 0}) == levels({50, 3, 9}));
}

TEST_CASE("the outline is finer than the rest, and what faces away is coarser") {
    const Curved ball = curved(sphere(8));
    const auto levels = [&](float silhouette) {
        LodOptions options;
        options.silhouette = silhouette;
        options.levels = Tessellation::Levels::continuous;
        return LevelOfDetail(options)
            .choose(ball.mesh.topology, ball.control, eye_at({0, 0, 1.1f}))
            .levels;
    };
    const std::vector<float> alike = levels(1), preferred = levels(4);
    int seen[3] = {0, 0, 0};
    for (uint32_t e = 0; e < ball.mesh.topology.edge_count(); ++e) {
        const uint32_t h = ball.mesh.topology.edge_half[e];
        const vec3 ends[2] = {ball.mesh.positions[ball.mesh.topology.vertex[h]],
                              ball.mesh.positions[ball.mesh.topology.end(h)]};
        double sines[2];
        for (int i = 0; i < 2; ++i)
            sines[i] = double(dot(normalize(vec3{0, 0, 1.1f} - ends[i]), ends[i]));
        if (alike[e] < 2) continue;  // cannot be made coarser by half
        const double ratio = double(preferred[e] / alike[e]);
        const auto [low, high] = std::minmax(sines[0], sines[1]);
        const int where = low > 0.36 ? 0 : high < -0.36 ? 2 : 1;
        ++seen[where];
        if (low > 0.36) CHECK(ratio == doctest::Approx(1));
        if (high < -0.36) CHECK(ratio == doctest::Approx(0.5));
        if (low < 0.34 && high > -0.34) CHECK(ratio == doctest::Approx(2));
    }
    for (const int count : seen) CHECK(count > 0);
}

TEST_CASE("small movements to and fro change no level") {
    const Curved ball = curved(sphere(3));
    const auto changes = [&](float hysteresis) {
        LodOptions options;
        options.hysteresis = hysteresis;
        LevelOfDetail lod(options);
        std::vector<float> last;
        int count = 0;
        for (int frame = 0; frame < 20; ++frame) {
            const float z = 4.0f + (frame % 2 == 0 ? 0.1f : -0.1f);
            std::vector<float> levels =
                lod.choose(ball.mesh.topology, ball.control, eye_at({0, 0, z})).levels;
            for (size_t e = 0; frame > 1 && e < levels.size(); ++e)
                count += levels[e] != last[e] ? 1 : 0;
            last = std::move(levels);
        }
        return count;
    };
    CHECK(changes(0) > 0);
    CHECK(changes(0.25f) == 0);
}

TEST_CASE("an edge that nobody sees is one segment, and all others stay as they are") {
    const Curved ball = curved(sphere(3));
    const Topology& topology = ball.mesh.topology;
    std::vector<uint8_t> hidden(topology.edge_count());
    for (size_t e = 0; e < hidden.size(); e += 3) hidden[e] = 1;
    const auto levels = [&](const EdgeFacts& facts) {
        return LevelOfDetail({}).choose(topology, ball.control, eye_at({0, 0, 2}), facts).levels;
    };
    const std::vector<float> seen = levels({}), some = levels({hidden, {}});
    for (size_t e = 0; e < hidden.size(); ++e) {
        CHECK(seen[e] > 1);
        CHECK(some[e] == (hidden[e] ? 1 : seen[e]));
    }
}

TEST_CASE("displaced edges have the segments with which they miss no more than the tolerance") {
    const Curved ball = curved(sphere(3));
    const Topology& topology = ball.mesh.topology;
    Viewpoint view;
    view.perspective = false;
    view.pixels_per_metre = 100;
    LodOptions options;
    options.silhouette = 1;
    const auto level = [&](float tolerance, const EdgeDetail& detail) {
        options.tolerance = tolerance;
        const std::vector<EdgeDetail> details(topology.edge_count(), detail);
        const LevelOfDetail::Choice choice =
            LevelOfDetail(options).choose(topology, ball.control, view, {{}, details});
        return *std::max_element(choice.levels.begin(), choice.levels.end());
    };
    // 1 / n metres with n segments: 100 pixels over n.
    EdgeDetail harmonic;
    for (size_t k = 0; k < harmonic.size(); ++k) harmonic[k] = 1 / static_cast<float>(1u << k);
    CHECK(level(100, harmonic) == 1);
    CHECK(level(10.1f, harmonic) == 10);
    CHECK(level(2.01f, harmonic) == 50);
    CHECK(level(0.2f, harmonic) == 128);
    // All of it lies within 8 segments.
    CHECK(level(10, {1, 1, 1, 0, 0, 0, 0, 0}) == 8);
    CHECK(level(200, {1, 1, 1, 0, 0, 0, 0, 0}) == 1);
    // With a budget the tolerance is one at which such edges fit.
    options.budget = 5000;
    const std::vector<EdgeDetail> details(topology.edge_count(), harmonic);
    options.tolerance = 0.1f;
    const LevelOfDetail::Choice choice =
        LevelOfDetail(options).choose(topology, ball.control, view, {{}, details});
    CHECK(choice.triangles <= 5000);
    CHECK(choice.triangles > 2500);
    for (const float own : choice.levels) CHECK(100 / own <= 1.01f * choice.tolerance);
}

TEST_CASE("a uniform level is as fine as the finest edge") {
    CHECK(uniform_level(std::vector<float>{1, 1}, 5) == 0);
    CHECK(uniform_level(std::vector<float>{1, 1.5f}, 5) == 1);
    CHECK(uniform_level(std::vector<float>{8, 1}, 5) == 3);
    CHECK(uniform_level(std::vector<float>{9, 1}, 5) == 4);
    CHECK(uniform_level(std::vector<float>{128}, 5) == 5);
    CHECK(uniform_level({}, 5) == 0);
}

}  // namespace
