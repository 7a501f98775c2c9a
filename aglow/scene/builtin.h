// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aglow {

struct BuiltinScene {
    std::string name;         ///< as on the command line; "stress:N" and "cad:N" are families
    std::string description;  ///< one line
};

/// The scenes made by code, in the order of `aglow scene --list`.
std::vector<BuiltinScene> builtin_scenes();

/// Makes one: cornell-box, furnace, cube-tc58, corridor, living-room, chess; moving in a loop of a
/// few seconds: walker, marbles, toys, forest, scatter; of a size: stress:N, cad:N, sculpture:N.
/// Errors  bad_argument (no such scene; names those there are; or N not in 12..20 000 000).
/// Repeat  same scene, bit for bit, every time.
Result<Scene> builtin_scene(std::string_view name);

/// The pieces of the scene "chess".
enum class ChessPiece : uint8_t { pawn, bishop, queen, king };

/// A closed surface with one vertex at each place.
struct CoarseShape {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;  ///< counter-clockwise seen from outside
};

/// Turned about +Y in 16 sides and standing on y = 0: the foot's radius is 0.95, a king is 3.9
/// tall. The king's cross is two boxes that reach into it.
CoarseShape chess_piece(ChessPiece piece);

}  // namespace aglow
