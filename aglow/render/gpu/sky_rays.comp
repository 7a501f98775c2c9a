// SPDX-License-Identifier: Apache-2.0
// Shadow rays from lit surfaces to one point of the sky: the twin of from_sky() in
// render/cpu/lighting.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/sampling.h"
#include "aglow/shared/wavefront.h"

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

#define AG_TEXTURED 0u
#include "aglow/render/gpu/surface.glsl"
#include "aglow/render/gpu/area_light.glsl"

bool sky_ray(Side side, uvec2 numbers, out RayQuery ray, out vec3 irradiance) {
    vec2 u = owen_sobol_2d(numbers.y, numbers.x);
    int width = args.scene.at[0].sky_width;
    int height = args.scene.at[0].sky_height;
    ray = RayQuery(side.origin, 0.0f, vec3(0.0f), kFarAway);
    irradiance = args.scene.at[0].sky_luminance;
    if (width == 0) {
        ray.direction = around_normal(cosine_hemisphere(u), side.normal);
        irradiance *= 3.14159265f;
        return dot(ray.direction, side.geometric_normal) > 0.0f;
    }
    Pick row = pick(args.scene.at[0].sky_rows, 0u, uint(height), u.y);
    Pick cell = pick(args.scene.at[0].sky_cells, row.index * uint(width), uint(width), u.x);
    vec2 uv = vec2((float(cell.index) + cell.within) / float(width),
                   (float(row.index) + row.within) / float(height));
    ray.direction = sky_direction(uv);
    float cosine = dot(ray.direction, side.normal);
    if (!(cosine > 0.0f) || !(dot(ray.direction, side.geometric_normal) > 0.0f)) return false;
    float weight = sky_weight(width, height, row.share * cell.share, uv) * cosine;
    irradiance *= args.scene.at[0].sky.at[row.index * uint(width) + cell.index] * weight;
    return true;
}

void main() {
    uint lit = global_index();
    if (lit >= args.alive_count) return;
    uint slot = args.first_light * args.alive_count + lit;
    bool alive = false;
    if (lit < args.wavefront.at[0].lit_queued.at[0]) {
        uint path = args.wavefront.at[0].lit_queue.at[lit];
        Side side = seen_side(args.wavefront.at[0].surfaces.at[path]);
        RayQuery ray;
        vec3 irradiance;
        alive = sky_ray(side, draw_of(path, kDrawSky), ray, irradiance);
        if (alive) {
            args.wavefront.at[0].shadow_rays.at[slot] = ray;
            args.wavefront.at[0].shadows.at[slot] = WavefrontShadow(irradiance, vec3(0.0f));
        }
    }
    args.wavefront.at[0].shadow_alive.at[slot] = alive ? 1u : 0u;
}
