// SPDX-License-Identifier: Apache-2.0
// Camera rays, one for each sample of each pixel of a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.path_count) return;
    FrameSettingsPtr frame = args.frame;
    CameraView view = frame.at[0].view;
    uint sample_index = args.first_sample + i / args.pixel_count;
    uvec2 pixel = tile_pixel(args.first_pixel + i % args.pixel_count, view.width);
    bool inside = pixel.x < view.width && pixel.y < view.height;
    args.wavefront.at[0].alive.at[i] = inside ? 1u : 0u;
    if (!inside) return;

    vec2 place = vec2(pixel) + 0.5f + frame.at[0].offsets.at[sample_index];
    CameraRay ray = camera_ray(view, place.x, place.y);
    args.wavefront.at[0].rays.at[i] = RayQuery(ray.origin, 0.0f, ray.direction, kFarAway);
    args.wavefront.at[0].paths.at[i] =
        WavefrontPath(vec3(0.0f), vec3(1.0f), camera_cone(view, frame.at[0].samples));
}
