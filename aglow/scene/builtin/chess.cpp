// SPDX-License-Identifier: Apache-2.0
// An endgame under a lamp. The pieces are coarse on purpose: they are what refinement rounds.
#include "aglow/scene/builtin.h"
#include "aglow/scene/builtin/scenes.h"
#include "aglow/scene/builtin/studio.h"

#include <array>
#include <string>

namespace aglow::builtin {
namespace {

constexpr float kSquare = 0.055f;                // m
constexpr float kFrame = 0.03f, kThick = 0.02f;  // m, of the board
constexpr float kPieceScale = 0.0235f;           // m; a king is 9 cm tall
constexpr float kCreaseDegrees = 60;             // collars and rims; heads are smooth

struct Placed {
    ChessPiece piece;
    const char* square;  ///< as players name it: a1 is on the left of the white side
};

constexpr std::array kWhite = {
    Placed{ChessPiece::king, "g1"},   Placed{ChessPiece::queen, "e3"},
    Placed{ChessPiece::bishop, "d5"}, Placed{ChessPiece::bishop, "f4"},
    Placed{ChessPiece::pawn, "b2"},   Placed{ChessPiece::pawn, "c3"},
    Placed{ChessPiece::pawn, "e4"},   Placed{ChessPiece::pawn, "f2"},
    Placed{ChessPiece::pawn, "g2"},   Placed{ChessPiece::pawn, "h3"},
};
constexpr std::array kBlack = {
    Placed{ChessPiece::king, "g8"},   Placed{ChessPiece::queen, "c7"},
    Placed{ChessPiece::bishop, "e7"}, Placed{ChessPiece::pawn, "a6"},
    Placed{ChessPiece::pawn, "b5"},   Placed{ChessPiece::pawn, "d6"},
    Placed{ChessPiece::pawn, "f7"},   Placed{ChessPiece::pawn, "g6"},
    Placed{ChessPiece::pawn, "h7"},
};

vec3 place_of(const char* square) {
    const auto steps = [](char at, char first) {
        return (static_cast<float>(at - first) - 3.5f) * kSquare;
    };
    return {steps(square[0], 'a'), 0, -steps(square[1], '1')};
}

Shape piece_shape(ChessPiece piece) {
    CoarseShape coarse = chess_piece(piece);
    Shape soup;
    soup.texcoords.resize(coarse.positions.size());
    for (const vec3 p : coarse.positions) soup.positions.push_back(p * kPieceScale);
    soup.triangles = std::move(coarse.triangles);
    return soup_to_shape(std::move(soup), kCreaseDegrees);
}

void add_side(SceneBuilder& scene, const std::string& side, std::span<const Placed> pieces,
              int material) {
    constexpr std::array kNames = {"pawn", "bishop", "queen", "king"};
    std::array<int, kNames.size()> meshes{};
    for (size_t i = 0; i < meshes.size(); ++i)
        meshes[i] = scene.add_mesh(side + " " + kNames[i],
                                   {{piece_shape(static_cast<ChessPiece>(i)), material}});
    for (const Placed& placed : pieces) {
        const auto kind = static_cast<size_t>(placed.piece);
        const int node =
            scene.add_node(side + " " + kNames[kind] + " " + placed.square, meshes[kind]);
        scene.node(node).translation = place_of(placed.square);
    }
}

/// The squares of one colour; a1 is dark.
Shape squares(bool light) {
    Shape shape;
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column) {
            if (((row + column) % 2 == 1) != light) continue;
            const vec3 low = {static_cast<float>(column - 4) * kSquare, 0,
                              static_cast<float>(4 - row) * kSquare};
            const vec3 right = {kSquare, 0, 0}, up = {0, 0, -kSquare};
            shape.append(quad(low, low + right, low + right + up, low + up));
        }
    return shape;
}

void add_board(SceneBuilder& scene) {
    constexpr float kHalf = 4 * kSquare, kOuter = kHalf + kFrame, kTop = 0.003f;
    const auto bar = [](float x0, float z0, float x1, float z1) {
        return rounded_box({x0, -kThick, z0}, {x1, kTop, z1}, 0.002f, 2);
    };
    Shape frame = bar(-kOuter, kHalf, kOuter, kOuter);
    frame.append(bar(-kOuter, -kOuter, kOuter, -kHalf));
    frame.append(bar(kHalf, -kHalf, kOuter, kHalf));
    frame.append(bar(-kOuter, -kHalf, -kHalf, kHalf));
    scene.add("board", {{squares(true), scene.glossy("maple", {0.62f, 0.45f, 0.27f}, 0.45f)},
                        {squares(false), scene.glossy("walnut", {0.16f, 0.075f, 0.035f}, 0.4f)},
                        {frame, scene.glossy("frame", {0.1f, 0.045f, 0.022f}, 0.35f)}});
}

}  // namespace

Scene chess() {
    SceneBuilder scene("chess");
    add_studio(scene,
               {.half = 0.8f,
                .height = 1,
                .floor_height = -kThick,
                .wall = {0.36f, 0.42f, 0.47f},
                .panel = 500,
                .spot = vec3{420, 380, 320},
                .spot_position = {-0.5f, 0.75f, 0.35f},
                .spot_target = {0.02f, 0, 0}},
               scene.diffuse("table", {0.2f, 0.15f, 0.12f}));
    scene.look({0.19f, 0.215f, 0.5f}, {0.01f, 0.015f, 0.02f}, 34);
    add_board(scene);
    add_side(scene, "white", kWhite, scene.glossy("ivory", {0.78f, 0.69f, 0.52f}, 0.3f));
    add_side(scene, "black", kBlack, scene.glossy("ebony", {0.045f, 0.032f, 0.028f}, 0.3f));
    return scene.take();
}

}  // namespace aglow::builtin
