// SPDX-License-Identifier: Apache-2.0
// The coffee table and the sideboard, with what stands on them.
#include "aglow/scene/builtin/room.h"

#include <array>
#include <cmath>

namespace aglow::builtin {
namespace {

using room::kHalfZ;

Shape round_leg(vec3 top, vec3 foot, float top_radius, float foot_radius) {
    const std::array<vec3, 2> path = {top, foot};
    const std::array<float, 2> radii = {top_radius, foot_radius};
    return tube(path, radii, 16);
}

Shape bowl() {
    const std::array<vec2, 15> profile = {
        vec2{0, 0},       {0.045f, 0},      {0.048f, 0.008f}, {0.075f, 0.018f}, {0.105f, 0.038f},
        {0.127f, 0.064f}, {0.138f, 0.09f},  {0.136f, 0.093f}, {0.132f, 0.091f}, {0.121f, 0.066f},
        {0.100f, 0.042f}, {0.072f, 0.024f}, {0.040f, 0.015f}, {0.015f, 0.012f}, {0, 0.012f}};
    return lathe(profile, 40);
}

Shape fruit(vec3 at, float radius) {
    const std::array<vec2, 12> profile = {vec2{0, -0.82f}, {0.15f, -0.92f}, {0.45f, -0.88f},
                                          {0.78f, -0.62f}, {0.97f, -0.2f},  {1.0f, 0.18f},
                                          {0.88f, 0.55f},  {0.62f, 0.8f},   {0.35f, 0.88f},
                                          {0.14f, 0.82f},  {0.05f, 0.72f},  {0, 0.7f}};
    return lathe(profile, 24).scaled({radius, radius, radius}).moved(at);
}

Shape saucer() {
    const std::array<vec2, 9> profile = {vec2{0, 0},       {0.03f, 0},       {0.035f, 0.004f},
                                         {0.06f, 0.010f},  {0.075f, 0.017f}, {0.074f, 0.020f},
                                         {0.055f, 0.014f}, {0.03f, 0.009f},  {0, 0.008f}};
    return lathe(profile, 32);
}

Shape handle() {
    std::array<vec3, 9> path{};
    std::array<float, 9> radii{};
    for (size_t i = 0; i < path.size(); ++i) {
        const float angle = kPi * (static_cast<float>(i) / 8 - 0.5f);
        path[i] = {0.036f + 0.022f * std::cos(angle), 0.043f + 0.019f * std::sin(angle), 0};
        radii[i] = 0.004f;
    }
    return tube(path, radii, 8);
}

Shape cup() {
    const std::array<vec2, 12> profile = {vec2{0, 0},       {0.022f, 0},      {0.027f, 0.006f},
                                          {0.035f, 0.022f}, {0.039f, 0.045f}, {0.041f, 0.068f},
                                          {0.040f, 0.070f}, {0.038f, 0.068f}, {0.036f, 0.045f},
                                          {0.031f, 0.022f}, {0.022f, 0.010f}, {0, 0.009f}};
    Shape shape = lathe(profile, 32);
    shape.append(handle());
    return shape.moved({0, 0.008f, 0});
}

Shape vase() {
    const std::array<vec2, 17> profile = {
        vec2{0, 0},       {0.045f, 0},      {0.052f, 0.006f}, {0.075f, 0.06f},  {0.088f, 0.12f},
        {0.083f, 0.18f},  {0.060f, 0.235f}, {0.036f, 0.275f}, {0.031f, 0.305f}, {0.040f, 0.33f},
        {0.037f, 0.333f}, {0.026f, 0.305f}, {0.030f, 0.275f}, {0.054f, 0.232f}, {0.076f, 0.18f},
        {0.070f, 0.06f},  {0, 0.02f}};
    return lathe(profile, 40);
}

struct Stack {
    Shape covers[3], pages;
};

/// Three books lying on each other, the uppermost turned most.
Stack book_stack() {
    constexpr std::array<vec3, 3> kSizes = {
        vec3{0.030f, 0.25f, 0.18f}, {0.022f, 0.22f, 0.16f}, {0.026f, 0.20f, 0.14f}};
    constexpr std::array<float, 3> kTurns = {8, -6, 21};
    Stack stack;
    float y = 0;
    for (size_t i = 0; i < kSizes.size(); ++i) {
        const vec3 size = kSizes[i];
        const auto lay = [&](const Shape& shape) {
            return shape.moved({0, -size.y / 2, -size.z / 2})
                .turned({0, 0, 1}, 90)
                .moved({0, y, 0})
                .turned({0, 1, 0}, kTurns[i]);
        };
        const Book b = book(size.x, size.y, size.z);
        stack.covers[i] = lay(b.cover);
        stack.pages.append(lay(b.pages));
        y += size.x;
    }
    return stack;
}

void add_books(SceneBuilder& scene, std::string name, const Stack& stack, vec3 at,
               const std::array<int, 3>& covers, int pages) {
    scene.add(std::move(name), {{stack.covers[0].moved(at), covers[0]},
                                {stack.covers[1].moved(at), covers[1]},
                                {stack.covers[2].moved(at), covers[2]},
                                {stack.pages.moved(at), pages}});
}

void add_coffee_table(SceneBuilder& scene, const room::Paints& paints, vec3 at) {
    constexpr float kTop = 0.40f, kTopX = 0.29f, kTopZ = 0.55f, kThickness = 0.032f;
    const Shape top =
        rounded_box({-kTopX, kTop - kThickness, -kTopZ}, {kTopX, kTop, kTopZ}, 0.012f, 3);
    const Shape shelf = rounded_box({-kTopX + 0.06f, 0.14f, -kTopZ + 0.09f},
                                    {kTopX - 0.06f, 0.158f, kTopZ - 0.09f}, 0.006f, 2);
    Shape legs;
    for (const float x : {-1.0f, 1.0f})
        for (const float z : {-1.0f, 1.0f})
            legs.append(
                round_leg({x * (kTopX - 0.06f), kTop - kThickness + 0.005f, z * (kTopZ - 0.08f)},
                          {x * (kTopX - 0.015f), 0.008f, z * (kTopZ - 0.02f)}, 0.020f, 0.012f));
    scene.add("coffee table", {{top.moved(at), paints.oak},
                               {shelf.moved(at), paints.oak},
                               {legs.moved(at), paints.dark_wood}});
}

void add_cabinet(SceneBuilder& scene, const room::Paints& paints, vec3 at, float width) {
    constexpr float kFoot = 0.14f, kTop = 0.66f, kDepth = 0.40f, kBoard = 0.022f;
    const float half = width / 2;
    const Shape carcass =
        rounded_box({-half, kFoot, -kDepth / 2}, {half, kTop, kDepth / 2 - 0.02f}, 0.008f, 2);
    const Shape board = rounded_box({-half - 0.01f, kTop - 0.003f, -kDepth / 2 - 0.005f},
                                    {half + 0.01f, kTop + kBoard, kDepth / 2 + 0.01f}, 0.008f, 2);
    Shape doors, knobs, legs;
    constexpr int kDoors = 3;
    const float door = width / kDoors;
    for (int i = 0; i < kDoors; ++i) {
        const float x0 = -half + door * static_cast<float>(i);
        doors.append(rounded_box({x0 + 0.006f, kFoot + 0.008f, kDepth / 2 - 0.026f},
                                 {x0 + door - 0.006f, kTop - 0.012f, kDepth / 2}, 0.006f, 2));
        knobs.append(sphere({x0 + (i == 0 ? door - 0.05f : 0.05f), 0.45f, kDepth / 2 + 0.012f},
                            0.014f, 16, 10));
    }
    for (const float x : {-1.0f, 1.0f})
        for (const float z : {-1.0f, 1.0f})
            legs.append(round_leg({x * (half - 0.10f), kFoot + 0.005f, z * 0.14f},
                                  {x * (half - 0.06f), 0, z * 0.17f}, 0.018f, 0.011f));
    // Doors face the room, which lies north of the sideboard.
    const auto place = [&](const Shape& shape) { return shape.turned({0, 1, 0}, 180).moved(at); };
    scene.add("sideboard", {{place(carcass), paints.oak},
                            {place(board), paints.oak},
                            {place(doors), paints.trim},
                            {place(knobs), paints.brass},
                            {place(legs), paints.dark_wood}});
}

}  // namespace

Book book(float thickness, float height, float depth) {
    Book b;
    b.cover = box({0, 0, 0}, {thickness, height, depth});
    // The page edges lie on the cover's block, a hair proud of it, and leave its boards visible.
    constexpr float kBoard = 0.0035f, kProud = 0.0006f;
    const float y = height + kProud;
    b.pages = quad({kBoard, y, depth - 2 * kBoard}, {thickness - kBoard, y, depth - 2 * kBoard},
                   {thickness - kBoard, y, kBoard}, {kBoard, y, kBoard});
    return b;
}

void add_tables(SceneBuilder& scene, const room::Paints& paints) {
    const int apple = scene.diffuse("apple", {0.50f, 0.075f, 0.045f});
    const int pear = scene.diffuse("pear", {0.45f, 0.46f, 0.08f});
    const int blue = scene.diffuse("blue cover", {0.06f, 0.12f, 0.27f});
    const int ochre = scene.diffuse("ochre cover", {0.55f, 0.32f, 0.07f});
    const int pages = scene.diffuse("pages", {0.74f, 0.70f, 0.59f});
    const vec3 table{0.78f, 0, 0.42f};
    add_coffee_table(scene, paints, table);
    const vec3 top = table + vec3{0, 0.40f, 0};

    const vec3 bowl_place = top + vec3{-0.02f, 0, 0.02f};
    scene.add("bowl", bowl().moved(bowl_place), paints.ceramic);
    Shape apples = fruit(bowl_place + vec3{-0.035f, 0.055f, 0.03f}, 0.038f);
    apples.append(fruit(bowl_place + vec3{0.048f, 0.058f, 0.02f}, 0.037f));
    scene.add("fruit",
              {{apples, apple}, {fruit(bowl_place + vec3{0.0f, 0.058f, -0.048f}, 0.038f), pear}});
    int number = 1;
    for (const vec3 offset : {vec3{-0.14f, 0, -0.30f}, {0.10f, 0, 0.30f}}) {
        Shape shape = saucer();
        shape.append(cup().turned({0, 1, 0}, number == 1 ? 30.0f : 200.0f));
        scene.add("cup " + std::to_string(number++), shape.moved(top + offset), paints.ceramic);
    }
    add_books(scene, "books on the table", book_stack(), top + vec3{0.06f, 0, -0.26f},
              {blue, ochre, paints.linen}, pages);
    add_books(scene, "books under the table", book_stack(), table + vec3{0, 0.158f, 0.10f},
              {paints.dark_wood, blue, ochre}, pages);
}

void add_sideboard(SceneBuilder& scene, const room::Paints& paints) {
    const int glaze = scene.diffuse("blue glaze", {0.07f, 0.17f, 0.30f});
    const vec3 place{-1.45f, 0, kHalfZ - 0.36f};
    add_cabinet(scene, paints, place, 1.4f);
    const vec3 top = place + vec3{0, 0.682f, 0};
    scene.add("vase", vase().moved(top + vec3{0.35f, 0, 0.02f}), glaze);
    scene.add("small vase", vase().scaled({0.6f, 0.55f, 0.6f}).moved(top + vec3{0.53f, 0, -0.05f}),
              paints.ceramic);
}

}  // namespace aglow::builtin
