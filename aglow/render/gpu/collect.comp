// SPDX-License-Identifier: Apache-2.0
// Gives lit surfaces the light that shadow rays let pass.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(constant_id = 0) const uint kFromLights = 1u;  // 0: from the sky and emissive triangles

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

void main() {
    uint lit = global_index();
    if (lit >= args.wavefront.at[0].lit_queued.at[0]) return;
    vec3 irradiance = vec3(0.0f);
    vec3 highlights = vec3(0.0f);
    for (uint k = 0u; k < args.light_count; ++k) {
        uint i = k * args.alive_count + lit;
        if (args.wavefront.at[0].shadow_alive.at[i] == 0u) continue;
        float share = args.wavefront.at[0].visibility.at[i];
        WavefrontShadow shadow = args.wavefront.at[0].shadows.at[i];
        irradiance += shadow.irradiance * share;
        highlights += shadow.highlight * share;
    }
    uint path = args.wavefront.at[0].lit_queue.at[lit];
    if (kFromLights == 0u) {
        args.wavefront.at[0].surfaces.at[path].irradiance += irradiance;
    } else {
        args.wavefront.at[0].surfaces.at[path].punctual += irradiance;
        args.wavefront.at[0].surfaces.at[path].highlights += highlights;
    }
}
