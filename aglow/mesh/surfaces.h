// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <vector>

namespace aglow {

/// One placement of one primitive in the world: a run of vertices and triangles of `Surfaces`.
struct SurfacePart {
    int node = 0;
    int instance = 0;  ///< of the node's EXT_mesh_gpu_instancing, else 0
    int mesh = 0;
    int primitive = 0;
    int material = -1;
    int placement = -1;  ///< in Atlas::placements, -1 without atlas
    uint32_t first_vertex = 0, vertex_count = 0;
    uint32_t first_triangle = 0, triangle_count = 0;
};

/// All triangles of a posed scene in world space: what light meets. Triangle order is that of
/// the nodes, their instances, primitives and triangles; triangles of zero area are kept (so
/// that nothing is lost) but have no normal to speak of.
struct Surfaces {
    std::vector<vec3> positions;  ///< [vertex_count] m
    std::vector<vec3> normals;    ///< [vertex_count] unit shading normals, towards the front
    std::vector<std::vector<vec2>>
        texcoords;                   ///< [set][vertex_count]; zeros where a part lacks the set
    std::vector<vec4> colors;        ///< [vertex_count], or empty where no part has any
    std::vector<vec2> lightmap_uvs;  ///< [vertex_count] in texels of the atlas, or empty
    std::vector<uvec3> triangles;    ///< counter-clockwise from the front, mirrored nodes included
    std::vector<uint32_t> part_of;   ///< [triangle_count] index into parts
    std::vector<SurfacePart> parts;

    const SurfacePart& part(uint32_t triangle) const { return parts[part_of[triangle]]; }
    vec3 corner(uint32_t triangle, int i) const {
        const uvec3 t = triangles[triangle];
        return positions[i == 0 ? t.x : i == 1 ? t.y : t.z];
    }
};

/// A point on a triangle: barycentrics of corners 1 and 2 (corner 0 has 1 - x - y), as Embree's.
struct SurfacePoint {
    uint32_t triangle = 0;
    vec2 barycentrics = {0, 0};
};

struct Atlas;

/// Poses the scene at `time` (nodes, skins, morphs; negative: the rest pose) and flattens it.
/// Where `atlas` is given, lightmap_uvs hold every vertex's place in it.
/// Cost  O(vertices + triangles) of all instances.
Surfaces pose(const Scene& scene, double time = -1, const Atlas* atlas = nullptr);

/// What the material of `at` looks like there. `scene` must be the one posed.
vec3 diffuse_reflectance(const Scene& scene, const Surfaces& surfaces,
                         SurfacePoint at);  ///< 0 <= rho <= kMaxReflectance
vec3 base_color(const Scene& scene, const Surfaces& surfaces,
                SurfacePoint at);  ///< before (1 - metallic)
vec3 emitted_luminance(const Scene& scene, const Surfaces& surfaces, SurfacePoint at);  ///< cd/m^2
float opacity(const Scene& scene, const Surfaces& surfaces,
              SurfacePoint at);  ///< 0..1; 0 or 1 for masks

vec3 position(const Surfaces& surfaces, SurfacePoint at);
vec3 geometric_normal(const Surfaces& surfaces,
                      uint32_t triangle);  ///< unit; zero for a degenerate triangle
vec3 shading_normal(const Surfaces& surfaces, SurfacePoint at);  ///< unit, interpolated
float area(const Surfaces& surfaces, uint32_t triangle);         ///< m^2

}  // namespace aglow
