// SPDX-License-Identifier: Apache-2.0
// Walls, floor, ceiling, window frames, skirting and the strip of garden before the windows.
#include "aglow/scene/builtin/room.h"

#include <algorithm>
#include <cmath>

namespace aglow::builtin {
namespace {

using namespace room;

constexpr float kSink = 0.004f;  // m; how deep trim sits in the surface that carries it

/// Repeatable noise in 0..1 of two integers.
float grain(int a, int b) {
    Dice dice(static_cast<uint64_t>(a) * 0x10001u + static_cast<uint64_t>(b) * 0x3b9ac9ffu);
    dice.next();
    return dice.next();
}

/// Smooth periodic noise: bilinear between lattice values, `period` cells until it repeats.
float smooth_noise(float x, float y, int period_x, int period_y, int seed) {
    const float fx = std::floor(x), fy = std::floor(y);
    const auto wrap = [](int i, int n) { return (i % n + n) % n; };
    const auto at = [&](int i, int j) {
        return grain(wrap(static_cast<int>(fx) + i, period_x) + 997 * seed,
                     wrap(static_cast<int>(fy) + j, period_y));
    };
    const auto ease = [](float t) { return t * t * (3 - 2 * t); };
    const float s = ease(x - fx), t = ease(y - fy);
    return shared::mix(shared::mix(at(0, 0), at(1, 0), s), shared::mix(at(0, 1), at(1, 1), s), t);
}

/// Oak boards along u: 16 rows, each of two boards whose joints are staggered.
vec3 boards(float u, float v) {
    constexpr int kRowCount = 16, kPerRow = 2;
    constexpr float kGap = 0.012f, kEndGap = 0.0009f;  // of a board's width; of the image's
    const float row = v * kRowCount;
    const int r = static_cast<int>(row);
    const float shifted = u + grain(r, 1);
    const float along = (shifted - std::floor(shifted)) * kPerRow;
    const int board = static_cast<int>(along);
    const float across = row - std::floor(row), end = (along - std::floor(along)) / kPerRow;
    const bool gap = across < kGap || across > 1 - kGap || end < kEndGap;

    const float tone = 0.8f + 0.35f * grain(r * kPerRow + board, 2);
    const float waves = smooth_noise(u * 24, row * 5, 24, 5 * kRowCount, r + 2);
    const float fine = smooth_noise(u * 64, row * 22, 64, 22 * kRowCount, r + 40);
    const float shade = tone * (0.78f + 0.27f * waves + 0.16f * fine);
    return vec3{0.46f, 0.285f, 0.15f} * (gap ? 0.3f * shade : shade);
}

int oak_floor(SceneBuilder& scene) {
    constexpr float kMetresPerImage = 2.4f;
    const int floor = scene.textured(painted("oak boards", 1024, 1024, boards));
    TextureRef& texture = scene.material(floor).base_color_texture;
    texture.scale = {1 / kMetresPerImage, 1 / kMetresPerImage};
    return floor;
}

bool in_openings(float x, float y) {
    const auto holds = [&](Opening o) { return x > o.x0 && x < o.x1; };
    return y > kSill && y < kLintel &&
           std::any_of(std::begin(kOpenings), std::end(kOpenings), holds);
}

float middle(const std::vector<float>& bounds, int i) {
    return (bounds[static_cast<size_t>(i)] + bounds[static_cast<size_t>(i) + 1]) / 2;
}

/// Walls of full thickness, floor slab and roof as one closed solid.
Lattice walls() {
    Lattice shell;
    shell.x = {-kHalfX - kWall, -kHalfX,         kOpenings[0].x0, kOpenings[0].x1,
               kOpenings[1].x0, kOpenings[1].x1, kHalfX,          kHalfX + kWall};
    shell.y = {-kWall, 0, kSill, kLintel, kHeight, kHeight + kWall};
    shell.z = {-kHalfZ - kWall, -kHalfZ, kHalfZ, kHalfZ + kWall};
    shell.solid = [x = shell.x, y = shell.y, z = shell.z](int i, int j, int k) {
        const auto outside = [](int at, const std::vector<float>& bounds) {
            return at < 0 || at + 1 >= static_cast<int>(bounds.size());
        };
        if (outside(i, x) || outside(j, y) || outside(k, z)) return false;
        const float px = middle(x, i), py = middle(y, j), pz = middle(z, k);
        const bool air = std::abs(px) < kHalfX && py > 0 && py < kHeight && std::abs(pz) < kHalfZ;
        return !air && !(pz > kHalfZ && in_openings(px, py));
    };
    return shell;
}

/// Board along a wall from a to b (seen from above), standing `depth` proud of it.
void add_skirting(Shape& shape, vec3 lo, vec3 hi) {
    constexpr float kSkirtingHeight = 0.09f;
    shape.append(box({lo.x, -kSink, lo.z}, {hi.x, kSkirtingHeight, hi.z}));
}

Shape skirting() {
    constexpr float kDepth = 0.014f;
    Shape shape;
    for (const float side : {-1.0f, 1.0f}) {
        const float wall_x = side * (kHalfX + kSink), face_x = side * (kHalfX - kDepth);
        const float wall_z = side * (kHalfZ + kSink), face_z = side * (kHalfZ - kDepth);
        add_skirting(shape, {std::min(wall_x, face_x), 0, -kHalfZ - kSink},
                     {std::max(wall_x, face_x), 0, kHalfZ + kSink});
        add_skirting(shape, {-kHalfX + kDepth, 0, std::min(wall_z, face_z)},
                     {kHalfX - kDepth, 0, std::max(wall_z, face_z)});
    }
    return shape;
}

/// Frame with one post and one crossbar, sunk a little into the opening's sides.
Shape window_frame(Opening opening) {
    constexpr float kBar = 0.055f, kPost = 0.035f, kCrossbar = 1.85f;  // m; crossbar above floor
    const float center = (opening.x0 + opening.x1) / 2;
    Lattice frame;
    frame.x = {opening.x0 - kSink, opening.x0 + kBar, center - kPost,
               center + kPost,     opening.x1 - kBar, opening.x1 + kSink};
    frame.y = {kSill - kSink,     kSill + kBar,   kCrossbar - kPost,
               kCrossbar + kPost, kLintel - kBar, kLintel + kSink};
    frame.z = {kHalfZ + 0.10f, kHalfZ + 0.16f};
    frame.solid = [](int i, int j, int k) {
        const bool inside = i >= 0 && i < 5 && j >= 0 && j < 5 && k == 0;
        return inside && (i % 2 == 0 || j % 2 == 0);
    };
    return frame.shape();
}

Shape window_board(Opening opening) {
    return rounded_box({opening.x0 - 0.05f, kSill - 0.02f, kHalfZ - 0.06f},
                       {opening.x1 + 0.05f, kSill + 0.015f, kHalfZ + 0.11f}, 0.008f, 2);
}

/// Pushes every vertex outward by waves of its place: foliage seen from afar.
Shape leafy(Shape shape, float depth) {
    for (size_t i = 0; i < shape.positions.size(); ++i) {
        vec3& p = shape.positions[i];
        const float waves = std::sin(9 * p.x + 2 * p.y) * std::sin(8 * p.y + 1) +
                            std::sin(13 * p.x - 4 * p.z) * std::sin(11 * p.z + 3 * p.y);
        p += shape.normals[i] * (depth * waves);
    }
    return soup_to_shape(std::move(shape), 180);
}

Shape hedge() {
    return leafy(rounded_box({-4.4f, -0.25f, 5.4f}, {4.4f, 0.85f, 6.1f}, 0.16f, 3, 0.05f), 0.05f);
}

}  // namespace

void add_shell(SceneBuilder& scene, const Paints& paints) {
    const int floor_paint = oak_floor(scene);
    const int accent = scene.diffuse("sage wall", {0.36f, 0.45f, 0.37f});
    const int render = scene.diffuse("render", {0.62f, 0.58f, 0.52f});
    Shape floor, white, sage, outside;
    walls().skin([&](const Lattice::Face& face) -> Shape& {
        const vec3 p = face.center;
        const bool inner = std::abs(p.x) <= kHalfX && p.y >= 0 && p.y <= kHeight &&
                           p.z >= -kHalfZ && p.z < kHalfZ + kWall;
        if (!inner) return outside;
        if (p.y == 0) return floor;
        return p.x == kHalfX ? sage : white;
    });
    scene.add("walls", {{white, paints.white}, {sage, accent}, {outside, render}});
    scene.add("floor", floor, floor_paint);
    scene.add("skirting", skirting(), paints.trim);
}

void add_windows(SceneBuilder& scene, const Paints& paints) {
    int number = 1;
    for (const Opening opening : kOpenings) {
        scene.add("window frame " + std::to_string(number), window_frame(opening), paints.trim);
        scene.add("window board " + std::to_string(number), window_board(opening), paints.trim);
        ++number;
    }
}

void add_garden(SceneBuilder& scene, const Paints& paints) {
    const int stone = scene.diffuse("terrace", {0.42f, 0.39f, 0.35f});
    const int grass = scene.diffuse("grass", {0.09f, 0.14f, 0.045f});
    const int leaves = scene.diffuse("hedge", {0.045f, 0.085f, 0.035f});
    const int foliage = scene.diffuse("foliage", {0.07f, 0.105f, 0.035f});
    constexpr float kSouth = kHalfZ + kWall;
    scene.add("terrace", box({-3.2f, -0.3f, kSouth - 0.05f}, {3.2f, -0.12f, kSouth + 1.6f}), stone);
    scene.add("lawn", box({-4.6f, -0.3f, kSouth + 1.5f}, {4.6f, -0.15f, 6.3f}), grass);
    scene.add("hedge", hedge(), leaves);
    // Low enough to leave the sun to the room.
    const Shape crown = leafy(sphere({0, 0, 0}, 1, 28, 16), 0.07f);
    int number = 1;
    for (const vec3 at : {vec3{0.45f, 0, 5.0f}, {3.7f, 0, 4.9f}})
        scene.add("tree " + std::to_string(number++),
                  {{crown.scaled({0.72f, 0.80f, 0.72f}).moved(at + vec3{0, 1.78f, 0}), foliage},
                   {cylinder(at - vec3{0, 0.2f, 0}, 0.06f, 1.5f, 12), paints.dark_wood}});
}

}  // namespace aglow::builtin
