// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/subdivided_faces.h"

#include "aglow/shared/ray.h"

#include <array>
#include <utility>

namespace aglow::render::gpu {
namespace {

using shared::RasterSubdividedFace;

/// A triangle that nothing is beside, whose corners stay: subdivided it keeps its outline.
Result<Topology> lone_triangle() {
    AG_TRY(TopologyResult made, build_topology({{0, 3}, {0, 1, 2}, 3}));
    made.topology.vertex_sharpness.assign(3, kSharp);
    return std::move(made.topology);
}

std::vector<uvec3> triangles_of(const Subdivision& subdivision) {
    std::vector<uvec3> triangles = subdivision.triangles();
    for (const auto& [a, b, c, d] : subdivision.quads()) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
    }
    return triangles;
}

/// Numbers of a subdivided mesh's points, the first of which is `first`.
class PointNumbers {
public:
    PointNumbers(const Topology& mesh, const FacePattern& pattern, uint32_t first)
        : mesh_(mesh), pattern_(pattern), first_(first) {}

    void set_corner(uint32_t half, uint32_t i, RasterSubdividedFace& face) const {
        face.first[i] = first_ + mesh_.vertex[half];
    }
    void set_edge(uint32_t half, uint32_t i, RasterSubdividedFace& face) const {
        const uint32_t edge = mesh_.edge[half], bit = 1u << (3 + i);
        face.first[3 + i] = first_edge() + edge * pattern_.edge_points;
        face.reversed = mesh_.edge_half[edge] == half ? face.reversed & ~bit : face.reversed | bit;
    }
    RasterSubdividedFace all(uint32_t f) const {
        RasterSubdividedFace face{};
        for (uint32_t i = 0; i < 3; ++i) {
            set_corner(mesh_.face_begin[f] + i, i, face);
            set_edge(mesh_.face_begin[f] + i, i, face);
        }
        face.first[shared::kSubdividedInside] = first_inside() + f * pattern_.inside;
        return face;
    }
    uint32_t end() const { return first_inside() + mesh_.face_count() * pattern_.inside; }

private:
    uint32_t first_edge() const { return first_ + mesh_.vertex_count(); }
    uint32_t first_inside() const {
        return first_edge() + mesh_.edge_count() * pattern_.edge_points;
    }

    const Topology& mesh_;
    const FacePattern& pattern_;
    uint32_t first_;
};

/// Points on creases are taken from the mesh that is cut open there.
RasterSubdividedFace parted(RasterSubdividedFace face, uint32_t f, const Topology& mesh,
                            const CreaseSides& sides, const PointNumbers& of_sides) {
    for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t half = mesh.face_begin[f] + i;
        if (sides.parted[mesh.vertex[half]]) of_sides.set_corner(half, i, face);
        if (mesh.edge_sharpness[mesh.edge[half]] >= kSharp) of_sides.set_edge(half, i, face);
    }
    return face;
}

}  // namespace

Result<FacePattern> face_pattern(const SubdivisionOptions& options) {
    AG_TRY(const Topology triangle, lone_triangle());
    AG_TRY(const Subdivision subdivision, Subdivision::create(triangle, options));
    constexpr std::array<float, 6> kCorners{0, 0, 1, 0, 0, 1};
    std::vector<float> refined(2 * size_t{subdivision.vertex_count()});
    AG_CHECK(subdivision.evaluate(kCorners, 2, refined));
    FacePattern pattern;
    pattern.triangles = triangles_of(subdivision);
    pattern.edge_points = (1u << options.level) - 1;
    pattern.inside = subdivision.vertex_count() - 3 - 3 * pattern.edge_points;
    std::array<uint32_t, 3> side_of{};  // [edge]
    for (uint32_t i = 0; i < 3; ++i) side_of[triangle.edge[i]] = i;
    const auto add = [&](uint32_t at, uint32_t count) {
        for (uint32_t step = 0; step < count; ++step)
            pattern.places.push_back(at | step << shared::kPlaceBits);
    };
    for (uint32_t i = 0; i < 3; ++i) add(i, 1);
    for (const uint32_t side : side_of) add(3 + side, pattern.edge_points);
    add(shared::kSubdividedInside, pattern.inside);
    for (size_t v = 0; v < subdivision.vertex_count(); ++v)
        pattern.barycentrics.push_back({refined[2 * v], refined[2 * v + 1]});
    return pattern;
}

SubdividedFaces subdivided_faces(const ControlScene& control, const CreaseSides& sides,
                                 const FacePattern& pattern) {
    const Topology& mesh = control.topology;
    const PointNumbers points(mesh, pattern, 0);
    const PointNumbers of_sides(sides.mesh, pattern, points.end());
    RasterSubdividedFace none{};
    none.first[0] = shared::kNoTriangle;
    SubdividedFaces faces;
    for (const uint32_t f : control.patch_of) {
        const RasterSubdividedFace face = f == kNone ? none : points.all(f);
        faces.positions.push_back(face);
        if (sides.empty()) continue;
        faces.normals.push_back(f == kNone ? none : parted(face, f, mesh, sides, of_sides));
    }
    return faces;
}

}  // namespace aglow::render::gpu
