// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/mesh/control_mesh.h"
#include "aglow/refine/displacement.h"
#include "aglow/refine/subdivision.h"
#include "aglow/scene/scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace aglow {

enum class RefineScheme : uint8_t {
    loop,           ///< subdivision of triangles
    catmull_clark,  ///< subdivision of quads and all other polygons
    pn,             ///< curved PN triangles
    tagged,         ///< the same, shaped by _SHARPNESS, _TENSION and _BIAS
    phong,          ///< Phong tessellation
    flat,           ///< triangles stay flat under linear normals: what heights are baked over
};

/// Height along the normals: scale * map(uv) + bias.
struct HeightDisplacement {
    HeightMap map;
    float scale = 1;   ///< m for a height of 1
    float bias = 0;    ///< m
    int texcoord = 0;  ///< set of texture coordinates
};

/// Where patches get their vertices, if not evenly.
struct PatternOptions {
    /// Irregular patterns: vertices are drawn to where the surface bends and, if there is an eye,
    /// to what is near it.
    bool irregular = false;
    std::optional<vec3> eye;  ///< m, in the world at rest
    /// Edges have only as many segments as keep them this near to the smooth surface, m; at most
    /// 2^level.
    std::optional<float> tolerance;
};

/// A mesh to be set onto faces, +Y upwards: its middle on theirs, its lowest point on the surface,
/// as wide as a quad is, or as the circle inside a triangle.
struct SurfaceModel {
    std::vector<vec3> positions, normals;  ///< [vertex]
    std::vector<uvec3> triangles;
    int repeats = 1;  ///< so many of them along an edge of a face
};

struct RefineOptions {
    RefineScheme scheme = RefineScheme::loop;
    int level = 1;       ///< 2^level segments to an edge
    bool limit = false;  ///< subdivision: vertices go where infinitely many levels would put them
    /// Subdivision: what boundaries do where they turn by more than 75 degrees.
    Corners corners = Corners::sharp;
    ControlOptions control = {};
    std::optional<HeightDisplacement> displacement;
    /// Heights that are a function of place in the mesh's own space, at rest: sine or noise, in
    /// place of a map.
    std::optional<shared::Displacement> field;
    PatternOptions pattern = {};  ///< patches
    /// Closed meshes that are others turned and moved are refined as these are, and shown through
    /// nodes that turn and move them.
    bool share = false;
    /// Set onto each face of patches, beside the refined surface and in its primitive: texture
    /// coordinates and colours are those of the place that a vertex stands over.
    std::optional<SurfaceModel> model;
};

/// The finest level that refine_scene() makes of a scheme.
int finest_level(RefineScheme scheme);

/// More triangles than this fill a .glb, which can hold 4 GiB.
inline constexpr uint64_t kMostRefinedTriangles = uint64_t{1} << 27;

/// Every mesh of a scene refined, one surface across its primitives: faces that meet in the input
/// meet bitwise, in every pose. Nodes, materials, animations and all else stay.
///
/// Positions    of the scheme.
/// Normals      of subdivision: the limit's, apart on both sides of a crease. Of patches: of the
///              scheme, from the file's normals, which part where these differ; a file without any,
///              or a crease angle, gets smooth ones that part at creases.
/// Texture coordinates, colours, scalar tags  smooth inside and straight along their seams under
///              subdivision; linear over patches.
/// Skin         influences of a vertex are the weighted means of those it comes from; the 4 largest
///              (8 where the mesh has more than 4 for each vertex) are kept, their sum 1.
/// Morph targets  the shape at weight 1, refined, less the shape at rest: exact for subdivision,
///              which is linear. Displacement follows the normals of each shape.
/// Creases and corners  lose 1 of their sharpness with each level, those that are sharp for ever
///              nothing. A mesh with tags keeps what is left, of the sharp edges that the options
///              make too; others have none. lightmap_uvs are left out.
/// Displacement  by `options.displacement` or `options.field`, or else by the heights that a mesh
///              names itself (Primitive::displacement): such a mesh is refined flat, whatever the
///              scheme, for that is the surface its heights stand on. They are read from the
///              scene's folder.
///
/// Likeness     meshes that differ in their materials alone are refined once; with options.share
///              also those that a rigid motion takes onto each other, unless displacement by place
///              tells them apart. These are the same mesh then, and each node that shows one has
///              got a child with the motion that shows it instead.
///
/// Primitives keep their numbers; those without triangles stay as they are.
/// Errors  bad_argument   level outside 1..finest_level(), limit or quads with a scheme that has
///                        none, both kinds of displacement, a pattern that the
///                        scheme has not or a tolerance that displacement would break, an eye
///                        together with sharing, a model on what is subdivided, displaced, skinned
///                        or morphed, more than
///                        kMostRefinedTriangles (how many)
///         those of read_height_map()
///         out_of_memory, cancelled
/// Repeat  same bits for any number of threads.
Result<Scene> refine_scene(const Scene& scene, const RefineOptions& options,
                           const Monitor& monitor = {});

}  // namespace aglow
