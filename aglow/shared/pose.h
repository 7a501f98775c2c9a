// SPDX-License-Identifier: Apache-2.0
// How vertices are posed: morphed, then skinned or placed (glTF 2.0, section 3.7.2.2 and 3.7.3).
#ifndef AGLOW_SHARED_POSE_H
#define AGLOW_SHARED_POSE_H
#include "aglow/shared/ray.h"
AG_NAMESPACE_BEGIN

// Vertices or triangles of one part that one group of invocations works on.
AG_CONST uint kPoseGroup = 64u;
// Few vertices lack a normal, and mostly none: the groups that look for them take many chunks.
AG_CONST uint kChunksPerRepairGroup = 16u;

struct PoseChunk {
    uint part;   // index into the parts as the kernels know them: moving ones first
    uint first;  // vertex or triangle of the part
};
AG_BUFFER_OF(PoseChunk);

// What stays the same of a part.
struct PosePart {
    vec3Ptr positions;   // [vertex_count] of its primitive, at rest
    vec3Ptr normals;     // [vertex_count]
    uvec3Ptr triangles;  // [triangle_count] counted from the part's first vertex
    uvec4Ptr joints;     // [vertex_count * influences / 4]
    vec4Ptr weights;     // [vertex_count * influences / 4]
    uint first_vertex, vertex_count;
    uint first_triangle, triangle_count;
    uint influences;      // a multiple of 4; 0: no skin
    uint first_mirrored;  // of a skinned part: place of its first vertex in PoseArgs.mirrored
};
AG_BUFFER_OF(PosePart);

// What changes: where the part is, and which of its morph targets count.
struct PoseState {
    Affine transform;  // of a part without skin
    uint mirrored;     // 1 where that turns the winding round
    uint first_joint;  // of a part with a skin
    uint first_target, target_count;
};
AG_BUFFER_OF(PoseState);

struct PoseTarget {
    vec3Ptr positions, normals;  // [vertex_count] displacements
    float weight;
    uint moves;  // bit 0: positions; bit 1: normals
};
AG_BUFFER_OF(PoseTarget);

struct PoseArgs {
    uint first_group;
    uint chunk_count;  // read where normals are repaired
    PoseChunkPtr chunks;
    PosePartPtr parts;
    PoseStatePtr states;
    AffinePtr joints;
    PoseTargetPtr targets;
    vec3Ptr positions, normals;  // of all vertices
    uintPtr mirrored;            // of skinned vertices: 1 where the winding turns round
    uvec3Ptr indices;            // of all triangles
    TrianglePtr corners;
    uintPtr without_normal;  // 1 where some vertex got none
    uintPtr first_triangle;  // of a vertex without normal: the first triangle that has one
};

struct PosedVertex {
    vec3 position;
    vec3 normal;    // unit, or zero where there is none
    uint mirrored;  // 1 where the winding turns round
};

// sum + weight * joint
AG_FN Affine add_joint(Affine sum, Affine joint, float weight) {
    Affine r;
    r.x = sum.x + joint.x * weight;
    r.y = sum.y + joint.y * weight;
    r.z = sum.z + joint.z * weight;
    r.t = sum.t + joint.t * weight;
    return r;
}

AG_FN Affine affine_zero() {
    Affine r;
    r.x.x = 0.0f;
    r.x.y = 0.0f;
    r.x.z = 0.0f;
    r.y = r.x;
    r.z = r.x;
    r.t = r.x;
    return r;
}

// Of the linear part; negative for a mirror.
AG_FN float affine_determinant(Affine m) { return dot(m.x, cross(m.y, m.z)); }

AG_FN vec3 unit_or_zero(vec3 v) {
    float norm = length(v);
    vec3 r;
    r.x = 0.0f;
    r.y = 0.0f;
    r.z = 0.0f;
    if (norm > 0.0f) r = v / norm;
    return r;
}

// Normals go by the cofactors of the linear part: they stay perpendicular to the surface, and on
// their side of it, under any affine map.
AG_FN PosedVertex place_vertex(Affine m, vec3 position, vec3 normal) {
    vec3 image =
        cross(m.y, m.z) * normal.x + cross(m.z, m.x) * normal.y + cross(m.x, m.y) * normal.z;
    PosedVertex r;
    r.mirrored = affine_determinant(m) < 0.0f ? 1u : 0u;
    r.position = transform_point(m, position);
    r.normal = unit_or_zero(r.mirrored == 1u ? -image : image);
    return r;
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::PosePart) == 64);
static_assert(sizeof(aglow::shared::PoseState) == 64);
static_assert(sizeof(aglow::shared::PoseTarget) == 24);
static_assert(sizeof(aglow::shared::PoseArgs) == 104);
#endif
#endif
