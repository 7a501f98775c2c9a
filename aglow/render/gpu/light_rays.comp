// SPDX-License-Identifier: Apache-2.0
// Shadow rays from lit surfaces to a few lights without extent: the twin of the loop over lights in
// render/cpu/lighting.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

#include "aglow/render/gpu/photometry.glsl"

// True where light falls on the lit side or shows on the side of the viewer.
bool shadow_ray(WavefrontSurface s, PunctualLight light, out RayQuery ray,
                out WavefrontShadow shadow) {
    LightArrival from = punctual_arrival(light, s.position);
    if (light.kind == kLightPhotometric)
        from.normal_irradiance *= photometric_intensity(args.scene, light, from.direction);
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
