// SPDX-License-Identifier: Apache-2.0
// Morphs and places the vertices of a chunk: the loops of mesh/pose/placement_pose.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/pose.h"

layout(local_size_x = kPoseGroup) in;
layout(push_constant, scalar) uniform Push { PoseArgs args; };

// A vertex without any weight follows its first joint.
Affine blended_joints(PosePart part, uint first_joint, uint vertex) {
    uint first = vertex * part.influences;
    float sum = 0.0f;
    for (uint i = 0u; i < part.influences; ++i) sum += part.weights.at[first + i];
    if (!(sum > 0.0f)) return args.joints.at[first_joint + part.joints.at[first]];
    Affine blend = affine_zero();
    for (uint i = 0u; i < part.influences; ++i) {
        float weight = part.weights.at[first + i];
        if (weight == 0.0f) continue;
        Affine joint = args.joints.at[first_joint + part.joints.at[first + i]];
        blend = add_joint(blend, joint, weight / sum);
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
    if (part.influences > 0u) transform = blended_joints(part, state.first_joint, vertex);
    PosedVertex posed = place_vertex(transform, position, normal);

    uint place = part.first_vertex + vertex;
    args.positions.at[place] = posed.position;
    args.normals.at[place] = posed.normal;
    if (part.influences > 0u) args.mirrored.at[part.first_mirrored + vertex] = posed.mirrored;
    if (posed.normal == vec3(0.0f)) {
        args.first_triangle.at[place] = kNoTriangle;
        args.without_normal.at[0] = 1u;
    }
}
