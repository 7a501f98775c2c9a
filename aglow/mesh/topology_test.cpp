// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/topology.h"

#include "aglow/mesh/testing/topology_check.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <initializer_list>
#include <limits>
#include <map>
#include <set>

using namespace aglow;
using namespace aglow::mesh::testing;

namespace {

using Corners = std::vector<uint32_t>;

PolygonList polygons(const std::vector<Corners>& faces) {
    PolygonList list;
    for (const Corners& face : faces) {
        list.corners.insert(list.corners.end(), face.begin(), face.end());
        list.face_begin.push_back(static_cast<uint32_t>(list.corners.size()));
        for (const uint32_t v : face) list.vertex_count = std::max(list.vertex_count, v + 1);
    }
    return list;
}

TopologyResult build(const PolygonList& list, std::span<const Crease> creases = {}) {
    Result<TopologyResult> result = build_topology(list, creases);
    REQUIRE_MESSAGE(result.has_value(), (result ? "" : to_string(result.error())));
    CHECK(find_topology_fault(result->topology) == "");
    return std::move(*result);
}

TopologyResult build_faces(const std::vector<Corners>& faces,
                           std::span<const Crease> creases = {}) {
    return build(polygons(faces), creases);
}

/// columns x rows quads between the vertices that vertex(x, y) names.
template <class Vertex>
PolygonList quad_grid(uint32_t columns, uint32_t rows, const Vertex& vertex) {
    std::vector<Corners> faces;
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x)
            faces.push_back(
                {vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)});
    return polygons(faces);
}

/// Quads over a sheet of columns x rows, whose opposite sides may be one.
PolygonList quad_sheet(uint32_t columns, uint32_t rows, bool closed_x, bool closed_y) {
    const uint32_t width = closed_x ? columns : columns + 1;
    return quad_grid(columns, rows, [=](uint32_t x, uint32_t y) {
        return (closed_y ? y % rows : y) * width + (closed_x ? x % columns : x);
    });
}

/// Triangles and quads round a globe.
PolygonList globe(uint32_t columns, uint32_t rows) {
    return quad_grid(columns, rows, [=](uint32_t x, uint32_t y) {
        return y == 0 ? 0 : y == rows ? 1 : 2 + (y - 1) * columns + x % columns;
    });
}

uint32_t edge_between(const Topology& t, uint32_t a, uint32_t b) {
    for (uint32_t h = 0; h < t.half_edge_count(); ++h)
        if ((t.vertex[h] == a && t.end(h) == b) || (t.vertex[h] == b && t.end(h) == a))
            return t.edge[h];
    return kNone;
}

/// Polygons anywhere: faces that share edges many times, turned over, repeated or degenerate.
PolygonList polygon_soup() {
    const int vertex_count = *rc::gen::inRange(1, 20);
    const auto faces = *rc::gen::container<std::vector<Corners>>(
        rc::gen::resize(6, rc::gen::container<Corners>(rc::gen::inRange<uint32_t>(
                               0, static_cast<uint32_t>(vertex_count)))));
    PolygonList list = polygons(faces);
    list.vertex_count = static_cast<uint32_t>(vertex_count);
    return list;
}

/// A closed or open sheet with some faces left out, turned over, doubled or bent to other vertices.
PolygonList damaged_sheet() {
    const PolygonList whole = quad_sheet(*rc::gen::inRange(2u, 6u), *rc::gen::inRange(2u, 6u),
                                         *rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>());
    std::vector<Corners> faces;
    for (uint32_t f = 0; f < whole.face_count(); ++f) {
        Corners face(whole.corners.begin() + whole.face_begin[f],
                     whole.corners.begin() + whole.face_begin[f + 1]);
        const int damage = *rc::gen::inRange(0, 20);
        if (damage == 0) continue;
        if (damage == 1) std::reverse(face.begin(), face.end());
        if (damage == 2) faces.push_back(face);
        if (damage == 3)
            face[*rc::gen::inRange(0u, 4u)] = *rc::gen::inRange(0u, whole.vertex_count);
        faces.push_back(face);
    }
    PolygonList list = polygons(faces);
    list.vertex_count = whole.vertex_count;
    return list;
}

using Edge = std::pair<uint32_t, uint32_t>;

/// Which faces run along each edge forwards and backwards, found by other means than the builder's.
std::map<Edge, std::pair<int, int>> edge_uses(const PolygonList& list, uint32_t& dropped) {
    std::map<Edge, std::pair<int, int>> uses;
    for (uint32_t f = 0; f < list.face_count(); ++f) {
        Corners corners;
        for (uint32_t c = list.face_begin[f]; c < list.face_begin[f + 1]; ++c)
            if (std::find(corners.begin(), corners.end(), list.corners[c]) == corners.end())
                corners.push_back(list.corners[c]);
        if (corners.size() < 3) {
            ++dropped;
            continue;
        }
        for (size_t i = 0; i < corners.size(); ++i) {
            const uint32_t a = corners[i], b = corners[(i + 1) % corners.size()];
            auto& [forwards, backwards] = uses[std::minmax(a, b)];
            ++(a < b ? forwards : backwards);
        }
    }
    return uses;
}

void check_against_definition(const PolygonList& list) {
    const Result<TopologyResult> result = build_topology(list);
    RC_ASSERT(result.has_value());
    const Topology& t = result->topology;
    RC_ASSERT(find_topology_fault(t) == "");
    uint32_t dropped = 0, cut = 0;
    const auto uses = edge_uses(list, dropped);
    for (const auto& [edge, count] : uses)
        cut += count.first + count.second > 1 && count != std::pair(1, 1);
    RC_ASSERT(result->repairs.dropped_faces == dropped);
    RC_ASSERT(result->repairs.cut_edges == cut);
    RC_ASSERT(result->repairs.split_vertices == t.vertex_count() - list.vertex_count);
    RC_ASSERT(t.face_count() == list.face_count() - dropped);
    for (uint32_t h = 0; h < t.half_edge_count(); ++h) {
        const uint32_t a = t.source_vertex[t.vertex[h]], b = t.source_vertex[t.end(h)];
        RC_ASSERT((t.twin[h] != kNone) == (uses.at(std::minmax(a, b)) == std::pair(1, 1)));
    }
    for (uint32_t v = 0; v < list.vertex_count; ++v) RC_ASSERT(t.source_vertex[v] == v);
}

}  // namespace

TEST_CASE("a closed globe has the Euler characteristic 2 and no boundary") {
    for (const uint32_t columns : {3u, 8u, 40u}) {
        const TopologyResult result = build(globe(columns, 5));
        CHECK(result.repairs.none());
        CHECK(euler_characteristic(result.topology) == 2);
        CHECK(boundary_edge_count(result.topology) == 0);
        CHECK(result.topology.edge_count() == columns * 9);
    }
}

TEST_CASE("a torus has the Euler characteristic 0, a tube too, a disc 1") {
    const Topology torus = build(quad_sheet(7, 5, true, true)).topology;
    CHECK(euler_characteristic(torus) == 0);
    CHECK(boundary_edge_count(torus) == 0);
    const Topology tube = build(quad_sheet(7, 5, true, false)).topology;
    CHECK(euler_characteristic(tube) == 0);
    CHECK(boundary_edge_count(tube) == 14);
    const Topology disc = build(quad_sheet(7, 5, false, false)).topology;
    CHECK(euler_characteristic(disc) == 1);
    CHECK(boundary_edge_count(disc) == 24);
}

TEST_CASE("of a vertex on the boundary turning counter-clockwise starts at the boundary") {
    // Three triangles of a fan from the right to the left above vertex 0.
    const Topology t = build_faces({{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}).topology;
    REQUIRE(t.on_boundary(0));
    uint32_t h = t.vertex_half[0];
    for (const uint32_t end : {1u, 2u, 3u}) {
        CHECK(t.end(h) == end);
        h = t.twin[t.previous(h)];
    }
    CHECK(h == kNone);
}

TEST_CASE("a Moebius strip is cut once across") {
    // Four quads whose last edge meets the first turned over: 4 = upper, lower swapped.
    const TopologyResult result =
        build_faces({{0, 2, 3, 1}, {2, 4, 5, 3}, {4, 6, 7, 5}, {6, 1, 0, 7}});
    CHECK(result.repairs.cut_edges == 1);
    CHECK(result.repairs.split_vertices == 2);
    CHECK(euler_characteristic(result.topology) == 1);  // a strip
}

TEST_CASE("pages that meet in one edge come apart") {
    const TopologyResult result = build_faces({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    CHECK(result.repairs.cut_edges == 1);
    CHECK(result.repairs.split_vertices == 4);
    CHECK(result.topology.edge_count() == 9);
    CHECK(result.topology.source_vertex[5 + 1] < 2);
}

TEST_CASE("two cones that meet in their tips have a tip each") {
    const TopologyResult result =
        build_faces({{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 4}});
    CHECK(result.repairs.cut_edges == 0);
    CHECK(result.repairs.split_vertices == 1);
    CHECK(result.topology.source_vertex.back() == 0);
}

TEST_CASE("faces of a repeated corner lose it, and go where two corners are left") {
    const TopologyResult result = build_faces({{0, 1, 1, 2}, {2, 1, 2}, {}, {0, 2, 3, 3}});
    CHECK(result.repairs.dropped_faces == 2);
    REQUIRE(result.topology.face_count() == 2);
    CHECK(result.topology.source_face == std::vector<uint32_t>{0, 3});
    CHECK(result.topology.face_size(0) == 3);
    CHECK(boundary_edge_count(result.topology) == 4);
}

TEST_CASE("a vertex without faces stays") {
    PolygonList list = polygons({{1, 2, 3}});
    list.vertex_count = 6;
    const Topology t = build(list).topology;
    CHECK(t.vertex_count() == 6);
    CHECK(t.vertex_half[0] == kNone);
    CHECK_FALSE(t.on_boundary(0));
    CHECK(build(PolygonList{}).topology.vertex_count() == 0);
}

TEST_CASE("creases sharpen their edges in either direction, the sharper of two") {
    const std::vector<Crease> creases = {{1, 0, 2.5f}, {2, 3, 1}, {3, 2, 3}, {2, 3, 2}, {1, 3}};
    const TopologyResult result = build_faces({{0, 1, 2}, {0, 2, 3}}, creases);
    const Topology& t = result.topology;
    CHECK(t.edge_sharpness[edge_between(t, 0, 1)] == 2.5f);
    CHECK(t.edge_sharpness[edge_between(t, 2, 3)] == 3);
    CHECK(t.edge_sharpness[edge_between(t, 0, 2)] == 0);
    CHECK(result.repairs.stray_creases == 1);  // 1 to 3 is the other diagonal
}

TEST_CASE("corners, creases and sharpness outside their range are errors that say which") {
    PolygonList list = polygons({{0, 1, 2}});
    const auto message = [&](std::initializer_list<Crease> creases) {
        const auto result = build_topology(list, std::vector<Crease>(creases));
        REQUIRE_FALSE(result.has_value());
        CHECK(result.error().code == Errc::bad_argument);
        return result.error().message;
    };
    CHECK(message({{0, 1}, {1, 3}}) == "crease 1 runs from vertex 1 to 3, but there are 3");
    CHECK(message({{0, 1, -1}}) == "crease 0 has the sharpness -1");
    CHECK(message({{0, 1, std::numeric_limits<float>::quiet_NaN()}}) ==
          "crease 0 has the sharpness nan");
    list.vertex_count = 2;
    CHECK(message({}) == "corner 2 is vertex 2, but there are 2");
}

TEST_CASE("any polygons become a manifold with the twins that the definition asks for") {
    CHECK(rc::check("soup", [] { check_against_definition(polygon_soup()); }));
    CHECK(rc::check("sheet", [] { check_against_definition(damaged_sheet()); }));
}
