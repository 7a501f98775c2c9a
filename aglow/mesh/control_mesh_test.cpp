// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/control_mesh.h"
#include "aglow/core/testing/scenes.h"

#include "aglow/mesh/testing/control_check.h"
#include "aglow/mesh/testing/meshes.h"
#include "aglow/mesh/topology/equal_rows.h"
#include "aglow/scene/load.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <filesystem>

using namespace aglow;
using namespace aglow::mesh::testing;

namespace {

ControlMesh control(const Mesh& mesh, const ControlOptions& options = {}) {
    Result<ControlMesh> result = make_control_mesh(mesh, options);
    REQUIRE_MESSAGE(result.has_value(), (result ? "" : to_string(result.error())));
    CHECK(find_control_fault(mesh, *result) == "");
    return std::move(*result);
}

Mesh mesh_of(std::vector<Primitive> primitives) { return {"mesh", std::move(primitives), {}}; }

/// Every triangle with vertices and a geometric normal of its own, as files with flat shading have.
Primitive flat(const Primitive& p) {
    Primitive out;
    for (const uvec3 t : p.triangles) {
        const auto first = static_cast<uint32_t>(out.positions.size());
        const vec3 a = p.positions[t.x], b = p.positions[t.y], c = p.positions[t.z];
        out.positions.insert(out.positions.end(), {a, b, c});
        out.normals.insert(out.normals.end(), 3, normalize(cross(b - a, c - a)));
        out.triangles.push_back({first, first + 1, first + 2});
    }
    return out;
}

/// A cylinder without lids whose texture is wound round it once.
Primitive tube(uint32_t columns, uint32_t rows) {
    Primitive p = sheet(columns, rows, [](float u, float v) {
        const float a = 2 * kPi * (u == 1 ? 0 : u);
        return vec3{std::cos(a), v, std::sin(a)};
    });
    p.texcoords.resize(1);
    for (uint32_t y = 0; y <= rows; ++y)
        for (uint32_t x = 0; x <= columns; ++x)
            p.texcoords[0].push_back({float(x) / float(columns), float(y) / float(rows)});
    return p;
}

/// `sheet` with a quad's triangles as exporters write them: (a, b, c), (a, c, d).
template <class Map>
Primitive quad_sheet(uint32_t columns, uint32_t rows, Map map) {
    Primitive p = sheet(columns, rows, map);
    for (size_t t = 0; t < p.triangles.size(); t += 2) {
        const uint32_t a = p.triangles[t].x, b = p.triangles[t].y;
        const uint32_t c = p.triangles[t + 1].y, d = p.triangles[t].z;
        p.triangles[t] = {a, b, c};
        p.triangles[t + 1] = {a, c, d};
    }
    return p;
}

uint32_t sharp_count(const Topology& t) {
    return static_cast<uint32_t>(
        std::ranges::count_if(t.edge_sharpness, [](float s) { return s > 0; }));
}

float sharpness_between(const ControlMesh& c, vec3 a, vec3 b) {
    const Topology& t = c.topology;
    for (uint32_t h = 0; h < t.half_edge_count(); ++h)
        if (c.positions[t.vertex[h]] == a && c.positions[t.end(h)] == b)
            return t.edge_sharpness[t.edge[h]];
    return -1;
}

/// Two quads that share only one vertex of an edge share no edge, and then no vertex.
void check_apart(const Primitive& left, const Primitive& right) {
    const ControlMesh c = control(mesh_of({left, right}));
    CHECK(c.topology.vertex_count() == 8);
    CHECK(c.repairs.split_vertices == 1);
}

}  // namespace

TEST_CASE("a cube with a normal for every face is one closed surface of eight vertices") {
    const Mesh cube = mesh_of({flat(box({1, 2, 3}))});
    const ControlMesh c = control(cube);
    CHECK(c.topology.vertex_count() == 8);
    CHECK(c.topology.edge_count() == 18);
    CHECK(boundary_edge_count(c.topology) == 0);
    CHECK(euler_characteristic(c.topology) == 2);
    CHECK(c.repairs.none());
    CHECK(c.warnings.empty());
    CHECK(sharp_count(c.topology) == 0);
    CHECK(euler_characteristic(c.seams) == 2);  // normals are no seam
}

TEST_CASE("creases of a cube are its twelve edges, by angle or by normals") {
    const Mesh cube = mesh_of({flat(box({1, 2, 3}))});
    for (const bool quads : {false, true}) {
        ControlOptions options;
        options.quads = quads;
        options.crease_angle = 89 * kPi / 180;
        CHECK(sharp_count(control(cube, options).topology) == 12);
        options.crease_angle = 91 * kPi / 180;
        CHECK(sharp_count(control(cube, options).topology) == 0);
        options.crease_at_normals = true;
        CHECK(sharp_count(control(cube, options).topology) == 12);
    }
    ControlOptions options;
    options.crease_at_normals = true;
    Primitive smooth = box({1, 1, 1});
    for (size_t v = 0; v < 8; ++v)
        smooth.normals[v] = normalize(smooth.positions[v] - vec3{0.5f, 0.5f, 0.5f});
    CHECK(sharp_count(control(mesh_of({smooth}), options).topology) == 0);
}

TEST_CASE("primitives are welded where they meet, minus zero is zero, and seams keep them apart") {
    Primitive left = unit_quad(), right = unit_quad();
    for (vec3& p : right.positions) p.x += 1;
    left.positions[1].z = -0.0f;
    right.positions[0].z = 0.0f;
    const ControlMesh c = control(mesh_of({left, right}));
    CHECK(c.topology.vertex_count() == 6);
    CHECK(boundary_edge_count(c.topology) == 6);
    CHECK(c.face_primitive == std::vector<uint32_t>{0, 0, 1, 1});
    CHECK(c.topology.source_face == std::vector<uint32_t>{0, 1, 2, 3});
    CHECK(c.seams.vertex_count() == 8);
    CHECK(boundary_edge_count(c.seams) == 8);
}

TEST_CASE("vertices in one place that move apart are not welded") {
    Primitive left = unit_quad(), right = unit_quad();
    for (vec3& p : right.positions) p.x += 1;
    for (Primitive* p : {&left, &right}) {
        p->influences = 4;
        for (size_t v = 0; v < 4; ++v) {
            p->joints.insert(p->joints.end(), {5, 3, 0, 7});
            p->weights.insert(p->weights.end(), {0.25f, 0.75f, 0, 0});
        }
        p->targets.resize(2);
        p->targets[1].positions.assign(4, vec3{0, 0, 1});
    }
    SUBCASE("influences in another order move alike, and an absent target moves nothing") {
        right.joints[0] = 3, right.joints[1] = 5, right.joints[3] = 1;
        right.weights[0] = 0.75f, right.weights[1] = 0.25f;
        right.targets[0].positions.assign(4, vec3{0, -0.0f, 0});
        CHECK(control(mesh_of({left, right})).topology.vertex_count() == 6);
    }
    SUBCASE("another weight") {
        right.weights[0] = 0.5f;
        check_apart(left, right);
    }
    SUBCASE("another joint") {
        left.joints[4 * 2 + 1] = 4;
        check_apart(left, right);
    }
    SUBCASE("another displacement") {
        left.targets[1].positions[1].y = 0.5f;
        check_apart(left, right);
    }
}

TEST_CASE("where a texture meets itself the surface is closed and its seams are open") {
    const ControlMesh c = control(mesh_of({tube(12, 3)}));
    CHECK(c.topology.vertex_count() == 12 * 4);
    CHECK(boundary_edge_count(c.topology) == 2 * 12);
    CHECK(c.seams.vertex_count() == 13 * 4);
    CHECK(boundary_edge_count(c.seams) == 2 * 12 + 2 * 3);
    CHECK(euler_characteristic(c.seams) == 1);
}

TEST_CASE("colours part the seams too") {
    Primitive p = flat(unit_quad());
    p.colors.assign(6, vec4{1, 0, 0, 1});
    CHECK(control(mesh_of({p})).seams.vertex_count() == 4);
    p.colors[0].z = 0.5f;
    const ControlMesh c = control(mesh_of({p}));
    CHECK(c.topology.vertex_count() == 4);
    CHECK(c.seams.vertex_count() == 6);  // the edge is cut, so that its other end is two as well
    CHECK(boundary_edge_count(c.seams) == 6);
}

TEST_CASE("the two sides of a leaf are two surfaces") {
    Primitive leaf = quad_sheet(4, 3, [](float u, float v) { return vec3{u, v, u * v}; });
    const std::vector<uvec3> front = leaf.triangles;
    for (const uvec3 t : front) leaf.triangles.push_back({t.x, t.z, t.y});
    const ControlMesh c = control(mesh_of({leaf}));
    CHECK(c.repairs.none());
    CHECK(c.topology.vertex_count() == 2 * 20);
    CHECK(boundary_edge_count(c.topology) == 2 * 14);
    CHECK(euler_characteristic(c.topology) == 2);
}

TEST_CASE("tagged creases and corners hold for all vertices in their place") {
    Primitive p = flat(unit_quad());  // (0, 0) (1, 0) (1, 1)   (0, 0) (1, 1) (0, 1)
    p.creases = {{0, 2, 2.5f}, {4, 3, 1.5f}, {4, 5, 0.5f}, {1, 5, 3}};
    p.corners = {{2, 4}, {4, 3}};
    const ControlMesh c = control(mesh_of({p}));
    CHECK(sharpness_between(c, {0, 0, 0}, {1, 1, 0}) == 2.5f);
    CHECK(sharpness_between(c, {1, 1, 0}, {0, 1, 0}) == 0.5f);
    CHECK(sharpness_between(c, {0, 0, 0}, {1, 0, 0}) == 0);
    CHECK(c.repairs.stray_creases == 1);
    REQUIRE(c.warnings.size() == 1);
    CHECK(c.warnings[0] == "mesh \"mesh\": 1 creases run along no edge and are left out");
    for (uint32_t v = 0; v < 4; ++v)
        CHECK(c.topology.vertex_sharpness[v] == (c.positions[v] == vec3{1, 1, 0} ? 4.0f : 0.0f));
}

TEST_CASE("triangles without area and pages of a book are mended, and that is said") {
    Primitive p = book(3);
    p.triangles.push_back({0, 2, 2});
    const auto copy = static_cast<uint32_t>(p.positions.size());
    p.positions.push_back(p.positions[0]);
    p.normals.push_back({0, 0, 1});
    p.triangles.push_back({0, 3, copy});
    const ControlMesh c = control({"", {p}, {}});
    CHECK(c.repairs.dropped_faces == 2);
    CHECK(c.repairs.cut_edges == 1);
    CHECK(c.repairs.split_vertices == 4);
    REQUIRE(c.warnings.size() == 3);
    CHECK(c.warnings[0] == "a mesh: 2 triangles without three different corners are left out");
}

TEST_CASE("the triangles of a grid become its quads, with the corners that they had") {
    ControlOptions options;
    options.quads = true;
    const auto bent = [](float u, float v) { return vec3{6 * u, 5 * v, std::sin(3 * u * v)}; };
    const Primitive in_order = quad_sheet(6, 5, bent);
    const ControlMesh c = control(mesh_of({in_order}), options);
    CHECK(c.quad_count == 30);
    REQUIRE(c.topology.face_count() == 30);
    for (uint32_t f = 0; f < 30; ++f) {
        REQUIRE(c.topology.face_size(f) == 4);
        const uvec3 first = in_order.triangles[2 * f];
        for (uint32_t i = 0; const uint32_t v : {first.x, first.y, first.z})
            CHECK(c.corners[4 * f + i++].vertex == v);
        CHECK(c.corners[4 * f + 3].vertex == in_order.triangles[2 * f + 1].z);
        CHECK(c.topology.source_face[f] == 2 * f);
    }
    // The same triangles in another order, with the other diagonal.
    Primitive shuffled = sheet(6, 5, bent);
    std::ranges::reverse(shuffled.triangles);
    std::rotate(shuffled.triangles.begin(), shuffled.triangles.begin() + 17,
                shuffled.triangles.end());
    const ControlMesh d = control(mesh_of({shuffled}), options);
    CHECK(d.quad_count == 30);
    CHECK(d.topology.edge_count() == c.topology.edge_count());
}

TEST_CASE("the caps of a globe stay triangles") {
    ControlOptions options;
    options.quads = true;
    const ControlMesh c = control(mesh_of({sphere(32, 16)}), options);
    CHECK(c.quad_count == 32 * 14);
    CHECK(c.topology.face_count() == 32 * 16);
    CHECK(euler_characteristic(c.topology) == 2);
}

TEST_CASE("no quad is made of triangles that fold, thin out, turn inwards or differ") {
    ControlOptions options;
    options.quads = true;
    const auto quads_of = [&](std::vector<vec3> corners) {
        const Primitive p = primitive(std::move(corners), {{0, 1, 2}, {0, 2, 3}});
        return control(mesh_of({p}), options).quad_count;
    };
    CHECK(quads_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}) == 1);
    CHECK(quads_of({{0, 0, 0}, {9, 0, 0}, {9, 1, 0}, {0, 1, 0}}) == 1);  // long, but a rectangle
    CHECK(quads_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 1}}) == 0);
    CHECK(quads_of({{0, 0, 0}, {1, 0, 0}, {5, 1, 0}, {4, 1, 0}}) == 0);
    CHECK(quads_of({{0, 0, 0}, {1, -1, 0}, {0.4f, 0, 0}, {1, 1, 0}}) == 0);  // a dart

    Primitive tagged = unit_quad();
    tagged.creases = {{2, 0, 1}};
    CHECK(control(mesh_of({tagged}), options).quad_count == 0);
    Primitive textured = flat(unit_quad());
    textured.texcoords = {{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}}};
    CHECK(control(mesh_of({textured}), options).quad_count == 1);
    textured.texcoords[0][3].x = 0.5f;
    CHECK(control(mesh_of({textured}), options).quad_count == 0);
}

TEST_CASE("quads bend by 40 degrees at most, and their corners by 40 from a right angle") {
    ControlOptions options;
    options.quads = true;
    const auto quads_of = [&](const std::vector<vec3>& corners, std::vector<uvec3> triangles) {
        return control(mesh_of({primitive(corners, std::move(triangles))}), options).quad_count;
    };
    const std::vector<uvec3> in_order = {{0, 1, 2}, {0, 2, 3}}, in_another = {{0, 2, 3}, {0, 1, 2}};
    const auto rhombus = [](float degrees) {
        const float c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
        return std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1 + c, s, 0}, {c, s, 0}};
    };
    CHECK(quads_of(rhombus(50.2f), in_another) == 1);
    CHECK(quads_of(rhombus(49.8f), in_another) == 0);
    // Exporters list the halves of their quads one after the other: corners by 60 degrees.
    CHECK(quads_of(rhombus(30.2f), in_order) == 1);
    CHECK(quads_of(rhombus(29.8f), in_order) == 0);
    // A square whose last corner turns about the diagonal out of the plane.
    const auto folded = [](float degrees) {
        const float c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
        return std::vector<vec3>{
            {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {(1 - c) / 2, (1 + c) / 2, s * std::sqrt(0.5f)}};
    };
    CHECK(quads_of(folded(39.8f), in_another) == 1);
    CHECK(quads_of(folded(40.2f), in_another) == 0);
}

TEST_CASE("triangles in an exporter's order make a quad, though others would make a better one") {
    ControlOptions options;
    options.quads = true;
    // A parallelogram of the first two triangles, a rectangle of the last two.
    const auto leaning = [&](float height) {
        const ControlMesh c = control(
            mesh_of(
                {primitive({{0, 0, 0}, {0, -height, 0}, {4, 0, 0}, {4, height, 0}, {0, height, 0}},
                           {{0, 1, 2}, {0, 2, 3}, {3, 4, 0}})}),
            options);
        CHECK(c.quad_count == 1);
        return c.topology.face_size(0) == 4;
    };
    CHECK(leaning(4 * std::tan(19.8f * kPi / 180)));
    CHECK_FALSE(leaning(4 * std::tan(20.2f * kPi / 180)));
}

TEST_CASE("normals of less than a degree between them are no crease") {
    ControlOptions options;
    options.crease_at_normals = true;
    const auto creases = [&](float degrees) {
        Primitive other = unit_quad();
        for (vec3& p : other.positions) p.x += 1;
        for (vec3& n : other.normals)
            n = {std::sin(degrees * kPi / 180), 0, std::cos(degrees * kPi / 180)};
        return sharp_count(control(mesh_of({unit_quad(), other}), options).topology);
    };
    CHECK(creases(0.99f) == 0);
    CHECK(creases(1.01f) == 1);
}

TEST_CASE("meshes without triangles are empty control meshes") {
    CHECK(control(mesh_of({})).topology.face_count() == 0);
    CHECK(control(mesh_of({Primitive{}, unit_quad()})).face_primitive ==
          std::vector<uint32_t>{1, 1});
}

TEST_CASE("rows are equal where all their words are") {
    mesh::Rows rows;
    const std::vector<std::vector<uint32_t>> words = {{1, 2}, {}, {1, 2, 0}, {1, 2}, {2, 1}, {}};
    for (const auto& row : words) {
        for (const uint32_t word : row) rows.add(word);
        rows.end_row();
    }
    const mesh::EqualRows equal = find_equal(rows);
    CHECK(equal.of == std::vector<uint32_t>{0, 1, 2, 0, 3, 1});
    CHECK(equal.class_count == 4);
}

TEST_CASE("any triangles become a control mesh in which all that must hold holds") {
    CHECK(rc::check([] {
        std::vector<Primitive> primitives;
        for (int i = *rc::gen::inRange(1, 3); i > 0; --i) {
            const int n = *rc::gen::inRange(1, 12);
            const auto any = [&] { return static_cast<uint32_t>(*rc::gen::inRange(0, n)); };
            Primitive p;
            for (int v = 0; v < n; ++v) {  // few places, so that many meet in each
                p.positions.push_back({float(*rc::gen::inRange(0, 2)),
                                       float(*rc::gen::inRange(0, 2)),
                                       float(*rc::gen::inRange(0, 2))});
                p.colors.push_back({float(*rc::gen::inRange(0, 2)), 0, 0, 1});
            }
            p.normals.assign(p.positions.size(), vec3{0, 0, 1});
            for (int t = *rc::gen::inRange(0, 30); t > 0; --t)
                p.triangles.push_back({any(), any(), any()});
            p.creases = {{any(), any(), 2}};
            primitives.push_back(p);
        }
        const Mesh mesh = mesh_of(std::move(primitives));
        for (const bool quads : {false, true}) {
            ControlOptions options;
            options.quads = quads;
            options.crease_angle = 0.5f;
            const Result<ControlMesh> result = make_control_mesh(mesh, options);
            RC_ASSERT(result.has_value());
            RC_ASSERT(find_control_fault(mesh, *result) == "");
        }
    }));
}

TEST_CASE("all meshes of the scenes at hand become control meshes") {
    const std::filesystem::path folder = scenes_folder();
    if (!is_here(folder)) return;
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".glb" && entry.path().extension() != ".gltf") continue;
        Result<Scene> scene = load_scene(entry.path());
        if (!scene) continue;  // some are there to be refused
        CAPTURE(entry.path().string());
        for (const Mesh& mesh : scene->meshes)
            for (const bool quads : {false, true}) {
                ControlOptions options;
                options.quads = quads;
                options.crease_at_normals = quads;
                const ControlMesh c = control(mesh, options);
                CHECK(c.repairs.none() == c.warnings.empty());
                ++count;
            }
    }
    CHECK(count > 0);
}
