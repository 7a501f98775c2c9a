// SPDX-License-Identifier: Apache-2.0
#include "refine_objects.h"

#include "aglow/core/file.h"
#include "aglow/scene/builtin.h"
#include "report.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace aglow::cli {
namespace {

/// Triangles whose corners in the same place are one vertex.
class Welder {
public:
    /// Corners that fall together leave no triangle.
    void add_triangle(vec3 a, vec3 b, vec3 c) {
        const std::array v = {vertex(a), vertex(b), vertex(c)};
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return;
        polygons_.corners.insert(polygons_.corners.end(), v.begin(), v.end());
        polygons_.face_begin.push_back(static_cast<uint32_t>(polygons_.corners.size()));
    }
    void add_quad(vec3 a, vec3 b, vec3 c, vec3 d) {
        add_triangle(a, b, c);
        add_triangle(a, c, d);
    }
    Result<CoarseObject> object() {
        polygons_.vertex_count = static_cast<uint32_t>(positions_.size());
        AG_TRY(TopologyResult built, build_topology(polygons_));
        CoarseObject result{std::move(built.topology), {}};
        for (const uint32_t v : result.topology.source_vertex)
            result.positions.push_back(positions_[v]);
        return result;
    }

private:
    uint32_t vertex(vec3 p) {
        constexpr float kSteps = 4096;  // per unit; objects are a few units large
        const auto step = [](float x) { return std::lround(x * kSteps); };
        const auto [known, is_new] = vertices_.try_emplace(
            {step(p.x), step(p.y), step(p.z)}, static_cast<uint32_t>(positions_.size()));
        if (is_new) positions_.push_back(p);
        return known->second;
    }

    PolygonList polygons_;
    std::vector<vec3> positions_;
    std::map<std::tuple<long, long, long>, uint32_t> vertices_;
};

void add_box(Welder& mesh, vec3 low, vec3 high) {
    const auto corner = [&](int i) {
        return vec3{(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                    (i & 4) != 0 ? high.z : low.z};
    };
    for (const auto& f : {std::array{0, 2, 3, 1},
                          {4, 5, 7, 6},
                          {0, 1, 5, 4},
                          {2, 6, 7, 3},
                          {0, 4, 6, 2},
                          {1, 3, 7, 5}})
        mesh.add_quad(corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
}

Result<CoarseObject> chess_object(ChessPiece piece) {
    const CoarseShape shape = chess_piece(piece);
    Welder mesh;
    for (const uvec3 t : shape.triangles)
        mesh.add_triangle(shape.positions[t.x], shape.positions[t.y], shape.positions[t.z]);
    return mesh.object();
}

/// A patch's 16 control points.
using Patch = std::array<vec3, 16>;

vec3 cubic(vec3 a, vec3 b, vec3 c, vec3 d, float t) {
    const float s = 1 - t;
    return a * (s * s * s) + b * (3 * s * s * t) + c * (3 * s * t * t) + d * (t * t * t);
}

vec3 point_on(const Patch& p, float u, float v) {
    std::array<vec3, 4> row{};
    for (size_t i = 0; i < 4; ++i)
        row[i] = cubic(p[4 * i], p[4 * i + 1], p[4 * i + 2], p[4 * i + 3], u);
    return cubic(row[0], row[1], row[2], row[3], v);
}

void add_patch(Welder& mesh, const Patch& patch, int segments, bool flipped) {
    const auto at = [&](int x, int y) {
        const float u = static_cast<float>(x) / static_cast<float>(segments);
        const float v = static_cast<float>(y) / static_cast<float>(segments);
        return point_on(patch, flipped ? 1 - u : u, v);
    };
    for (int y = 0; y < segments; ++y)
        for (int x = 0; x < segments; ++x)
            mesh.add_quad(at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
}

Patch turned(Patch patch, int quarters) {
    for (vec3& p : patch)
        for (int i = 0; i < quarters; ++i) p = {-p.y, p.x, p.z};
    return patch;
}

Patch mirrored(Patch patch) {
    for (vec3& p : patch) p.y = -p.y;
    return patch;
}

/// How a piece is completed, and how finely its patches are cut.
struct TeaPiece {
    const char* key;
    size_t quadrant_patches;  ///< that are turned to all four quadrants; 0: the piece is whole
    int segments;
};

TeaPiece tea_piece(const std::string& name) {
    if (name == "teapot") return {"teapot", 6, 3};
    if (name == "cup") return {"teacup", 6, 3};
    return {"teaspoon", 0, 4};
}

Result<CoarseObject> tea_object(const std::string& name, const std::string& file) {
    AG_TRY(const std::vector<uint8_t> bytes, read_file(file));
    const Json all = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    const TeaPiece piece = tea_piece(name);
    try {
        const auto points = all.at(piece.key).at("points").get<std::vector<std::array<float, 3>>>();
        const auto patches =
            all.at(piece.key).at("patches").get<std::vector<std::array<size_t, 16>>>();
        Welder mesh;
        for (size_t i = 0; i < patches.size(); ++i) {
            Patch patch{};
            for (size_t k = 0; k < patch.size(); ++k) {
                const auto& p = points.at(patches[i][k]);
                patch[k] = {p[0], p[1], p[2]};
            }
            const bool in_quadrant = i < piece.quadrant_patches;
            for (int quarter = 0; quarter < (in_quadrant ? 4 : 1); ++quarter)
                add_patch(mesh, turned(patch, quarter), piece.segments, false);
            if (!in_quadrant && piece.quadrant_patches > 0)
                add_patch(mesh, mirrored(patch), piece.segments, true);
        }
        return mesh.object();
    } catch (const std::exception& e) {
        return fail(Errc::malformed,
                    fmt::format("{}: not a tea set of Bezier patches: {}", file, e.what()));
    }
}

}  // namespace

Result<CoarseObject> coarse_object(const std::string& name, const std::string& teaset) {
    if (name == "teapot" || name == "spoon" || name == "cup") {
        if (!teaset.empty()) return tea_object(name, teaset);
        return fail(Errc::bad_argument, fmt::format("\"{}\" is made from a file of Bezier patches: "
                                                    "name it with --teaset FILE",
                                                    name));
    }
    if (name == "cube") {
        Welder mesh;
        add_box(mesh, {-1, -1, -1}, {1, 1, 1});
        return mesh.object();
    }
    if (name == "pawn") return chess_object(ChessPiece::pawn);
    if (name == "bishop") return chess_object(ChessPiece::bishop);
    if (name == "queen") return chess_object(ChessPiece::queen);
    if (name == "king") return chess_object(ChessPiece::king);
    return fail(Errc::bad_argument,
                fmt::format("there is no object \"{}\"; there are pawn, bishop, queen, king, cube, "
                            "and with --teaset FILE teapot, spoon, cup",
                            name));
}

}  // namespace aglow::cli
