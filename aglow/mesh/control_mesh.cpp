// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/control_mesh.h"

#include "aglow/mesh/topology/equal_rows.h"
#include "aglow/mesh/topology/quads.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <unordered_map>
#include <utility>

namespace aglow {
namespace {

using mesh::EqualRows;
using mesh::Rows;

// Normals that differ by less are the same direction, stored in few bits.
constexpr float kSameNormal = 1 * kPi / 180;

/// Numbers all vertices of a mesh, those of one primitive after those of another.
class FileVertices {
public:
    explicit FileVertices(const Mesh& mesh) {
        for (const Primitive& p : mesh.primitives)
            begin_.push_back(begin_.back() + p.positions.size());
    }
    uint64_t count() const { return begin_.back(); }
    uint32_t number(uint32_t primitive, uint32_t vertex) const {
        return static_cast<uint32_t>(begin_[primitive] + vertex);
    }
    VertexOf operator[](uint32_t number) const {
        const auto next = std::ranges::upper_bound(begin_, number);
        const auto primitive = static_cast<uint32_t>(next - begin_.begin() - 1);
        return {primitive, static_cast<uint32_t>(number - begin_[primitive])};
    }

private:
    std::vector<uint64_t> begin_ = {0};  // [primitive + 1]
};

void add(Rows& rows, vec3 v) {
    for (const float x : {v.x, v.y, v.z}) rows.add(x);
}

/// Joints in the order of their numbers, without those that have no weight: how a vertex moves does
/// not depend on how its influences are listed.
void add_influences(Rows& rows, const Primitive& p, size_t v) {
    const auto width = static_cast<size_t>(p.influences);
    std::vector<std::pair<uint32_t, float>> influences;
    for (size_t i = v * width; i < (v + 1) * width && !p.joints.empty(); ++i)
        if (p.weights[i] > 0) influences.emplace_back(p.joints[i], p.weights[i]);
    std::ranges::sort(influences);
    for (const auto& [joint, weight] : influences) {
        rows.add(joint);
        rows.add(weight);
    }
}

/// [file vertex] Which stand in the same place in every pose.
EqualRows find_places(const Mesh& mesh) {
    Rows rows;
    for (const Primitive& p : mesh.primitives)
        for (size_t v = 0; v < p.positions.size(); ++v) {
            add(rows, p.positions[v]);
            for (const MorphTarget& target : p.targets)
                add(rows, target.positions.empty() ? vec3{0, 0, 0} : target.positions[v]);
            add_influences(rows, p, v);
            rows.end_row();
        }
    return find_equal(rows);
}

/// [file vertex] Which look the same too: one place, one primitive, one colour and texture.
EqualRows find_looks(const Mesh& mesh, const EqualRows& places) {
    Rows rows;
    for (uint32_t i = 0; i < mesh.primitives.size(); ++i) {
        const Primitive& p = mesh.primitives[i];
        for (size_t v = 0; v < p.positions.size(); ++v) {
            rows.add(places.of[rows.count()]);
            rows.add(i);
            for (const std::vector<vec2>& set : p.texcoords) {
                rows.add(set[v].x);
                rows.add(set[v].y);
            }
            if (!p.colors.empty()) {
                add(rows, {p.colors[v].x, p.colors[v].y, p.colors[v].z});
                rows.add(p.colors[v].w);
            }
            rows.end_row();
        }
    }
    return find_equal(rows);
}

/// Faces in the making.
struct Faces {
    PolygonList polygons;            // over sheet vertices
    std::vector<uint32_t> file;      // [corner] file vertex
    std::vector<uint32_t> triangle;  // [face] the first, counted through all primitives

    void end_face(uint32_t first_triangle) {
        polygons.face_begin.push_back(static_cast<uint32_t>(polygons.corners.size()));
        triangle.push_back(first_triangle);
    }
};

/// Vertices of surfaces: a place has one for each of the sheets that cover each other there.
class Sheets {
public:
    explicit Sheets(uint32_t place_count) : lowest_(place_count, kNone) {}

    uint32_t vertex(uint32_t place, uint32_t sheet) {
        uint32_t& known = sheet == 0 ? lowest_[place]
                                     : others_.try_emplace(key(place, sheet), kNone).first->second;
        if (known == kNone) {
            known = static_cast<uint32_t>(places_.size());
            places_.push_back(place);
            sheet_count_ = std::max(sheet_count_, sheet + 1);
        }
        return known;
    }
    /// kNone where no face is.
    uint32_t find(uint32_t place, uint32_t sheet) const {
        if (sheet == 0) return lowest_[place];
        const auto found = others_.find(key(place, sheet));
        return found == others_.end() ? kNone : found->second;
    }
    uint32_t place(uint32_t vertex) const { return places_[vertex]; }
    uint32_t vertex_count() const { return static_cast<uint32_t>(places_.size()); }
    uint32_t sheet_count() const { return sheet_count_; }

private:
    static uint64_t key(uint32_t place, uint32_t sheet) { return uint64_t{sheet} << 32 | place; }

    std::vector<uint32_t> lowest_;                   // [place]
    std::unordered_map<uint64_t, uint32_t> others_;  // (sheet, place)
    std::vector<uint32_t> places_;                   // [vertex]
    uint32_t sheet_count_ = 1;
};

class Welder {
public:
    Welder(const Mesh& mesh, const ControlOptions& options)
        : mesh_(mesh), options_(options), file_(mesh) {}

    Result<ControlMesh> weld() {
        if (file_.count() >= kNone)
            return fail(Errc::out_of_memory, "a mesh has more than 2^32 vertices");
        places_ = find_places(mesh_);
        looks_ = find_looks(mesh_, places_);
        Sheets sheets(places_.class_count);
        Faces faces = gather_faces(sheets);
        const std::vector<Crease> creases = tagged_creases(sheets);
        if (options_.quads) {
            AG_TRY(faces, join_quads(faces, creases));
        }
        AG_TRY(TopologyResult built, build_topology(faces.polygons, creases));
        out_.topology = std::move(built.topology);
        out_.repairs.cut_edges = built.repairs.cut_edges;
        out_.repairs.split_vertices = built.repairs.split_vertices;
        out_.repairs.stray_creases = built.repairs.stray_creases;
        fill_vertices(faces);
        sharpen_edges();
        sharpen_vertices();
        AG_CHECK(make_seams(faces));
        warn();
        return std::move(out_);
    }

private:
    /// Triangles with three different places; those of the same three lie in different sheets.
    Faces gather_faces(Sheets& sheets) {
        Faces faces;
        Rows rows;
        uint32_t triangle = 0;
        for (uint32_t p = 0; p < mesh_.primitives.size(); ++p)
            for (const uvec3 t : mesh_.primitives[p].triangles) {
                std::array<uint32_t, 3> place{};
                for (size_t i = 0; const uint32_t v : {t.x, t.y, t.z}) {
                    faces.file.push_back(file_.number(p, v));
                    place[i++] = places_.of[faces.file.back()];
                }
                std::ranges::sort(place);
                if (place[0] == place[1] || place[1] == place[2]) {
                    faces.file.resize(faces.file.size() - 3);
                    ++out_.repairs.dropped_faces;
                } else {
                    faces.triangle.push_back(triangle);
                    for (const uint32_t v : place) rows.add(v);
                    rows.end_row();
                }
                ++triangle;
            }
        const EqualRows covering = find_equal(rows);
        std::vector<uint32_t> sheet_count(covering.class_count, 0);
        for (uint32_t f = 0; f < faces.triangle.size(); ++f) {
            const uint32_t sheet = sheet_count[covering.of[f]]++;
            for (size_t c = 3 * size_t{f}; c < 3 * size_t{f} + 3; ++c)
                faces.polygons.corners.push_back(sheets.vertex(places_.of[faces.file[c]], sheet));
            faces.polygons.face_begin.push_back(3 * (f + 1));
        }
        faces.polygons.vertex_count = sheets.vertex_count();
        corner_sharpness(sheets);
        return faces;
    }

    std::vector<Crease> tagged_creases(const Sheets& sheets) const {
        std::vector<Crease> creases;
        for (uint32_t p = 0; p < mesh_.primitives.size(); ++p)
            for (const SharpEdge& tag : mesh_.primitives[p].creases) {
                const uint32_t a = places_.of[file_.number(p, tag.a)];
                const uint32_t b = places_.of[file_.number(p, tag.b)];
                for (uint32_t s = 0; s < sheets.sheet_count(); ++s)
                    if (sheets.find(a, s) != kNone && sheets.find(b, s) != kNone)
                        creases.push_back({sheets.find(a, s), sheets.find(b, s), tag.sharpness});
            }
        return creases;
    }

    /// [sheet vertex] What the tagged corners ask for.
    void corner_sharpness(const Sheets& sheets) {
        std::vector<float> of_place(places_.class_count, 0.0f);
        for (uint32_t p = 0; p < mesh_.primitives.size(); ++p)
            for (const SharpVertex& tag : mesh_.primitives[p].corners) {
                float& sharpness = of_place[places_.of[file_.number(p, tag.vertex)]];
                sharpness = std::max(sharpness, tag.sharpness);
            }
        for (uint32_t v = 0; v < sheets.vertex_count(); ++v)
            corner_sharpness_.push_back(of_place[sheets.place(v)]);
    }

    vec3 position(uint32_t file_vertex) const {
        const VertexOf v = file_[file_vertex];
        return mesh_.primitives[v.primitive].positions[v.vertex];
    }

    /// Edges whose triangles are of one primitive and look the same on both sides.
    std::vector<bool> joinable_edges(const Topology& t, const Faces& faces) const {
        std::vector<bool> joinable(t.edge_count(), false);
        for (uint32_t e = 0; e < t.edge_count(); ++e) {
            const uint32_t h = t.edge_half[e], twin = t.twin[h];
            if (twin == kNone || t.edge_sharpness[e] > 0) continue;
            const auto look = [&](uint32_t corner) { return looks_.of[faces.file[corner]]; };
            joinable[e] = look(h) == look(t.next(twin)) && look(t.next(h)) == look(twin);
        }
        return joinable;
    }

    Result<Faces> join_quads(const Faces& triangles, std::span<const Crease> creases) {
        AG_TRY(const TopologyResult built, build_topology(triangles.polygons, creases));
        const Topology& t = built.topology;
        std::vector<vec3> positions(t.vertex_count());
        for (uint32_t h = 0; h < t.half_edge_count(); ++h)
            positions[t.vertex[h]] = position(triangles.file[h]);
        const std::vector<uint32_t> diagonal =
            mesh::pair_triangles(t, positions, joinable_edges(t, triangles));
        Faces joined;
        joined.polygons.vertex_count = triangles.polygons.vertex_count;
        const auto add_corner = [&](uint32_t h) {
            joined.polygons.corners.push_back(triangles.polygons.corners[h]);
            joined.file.push_back(triangles.file[h]);
        };
        for (uint32_t f = 0; f < t.face_count(); ++f) {
            const uint32_t twin = diagonal[f] == kNone ? kNone : t.twin[diagonal[f]];
            if (twin != kNone && t.face[twin] < f) continue;
            for (uint32_t h = t.face_begin[f]; h < t.face_begin[f + 1]; ++h) {
                add_corner(h);
                if (h == diagonal[f]) add_corner(t.previous(twin));
            }
            joined.end_face(triangles.triangle[f]);
            out_.quad_count += twin != kNone;
        }
        return joined;
    }

    void fill_vertices(const Faces& faces) {
        Topology& t = out_.topology;
        for (uint32_t& face : t.source_face) face = faces.triangle[face];
        out_.positions.resize(t.vertex_count());
        out_.vertices.resize(t.vertex_count());
        for (const uint32_t file_vertex : faces.file) out_.corners.push_back(file_[file_vertex]);
        for (uint32_t h = t.half_edge_count(); h-- > 0;) {
            out_.vertices[t.vertex[h]] = out_.corners[h];
            out_.positions[t.vertex[h]] = position(faces.file[h]);
        }
        for (uint32_t f = 0; f < t.face_count(); ++f)
            out_.face_primitive.push_back(out_.corners[t.face_begin[f]].primitive);
    }

    /// Twice the area times the normal.
    vec3 area_normal(uint32_t f) const {
        const Topology& t = out_.topology;
        const vec3 origin = out_.positions[t.vertex[t.face_begin[f]]];
        vec3 sum{0, 0, 0};
        for (uint32_t h = t.face_begin[f] + 1; h + 1 < t.face_begin[f + 1]; ++h)
            sum = sum + cross(out_.positions[t.vertex[h]] - origin,
                              out_.positions[t.vertex[h + 1]] - origin);
        return sum;
    }

    static float angle(vec3 a, vec3 b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

    vec3 file_normal(uint32_t h) const {
        const VertexOf v = out_.corners[h];
        return mesh_.primitives[v.primitive].normals[v.vertex];
    }

    bool normals_differ(uint32_t h, uint32_t twin) const {
        const Topology& t = out_.topology;
        return angle(file_normal(h), file_normal(t.next(twin))) > kSameNormal ||
               angle(file_normal(t.next(h)), file_normal(twin)) > kSameNormal;
    }

    void sharpen_edges() {
        Topology& t = out_.topology;
        if (!options_.crease_angle && !options_.crease_at_normals) return;
        std::vector<vec3> normals;
        for (uint32_t f = 0; f < t.face_count(); ++f) {
            const vec3 normal = area_normal(f);
            const float size = length(normal);
            normals.push_back(size > 0 ? normal * (1 / size) : normal);
        }
        for (uint32_t e = 0; e < t.edge_count(); ++e) {
            const uint32_t h = t.edge_half[e], twin = t.twin[h];
            if (twin == kNone) continue;
            const bool steep =
                options_.crease_angle &&
                angle(normals[t.face[h]], normals[t.face[twin]]) > *options_.crease_angle;
            if (steep || (options_.crease_at_normals && normals_differ(h, twin)))
                t.edge_sharpness[e] = kSharp;  // no tag can ask for more
        }
    }

    void sharpen_vertices() {
        Topology& t = out_.topology;
        for (uint32_t v = 0; v < t.vertex_count(); ++v)
            t.vertex_sharpness[v] = corner_sharpness_[t.source_vertex[v]];
    }

    Status make_seams(const Faces& faces) {
        std::vector<uint32_t> number(looks_.class_count, kNone);
        std::vector<uint32_t> corners;
        uint32_t count = 0;
        for (const uint32_t file_vertex : faces.file) {
            uint32_t& of_look = number[looks_.of[file_vertex]];
            if (of_look == kNone) of_look = count++;
            corners.push_back(of_look);
        }
        AG_TRY(out_.seams, cut_seams(out_.topology, corners, count));
        for (const uint32_t h : out_.seams.vertex_half) {
            out_.seam_vertices.push_back(out_.corners[h]);
            out_.seam_to_vertex.push_back(out_.topology.vertex[h]);
        }
        return {};
    }

    void warn() {
        const std::string mesh =
            mesh_.name.empty() ? "a mesh" : fmt::format("mesh \"{}\"", mesh_.name);
        const auto say = [&](uint32_t count, const char* what) {
            if (count > 0) out_.warnings.push_back(fmt::format("{}: {} {}", mesh, count, what));
        };
        say(out_.repairs.dropped_faces, "triangles without three different corners are left out");
        say(out_.repairs.cut_edges,
            "edges of more than two faces, or of faces that disagree about their front, are cut");
        say(out_.repairs.split_vertices, "points in which surfaces only touch are split");
        say(out_.repairs.stray_creases, "creases run along no edge and are left out");
    }

    const Mesh& mesh_;
    const ControlOptions& options_;
    FileVertices file_;
    EqualRows places_;
    EqualRows looks_;
    std::vector<float> corner_sharpness_;  // [sheet vertex]
    ControlMesh out_;
};

}  // namespace

bool has_own_normals(const Mesh& mesh) {
    return std::ranges::any_of(mesh.primitives, [](const Primitive& p) {
        return !p.triangles.empty() && p.source_vertex.empty();
    });
}

Result<ControlMesh> make_control_mesh(const Mesh& mesh, const ControlOptions& options) {
    try {
        return Welder(mesh, options).weld();
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory,
                    fmt::format("mesh \"{}\" does not fit into memory", mesh.name));
    }
}

}  // namespace aglow
