// SPDX-License-Identifier: Apache-2.0
// Shadow rays from lit surfaces to a few lights without extent: the twin of the loop over lights in
// render/cpu/lighting.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

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
float photometric_intensity(PunctualLight light, vec3 to_light) {
    floatPtr table = args.scene.at[0].photometry;
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

// True where light falls on the lit side or shows on the side of the viewer.
bool shadow_ray(WavefrontSurface s, PunctualLight light, out RayQuery ray,
                out WavefrontShadow shadow) {
    LightArrival from = punctual_arrival(light, s.position);
    if (light.kind == kLightPhotometric)
        from.normal_irradiance *= photometric_intensity(light, from.direction);
    float n_l = dot(s.normal, from.direction);
    bool in_front = n_l > 0.0f;
    float side = in_front ? 1.0f : -1.0f;
    bool lights_front = args.frame.at[0].stored != kStoredNothing || s.front != 0u;
    bool given = in_front == lights_front;
    bool shines = s.glossy != 0u && in_front == (s.front != 0u);
    if (!(given || shines) || from.normal_irradiance == vec3(0.0f)) return false;

    vec3 irradiance = from.normal_irradiance * abs(n_l);
    shadow.irradiance = given ? irradiance : vec3(0.0f);
    shadow.highlight = vec3(0.0f);
    if (shines)
        shadow.highlight = irradiance * highlight(args.frame.at[0].highlight, s.f0, s.alpha,
                                                  s.normal * side, s.to_viewer, from.direction);
    ray = RayQuery(in_front ? s.front_origin : s.back_origin, 0.0f, from.direction, from.distance);
    return true;
}

void main() {
    uint i = global_index();
    if (i >= args.alive_count * args.light_count) return;
    uint lit = i % args.alive_count;
    bool alive = false;
    if (lit < args.wavefront.at[0].lit_queued.at[0]) {
        PunctualLight light = args.scene.at[0].lights.at[args.first_light + i / args.alive_count];
        uint path = args.wavefront.at[0].lit_queue.at[lit];
        RayQuery ray;
        WavefrontShadow shadow;
        alive = shadow_ray(args.wavefront.at[0].surfaces.at[path], light, ray, shadow);
        if (alive) {
            args.wavefront.at[0].shadow_rays.at[i] = ray;
            args.wavefront.at[0].shadows.at[i] = shadow;
        }
    }
    args.wavefront.at[0].shadow_alive.at[i] = alive ? 1u : 0u;
}
