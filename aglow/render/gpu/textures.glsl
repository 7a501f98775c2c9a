// SPDX-License-Identifier: Apache-2.0
// Colours from textures, the lightmap and the sky: twins of render/cpu/surface.cpp and lighting.cpp.
#ifndef AGLOW_RENDER_GPU_TEXTURES_GLSL
#define AGLOW_RENDER_GPU_TEXTURES_GLSL
#include "aglow/shared/device_scene.h"

vec4 decoded_texel(DeviceScenePtr scene, uint index, uint srgb) {
    uint word = scene.at[0].texels.at[index];
    uvec4 bytes = uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 255u;
    vec4 linear = vec4(bytes) / 255.0f;
    if (srgb == 0u) return linear;
    floatPtr table = scene.at[0].from_srgb;
    return vec4(table.at[bytes.x], table.at[bytes.y], table.at[bytes.z], linear.w);
}

vec4 texels_around(DeviceScenePtr scene, TextureLevels texture, vec2 st, uint level, uint blend) {
    TexelQuad quad = texel_quad(texture, st, level, blend);
    vec4 upper_left = decoded_texel(scene, quad.upper_left, texture.srgb);
    if (blend == 0u) return upper_left;
    return blend_quad(quad, upper_left, decoded_texel(scene, quad.upper_right, texture.srgb),
                      decoded_texel(scene, quad.lower_left, texture.srgb),
                      decoded_texel(scene, quad.lower_right, texture.srgb));
}

// The texture at `st` between mip levels. A loop, so that the code is there once.
vec4 filtered_texture(DeviceScenePtr scene, TextureLevels texture, vec2 st, float level) {
    uint blend = level > 0.0f ? 1u : 1u - texture.nearest;
    uint finer = uint(max(level, 0.0f));
    float share = max(level, 0.0f) - float(finer);
    vec4 color = vec4(0.0f);
    for (uint k = 0u; k < (share > 0.0f ? 2u : 1u); ++k) {
        vec4 texels = texels_around(scene, texture, st, finer + k, blend);
        color = k == 0u ? texels : mix(color, texels, share);
    }
    return color;
}

vec3 lightmap_at(DeviceScenePtr scene, vec2 texel) {
    TexelQuad quad =
        lightmap_quad(scene.at[0].lightmap_width, scene.at[0].lightmap_height, texel);
    vec3Ptr map = scene.at[0].lightmap;
    vec3 upper = mix(map.at[quad.upper_left], map.at[quad.upper_right], quad.right);
    vec3 lower = mix(map.at[quad.lower_left], map.at[quad.lower_right], quad.right);
    return mix(upper, lower, quad.down);
}

vec3 sky_at(DeviceScenePtr scene, vec3 direction) {
    int width = scene.at[0].sky_width;
    if (width == 0) return scene.at[0].sky_luminance;
    TexelQuad quad = sky_quad(width, scene.at[0].sky_height, direction);
    vec3Ptr map = scene.at[0].sky;
    vec3 upper = mix(map.at[quad.upper_left], map.at[quad.upper_right], quad.right);
    vec3 lower = mix(map.at[quad.lower_left], map.at[quad.lower_right], quad.right);
    return scene.at[0].sky_luminance * mix(upper, lower, quad.down);
}

#endif
