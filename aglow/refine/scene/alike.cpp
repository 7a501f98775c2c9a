// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/scene/alike.h"

#include "aglow/mesh/control_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace aglow::refine {
namespace {

// Of the largest coordinate: what copies lose that were turned and moved in single precision.
constexpr float kRounding = 4e-7f;
constexpr float kSameNormal = 0.9999f;

struct Vector {
    double x = 0, y = 0, z = 0;
};
Vector to_double(vec3 v) { return {double(v.x), double(v.y), double(v.z)}; }
Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator*(Vector a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(Vector a, Vector b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vector unit(Vector v) { return v * (1 / std::sqrt(dot(v, v))); }

using Points = std::vector<Vector>;
/// Columns of a rotation.
using Rotation = std::array<Vector, 3>;

Vector turned(const Rotation& r, Vector v) { return r[0] * v.x + r[1] * v.y + r[2] * v.z; }

/// Of all primitives, about their mean.
Points centred(const Mesh& mesh, Vector& centre) {
    Points points;
    for (const Primitive& p : mesh.primitives)
        for (const vec3 v : p.positions) points.push_back(to_double(v));
    for (const Vector p : points) centre = centre + p;
    centre = centre * (1 / std::max(static_cast<double>(points.size()), 1.0));
    for (Vector& p : points) p = p - centre;
    return points;
}

/// An orthonormal frame that points a and b span.
Rotation frame_of(Vector a, Vector b) {
    const Vector x = unit(a), z = unit(cross(a, b));
    return {x, cross(z, x), z};
}

/// From the frames of the points that span the most.
std::optional<Rotation> rough_rotation(const Points& from, const Points& to) {
    const auto best = [&](const auto& size) {
        const auto found = std::ranges::max_element(from, {}, [&](Vector p) { return size(p); });
        return static_cast<size_t>(found - from.begin());
    };
    const size_t a = best([](Vector p) { return dot(p, p); });
    const auto area = [&](Vector p) { return dot(cross(from[a], p), cross(from[a], p)); };
    const size_t b = best(area);
    const Vector there = cross(to[a], to[b]);
    if (!(area(from[b]) > 0) || !(dot(there, there) > 0)) return std::nullopt;
    const Rotation f = frame_of(from[a], from[b]), t = frame_of(to[a], to[b]);
    return Rotation{t[0] * f[0].x + t[1] * f[1].x + t[2] * f[2].x,
                    t[0] * f[0].y + t[1] * f[1].y + t[2] * f[2].y,
                    t[0] * f[0].z + t[1] * f[1].z + t[2] * f[2].z};
}

/// A step of least squares over all points, by the small turn w with sum r x (d - w x r) = 0.
Rotation improved(const Rotation& rotation, const Points& from, const Points& to) {
    Vector moment;
    Rotation inertia{};  // symmetric
    for (size_t i = 0; i < from.size(); ++i) {
        const Vector r = turned(rotation, from[i]);
        moment = moment + cross(r, to[i] - r);
        const double square = dot(r, r);
        inertia[0] = inertia[0] + Vector{square, 0, 0} - r * r.x;
        inertia[1] = inertia[1] + Vector{0, square, 0} - r * r.y;
        inertia[2] = inertia[2] + Vector{0, 0, square} - r * r.z;
    }
    const double determinant = dot(inertia[0], cross(inertia[1], inertia[2]));
    if (!(determinant > 0)) return rotation;
    const Vector w = Vector{dot(moment, cross(inertia[1], inertia[2])),
                            dot(moment, cross(inertia[2], inertia[0])),
                            dot(moment, cross(inertia[0], inertia[1]))} *
                     (1 / determinant);
    const Vector x = unit(rotation[0] + cross(w, rotation[0]));
    const Vector z = unit(cross(x, rotation[1] + cross(w, rotation[1])));
    return {x, cross(z, x), z};
}

mat4 motion_of(const Rotation& r, Vector from, Vector to) {
    const Vector t = to - turned(r, from);
    mat4 motion;
    const std::array columns = {r[0], r[1], r[2], t};
    for (size_t c = 0; c < columns.size(); ++c) {
        motion.m[4 * c] = static_cast<float>(columns[c].x);
        motion.m[4 * c + 1] = static_cast<float>(columns[c].y);
        motion.m[4 * c + 2] = static_cast<float>(columns[c].z);
    }
    return motion;
}

float largest_coordinate(const Mesh& mesh) {
    float largest = 0;
    for (const Primitive& p : mesh.primitives)
        for (const vec3 v : p.positions)
            largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    return largest;
}

bool lands_on(const mat4& motion, const Primitive& from, const Primitive& to, float tolerance) {
    for (size_t v = 0; v < from.positions.size(); ++v) {
        if (length(transform_point(motion, from.positions[v]) - to.positions[v]) > tolerance)
            return false;
        const vec3 normal = transform_direction(motion, from.normals[v]);
        if (aglow::shared::dot(normal, to.normals[v]) < kSameNormal) return false;
    }
    return true;
}

/// All but material and place.
bool same_make(const Primitive& a, const Primitive& b) {
    if (a.positions.size() != b.positions.size() || a.triangles != b.triangles) return false;
    Primitive moved = b;
    moved.positions = a.positions;
    moved.normals = a.normals;
    return same_geometry(a, moved);
}

/// The rigid motion that takes `from` to `to`.
std::optional<mat4> motion_between(const Mesh& from, const Mesh& to) {
    for (size_t p = 0; p < from.primitives.size(); ++p)
        if (!same_make(from.primitives[p], to.primitives[p])) return std::nullopt;
    Vector from_centre, to_centre;
    const Points from_points = centred(from, from_centre), to_points = centred(to, to_centre);
    if (from_points.empty()) return std::nullopt;
    const std::optional<Rotation> rough = rough_rotation(from_points, to_points);
    if (!rough) return std::nullopt;
    const mat4 motion = motion_of(improved(*rough, from_points, to_points), from_centre, to_centre);
    const float tolerance = kRounding * std::max(largest_coordinate(from), largest_coordinate(to));
    for (size_t p = 0; p < from.primitives.size(); ++p)
        if (!lands_on(motion, from.primitives[p], to.primitives[p], tolerance)) return std::nullopt;
    return motion;
}

bool is_closed(const Mesh& mesh) {
    const auto control = make_control_mesh(mesh);
    return control &&
           std::ranges::find(control->topology.twin, kNone) == control->topology.twin.end();
}

/// [mesh] May it be shown through other nodes?
std::vector<bool> movable(const Scene& scene) {
    std::vector<bool> movable;
    for (const Mesh& mesh : scene.meshes)
        movable.push_back(std::ranges::all_of(mesh.primitives, [](const Primitive& p) {
            return p.joints.empty() && p.targets.empty();
        }));
    for (const Node& node : scene.nodes)
        if (node.mesh >= 0 && (node.skin >= 0 || !node.instances.empty()))
            movable[static_cast<size_t>(node.mesh)] = false;
    for (size_t m = 0; m < movable.size(); ++m)
        if (movable[m]) movable[m] = is_closed(scene.meshes[m]);
    return movable;
}

bool same(const Mesh& a, const Mesh& b) {
    return std::ranges::equal(a.primitives, b.primitives, same_geometry);
}

/// Sizes that meshes must share to be alike.
std::vector<size_t> sizes(const Mesh& mesh) {
    std::vector<size_t> sizes;
    for (const Primitive& p : mesh.primitives)
        sizes.insert(sizes.end(), {p.triangles.size(), p.positions.size()});
    return sizes;
}

}  // namespace

std::vector<Likeness> find_alike(const Scene& scene, Motions motions) {
    std::vector<Likeness> alike(scene.meshes.size());
    const std::vector<bool> may_move =
        motions == Motions::rigid ? movable(scene) : std::vector<bool>(alike.size(), false);
    std::map<std::vector<size_t>, std::vector<size_t>> firsts;
    for (size_t m = 0; m < alike.size(); ++m) {
        alike[m].mesh = m;
        std::vector<size_t>& candidates = firsts[sizes(scene.meshes[m])];
        for (const size_t first : candidates)
            if (same(scene.meshes[first], scene.meshes[m])) alike[m].mesh = first;
        for (size_t i = 0; i < candidates.size() && alike[m].mesh == m && may_move[m]; ++i) {
            const auto motion = motion_between(scene.meshes[candidates[i]], scene.meshes[m]);
            if (motion) alike[m] = {candidates[i], true, *motion};
        }
        if (alike[m].mesh == m) candidates.push_back(m);
    }
    return alike;
}

void place_moved(Scene& scene, const std::vector<Likeness>& alike) {
    const size_t count = scene.nodes.size();
    for (size_t n = 0; n < count; ++n) {
        const int mesh = scene.nodes[n].mesh;
        if (mesh < 0 || !alike[static_cast<size_t>(mesh)].moved) continue;
        Node child;
        child.name = scene.nodes[n].name;
        child.parent = static_cast<int>(n);
        child.has_matrix = true;
        child.matrix = alike[static_cast<size_t>(mesh)].motion;
        child.mesh = mesh;
        child.in_scene = scene.nodes[n].in_scene;
        scene.nodes[n].mesh = -1;
        scene.nodes[n].children.push_back(static_cast<int>(scene.nodes.size()));
        scene.nodes.push_back(std::move(child));
    }
}

}  // namespace aglow::refine
