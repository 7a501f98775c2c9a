// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/cameras_lights.h"

#include "aglow/scene/gltf/uri.h"

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

/// color * the number `factor`, both 1 where absent.
Result<vec3> read_color_times(const Json& json, const char* factor) {
    float color[3] = {1, 1, 1};
    AG_CHECK(json.numbers("color", color));
    AG_TRY(const float number, json.number(factor, 1));
    if (number < 0) return json.wrong(fmt::format("{} is negative", factor));
    for (float& v : color) {
        if (v < 0) return json.wrong("color is negative");
        v *= number;
        if (!std::isfinite(v)) return json.wrong(fmt::format("color * {} is not finite", factor));
    }
    return vec3{color[0], color[1], color[2]};
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
    AG_TRY(light.intensity, read_color_times(json, "intensity"));
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

Result<LightProfiles> read_light_profiles(const Json& root, std::span<const BufferView> views,
                                          const std::filesystem::path& folder) {
    AG_TRY(const Json extension, root.extension("EXT_lights_ies"));
    AG_TRY(const std::vector<Json> list, elements(extension, "lights", "light profile"));
    LightProfiles profiles;
    profiles.files.resize(list.size());
    for (size_t i = 0; i < list.size(); ++i) {
        const Json& json = list[i];
        const auto of_profile = [&](const Error& error) {
            return fail(error.code, json.element() + ": " + error.message);
        };
        AG_TRY(const int view, json.index("bufferView", views.size(), "bufferView"));
        AG_TRY(const std::string uri, json.text("uri", ""));
        if (json.has("uri") == (view >= 0))
            return json.wrong("has to have either a uri or a bufferView");
        if (view < 0) {
            auto file = read_uri(uri, folder);
            if (!file) return of_profile(file.error());
            profiles.files[i] = std::move(*file);
        }
        auto photometry = read_photometry(view < 0 ? std::span<const uint8_t>(profiles.files[i])
                                                   : views[static_cast<size_t>(view)].bytes);
        if (!photometry) return of_profile(photometry.error());
        AG_TRY(const std::string name, json.text("name", ""));
        if (!name.empty()) photometry->name = name;
        profiles.photometries.push_back(std::make_shared<const Photometry>(std::move(*photometry)));
    }
    return profiles;
}

Result<std::optional<Light>> read_luminaire(const Json& node, const LightProfiles& profiles) {
    AG_TRY(const Json extension, node.extension("EXT_lights_ies"));
    if (!extension.exists()) return std::nullopt;
    AG_TRY(const int index,
           extension.required_index("light", profiles.photometries.size(), "light profile"));
    Light light;
    light.kind = LightKind::photometric;
    light.photometry = profiles.photometries[static_cast<size_t>(index)];
    light.name = light.photometry->name;
    AG_TRY(light.intensity, read_color_times(extension, "multiplier"));
    return light;
}

}  // namespace aglow::gltf
