// SPDX-License-Identifier: Apache-2.0
// What a shader needs to trace rays through acceleration structures: see accel/gpu/trace.glsl.
#ifndef AGLOW_SHARED_STRUCTURE_H
#define AGLOW_SHARED_STRUCTURE_H
#include "aglow/shared/ray.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kStructureGrid = 0u;
AG_CONST uint kStructureGrid2 = 1u;
AG_CONST uint kStructureBvh = 2u;
AG_CONST uint kStructureKindCount = 3u;

// One structure and the triangles it was built over, in a space of its own. Its header's layout is
// known to its kind alone: shared/grid.h, shared/grid2.h, shared/bvh.h.
struct Instance {
    Affine to_local;      // from world space to the space of the structure's triangles
    uint kind;            // kStructure...
    uint first_triangle;  // local triangle i is the scene's triangle first_triangle + i
    uvec2 header;         // address of the structure's header, low word first
};
AG_BUFFER_OF(Instance);

// A node of the tree over instances. Leaves hold one instance: count = 1, child = its index.
// Inner nodes: count = 0, children at `child` and `child` + 1.
struct TopNode {
    Bounds box;  // world space
    uint child;
    uint count;
};
AG_BUFFER_OF(TopNode);

// Levels of that tree below its root, at most: how deep a walk's stack has to be.
AG_CONST uint kTopDepth = 32u;

// All that rays can hit. An empty scene has instance_count = 0.
struct TraceScene {
    InstancePtr instances;
    TopNodePtr nodes;  // node 0 is the root; unused with one instance
    uint instance_count;
    uint kinds;  // bit k is set: some instance is of kind k
};
AG_BUFFER_OF(TraceScene);

// How much work rays caused; summed over rays.
struct TraceCounts {
    uint steps;      // cells or nodes visited
    uint triangles;  // triangles tested
};
AG_BUFFER_OF(TraceCounts);

AG_CONST uint kTraceGroupSize = 64u;

// Push constants of trace_rays.comp.
struct TraceRaysArgs {
    uint first_group;
    uint ray_count;
    TraceScenePtr scene;
    RayQueryPtr rays;       // [ray_count]
    RayHitPtr hits;         // [ray_count], where nearest hits are wanted
    uintPtr blocked;        // [ray_count] 0 or 1, where any hit will do
    TraceCountsPtr counts;  // [1] added to, where work is counted
};

AG_CONST uint kBoundsGroupSize = 128u;

// Push constants of group_bounds.comp.
struct GroupBoundsArgs {
    uint first_group;
    uint padding;
    TrianglePtr triangles;
    uvec2Ptr runs;    // per group of the dispatch: first triangle and count
    BoundsPtr boxes;  // per group of the dispatch
};

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::Instance) == 64);
static_assert(sizeof(aglow::shared::TopNode) == 32);
static_assert(sizeof(aglow::shared::TraceScene) == 24);
static_assert(sizeof(aglow::shared::TraceCounts) == 8);
#endif
#endif
