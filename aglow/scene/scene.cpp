// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/scene.h"

#include "aglow/scene/photometry.h"

#include <cmath>
#include <tuple>

namespace aglow {
namespace {

constexpr double kPiDouble = 3.14159265358979323846;

double radians(float degrees) { return static_cast<double>(degrees) * kPiDouble / 180; }

/// Adds `light` and a root node that carries it.
Node& add_light_node(Scene& scene, Light light) {
    Node node;
    node.name = light.name;
    node.light = static_cast<int>(scene.lights.size());
    scene.lights.push_back(std::move(light));
    scene.nodes.push_back(std::move(node));
    return scene.nodes.back();
}

/// Turns +Z to the direction with this azimuth (clockwise from -Z) and elevation, in radians:
/// first up about X, then round about Y.
vec4 face(double azimuth, double elevation) {
    const double yaw = kPiDouble - azimuth, pitch = -elevation;
    const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
    const double cp = std::cos(pitch / 2), sp = std::sin(pitch / 2);
    return {static_cast<float>(cy * sp), static_cast<float>(sy * cp), static_cast<float>(-sy * sp),
            static_cast<float>(cy * cp)};
}

/// Positions first: they are what differs.
auto geometry_of(const Primitive& p) {
    return std::tie(p.positions, p.normals, p.triangles, p.texcoords, p.colors, p.joints, p.weights,
                    p.influences, p.targets, p.sharpness, p.tension, p.bias, p.creases, p.corners,
                    p.displacement, p.tangents, p.source_vertex, p.lightmap_uvs);
}

}  // namespace

bool same_geometry(const Primitive& a, const Primitive& b) {
    return geometry_of(a) == geometry_of(b);
}

void add_point_light(Scene& scene, vec3 position, float flux) {
    Light light;
    light.name = "point light";
    light.kind = LightKind::point;
    const float candela = flux / (4 * kPi);
    light.intensity = {candela, candela, candela};
    add_light_node(scene, std::move(light)).translation = position;
}

void add_luminaire(Scene& scene, vec3 position, std::shared_ptr<const Photometry> photometry) {
    Light light;
    light.name = photometry->name.empty() ? "luminaire" : photometry->name;
    light.kind = LightKind::photometric;
    light.photometry = std::move(photometry);
    Node& node = add_light_node(scene, std::move(light));
    node.translation = position;
    const auto half = static_cast<float>(std::sqrt(0.5));
    node.rotation = {-half, 0, 0, half};  // -Z turns to -Y about X
}

void add_sun(Scene& scene, float azimuth_degrees, float elevation_degrees, float illuminance) {
    Light light;
    light.name = "sun";
    light.kind = LightKind::directional;
    light.intensity = {illuminance, illuminance, illuminance};
    // Lights shine along -Z of their node, so +Z points back at the sun.
    add_light_node(scene, std::move(light)).rotation =
        face(radians(azimuth_degrees), radians(elevation_degrees));
}

void apply_clay(Scene& scene, float rho) {
    // Primitives without a material get one of clay: the default material is white.
    const int clay = static_cast<int>(scene.materials.size());
    bool needs_clay = false;
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives) {
            primitive.colors.clear();
            if (primitive.material >= 0) continue;
            primitive.material = clay;
            needs_clay = true;
        }
    if (needs_clay) {
        scene.materials.emplace_back();
        scene.materials.back().name = "clay";
    }
    for (Material& material : scene.materials) {
        material.base_color = {rho, rho, rho, 1};
        material.base_color_texture = {};
        material.metallic = 0;
        material.roughness = 1;
        material.metallic_roughness_texture = {};
        material.alpha_mode = AlphaMode::opaque;
    }
}

}  // namespace aglow
