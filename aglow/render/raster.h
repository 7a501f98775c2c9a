// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/render/frames.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace aglow {

/// How the coarse, posed triangles are refined in every frame.
struct Refinement {
    enum class Kind : uint8_t {
        none,
        pn,             ///< curved PN triangles
        tagged,         ///< the same, shaped by the file's _SHARPNESS, _TENSION and _BIAS
        loop,           ///< Loop's subdivision surface, of which triangles are the control mesh
        catmull_clark,  ///< Catmull and Clark's, of triangles; levels from 1 on
        /// `tagged`, every edge as fine as it takes to look smooth in the frame
        automatic,
    };
    Kind kind = Kind::none;
    int level = 0;           ///< 2^level segments to an edge, at most kMostRefinement
    float tolerance = 0.5f;  ///< automatic: pixels that edges may be away from the curve
    uint64_t budget = 0;     ///< automatic: triangles of a frame at most, 0: any number
    /// Edges whose faces meet at a larger angle are creases, radians. None: only tagged edges are.
    std::optional<float> crease_angle = std::nullopt;
};
inline constexpr int kMostRefinement = 7;
inline constexpr float kFinestTolerance = 0.01f;  ///< pixels
inline constexpr float kCoarsestTolerance = 1000;

/// Whether mesh shaders draw what is refined; vertex shaders draw the same picture.
enum class MeshShaders : uint8_t { where_offered, never };

struct RasterOptions {
    int samples = 4;  ///< of a pixel for edges, as many as the GPU takes: 1, 2, 4, 8, ...
    Refinement refinement = {};
    MeshShaders mesh_shaders = MeshShaders::where_offered;
};

/// Draws on the GPU by rasterization: the look of engine `rays` without reflections, luminance =
/// emitted + base colour / pi * E, at one point of each pixel; edges, and the outlines of alpha
/// masks, at `samples` points. footage.options are of engine `rays` and not looked at.
///
/// With baked light, E is looked up in the lightmap, also in scenes that move: shadows and lamps in
/// it stay where they were in the rest pose. Without, E is direct light that nothing is in the way
/// of: that of punctual lights exactly; that of the sky as if there were only the sky, to the
/// second degree of spherical harmonics; that of emissive triangles by their form factors, of more
/// than 32 that of a choice by power that stands for all. Interiors are lit through their walls: to
/// see shadows, bake or take engine `rays`.
///
/// Backs of single-sided materials are not drawn. Blended triangles are drawn from the farthest to
/// the nearest middle.
///
/// Refined meshes are welded first, each for itself: triangles that meet in position meet without
/// gaps, whether their normals agree or not. Curved triangles follow the file's normals, or smooth
/// ones where it has none or a crease angle is given; subdivision surfaces stand at their limit,
/// and are sharp where refine_scene() keeps them so. Texture coordinates and colours are linear on
/// every triangle.
///
/// Automatic levels go from frame to frame: see LevelOfDetail. They make triangles of the coarse
/// mesh only finer, so that a budget below those is not kept.
///
/// Errors  bad_argument (samples < 1, level or tolerance out of range, more than 2^31 refined
///         points), unsupported (the GPU cannot draw), out_of_memory (of a level, how much it
///         needs), device_lost.
/// Repeat  same bits every run on one device, of the same frames in the same order.
Result<std::unique_ptr<FrameRenderer>> make_raster_frame_renderer(
    const Gpu& gpu, const Footage& footage, const RasterOptions& options = {});

}  // namespace aglow
