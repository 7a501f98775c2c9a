// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/camera.h"

#include "aglow/render/cpu/auto_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace aglow {
namespace {

/// The node of the active scene that a camera stands at, -1 if none.
int node_of_camera(const Scene& scene, int camera) {
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].in_scene && scene.nodes[i].camera == camera) return static_cast<int>(i);
    return -1;
}

/// The first node of the active scene with a camera, -1 if none.
int first_camera_node(const Scene& scene) {
    int best = -1;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!node.in_scene || node.camera < 0) continue;
        if (best < 0 || node.camera < scene.nodes[static_cast<size_t>(best)].camera)
            best = static_cast<int>(i);
    }
    return best;
}

std::optional<int> parse_number(std::string_view text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// The node of the camera with that name, or the node with that name that has a camera.
int named_camera_node(const Scene& scene, std::string_view name) {
    for (size_t i = 0; i < scene.cameras.size(); ++i)
        if (scene.cameras[i].name == name)
            if (const int node = node_of_camera(scene, static_cast<int>(i)); node >= 0) return node;
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].in_scene && scene.nodes[i].camera >= 0 && scene.nodes[i].name == name)
            return static_cast<int>(i);
    return -1;
}

/// `0 "front", 1 "top"`
std::string list_cameras(const Scene& scene) {
    std::string text;
    for (size_t i = 0; i < scene.cameras.size(); ++i) {
        const int node = node_of_camera(scene, static_cast<int>(i));
        if (node < 0) continue;
        const std::string& own = scene.cameras[i].name;
        const std::string& name = own.empty() ? scene.nodes[static_cast<size_t>(node)].name : own;
        text += fmt::format("{}{} \"{}\"", text.empty() ? "" : ", ", i, name);
    }
    return text.empty() ? "the scene has none, use \"auto\"" : "there are: " + text;
}

Result<int> find_camera_node(const Scene& scene, std::string_view camera) {
    const std::optional<int> number = parse_number(camera);
    int node = -1;
    if (number && *number >= 0) node = node_of_camera(scene, *number);
    if (node < 0) node = named_camera_node(scene, camera);
    if (node < 0)
        return fail(Errc::bad_argument,
                    fmt::format("camera \"{}\" does not exist in the active scene; {}", camera,
                                list_cameras(scene)));
    return node;
}

/// Position and viewing direction of a camera, freed of scale, shear and mirroring.
mat4 rigid(const mat4& m) {
    const vec3 eye = transform_point(m, {0, 0, 0});
    const vec3 back = transform_direction(m, {0, 0, 1}), above = transform_direction(m, {0, 1, 0});
    const vec3 right = cross(above, back);
    if (!(length(back) > 0) || !(length(right) > 0)) return translation(eye);
    const vec3 z = normalize(back), x = normalize(right), y = cross(z, x);
    mat4 result;
    result.m = {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, eye.x, eye.y, eye.z, 1};
    return result;
}

View view_of(const Camera& camera, const mat4& to_world, int width, int height) {
    const mat4 pose = rigid(to_world);
    if (camera.perspective)
        return render::cpu::perspective_view(pose, camera.y_fov, camera.aspect, width, height);
    const float image_aspect = static_cast<float>(width) / static_cast<float>(height);
    const float x_mag = std::abs(camera.x_mag), y_mag = std::abs(camera.y_mag);
    const float half_height = std::max(y_mag, x_mag / image_aspect);
    return {.to_world = pose,
            .perspective = false,
            .half_width = half_height * image_aspect,
            .half_height = half_height,
            .width = width,
            .height = height};
}

}  // namespace

shared::CameraView View::shared_view() const {
    const auto column = [&](int i) {
        return vec3{to_world.at(0, i), to_world.at(1, i), to_world.at(2, i)};
    };
    shared::CameraView view{};
    view.to_world = {column(0), column(1), column(2), column(3)};
    view.half_width = half_width;
    view.half_height = half_height;
    view.perspective = perspective ? 1u : 0u;
    view.width = static_cast<uint32_t>(width);
    view.height = static_cast<uint32_t>(height);
    return view;
}

Ray View::ray(float x, float y) const {
    const shared::CameraRay ray = shared::camera_ray(shared_view(), x, y);
    return {ray.origin, ray.direction};
}

Result<std::optional<View>> camera_view(const Scene& scene, std::string_view camera, int width,
                                        int height, double time) {
    if (width < 1 || height < 1)
        return fail(Errc::bad_argument,
                    fmt::format("an image of {}x{} pixels is empty", width, height));
    int node = first_camera_node(scene);
    if (camera == "auto" && node < 0) return std::nullopt;
    if (camera != "auto") {
        AG_TRY(node, find_camera_node(scene, camera));
    }
    const auto index = static_cast<size_t>(node);
    const Camera& chosen = scene.cameras[static_cast<size_t>(scene.nodes[index].camera)];
    return view_of(chosen, world_transforms(scene, time)[index], width, height);
}

Result<View> choose_view(const Scene& scene, const Surfaces& surfaces, const RayScene& rays,
                         std::string_view camera, int width, int height, double time) {
    AG_TRY(const std::optional<View> view, camera_view(scene, camera, width, height, time));
    return view ? *view : render::cpu::automatic_view(surfaces, rays, width, height);
}

}  // namespace aglow
