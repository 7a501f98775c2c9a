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

vec4 turn(vec3 axis, float degrees) {
    const float half = degrees * kPi / 360;
    const vec3 v = normalize(axis) * std::sin(half);
    return {v.x, v.y, v.z, std::cos(half)};
}

vec4 then(vec4 first, vec4 second) {
    const vec3 a{second.x, second.y, second.z}, b{first.x, first.y, first.z};
    const vec3 v = b * second.w + a * first.w + cross(a, b);
    return {v.x, v.y, v.z, second.w * first.w - dot(a, b)};
}

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

int SceneBuilder::metal(std::string name, vec3 reflectance, float roughness) {
    const int index = glossy(std::move(name), reflectance, roughness);
    material(index).metallic = 0.75f;
    return index;
}

int SceneBuilder::glossy(std::string name, vec3 reflectance, float roughness) {
    const int index = diffuse(std::move(name), reflectance);
    material(index).roughness = roughness;
    return index;
}

int SceneBuilder::add(std::string name, const Shape& shape, int material) {
    return add(std::move(name), {{shape, material}});
}

int SceneBuilder::add(std::string name, std::initializer_list<Part> parts) {
    const int mesh = add_mesh(name, parts);
    return add_node(std::move(name), mesh);
}

int SceneBuilder::add_mesh(std::string name, std::initializer_list<Part> parts) {
    Mesh mesh;
    mesh.name = std::move(name);
    for (const Part& part : parts) {
        const bool has_texture = material(part.material).base_color_texture.texture >= 0;
        mesh.primitives.push_back(to_primitive(part.shape, part.material, has_texture));
    }
    scene_.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene_.meshes.size()) - 1;
}

int SceneBuilder::add_node(std::string name, int mesh) {
    Node node;
    node.name = std::move(name);
    node.mesh = mesh;
    scene_.nodes.push_back(std::move(node));
    return static_cast<int>(scene_.nodes.size()) - 1;
}

void SceneBuilder::attach(int child, int parent) {
    node(child).parent = parent;
    node(parent).children.push_back(child);
}

int SceneBuilder::add_skin(Skin skin) {
    scene_.skins.push_back(std::move(skin));
    return static_cast<int>(scene_.skins.size()) - 1;
}

void SceneBuilder::animate(int node, Path path, std::vector<float> times, std::vector<float> values,
                           Interpolation interpolation) {
    if (scene_.animations.empty()) scene_.animations.push_back({"motion", {}});
    scene_.animations[0].channels.push_back(
        {node, path, interpolation, std::move(times), std::move(values)});
}

void SceneBuilder::spin(int node, vec3 axis, int turns, float seconds) {
    const vec4 rest = this->node(node).rotation;
    const int keys = 4 * std::abs(turns);  // quarter turns: which way round is never in doubt
    std::vector<float> times, values;
    for (int k = 0; k <= keys; ++k) {
        const float t = static_cast<float>(k) / static_cast<float>(keys);
        const vec4 q = then(turn(axis, 360 * static_cast<float>(turns) * t), rest);
        times.push_back(seconds * t);
        values.insert(values.end(), {q.x, q.y, q.z, q.w});
    }
    animate(node, Path::rotation, std::move(times), std::move(values));
}

void SceneBuilder::add_light(Light light, vec3 position) {
    Node node;
    node.name = light.name;
    node.translation = position;
    node.light = static_cast<int>(scene_.lights.size());
    scene_.lights.push_back(std::move(light));
    scene_.nodes.push_back(std::move(node));
}

void SceneBuilder::add_spot(Light light, vec3 position, vec3 target) {
    light.kind = LightKind::spot;
    add_light(std::move(light), position);
    const Frame frame(normalize(position - target));  // lights shine along -Z of their node
    scene_.nodes.back().rotation = quaternion(frame.tangent, frame.bitangent, frame.normal);
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
