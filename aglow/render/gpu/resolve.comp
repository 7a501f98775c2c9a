// SPDX-License-Identifier: Apache-2.0
// Adds up the samples of each pixel of a tile; the last of them make the sum a mean.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.pixel_count) return;
    CameraView view = args.frame.at[0].view;
    uvec2 pixel = tile_pixel(args.first_pixel + i, view.width);
    if (pixel.x >= view.width || pixel.y >= view.height) return;
    uint at = pixel.y * view.width + pixel.x;
    vec3Ptr image = args.frame.at[0].image;
    vec3 sum = args.first_sample == 0u ? vec3(0.0f) : image.at[at];
    for (uint path = i; path < args.path_count; path += args.pixel_count)
        sum += args.wavefront.at[0].paths.at[path].luminance;
    uint samples = args.frame.at[0].samples;
    bool last = args.first_sample + args.path_count / args.pixel_count == samples;
    image.at[at] = last ? sum / float(samples) : sum;
}
