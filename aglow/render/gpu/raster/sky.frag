// SPDX-License-Identifier: Apache-2.0
// What is seen where nothing stands.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/render/gpu/raster/raster.glsl"
#include "aglow/render/gpu/textures.glsl"

layout(location = 0) out vec4 color;

void main() {
    CameraRay ray = camera_ray(args.frame.at[0].view, gl_FragCoord.x, gl_FragCoord.y);
    vec3 luminance = sky_at(args.scene, ray.direction);
    color = vec4(min(luminance, vec3(args.frame.at[0].most_luminance)), 1.0f);
}
