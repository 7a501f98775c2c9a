// SPDX-License-Identifier: Apache-2.0
// Patches on a device: how a coarse mesh is laid out there, and what is made of it in each frame.
#ifndef AGLOW_SHARED_DEVICE_PATCH_H
#define AGLOW_SHARED_DEVICE_PATCH_H
#include "aglow/shared/displacement.h"
#include "aglow/shared/pattern.h"
#include "aglow/shared/tagged_triangle.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kPatchGroup = 64u;

AG_CONST uint kFlatPatch = 0u;
AG_CONST uint kPnPatch = 1u;
AG_CONST uint kPhongPatch = 2u;

// What the faces of a part of the mesh have in common. 88 bytes.
struct PatchKind {
    uint shape;      // k...Patch
    uint quadratic;  // 1: normals are
    Displacement displacement;
};
AG_BUFFER_OF(PatchKind);

// Mip levels of the height map on a face: on its edges, and inside. 20 bytes.
struct PatchMips {
    float edge[4];
    float inner;
};
AG_BUFFER_OF(PatchMips);

// A face. 48 bytes.
struct PatchFace {
    uint first;     // half-edge
    uint corners;   // 3 or 4
    uint reversed;  // bit i: edge i runs from the vertex of the higher number
    uint vertex[4];
    uint edge[4];
    uint kind;
};
AG_BUFFER_OF(PatchFace);

// An edge: its ends, and which normals belong to the faces at its sides there, as in PatchEdge.
struct PatchEdgeEnds {
    uint low, high;
    uint left_low, left_high;
    uint right_low, right_high;
};
AG_BUFFER_OF(PatchEdgeEnds);

// What a patch is evaluated from: corners, edge points and centre as in PatchPoints or QuadPoints;
// normals as in PatchNormals or QuadNormals. 240 bytes.
struct DevicePatch {
    vec3 p[12];
    vec3 n[8];
};
AG_BUFFER_OF(DevicePatch);

// Along which displacement moves it, in the order of DevicePatch::n.
struct PatchDirections {
    vec3 n[8];
};
AG_BUFFER_OF(PatchDirections);

// Where all of this lies.
struct PatchMesh {
    uint vertex_count, edge_count, face_count;
    uint tagged;  // 1: there are tags
    float phong_shape;
    uint displacement_kind;  // k...Displacement
    PatchKindPtr kinds;
    uintPtr vertex_kind;  // [vertex]

    // Of the topology.
    uintPtr vertex_source;  // [vertex] of the positions that come in
    uintPtr fan_begin;      // [vertex + 1] its corners in `fans`
    uintPtr fans;           // half-edges that leave the vertex
    uintPtr corner_normal;  // [half-edge] of the normals that come in
    PatchEdgeEndsPtr edges;
    PatchFacePtr faces;
    ShapeTagsPtr tags;  // [vertex]

    // Of displacement.
    floatPtr heights;      // texels of all height maps
    vec2Ptr uvs;           // [half-edge]
    uvec2Ptr across;       // [half-edge] where it starts and ends, the half-edges beyond
    uintPtr face_of;       // [half-edge]
    floatPtr vertex_mips;  // [vertex]
    PatchMipsPtr mips;     // [face]

    // Of a frame.
    vec3Ptr positions;                    // [vertex]
    vec3Ptr directions;                   // [vertex]
    floatPtr vertex_heights;              // [vertex] of the height map
    vec3Ptr raised_normals;               // [half-edge] where it starts, of flat faces
    EdgePointsPtr edge_points;            // [edge]
    vec3Ptr edge_directions;              // [edge]
    DevicePatchPtr patches;               // [face]
    PatchDirectionsPtr patch_directions;  // [face], where it is displaced
};
AG_BUFFER_OF(PatchMesh);

struct PatchControlArgs {
    uint first_group;
    uint unused;
    PatchMeshPtr mesh;
    vec3Ptr positions, normals;  // that come in
};

struct PatchEvaluateArgs {
    uint first_group;
    uint segments;      // of the pattern
    uint vertex_count;  // of the pattern
    uint first_face, face_count;
    uint unused;
    PatchMeshPtr mesh;
    uintPtr steps;          // [vertex_count] Pattern::steps
    PatchLevelsPtr levels;  // [face of the mesh]
    vec3Ptr positions;      // [face - first_face][vertex_count]
    vec3Ptr normals;        // likewise
};

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::PatchFace) == 48);
static_assert(sizeof(aglow::shared::PatchEdgeEnds) == 24);
static_assert(sizeof(aglow::shared::DevicePatch) == 240);
static_assert(sizeof(aglow::shared::PatchDirections) == 96);
static_assert(sizeof(aglow::shared::PatchKind) == 88);
static_assert(sizeof(aglow::shared::PatchMips) == 20);
static_assert(sizeof(aglow::shared::PatchMesh) == 208);
static_assert(sizeof(aglow::shared::PatchControlArgs) == 32);
static_assert(sizeof(aglow::shared::PatchEvaluateArgs) == 64);
#endif
#endif
