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

AG_NAMESPACE_END
#endif
