// SPDX-License-Identifier: Apache-2.0
// Keys that sort faces from the farthest to the nearest, by their middles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/raster.h"

struct OrderArgs {
    uint first_group;
    uint count;
    DeviceScenePtr scene;
    RasterFramePtr frame;
    uintPtr faces;     // [count]
    uintPtr keys;      // [count]
    uintPtr sortable;  // [count] the faces again
};
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OrderArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    uint face = args.faces.at[i];
    Triangle corners = args.scene.at[0].corners.at[face];
    CameraView view = args.frame.at[0].view;
    vec3 to_middle = (corners.a + corners.b + corners.c) / 3.0f - view.to_world.t;
    float depth = view.perspective != 0u ? length(to_middle) : -dot(to_middle, view.to_world.z);
    // Floats below zero count down; what is nearest gets the largest key.
    uint bits = floatBitsToUint(depth);
    uint ascending = (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
    args.keys.at[i] = ~ascending;
    args.sortable.at[i] = face;
}
