// SPDX-License-Identifier: Apache-2.0
// What a geometry shader knows of a mesh that it subdivides by Loop's rules: for every vertex its
// fan, the neighbours counter-clockwise, on a boundary from the boundary on.
#ifndef AGLOW_SHARED_GEOMETRY_LOOP_H
#define AGLOW_SHARED_GEOMETRY_LOOP_H
#include "aglow/shared/buffers.h"
AG_NAMESPACE_BEGIN

// Neighbours that a vertex brings along where they come through the vertex stage.
AG_CONST uint kNeighboursPerVertex = 12u;

AG_CONST uint kLoopSmooth = 0u;
AG_CONST uint kLoopBoundary = 1u;
AG_CONST uint kLoopCorner = 2u;  // stays where it is; its fan is closed
AG_CONST uint kLoopBoundaryCorner = 3u;

struct LoopVertex {
    uint point;        // its own place among the points
    uint first;        // of its fan
    uint count;        // neighbours
    uint kind;         // kLoopSmooth, ...
    float correction;  // cf(count)
};
AG_BUFFER_OF(LoopVertex);

struct LoopArgs {
    uint first_primitive;
    vec3Ptr points;
    LoopVertexPtr vertices;
    uintPtr fans;    // places among the points
    uintPtr starts;  // [3 * triangle + corner] which of its fan the next corner is
};

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::LoopVertex) == 20);
static_assert(sizeof(aglow::shared::LoopArgs) == 40);
#endif
#endif
