// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/room.h"

#include <array>

namespace aglow::builtin {
namespace {

constexpr float kWidth = 0.92f, kDepth = 0.30f, kBoard = 0.024f, kBack = 0.012f;  // m
constexpr std::array<float, 5> kShelfTops = {0.10f, 0.50f, 0.90f, 1.27f, 1.62f};
constexpr float kTop = 1.98f;
constexpr size_t kCovers = 6;

/// Sides, boards and back as one solid; open towards +Z.
Shape carcass() {
    Lattice shelf;
    shelf.x = {0, kBoard, kWidth - kBoard, kWidth};
    shelf.z = {0, kBack, kDepth};
    shelf.y = {0.002f};
    for (const float top : kShelfTops) {
        if (top != kShelfTops[0]) shelf.y.push_back(top - kBoard);
        shelf.y.push_back(top);
    }
    shelf.y.push_back(kTop - kBoard);
    shelf.y.push_back(kTop);
    const int rows = static_cast<int>(shelf.y.size()) - 1;
    // The boards are the even rows: plinth, shelves, top.
    shelf.solid = [rows](int i, int j, int k) {
        const bool inside = i >= 0 && i < 3 && j >= 0 && j < rows && k >= 0 && k < 2;
        return inside && (i != 1 || k == 0 || j % 2 == 0);
    };
    return shelf.shape();
}

struct Books {
    std::array<Shape, kCovers> covers;
    Shape pages;

    void add(const Book& b, size_t color, vec3 at, float lean_degrees) {
        covers[color].append(b.cover.turned({0, 0, 1}, lean_degrees).moved(at));
        pages.append(b.pages.turned({0, 0, 1}, lean_degrees).moved(at));
    }
};

/// Stands books side by side from x0 to x1; the last of a row leans on the others.
void fill_row(Books& books, Dice& dice, float x0, float x1, float y, float headroom) {
    constexpr float kGap = 0.0012f, kLean = 9;
    float x = x0;
    while (true) {
        const float thickness = dice.between(0.018f, 0.045f);
        const float height = headroom * dice.between(0.62f, 0.88f);
        const float depth = dice.between(0.15f, 0.22f);
        const size_t color = static_cast<size_t>(dice.next() * kCovers) % kCovers;
        const vec3 at{x, y, kDepth - 0.03f - depth - dice.between(0, 0.02f)};
        const bool is_last = x + thickness + 0.12f > x1;
        if (x + thickness > x1) return;
        // Turned about its lower left edge by a positive angle it would sink into its neighbour.
        const float shift = is_last ? height * 0.157f : 0;
        books.add(book(thickness, height, depth), color, at + vec3{shift, 0, 0},
                  is_last ? kLean : 0);
        if (is_last) return;
        x += thickness + kGap;
    }
}

Shape storage_box(vec3 at) { return rounded_box(at, at + vec3{0.26f, 0.20f, 0.22f}, 0.01f, 2); }

Shape globe(vec3 at) {
    const std::array<vec2, 8> foot = {vec2{0, 0},       {0.06f, 0},       {0.06f, 0.008f},
                                      {0.02f, 0.018f},  {0.009f, 0.035f}, {0.008f, 0.06f},
                                      {0.007f, 0.075f}, {0, 0.08f}};
    Shape shape = lathe(foot, 24);
    shape.append(sphere({0, 0.155f, 0}, 0.085f, 28, 18));
    return shape.moved(at);
}

}  // namespace

void add_bookshelf(SceneBuilder& scene, const room::Paints& paints) {
    constexpr std::array<vec3, kCovers> kColors = {
        vec3{0.36f, 0.06f, 0.05f}, {0.05f, 0.10f, 0.22f}, {0.52f, 0.36f, 0.10f},
        {0.07f, 0.20f, 0.13f},     {0.60f, 0.56f, 0.48f}, {0.20f, 0.09f, 0.16f}};
    std::array<int, kCovers> covers{};
    for (size_t i = 0; i < kCovers; ++i)
        covers[i] = scene.diffuse("book cover " + std::to_string(i + 1), kColors[i]);
    const int pages = scene.diffuse("page edges", {0.72f, 0.68f, 0.57f});

    Dice dice(7);
    Books books;
    const float left = kBoard + 0.004f, right = kWidth - kBoard - 0.004f;
    fill_row(books, dice, left, right, kShelfTops[1], 0.36f);
    fill_row(books, dice, left, right - 0.30f, kShelfTops[2], 0.33f);
    fill_row(books, dice, left + 0.26f, right, kShelfTops[3], 0.31f);
    fill_row(books, dice, left, right - 0.12f, kShelfTops[4], 0.32f);

    // The shelf's back stands at the east wall; its open side faces west.
    const vec3 at{room::kHalfX - 0.006f, 0, -1.93f};
    const auto place = [&](const Shape& shape) { return shape.turned({0, 1, 0}, -90).moved(at); };
    scene.add("bookshelf", place(carcass()), paints.oak);
    Shape boxes = storage_box({0.08f, kShelfTops[0], 0.05f});
    boxes.append(storage_box({0.42f, kShelfTops[0], 0.05f}));
    scene.add("storage boxes", place(boxes), paints.linen);
    scene.add("globe", place(globe({0.15f, kShelfTops[3], 0.16f})), paints.brass);
    for (size_t i = 0; i < kCovers; ++i)
        scene.add("books " + std::to_string(i + 1), place(books.covers[i]), covers[i]);
    scene.add("book pages", place(books.pages), pages);
}

}  // namespace aglow::builtin
