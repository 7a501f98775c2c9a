// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/scene/refine_mesh.h"

#include "aglow/refine/patches.h"
#include "aglow/refine/scene/displace.h"
#include "aglow/refine/scene/refined_surface.h"
#include "aglow/refine/scene/relief.h"
#include "aglow/refine/scene/skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace aglow::refine {
namespace {

/// Columns of the attributes that part along seams: all sets of texture coordinates, the colour,
/// the scalar tags.
struct Columns {
    explicit Columns(const Mesh& mesh) {
        for (const Primitive& p : mesh.primitives) {
            sets = std::max(sets, p.texcoords.size());
            colors |= !p.colors.empty();
            tags |= !p.sharpness.empty() || !p.tension.empty() || !p.bias.empty();
        }
    }
    size_t color() const { return 2 * sets; }
    size_t tag() const { return color() + (colors ? 4 : 0); }
    size_t width() const { return tag() + (tags ? 3 : 0); }

    size_t sets = 0;
    bool colors = false, tags = false;
};

float tag_at(const std::vector<float>& values, uint32_t vertex) {
    return values.empty() ? 0.0f : values[vertex];
}

bool is_patch(RefineScheme scheme) {
    return scheme == RefineScheme::pn || scheme == RefineScheme::tagged ||
           scheme == RefineScheme::phong || scheme == RefineScheme::flat;
}

class MeshRefiner {
public:
    MeshRefiner(const Mesh& mesh, const RefineOptions& options)
        : mesh_(mesh), options_(options), columns_(mesh) {}

    Result<Mesh> refine(std::vector<std::string>& warnings) {
        AG_TRY(control_, make_control_mesh(mesh_, options_.control));
        warnings.insert(warnings.end(), control_.warnings.begin(), control_.warnings.end());
        if (control_.topology.face_count() == 0) return mesh_;
        AG_TRY(surface_, make_surface());
        AG_CHECK(refine_attributes());
        AG_TRY(skin_, refine_skin(mesh_, control_, *surface_));
        AG_CHECK(surface_->place(rest_shape(), rest_));
        heights_ = heights();
        if (!heights_.empty()) displace(*surface_, heights_, rest_);
        AG_CHECK(refine_targets());
        Mesh refined = in_primitives();
        if (options_.model) AG_CHECK(add_models(refined));
        return refined;
    }

private:
    struct Target {
        std::vector<vec3> positions, normals;  // [refined vertex] displacements, or empty
    };

    Result<std::unique_ptr<RefinedSurface>> make_surface() const {
        if (!is_patch(options_.scheme)) return subdivision_surface(control_, options_);
        return patch_surface(control_, options_, rest_shape(), shape_tags());
    }

    std::vector<shared::ShapeTags> shape_tags() const {
        std::vector<shared::ShapeTags> tags;
        if (options_.scheme != RefineScheme::tagged) return tags;
        for (const VertexOf v : control_.vertices) {
            const Primitive& p = mesh_.primitives[v.primitive];
            tags.push_back({tag_at(p.sharpness, v.vertex), tag_at(p.tension, v.vertex),
                            tag_at(p.bias, v.vertex)});
        }
        return tags;
    }

    bool makes_normals() const { return options_.control.crease_angle || !has_own_normals(mesh_); }

    vec3 normal_at(VertexOf v) const { return mesh_.primitives[v.primitive].normals[v.vertex]; }

    Shape rest_shape() const {
        Shape shape{control_.positions, {}};
        if (!is_patch(options_.scheme)) return shape;
        if (makes_normals()) {
            shape.corner_normals = corner_normals(control_.topology, shape.positions);
        } else {
            for (const VertexOf corner : control_.corners)
                shape.corner_normals.push_back(normal_at(corner));
        }
        return shape;
    }

    const MorphTarget& target_of(VertexOf v, size_t target) const {
        return mesh_.primitives[v.primitive].targets[target];
    }

    Shape target_shape(size_t target) const {
        Shape shape = rest_shape();
        for (uint32_t v = 0; v < shape.positions.size(); ++v) {
            const VertexOf from = control_.vertices[v];
            const MorphTarget& of = target_of(from, target);
            if (!of.positions.empty())
                shape.positions[v] = shape.positions[v] + of.positions[from.vertex];
        }
        if (!is_patch(options_.scheme)) return shape;
        if (makes_normals()) {
            shape.corner_normals = corner_normals(control_.topology, shape.positions);
            return shape;
        }
        for (uint32_t h = 0; h < control_.corners.size(); ++h) {
            const VertexOf corner = control_.corners[h];
            const MorphTarget& of = target_of(corner, target);
            vec3& normal = shape.corner_normals[h];
            if (!of.normals.empty())
                normal = shared::unit_or(normal + of.normals[corner.vertex], normal);
        }
        return shape;
    }

    /// Refined and displaced.
    Result<RefinedShape> placed(const Shape& shape) const {
        RefinedShape refined;
        AG_CHECK(surface_->place(shape, refined));
        if (!heights_.empty()) displace(*surface_, heights_, refined);
        return refined;
    }

    /// By how much displacement moves each refined vertex, from where it is at rest; empty: none.
    std::vector<float> heights() const {
        std::vector<float> heights;
        if (const auto& field = options_.field) {
            for (const vec3 p : rest_.positions)
                heights.push_back(shared::displacement_at(*field, p).value);
        } else if (const auto& map = options_.displacement;
                   map && static_cast<size_t>(map->texcoord) < columns_.sets) {
            heights = map_heights(*surface_, *map, texcoords(map->texcoord));
        }
        return heights;
    }

    std::vector<vec2> texcoords(int set) const {
        std::vector<vec2> uvs;
        for (const uint32_t v : surface_->seams) {
            const float* row =
                attributes_.data() + v * columns_.width() + 2 * static_cast<size_t>(set);
            uvs.push_back({row[0], row[1]});
        }
        return uvs;
    }

    /// What a vertex of the seams has in the file; 0 where its primitive lacks an attribute.
    void put_row(VertexOf v, float* row) const {
        const Primitive& p = mesh_.primitives[v.primitive];
        for (size_t set = 0; set < p.texcoords.size(); ++set) {
            row[2 * set] = p.texcoords[set][v.vertex].x;
            row[2 * set + 1] = p.texcoords[set][v.vertex].y;
        }
        if (!p.colors.empty()) {
            const vec4 c = p.colors[v.vertex];
            const float channels[] = {c.x, c.y, c.z, c.w};
            std::copy_n(channels, 4, row + columns_.color());
        }
        if (columns_.tags) {
            row[columns_.tag()] = tag_at(p.sharpness, v.vertex);
            row[columns_.tag() + 1] = tag_at(p.tension, v.vertex);
            row[columns_.tag() + 2] = tag_at(p.bias, v.vertex);
        }
    }

    Status refine_attributes() {
        const size_t width = columns_.width();
        if (width == 0) return {};
        std::vector<float> control(control_.seam_vertices.size() * width, 0.0f);
        for (size_t v = 0; v < control_.seam_vertices.size(); ++v)
            put_row(control_.seam_vertices[v], control.data() + v * width);
        return surface_->interpolate(Layer::seams, control, static_cast<int>(width), attributes_);
    }

    Status refine_targets() {
        const size_t count = mesh_.primitives.front().targets.size();
        for (size_t t = 0; t < count; ++t) {
            const auto has = [&](auto member) {
                return std::ranges::any_of(mesh_.primitives, [&](const Primitive& p) {
                    return !(p.targets[t].*member).empty();
                });
            };
            Target target;
            // All primitives or none, for what one moves the others must follow at their border.
            const bool moves = has(&MorphTarget::positions), turns = has(&MorphTarget::normals);
            if (moves || turns) {
                AG_TRY(const RefinedShape shape, placed(target_shape(t)));
                for (size_t v = 0; moves && v < shape.positions.size(); ++v)
                    target.positions.push_back(shape.positions[v] - rest_.positions[v]);
                for (size_t v = 0; turns && v < shape.normals.size(); ++v)
                    target.normals.push_back(shape.normals[v] - rest_.normals[v]);
            }
            targets_.push_back(std::move(target));
        }
        return {};
    }

    Mesh in_primitives() {
        Mesh refined = mesh_;
        std::vector<std::vector<uvec3>> triangles(mesh_.primitives.size());
        for (uint32_t f = 0; f < control_.topology.face_count(); ++f)
            for (uint32_t t = surface_->face_triangle[f]; t < surface_->face_triangle[f + 1]; ++t)
                triangles[control_.face_primitive[f]].push_back(surface_->triangles[t]);
        std::vector<uint32_t> number(surface_->vertex_count(), kNone);
        for (size_t p = 0; p < triangles.size(); ++p) {
            // A primitive all of whose triangles vanish in lines is harmless as it is.
            if (triangles[p].empty()) continue;
            std::vector<uint32_t> vertices;
            for (uvec3& t : triangles[p])
                for (uint32_t* v : {&t.x, &t.y, &t.z}) {
                    if (number[*v] == kNone) {
                        number[*v] = static_cast<uint32_t>(vertices.size());
                        vertices.push_back(*v);
                    }
                    *v = number[*v];
                }
            refined.primitives[p] = primitive(mesh_.primitives[p], vertices);
            refined.primitives[p].triangles = std::move(triangles[p]);
        }
        add_sharp_tags(number, refined);
        return refined;
    }

    /// How sharp what was refined so often still is.
    float sharpness_left(float sharpness) const {
        return sharpness >= kSharp ? sharpness : sharpness - static_cast<float>(options_.level);
    }

    /// Of a mesh with tags: what is left of all that is sharp. `number` tells refined vertices as
    /// their primitive has them.
    void add_sharp_tags(std::span<const uint32_t> number, Mesh& refined) const {
        const bool tagged = std::ranges::any_of(mesh_.primitives, [](const Primitive& p) {
            return !p.creases.empty() || !p.corners.empty();
        });
        if (!tagged) return;
        const Topology& topology = control_.topology;
        const auto primitive_of = [&](uint32_t half) -> Primitive& {
            return refined.primitives[control_.face_primitive[topology.face[half]]];
        };
        for (uint32_t e = 0; e < topology.edge_count(); ++e) {
            const float left = sharpness_left(topology.edge_sharpness[e]);
            if (!(left > 0)) continue;
            const std::vector<uint32_t> chain = surface_->edge_vertices(topology.edge_half[e]);
            for (size_t i = 0; i + 1 < chain.size(); ++i)
                primitive_of(topology.edge_half[e])
                    .creases.push_back({number[chain[i]], number[chain[i + 1]], left});
        }
        for (uint32_t v = 0; v < topology.vertex_count(); ++v) {
            const float left = sharpness_left(topology.vertex_sharpness[v]);
            const uint32_t half = topology.vertex_half[v];
            if (left > 0 && half != kNone)
                primitive_of(half).corners.push_back({number[surface_->cut.vertex[half]], left});
        }
    }

    Primitive primitive(const Primitive& from, std::span<const uint32_t> vertices) const {
        Primitive out;
        out.material = from.material;
        for (const uint32_t v : vertices) {
            out.positions.push_back(rest_.positions[v]);
            out.normals.push_back(shared::unit_or(rest_.normals[v], vec3{0, 1, 0}));
        }
        add_attributes(from, vertices, out);
        if (!from.joints.empty()) add_skin(vertices, out);
        for (const Target& target : targets_) {
            MorphTarget morph;
            for (const uint32_t v : vertices) {
                if (!target.positions.empty()) morph.positions.push_back(target.positions[v]);
                if (!target.normals.empty()) morph.normals.push_back(target.normals[v]);
            }
            out.targets.push_back(std::move(morph));
        }
        return out;
    }

    void add_attributes(const Primitive& from, std::span<const uint32_t> vertices,
                        Primitive& out) const {
        out.texcoords.resize(from.texcoords.size());
        for (const uint32_t v : vertices)
            add_row(attributes_.data() + surface_->seams[v] * columns_.width(), from, out);
    }

    /// Columns of a vertex as the attributes that `from` has.
    void add_row(const float* row, const Primitive& from, Primitive& out) const {
        for (size_t set = 0; set < out.texcoords.size(); ++set)
            out.texcoords[set].push_back({row[2 * set], row[2 * set + 1]});
        const float* c = row + columns_.color();
        const auto channel = [&](int i) { return std::clamp(c[i], 0.0f, 1.0f); };
        if (!from.colors.empty())
            out.colors.push_back({channel(0), channel(1), channel(2), channel(3)});
        const float* tags = row + columns_.tag();
        if (!from.sharpness.empty()) out.sharpness.push_back(tags[0]);
        if (!from.tension.empty()) out.tension.push_back(tags[1]);
        if (!from.bias.empty()) out.bias.push_back(tags[2]);
    }

    Status add_models(Mesh& refined) const {
        for (const Primitive& p : mesh_.primitives)
            if (!p.joints.empty() || !p.targets.empty())
                return fail(Errc::bad_argument,
                            "models stand still: they cannot go onto a mesh with a skin or morph "
                            "targets");
        AG_TRY(const RaisedMesh raised,
               raise_model(control_, rest_shape(), shape_tags(), options_.scheme, *options_.model));
        std::vector<uint32_t> number(raised.positions.size());
        for (uint32_t v = 0; v < number.size(); ++v) {
            const uint32_t p = control_.face_primitive[raised.face[v]];
            Primitive& to = refined.primitives[p];
            number[v] = static_cast<uint32_t>(to.positions.size());
            to.positions.push_back(raised.positions[v]);
            to.normals.push_back(raised.normals[v]);
            add_row(row_at(raised.face[v], raised.coordinates[v]).data(), mesh_.primitives[p], to);
        }
        for (const uvec3 t : raised.triangles)
            refined.primitives[control_.face_primitive[raised.face[t.x]]].triangles.push_back(
                {number[t.x], number[t.y], number[t.z]});
        return {};
    }

    /// The columns at a place on a face, linear in those of its corners.
    std::vector<float> row_at(uint32_t face, vec2 at) const {
        const bool is_triangle = control_.topology.face_size(face) == 3;
        const float x = at.x, y = at.y;
        const std::array<float, 4> shares = {is_triangle ? 1 - x - y : (1 - x) * (1 - y),
                                             is_triangle ? x : x * (1 - y), is_triangle ? y : x * y,
                                             (1 - x) * y};
        std::vector<float> row(columns_.width(), 0.0f), corner(columns_.width());
        for (uint32_t i = 0; i < control_.topology.face_size(face); ++i) {
            std::ranges::fill(corner, 0.0f);
            put_row(control_.corners[control_.topology.face_begin[face] + i], corner.data());
            for (size_t c = 0; c < row.size(); ++c) row[c] += shares[i] * corner[c];
        }
        return row;
    }

    void add_skin(std::span<const uint32_t> vertices, Primitive& out) const {
        out.influences = skin_.influences;
        const auto width = static_cast<size_t>(skin_.influences);
        for (const uint32_t v : vertices) {
            const size_t at = surface_->whole[v] * width;
            for (size_t i = at; i < at + width; ++i) {
                const float weight = skin_.weights[i];
                out.weights.push_back(weight);
                out.joints.push_back(weight > 0 ? skin_.joints[i] : 0);
            }
        }
    }

    const Mesh& mesh_;
    const RefineOptions& options_;
    const Columns columns_;
    ControlMesh control_;
    std::unique_ptr<RefinedSurface> surface_;
    std::vector<float> attributes_;  // [refined vertex of the seams * columns_.width()]
    RefinedSkin skin_;
    RefinedShape rest_;
    std::vector<float> heights_;
    std::vector<Target> targets_;
};

}  // namespace

Result<Mesh> refine_mesh(const Mesh& mesh, const RefineOptions& options,
                         std::vector<std::string>& warnings) {
    const bool solid = std::ranges::any_of(mesh.primitives,
                                           [](const Primitive& p) { return !p.triangles.empty(); });
    if (!solid) return mesh;
    return MeshRefiner(mesh, options).refine(warnings);
}

}  // namespace aglow::refine
