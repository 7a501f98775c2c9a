// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/testing/layout_check.h"
#include "aglow/mesh/testing/meshes.h"
#include "aglow/mesh/unwrap.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>
#include <string>

using namespace aglow;
using namespace aglow::mesh::testing;

namespace {

uint32_t count(int lo, int hi) { return static_cast<uint32_t>(*rc::gen::inRange(lo, hi)); }
float number(float lo, float hi) {
    return lo + (hi - lo) * float(*rc::gen::inRange(0, 1001)) / 1000;
}

/// Triangles anywhere: intersecting, touching, of any shape.
Primitive triangle_soup() {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    const uint32_t n = count(3, 30);
    for (uint32_t i = 0; i < n; ++i)
        positions.push_back({number(-1, 1), number(-1, 1), number(-1, 1)});
    for (uint32_t t = count(1, 60); t > 0; --t)
        triangles.push_back({count(0, int(n)), count(0, int(n)), count(0, int(n))});
    return primitive(positions, triangles);
}

/// A box some of whose triangles come twice, turned over, or squeezed to a line.
Primitive damaged_box() {
    Primitive p = box({number(0.1f, 2), number(0.1f, 2), number(0.1f, 2)});
    for (uint32_t k = count(0, 8); k > 0; --k) {
        const uvec3 t = p.triangles[count(0, 12)];
        switch (count(0, 4)) {
            case 0:
                p.triangles.push_back(t);
                break;
            case 1:
                p.triangles.push_back({t.x, t.z, t.y});
                break;
            case 2:
                p.triangles.push_back({t.x, t.x, t.y});
                break;
            default:
                p.positions.push_back((p.positions[t.x] + p.positions[t.y]) * 0.5f);
                p.normals.push_back({0, 0, 1});
                p.triangles.push_back({t.x, static_cast<uint32_t>(p.positions.size() - 1), t.y});
        }
    }
    return p;
}

/// A height field, gentle or wild.
Primitive terrain() {
    const float height = number(0, 2);
    const uint32_t n = count(1, 14);
    Primitive p = sheet(n, count(1, 14), [](float u, float v) { return vec3{u, 0, -v}; });
    for (vec3& q : p.positions) q.y = height * number(0, 1);
    return p;
}

/// A fan of very thin triangles round one point.
Primitive thin_fan() {
    Primitive p = primitive({{0, 0, 0}}, {});
    const uint32_t n = count(3, 200);
    const float height = number(0, 1);
    for (uint32_t i = 0; i <= n; ++i) {
        const float a = 2 * kPi * float(i % n) / float(n);
        p.positions.push_back({std::cos(a), height, std::sin(a)});
        if (i > 0) p.triangles.push_back({0, i + 1, i});
    }
    p.normals.assign(p.positions.size(), vec3{0, 1, 0});
    return p;
}

Primitive any_mesh() {
    switch (count(0, 8)) {
        case 0:
            return triangle_soup();
        case 1:
            return damaged_box();
        case 2:
            return terrain();
        case 3:
            return thin_fan();
        case 4:
            return torus(count(3, 30), count(3, 16), 2, number(0.1f, 1.9f));
        case 5:
            return mobius_strip(count(3, 40));
        case 6:
            return sphere(count(3, 30), count(2, 16));
        default:
            return book(count(1, 9));
    }
}

std::vector<mat4> any_transforms() {
    std::vector<mat4> transforms;
    for (uint32_t k = count(1, 4); k > 0; --k) {
        const float mirror = count(0, 2) == 0 ? 1.0f : -1.0f;
        transforms.push_back(scaling({number(0.2f, 3), number(0.2f, 3), mirror * number(0.2f, 3)}));
    }
    return transforms;
}

/// The resolution that a refusal names; 0 if it names none.
uint32_t advised_resolution(const std::string& refusal) {
    const std::string before = "a resolution of ";
    const size_t at = refusal.find(before);
    if (at == std::string::npos) return 0;
    return static_cast<uint32_t>(std::stoul(refusal.substr(at + before.size())));
}

/// Surface area with area in the atlas: whatever was lost is missing here.
double covered_area(const Surfaces& s, const Atlas& atlas) {
    const Texels texels = rasterize(s, atlas, 1);
    return std::accumulate(texels.area.begin(), texels.area.end(), 0.0);
}

}  // namespace

TEST_CASE("any mesh gets charts that do not overlap, lose nothing and keep their gutters") {
    CHECK(rc::check("layout is sound", [] {
        std::vector<Primitive> primitives;
        for (uint32_t k = count(1, 3); k > 0; --k) primitives.push_back(any_mesh());
        Scene scene = scene_of(primitives, any_transforms());
        UnwrapOptions options;
        options.resolution = *rc::gen::element(64, 150, 256);
        options.gutter = *rc::gen::inRange(1, 4);
        Result<Atlas> atlas = unwrap(scene, options);
        if (!atlas) {  // too many charts for so few texels: then what it advises must hold
            const std::string why = to_string(atlas.error());
            RC_LOG() << why << '\n';
            options.resolution = advised_resolution(why);
            atlas = unwrap(scene, options);
        }
        if (!atlas) RC_FAIL(to_string(atlas.error()));
        RC_ASSERT(atlas->width == options.resolution);

        const Surfaces s = pose(scene, -1, &*atlas);
        const LayoutFaults faults = find_faults(s, *atlas, options.gutter);
        RC_LOG() << "range " << faults.out_of_range << " lost " << faults.lost << " overlaps "
                 << faults.overlaps << " near " << faults.near << '\n';
        RC_ASSERT(faults.none());
        double total = 0;
        for (uint32_t t = 0; t < s.triangles.size(); ++t) total += double(area(s, t));
        RC_ASSERT(std::abs(covered_area(s, *atlas) - total) <= 1e-4 * total);
    }));
}

TEST_CASE("no triangle of a charted mesh is stretched beyond bounds") {
    CHECK(rc::check("stretch is bounded", [] {
        Scene scene = scene_of({any_mesh()});
        UnwrapOptions options;
        options.texel_size = 0.004f;  // fine, so that widening to a whole texel does not matter
        const Result<Atlas> atlas = unwrap(scene, options);
        if (!atlas) RC_FAIL(to_string(atlas.error()));
        const Surfaces s = pose(scene, -1, &*atlas);
        for (uint32_t t = 0; t < s.triangles.size(); ++t) {
            const uvec3 v = s.triangles[t];
            const std::array<uint32_t, 3> corners = {v.x, v.y, v.z};
            double longest = 0;
            for (size_t i = 0; i < 3; ++i)
                longest = std::max(
                    longest, double(length(s.corner(t, int((i + 1) % 3)) - s.corner(t, int(i)))));
            if (double(area(s, t)) < 0.02 * longest * longest || longest < 0.1) continue;
            for (size_t i = 0; i < 3; ++i) {
                const uint32_t a = corners[i], b = corners[(i + 1) % 3];
                const double meters = double(length(s.positions[a] - s.positions[b]));
                const double texels = double(length(s.lightmap_uvs[a] - s.lightmap_uvs[b]));
                if (meters < 0.05) continue;
                const double ratio = texels * 0.004 / meters;
                RC_ASSERT(ratio > 0.3);
                RC_ASSERT(ratio < 3.0);
            }
        }
    }));
}
