// SPDX-License-Identifier: Apache-2.0
// Morphs and places the vertices of a chunk: the loops of mesh/pose/placement_pose.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/pose.h"

layout(constant_id = 0) const bool kSkinned = false;
layout(local_size_x = kPoseGroup) in;
layout(push_constant, scalar) uniform Push { PoseArgs args; };

// Joints without weight are not read: they may be anything.
Affine add_joints(Affine blend, uint first_joint, uvec4 joints, vec4 weights) {
    if (weights.x != 0.0f)
        blend = add_joint(blend, args.joints.at[first_joint + joints.x], weights.x);
    if (weights.y != 0.0f)
        blend = add_joint(blend, args.joints.at[first_joint + joints.y], weights.y);
    if (weights.z != 0.0f)
        blend = add_joint(blend, args.joints.at[first_joint + joints.z], weights.z);
    if (weights.w != 0.0f)
        blend = add_joint(blend, args.joints.at[first_joint + joints.w], weights.w);
    return blend;
}

float sum_of(float sum, vec4 w) { return (((sum + w.x) + w.y) + w.z) + w.w; }

// A vertex without any weight follows its first joint.
Affine blended_joints(PosePart part, uint first_joint, uint vertex) {
    uint sets = part.influences / 4u;
    uint first = vertex * sets;
    float sum = 0.0f;
    for (uint s = 0u; s < sets; ++s) sum = sum_of(sum, part.weights.at[first + s]);
    Affine blend = affine_zero();
    for (uint s = 0u; s < sets; ++s) {
        vec4 weights = part.weights.at[first + s] / sum;
        if (!(sum > 0.0f)) weights = vec4(s == 0u ? 1.0f : 0.0f, 0.0f, 0.0f, 0.0f);
        blend = add_joints(blend, first_joint, part.joints.at[first + s], weights);
    }
    return blend;
}

void main() {
    PoseChunk chunk = args.chunks.at[group_index()];
    PosePart part = args.parts.at[chunk.part];
    PoseState state = args.states.at[chunk.part];
    uint vertex = chunk.first + gl_LocalInvocationID.x;
    if (vertex >= part.vertex_count) return;

    vec3 position = part.positions.at[vertex];
    vec3 normal = part.normals.at[vertex];
    for (uint t = 0u; t < state.target_count; ++t) {
        PoseTarget target = args.targets.at[state.first_target + t];
        if ((target.moves & 1u) != 0u) position += target.positions.at[vertex] * target.weight;
        if ((target.moves & 2u) != 0u) normal += target.normals.at[vertex] * target.weight;
    }
    Affine transform = state.transform;
    if (kSkinned) transform = blended_joints(part, state.first_joint, vertex);
    PosedVertex posed = place_vertex(transform, position, normal);

    uint place = part.first_vertex + vertex;
    args.positions.at[place] = posed.position;
    args.normals.at[place] = posed.normal;
    if (kSkinned) args.mirrored.at[part.first_mirrored + vertex] = posed.mirrored;
    if (posed.normal == vec3(0.0f)) {
        args.first_triangle.at[place] = kNoTriangle;
        args.without_normal.at[0] = 1u;
    }
}
