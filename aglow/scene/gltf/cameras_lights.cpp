// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/cameras_lights.h"

#include <fmt/format.h>

#include <cmath>

namespace aglow::gltf {
namespace {

Status read_perspective(const Json& json, Camera& camera) {
    AG_TRY(camera.y_fov, json.number("yfov", 0));
    AG_TRY(camera.aspect, json.number("aspectRatio", 0));
    AG_TRY(camera.z_near, json.number("znear", 0));
    if (!(camera.y_fov > 0 && camera.y_fov < kPi)) return json.wrong("yfov must be in 0..pi");
    if (camera.aspect < 0 || (json.has("aspectRatio") && camera.aspect == 0))
        return json.wrong("aspectRatio must be above 0");
    if (!(camera.z_near > 0)) return json.wrong("znear must be above 0");
    return {};
}

Status read_orthographic(const Json& json, Camera& camera) {
    AG_TRY(camera.x_mag, json.number("xmag", 0));
    AG_TRY(camera.y_mag, json.number("ymag", 0));
    AG_TRY(camera.z_near, json.number("znear", 0));
    if (camera.x_mag == 0 || camera.y_mag == 0) return json.wrong("xmag and ymag must not be 0");
    if (camera.z_near < 0) return json.wrong("znear is negative");
    return {};
}

Result<Camera> read_camera(const Json& json) {
    Camera camera;
    AG_TRY(camera.name, json.text("name", ""));
    AG_TRY(const std::string type, json.text("type", ""));
    if (type != "perspective" && type != "orthographic")
        return json.wrong(fmt::format("type \"{}\" does not exist", type.substr(0, 20)));
    camera.perspective = type == "perspective";
    AG_TRY(const Json lens, json.object(type.c_str()));
    if (!lens.exists()) return json.wrong(type + " is missing");
    AG_CHECK(camera.perspective ? read_perspective(lens, camera) : read_orthographic(lens, camera));
    return camera;
}

Status read_cone(const Json& json, Light& light) {
    AG_TRY(const Json spot, json.object("spot"));
    AG_TRY(light.inner_cone, spot.number("innerConeAngle", 0));
    AG_TRY(light.outer_cone, spot.number("outerConeAngle", kPi / 4));
    constexpr float kRightAngle = kPi / 2 + 1e-5f;  // pi/2 as writers round it
    if (!(light.inner_cone >= 0 && light.inner_cone < light.outer_cone &&
          light.outer_cone <= kRightAngle))
        return json.wrong("cone angles must be 0 <= inner < outer <= pi/2");
    return {};
}

Result<Light> read_light(const Json& json) {
    Light light;
    AG_TRY(light.name, json.text("name", ""));
    AG_TRY(const std::string type, json.text("type", ""));
    if (type != "point" && type != "spot" && type != "directional")
        return json.wrong(fmt::format("type \"{}\" does not exist", type.substr(0, 20)));
    light.kind = type == "point"  ? LightKind::point
                 : type == "spot" ? LightKind::spot
                                  : LightKind::directional;
    float color[3] = {1, 1, 1};
    AG_CHECK(json.numbers("color", color));
    AG_TRY(const float intensity, json.number("intensity", 1));
    if (intensity < 0) return json.wrong("intensity is negative");
    for (float& v : color) {
        if (v < 0) return json.wrong("color is negative");
        v *= intensity;
        if (!std::isfinite(v)) return json.wrong("color * intensity is not finite");
    }
    light.intensity = {color[0], color[1], color[2]};
    AG_TRY(light.range, json.number("range", kInfinity));
    if (!(light.range > 0)) return json.wrong("range must be above 0");
    if (light.kind == LightKind::spot) {
        AG_CHECK(read_cone(json, light));
    }
    return light;
}

}  // namespace

Result<std::vector<Camera>> read_cameras(const Json& root) {
    AG_TRY(const std::vector<Json> list, elements(root, "cameras", "camera"));
    std::vector<Camera> cameras;
    for (const Json& json : list) {
        AG_TRY(Camera camera, read_camera(json));
        cameras.push_back(std::move(camera));
    }
    return cameras;
}

Result<std::vector<Light>> read_lights(const Json& root) {
    AG_TRY(const Json extension, root.extension("KHR_lights_punctual"));
    AG_TRY(const std::vector<Json> list, elements(extension, "lights", "light"));
    std::vector<Light> lights;
    for (const Json& json : list) {
        AG_TRY(Light light, read_light(json));
        lights.push_back(std::move(light));
    }
    return lights;
}

}  // namespace aglow::gltf
