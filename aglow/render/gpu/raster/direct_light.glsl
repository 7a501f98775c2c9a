// SPDX-License-Identifier: Apache-2.0
// Light that comes straight from its sources, with nothing in between. To be included after the
// shader's `args`.
#include "aglow/render/gpu/photometry.glsl"

vec3 punctual_irradiance(vec3 p, vec3 n) {
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < args.scene.at[0].light_count; ++i) {
        PunctualLight light = args.scene.at[0].lights.at[i];
        LightArrival from = punctual_arrival(light, p);
        float cosine = dot(n, from.direction);
        if (!(cosine > 0.0f)) continue;
        if (light.kind == kLightPhotometric)
            from.normal_irradiance *= photometric_intensity(args.scene, light, from.direction);
        sum += from.normal_irradiance * cosine;
    }
    return sum;
}

vec3 emitter_irradiance(vec3 p, vec3 n) {
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < args.frame.at[0].emitter_count; ++i) {
        RasterEmitter emitter = args.frame.at[0].emitters.at[i];
        float factor = signed_form_factor(p, n, args.scene.at[0].corners.at[emitter.triangle]);
        if (emitter.both_sides != 0u) factor = abs(factor);
        sum += emitter.luminance * max(factor, 0.0f);
    }
    return sum * 3.14159265f;
}

vec3 direct_irradiance(vec3 p, vec3 n) {
    return punctual_irradiance(p, n) + emitter_irradiance(p, n) +
           sky_irradiance(args.frame.at[0], n);
}
