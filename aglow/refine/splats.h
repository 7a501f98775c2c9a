// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/scene/rewrite_gltf.h"
#include "aglow/scene/scene.h"

#include <span>
#include <vector>

namespace aglow {

/// A disc in space.
struct Splat {
    vec3 position;
    vec3 normal;       ///< unit
    float radius = 0;  ///< m
};

/// Discs in place of triangles, one at each vertex, so large that those of a triangle's corners
/// cover it where the normals are its own.
/// Shapes  normals as positions
/// Source  Zwicker, Pfister, van Baar & Gross, "Surface Splatting", SIGGRAPH 2001, for discs as a
///         primitive.
std::vector<Splat> make_splats(std::span<const vec3> positions, std::span<const vec3> normals,
                               std::span<const uvec3> triangles);

/// Their radii alone, for every primitive of a scene with triangles, as rewrite_gltf() takes them.
SplatRadii splat_radii(const Scene& scene);

}  // namespace aglow
