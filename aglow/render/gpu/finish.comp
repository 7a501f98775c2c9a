// SPDX-License-Identifier: Apache-2.0
// Adds the light of lit surfaces to their paths, and sends these on to what mirrors show.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

#include "aglow/render/gpu/surface.glsl"

void main() {
    uint lit = global_index();
    if (lit >= args.wavefront.at[0].lit_queued.at[0]) return;
    uint index = args.wavefront.at[0].lit_queue.at[lit];
    WavefrontSurface s = args.wavefront.at[0].surfaces.at[index];
    WavefrontPath path = args.wavefront.at[0].paths.at[index];
    bool stored = args.frame.at[0].stored == kStoredAll;
    vec3 mean = stored ? max(s.irradiance - s.punctual, vec3(0.0f)) : s.irradiance;
    vec3 irradiance = stored ? s.irradiance : s.irradiance + s.punctual;
    path.luminance +=
        path.weight * (s.look.diffuse * irradiance + s.look.mean * mean + s.highlights);

    if (s.look.mirror != vec3(0.0f)) {
        float side = s.front != 0u ? 1.0f : -1.0f;
        vec3 outward = s.geometric_normal * side;
        path.weight *= s.look.mirror;
        path.cone = s.mirrored;
        vec3 direction = mirror_direction(-s.to_viewer, s.normal * side, outward);
        vec3 origin = s.position + outward * clearance(s.magnitude);
        args.wavefront.at[0].rays.at[index] = RayQuery(origin, 0.0f, direction, kFarAway);
        args.wavefront.at[0].alive.at[index] = 1u;
    }
    args.wavefront.at[0].paths.at[index] = path;
}
