// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/geometry.h"

#include <cmath>

namespace aglow::builtin {
namespace {

/// Quaternion of the rotation whose matrix has these columns: orthonormal and right-handed.
/// Source  Shepperd, "Quaternion from Rotation Matrix", J. Guidance and Control, 1978.
vec4 quaternion(vec3 x, vec3 y, vec3 z) {
    const float trace = x.x + y.y + z.z;
    vec4 q;
    if (trace > 0)
        q = {y.z - z.y, z.x - x.z, x.y - y.x, 1 + trace};
    else if (x.x > y.y && x.x > z.z)
        q = {1 + x.x - y.y - z.z, x.y + y.x, z.x + x.z, y.z - z.y};
    else if (y.y > z.z)
        q = {x.y + y.x, 1 - x.x + y.y - z.z, y.z + z.y, z.x - x.z};
    else
        q = {z.x + x.z, y.z + z.y, 1 - x.x - y.y + z.z, x.y - y.x};
    return q * (1 / std::sqrt(dot(q, q)));
}

Primitive to_primitive(const Shape& shape, int material, bool has_texture) {
    Primitive primitive;
    primitive.material = material;
    primitive.triangles = shape.triangles;
    primitive.positions = shape.positions;
    primitive.normals = shape.normals;
    if (has_texture) primitive.texcoords = {shape.texcoords};
    return primitive;
}

}  // namespace

int SceneBuilder::diffuse(std::string name, vec3 reflectance) {
    Material material;
    material.name = std::move(name);
    material.base_color = {reflectance.x, reflectance.y, reflectance.z, 1};
    material.metallic = 0;
    scene_.materials.push_back(std::move(material));
    return static_cast<int>(scene_.materials.size()) - 1;
}

int SceneBuilder::textured(TextureImage image, vec3 tint) {
    const int index = diffuse(image.name, tint);
    Texture texture;
    texture.image = static_cast<int>(scene_.images.size());
    material(index).base_color_texture.texture = static_cast<int>(scene_.textures.size());
    scene_.images.push_back(std::move(image));
    scene_.textures.push_back(texture);
    return index;
}

int SceneBuilder::luminous(std::string name, vec3 reflectance, vec3 luminance) {
    const int index = diffuse(std::move(name), reflectance);
    material(index).emission = luminance;
    return index;
}

void SceneBuilder::add(std::string name, const Shape& shape, int material) {
    add(std::move(name), {{shape, material}});
}

void SceneBuilder::add(std::string name, std::initializer_list<Part> parts) {
    Node node;
    node.name = name;
    node.mesh = static_cast<int>(scene_.meshes.size());
    Mesh mesh;
    mesh.name = std::move(name);
    for (const Part& part : parts) {
        const bool has_texture = material(part.material).base_color_texture.texture >= 0;
        mesh.primitives.push_back(to_primitive(part.shape, part.material, has_texture));
    }
    scene_.meshes.push_back(std::move(mesh));
    scene_.nodes.push_back(std::move(node));
}

void SceneBuilder::add_light(Light light, vec3 position) {
    Node node;
    node.name = light.name;
    node.translation = position;
    node.light = static_cast<int>(scene_.lights.size());
    scene_.lights.push_back(std::move(light));
    scene_.nodes.push_back(std::move(node));
}

void SceneBuilder::add_directional(Light light, float azimuth_degrees, float elevation_degrees) {
    const float azimuth = azimuth_degrees * kPi / 180, elevation = elevation_degrees * kPi / 180;
    const vec3 to_light{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                        -std::cos(azimuth) * std::cos(elevation)};
    add_light(std::move(light), {0, 0, 0});
    const vec3 right = Frame(to_light).tangent;  // lights shine along -Z of their node
    scene_.nodes.back().rotation = quaternion(right, cross(to_light, right), to_light);
}

void SceneBuilder::look(vec3 eye, vec3 target, float y_fov_degrees) {
    const vec3 back = normalize(eye - target);
    const vec3 right = normalize(cross({0, 1, 0}, back));
    Camera camera;
    camera.name = "camera";
    camera.y_fov = y_fov_degrees * kPi / 180;
    Node node;
    node.name = "camera";
    node.camera = static_cast<int>(scene_.cameras.size());
    node.translation = eye;
    node.rotation = quaternion(right, cross(back, right), back);
    scene_.cameras.push_back(std::move(camera));
    scene_.nodes.push_back(std::move(node));
}

float Dice::next() {
    state_ += 0x9e3779b97f4a7c15ull;
    uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    z ^= z >> 31;
    return static_cast<float>(z >> 40) / static_cast<float>(1 << 24);
}

}  // namespace aglow::builtin
