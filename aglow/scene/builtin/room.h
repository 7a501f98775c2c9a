// SPDX-License-Identifier: Apache-2.0
// The parts of the living room, each added by one function. The room's floor is y = 0; x points
// east, z south, where the windows are; the sofa stands at the east wall.
#pragma once
#include "aglow/scene/builtin/geometry.h"

namespace aglow::builtin {

namespace room {

// Inner size: 5 x 4 x 2.7 m around the origin. All in metres.
inline constexpr float kHalfX = 2.5f, kHalfZ = 2, kHeight = 2.7f, kWall = 0.25f;
inline constexpr float kSill = 0.5f, kLintel = 2.35f;  ///< lower and upper edge of the openings

/// The two openings in the south wall, from west to east.
struct Opening {
    float x0, x1;
};
inline constexpr Opening kOpenings[] = {{-2.1f, -0.3f}, {0.3f, 2.1f}};

/// Materials that several parts share.
struct Paints {
    int white, trim, oak, dark_wood, brass, ceramic, linen, black;
};

}  // namespace room

void add_shell(SceneBuilder& scene, const room::Paints& paints);    ///< walls, floor, ceiling
void add_windows(SceneBuilder& scene, const room::Paints& paints);  ///< frames and boards
void add_garden(SceneBuilder& scene, const room::Paints& paints);   ///< what is seen outside
void add_seats(SceneBuilder& scene, const room::Paints& paints);    ///< sofa, armchair, pillows
void add_tables(SceneBuilder& scene, const room::Paints& paints);   ///< and what stands on them
void add_sideboard(SceneBuilder& scene, const room::Paints& paints);
void add_bookshelf(SceneBuilder& scene, const room::Paints& paints);
void add_lamps(SceneBuilder& scene, const room::Paints& paints);
void add_textiles(SceneBuilder& scene, const room::Paints& paints);  ///< rug and curtains
void add_pictures(SceneBuilder& scene, const room::Paints& paints);
void add_plant(SceneBuilder& scene);

/// A book that stands on its lower edge: spine towards +Z, lower left back corner at the origin.
struct Book {
    Shape cover, pages;
};
Book book(float thickness, float height, float depth);

}  // namespace aglow::builtin
