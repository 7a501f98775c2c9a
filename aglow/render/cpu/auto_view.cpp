// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/cpu/auto_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace aglow::render::cpu {
namespace {

constexpr int kProbeRays = 256;
constexpr float kObjectFov = 40 * kPi / 180;  // vertical
constexpr float kRoomFov = 75 * kPi / 180;    // vertical
constexpr float kMargin = 1.04f;              // free space around an object

/// Evenly spread directions: the spherical Fibonacci lattice.
vec3 probe_direction(int i, int count) {
    constexpr float kGoldenAngle = 2.39996323f;
    const float y = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(count);
    const float radius = std::sqrt(std::max(0.0f, 1 - y * y));
    const float angle = kGoldenAngle * static_cast<float>(i);
    return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

/// The inside of a room, seen from a point in it.
struct Room {
    Box box;
    vec3 opening = {0, 0, 0};  ///< unit, along an axis: where a whole side is open; zero if closed
};

/// The axis in the horizontal plane along which the rays that miss leave, zero where they are few
/// or leave on several sides.
vec3 opening_of(vec3 miss_sum, int miss_count) {
    // The open side of a cube takes a sixth of all rays from its middle, and their mean direction
    // is about 0.8 long; a window takes fewer rays, windows on two sides cancel out.
    if (miss_count < kProbeRays / 10 || length(miss_sum) < 0.6f * static_cast<float>(miss_count))
        return {0, 0, 0};
    const vec3 mean = normalize(miss_sum);
    if (std::abs(mean.x) > 0.85f) return {mean.x > 0 ? 1.0f : -1.0f, 0, 0};
    if (std::abs(mean.z) > 0.85f) return {0, 0, mean.z > 0 ? 1.0f : -1.0f};
    return {0, 0, 0};
}

/// Number of ray ends within a tenth of the box's size of its sides. Most of what one sees in a
/// room is its walls; among scattered objects, ends lie all over.
size_t on_walls(const Box& box, const std::array<std::vector<float>, 3>& ends) {
    size_t count = 0;
    for (size_t i = 0; i < ends[0].size(); ++i) {
        const vec3 size = box.size();
        const auto near = [&](float value, float lo, float hi, float extent) {
            return value < lo + 0.1f * extent || value > hi - 0.1f * extent;
        };
        count += near(ends[0][i], box.lo.x, box.hi.x, size.x) ||
                 near(ends[1][i], box.lo.y, box.hi.y, size.y) ||
                 near(ends[2][i], box.lo.z, box.hi.z, size.z);
    }
    return count;
}

/// Looks all round from `p`: where `p` is inside a room, that room. Of the coordinates that rays
/// end at, the outermost 2 % are left out: what a window shows is no part of the room.
std::optional<Room> room_around(const RayScene& rays, vec3 p) {
    std::array<std::vector<float>, 3> ends;
    int front = 0;
    vec3 misses = {0, 0, 0};
    for (int i = 0; i < kProbeRays; ++i) {
        const vec3 direction = probe_direction(i, kProbeRays);
        const std::optional<Hit> hit = rays.intersect({p, direction});
        if (!hit) misses += direction;
        if (!hit) continue;
        front += hit->front ? 1 : 0;
        const vec3 end = p + direction * hit->distance;
        ends[0].push_back(end.x);
        ends[1].push_back(end.y);
        ends[2].push_back(end.z);
    }
    const size_t closed = ends[0].size();
    if (closed < kProbeRays * 7 / 10 || 4 * static_cast<size_t>(front) < 3 * closed) return {};
    const std::array<std::vector<float>, 3> where = ends;
    for (auto& axis : ends) std::sort(axis.begin(), axis.end());
    const size_t skip = closed / 50, last = closed - 1 - skip;
    const Box box{{ends[0][skip], ends[1][skip], ends[2][skip]},
                  {ends[0][last], ends[1][last], ends[2][last]}};
    if (on_walls(box, where) < closed * 6 / 10) return {};
    return Room{box, opening_of(misses, kProbeRays - static_cast<int>(closed))};
}

/// The largest of the rooms that points about the middle of `box` stand in, none if fewer than
/// half stand in one.
std::optional<Room> find_room(const RayScene& rays, const Box& box) {
    std::optional<Room> largest;
    int inside = 0;
    constexpr std::array<vec3, 5> kProbes = {{{0.5f, 0.5f, 0.5f},
                                              {0.35f, 0.6f, 0.4f},
                                              {0.65f, 0.6f, 0.6f},
                                              {0.6f, 0.4f, 0.35f},
                                              {0.4f, 0.7f, 0.65f}}};
    for (vec3 probe : kProbes) {
        const std::optional<Room> room = room_around(rays, box.lo + box.size() * probe);
        if (!room) continue;
        ++inside;
        if (!largest || length(room->box.size()) > length(largest->box.size())) largest = room;
    }
    return 2 * inside > static_cast<int>(kProbes.size()) ? largest : std::nullopt;
}

/// How much of the room an eye sees: the mean logarithm of the free distance over its image. An
/// eye inside furniture, or with its view blocked at arm's length, scores lower.
float openness(const RayScene& rays, const View& view, float size) {
    constexpr int kColumns = 12, kRows = 8;
    float sum = 0;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const float x = (static_cast<float>(column) + 0.5f) / kColumns;
            const float y = (static_cast<float>(row) + 0.5f) / kRows;
            const Ray ray =
                view.ray(x * static_cast<float>(view.width), y * static_cast<float>(view.height));
            const std::optional<Hit> hit = rays.intersect(ray);
            const float distance = hit ? std::min(hit->distance, size) : size;
            sum += std::log(std::max(distance, 0.01f * size) / size);
            if (hit && !hit->front) sum -= 1;
        }
    return sum / (kColumns * kRows);
}

View room_view(const RayScene& rays, const Box& room, int width, int height) {
    const vec3 size = room.size();
    // Looking slightly below the middle shows more floor than ceiling.
    const vec3 target = room.lo + size * vec3{0.5f, 0.42f, 0.5f};
    View best;
    float best_score = -kInfinity;
    for (float inset : {0.06f, 0.12f, 0.2f})
        for (float x : {1 - inset, inset})
            for (float z : {1 - inset, inset}) {
                const vec3 eye = room.lo + size * vec3{x, 0.6f, z};
                const View view =
                    perspective_view(look_at(eye, target), kRoomFov, 4.0f / 3.0f, width, height);
                const float score = openness(rays, view, length(size));
                if (score > best_score + 1e-4f) {
                    best_score = score;
                    best = view;
                }
            }
    return best;
}

/// The least distance along `away` from which all corners of the box fit into the image.
View framing_view(const Box& box, vec3 away, int width, int height) {
    const vec3 center = box.center();
    View view = perspective_view(look_at(center + away, center), kObjectFov, 1, width, height);
    const vec3 right = transform_direction(view.to_world, {1, 0, 0});
    const vec3 up = transform_direction(view.to_world, {0, 1, 0});
    float distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 p = {corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                        corner & 4 ? box.hi.z : box.lo.z};
        const vec3 d = p - center;
        const float sideways = std::max(std::abs(dot(d, right)) / view.half_width,
                                        std::abs(dot(d, up)) / view.half_height);
        distance = std::max(distance, dot(d, away) + kMargin * sideways);
    }
    if (!(distance > 0)) distance = 1;
    view.to_world = look_at(center + away * distance, center);
    return view;
}

}  // namespace

mat4 look_at(vec3 eye, vec3 target) {
    const vec3 back = normalize(eye - target);
    const vec3 above = std::abs(back.y) < 0.999f ? vec3{0, 1, 0} : vec3{0, 0, -1};
    const vec3 right = normalize(cross(above, back));
    const vec3 up = cross(back, right);
    mat4 result;
    result.m = {right.x, right.y, right.z, 0, up.x,  up.y,  up.z,  0,
                back.x,  back.y,  back.z,  0, eye.x, eye.y, eye.z, 1};
    return result;
}

View perspective_view(const mat4& to_world, float y_fov, float aspect, int width, int height) {
    const float image_aspect = static_cast<float>(width) / static_cast<float>(height);
    View view{.to_world = to_world, .width = width, .height = height};
    view.half_height = std::tan(y_fov / 2);
    if (aspect > 0 && image_aspect < aspect) view.half_height *= aspect / image_aspect;
    view.half_width = view.half_height * image_aspect;
    return view;
}

View automatic_view(const Surfaces& surfaces, const RayScene& rays, int width, int height) {
    Box box;
    for (uvec3 t : surfaces.triangles)
        for (uint32_t vertex : {t.x, t.y, t.z}) box.add(surfaces.positions[vertex]);
    if (box.empty()) box.add({0, 0, 0});
    const std::optional<Room> room = find_room(rays, box);
    if (!room) return framing_view(box, normalize(vec3{0.55f, 0.42f, 0.9f}), width, height);
    if (length(room->opening) > 0) return framing_view(box, room->opening, width, height);
    return room_view(rays, room->box, width, height);
}

}  // namespace aglow::render::cpu
