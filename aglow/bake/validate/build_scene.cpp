// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/validate/build_scene.h"

#include <array>

namespace aglow::validation {

int add_material(Scene& scene, vec3 rho, vec3 luminance, Sides sides) {
    Material material;
    material.name = "material " + std::to_string(scene.materials.size());
    material.base_color = {rho.x, rho.y, rho.z, 1};
    material.metallic = 0;
    material.emission = luminance;
    material.double_sided = sides == Sides::two;
    scene.materials.push_back(std::move(material));
    return static_cast<int>(scene.materials.size()) - 1;
}

namespace {

/// Four vertices and two triangles of the parallelogram, with its flat normal.
void append_rectangle(Primitive& primitive, vec3 corner, vec3 u, vec3 v) {
    const auto first = static_cast<uint32_t>(primitive.positions.size());
    const vec3 normal = normalize(cross(u, v));
    for (vec3 p : {corner, corner + u, corner + u + v, corner + v}) {
        primitive.positions.push_back(p);
        primitive.normals.push_back(normal);
    }
    primitive.triangles.push_back({first, first + 1, first + 2});
    primitive.triangles.push_back({first, first + 2, first + 3});
}

int add_mesh_node(Scene& scene, Primitive primitive) {
    Mesh mesh;
    mesh.name = "mesh " + std::to_string(scene.meshes.size());
    mesh.primitives.push_back(std::move(primitive));
    Node node;
    node.name = "node " + std::to_string(scene.nodes.size());
    node.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(std::move(node));
    return static_cast<int>(scene.nodes.size()) - 1;
}

/// The rotation that turns -Z into `direction`.
vec4 turn_to(vec3 direction) {
    const vec3 from{0, 0, -1};
    const float cosine = dot(from, direction);
    if (cosine < -0.999999f) return {0, 1, 0, 0};  // half a turn about any axis at right angles
    const vec3 axis = cross(from, direction);
    const float w = 1 + cosine;
    const float norm = std::sqrt(dot(axis, axis) + w * w);
    return {axis.x / norm, axis.y / norm, axis.z / norm, w / norm};
}

}  // namespace

int add_rectangle(Scene& scene, int material, vec3 corner, vec3 u, vec3 v) {
    Primitive primitive;
    primitive.material = material;
    append_rectangle(primitive, corner, u, v);
    return add_mesh_node(scene, std::move(primitive));
}

int add_box(Scene& scene, int material, vec3 lo, vec3 hi, Facing facing) {
    const vec3 size = hi - lo;
    const vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    struct Face {
        vec3 corner, u, v;  // front outwards
    };
    const std::array<Face, 6> faces = {Face{lo, y, x},     Face{lo + z, x, y}, Face{lo, z, y},
                                       Face{lo + x, y, z}, Face{lo, x, z},     Face{lo + y, z, x}};
    Primitive primitive;
    primitive.material = material;
    for (const Face& face : faces) {
        const bool inwards = facing == Facing::inwards;
        append_rectangle(primitive, face.corner, inwards ? face.v : face.u,
                         inwards ? face.u : face.v);
    }
    return add_mesh_node(scene, std::move(primitive));
}

void add_light(Scene& scene, Light light, vec3 position, vec3 direction) {
    Node node;
    node.name = "light " + std::to_string(scene.lights.size());
    node.translation = position;
    node.rotation = turn_to(direction);
    node.light = static_cast<int>(scene.lights.size());
    scene.lights.push_back(std::move(light));
    scene.nodes.push_back(std::move(node));
}

void scale_scene(Scene& scene, double scale) {
    const auto s = static_cast<float>(scale);
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives)
            for (vec3& p : primitive.positions) p *= s;
    for (Node& node : scene.nodes) node.translation *= s;
    for (Light& light : scene.lights) {
        if (light.kind != LightKind::directional) light.intensity *= s * s;
        light.range *= s;
    }
}

Receiver sensor(vec3 position, vec3 normal) {
    return {.position = position, .normal = normal, .geometric_normal = normal};
}

}  // namespace aglow::validation
