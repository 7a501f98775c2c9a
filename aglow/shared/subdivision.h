// SPDX-License-Identifier: Apache-2.0
// How the tables of a subdivision lie on a device. A refined point of a face is a column of its
// class's table times its ring: sum over rows r of weights[r * stride + column] * points[ring[r]].
#ifndef AGLOW_SHARED_SUBDIVISION_H
#define AGLOW_SHARED_SUBDIVISION_H
#include "aglow/shared/buffers.h"
AG_NAMESPACE_BEGIN

// Invocations of a group that make columns side by side.
AG_CONST uint kSubdivideColumnLanes = 8u;
// Rows of rings that shared memory holds at a time. A larger ring is read in several turns.
AG_CONST uint kSubdivideRows = 32u;
// Points of a step, and vertices without faces, that one group makes.
AG_CONST uint kSubdividePointGroup = 64u;

// What one group works on: faces that follow each other and are of one class.
struct SubdivideTile {
    uint weights;  // first of the class's table
    uint rows;     // of that table: size of the rings
    uint ring;     // first entry of the ring of the first face; the others' follow
    uint first_face, face_count;
};
AG_BUFFER_OF(SubdivideTile);

// Where a face writes: the first of its points at each corner (1), along each edge and inside.
struct SubdivideFace {
    uint first[9];  // of corners, then edges, then inside; a triangle lacks a corner and an edge
    uint owned;     // bit i: it writes those of first[i]
};
AG_BUFFER_OF(SubdivideFace);
AG_CONST uint kSubdivideInside = 8u;  // in SubdivideFace.first
AG_CONST uint kSubdivideFaceWords = 10u;

// Points are vec3, or rows of `width` numbers of which up to three are taken.
struct SubdivideArgs {
    uint first_group;
    uint blocks;        // groups that divide the columns of a tile
    uint corners;       // of every face
    uint segment_bits;  // segments per edge: 2 to this power
    uint columns;       // refined points of a face
    uint stride;        // of the tables' rows
    uint channels;      // this and what follows are read where points are no vec3
    uint from_width, from_channel;
    uint to_width, to_channel;
    SubdivideTilePtr tiles;
    uintPtr faces;  // SubdivideFace[]
    uintPtr ring;
    floatPtr weights;
    floatPtr from, to;
};

// The same with three tables, for limit points and normals.
struct SubdivideLimitArgs {
    uint first_group;
    uint blocks, corners, segment_bits, columns, stride;
    SubdivideTilePtr tiles;
    uintPtr faces;
    uintPtr ring;
    floatPtr position_weights, u_weights, v_weights;
    vec3Ptr from;
    vec3Ptr positions, normals;
};

// Points as sums of others, a row of terms for each.
struct SubdivideStepArgs {
    uint first_group;
    uint count;
    uint from_width, from_channel;  // numbers of a point, and of these the first that is read
    uint to_width, to_channel;      // likewise what is written
    uint channels;                  // how many are read and written, up to three
    uintPtr begin;                  // [count + 1] into both below
    uintPtr index;
    floatPtr weight;
    floatPtr from, to;
};

// Vertices that stay where they are.
struct SubdivideLooseArgs {
    uint first_group;
    uint count;
    uint width;  // numbers of a vertex
    uint zero;   // 1: 0 is written
    uintPtr vertices;
    floatPtr from, to;
};

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::SubdivideTile) == 20);
static_assert(sizeof(aglow::shared::SubdivideFace) == 40);
static_assert(sizeof(aglow::shared::SubdivideArgs) == 96);
static_assert(sizeof(aglow::shared::SubdivideLimitArgs) == 96);
static_assert(sizeof(aglow::shared::SubdivideStepArgs) == 72);
static_assert(sizeof(aglow::shared::SubdivideLooseArgs) == 40);
#endif
#endif
