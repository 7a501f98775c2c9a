// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin.h"

#include <array>
#include <cmath>
#include <span>

namespace aglow {
namespace {

constexpr uint32_t kSides = 16;

/// A circle of a surface of revolution; every other of its vertices is raised by `crest`.
struct Circle {
    float radius = 0, height = 0, crest = 0;
};

/// Adds the vertices of a circle: one where it is a point of the axis. Result: the first of them.
uint32_t add_circle(CoarseShape& shape, const Circle& circle) {
    const auto first = static_cast<uint32_t>(shape.positions.size());
    for (uint32_t side = 0; side < (circle.radius > 0 ? kSides : 1); ++side) {
        const float angle = 2 * kPi * static_cast<float>(side) / kSides;
        shape.positions.push_back({circle.radius * std::cos(angle),
                                   circle.height + (side % 2 == 0 ? circle.crest : 0.0f),
                                   -circle.radius * std::sin(angle)});
    }
    return first;
}

void add_quad(CoarseShape& shape, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    if (a != b) shape.triangles.push_back({a, b, c});
    if (c != d) shape.triangles.push_back({a, c, d});
}

/// From the bottom to the top; both ends have radius 0.
void add_revolution(CoarseShape& shape, std::span<const Circle> profile) {
    uint32_t lower = add_circle(shape, profile.front());
    for (size_t i = 0; i + 1 < profile.size(); ++i) {
        const uint32_t upper = add_circle(shape, profile[i + 1]);
        const auto at = [&](uint32_t first, const Circle& circle, uint32_t side) {
            return circle.radius > 0 ? first + side % kSides : first;
        };
        for (uint32_t side = 0; side < kSides; ++side)
            add_quad(shape, at(lower, profile[i], side), at(lower, profile[i], side + 1),
                     at(upper, profile[i + 1], side + 1), at(upper, profile[i + 1], side));
        lower = upper;
    }
}

void add_box(CoarseShape& shape, vec3 low, vec3 high) {
    const auto first = static_cast<uint32_t>(shape.positions.size());
    for (const float y : {low.y, high.y})
        for (const float z : {high.z, low.z})
            for (const float x : {low.x, high.x}) shape.positions.push_back({x, y, z});
    constexpr std::array<std::array<uint32_t, 4>, 6> kFaces = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& f : kFaces)
        add_quad(shape, first + f[0], first + f[1], first + f[2], first + f[3]);
}

/// The foot that all pieces share, up to the collar below the head.
std::vector<Circle> foot(float collar) {
    return {{0, 0},        {0.9f, 0},       {0.95f, 0.15f},        {0.7f, 0.4f},
            {0.45f, 0.7f}, {0.33f, collar}, {0.55f, collar + 0.1f}};
}

std::vector<Circle> profile_of(ChessPiece piece) {
    std::vector<Circle> profile;
    const auto made = [&](float collar, std::initializer_list<Circle> head) {
        profile = foot(collar);
        profile.insert(profile.end(), head);
    };
    switch (piece) {
        case ChessPiece::pawn:
            made(1.4f, {{0.35f, 1.55f}, {0.5f, 1.85f}, {0.35f, 2.2f}, {0, 2.3f}});
            break;
        case ChessPiece::bishop:
            made(1.8f, {{0.32f, 1.98f},
                        {0.5f, 2.3f},
                        {0.35f, 2.75f},
                        {0.1f, 3.0f},
                        {0.14f, 3.1f},
                        {0, 3.2f}});
            break;
        case ChessPiece::queen:
            made(2.1f, {{0.36f, 2.3f},
                        {0.62f, 3.1f, 0.2f},
                        {0.45f, 3.05f},
                        {0.12f, 3.2f},
                        {0.15f, 3.32f},
                        {0, 3.4f}});
            break;
        case ChessPiece::king:
            made(2.2f, {{0.36f, 2.4f}, {0.55f, 3.1f}, {0.5f, 3.25f}, {0.12f, 3.35f}, {0, 3.4f}});
            break;
    }
    return profile;
}

}  // namespace

CoarseShape chess_piece(ChessPiece piece) {
    CoarseShape shape;
    if (piece == ChessPiece::king) {
        add_box(shape, {-0.06f, 3.35f, -0.06f}, {0.06f, 3.9f, 0.06f});
        add_box(shape, {-0.2f, 3.6f, -0.05f}, {0.2f, 3.72f, 0.05f});
    }
    add_revolution(shape, profile_of(piece));
    return shape;
}

}  // namespace aglow
