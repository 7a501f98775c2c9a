// SPDX-License-Identifier: Apache-2.0
// Intensity of luminaires with measured photometry.
#ifndef AGLOW_RENDER_GPU_PHOTOMETRY_GLSL
#define AGLOW_RENDER_GPU_PHOTOMETRY_GLSL
#include "aglow/shared/device_scene.h"

// Number of the measured angle below `angle`, which is within the first and the last; of the last
// interval at most.
uint interval_of(floatPtr table, uint first, uint count, float angle) {
    uint low = 0u;
    uint high = count - 1u;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (table.at[first + middle] > angle)
            high = middle;
        else
            low = middle;
    }
    return low;
}

// How far `angle` is from measured angle `below` to the next.
float share_of(floatPtr table, uint below, float angle) {
    float from = table.at[below];
    return clamp((angle - from) / (table.at[below + 1u] - from), 0.0f, 1.0f);
}

// The twin of intensity() in scene/photometry.cpp.
float photometric_intensity(DeviceScenePtr scene, PunctualLight light, vec3 to_light) {
    floatPtr table = scene.at[0].photometry;
    vec2 angles = photometric_angles(photometric_direction(light, to_light));
    uint gammas = light.photometry;
    uint cs = gammas + light.gamma_count;
    uint candela = cs + light.c_count;
    if (angles.x < table.at[gammas]) return 0.0f;
    if (angles.x > table.at[gammas + light.gamma_count - 1u]) return 0.0f;
    uint g = 0u;
    float g_share = 0.0f;
    if (light.gamma_count > 1u) {
        g = interval_of(table, gammas, light.gamma_count, angles.x);
        g_share = share_of(table, gammas + g, angles.x);
    }
    uint c = 0u;
    float c_share = 0.0f;
    if (light.c_count > 1u) {
        float turned = angles.y < table.at[cs] ? angles.y + 360.0f : angles.y;
        c = interval_of(table, cs, light.c_count, turned);
        c_share = share_of(table, cs + c, turned);
    }
    uint row = candela + c * light.gamma_count + g;
    uint next = light.c_count > 1u ? row + light.gamma_count : row;
    uint step = light.gamma_count > 1u ? 1u : 0u;
    return mix(mix(table.at[row], table.at[next], c_share),
               mix(table.at[row + step], table.at[next + step], c_share), g_share);
}

#endif
