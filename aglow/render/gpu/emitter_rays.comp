// SPDX-License-Identifier: Apache-2.0
// Shadow rays from lit surfaces to a point on one of the emissive triangles: the twin of from_emitters() in
// render/cpu/lighting.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/sampling.h"
#include "aglow/shared/wavefront.h"

layout(constant_id = 0) const uint kTextured = 1u;

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

#define AG_TEXTURED kTextured
#include "aglow/render/gpu/surface.glsl"
#include "aglow/render/gpu/area_light.glsl"

bool emitter_ray(Side side, uvec2 numbers, out RayQuery ray, out vec3 irradiance) {
    vec3 u = owen_sobol_3d(numbers.y, numbers.x);
    Pick picked = pick(args.scene.at[0].emitter_sums, 0u, args.scene.at[0].emitter_count, u.x);
    uint triangle = args.scene.at[0].emitters.at[picked.index];
    Triangle corners = args.scene.at[0].corners.at[triangle];
    EmitterSample light =
        sample_emitter(corners, picked.share, u.yz, side.origin, side.normal);
    if (!(light.weight > 0.0f)) return false;
    if (!(dot(light.direction, side.geometric_normal) > 0.0f)) return false;
    SurfaceMaterial material = material_of(args.scene, triangle);
    if (light.front == 0u && (material.flags & kMaterialDoubleSided) == 0u) return false;
    SurfacePoint at = surface_point(args.scene, triangle, light.barycentrics);
    MaterialTexels texels =
        material_texels(args.scene, material, at, kSharp, kBaseColor | kEmissive);
    float opacity = opacity_of(material, texels.base_color, vertex_color(args.scene, at));
    irradiance = material.emission * texels.emissive.rgb * (opacity * light.weight);
    if (irradiance == vec3(0.0f)) return false;
    // The ray ends a clearance above the light, so that it meets neither it nor a twin of it.
    float leaving = abs(dot(triangle_normal(corners), light.direction));
    float cut = clearance(magnitude_of(corners)) / max(leaving, 1e-6f);
    ray = RayQuery(side.origin, 0.0f, light.direction, max(light.distance - cut, 0.0f));
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
        alive = emitter_ray(side, draw_of(path, kDrawEmitter), ray, irradiance);
        if (alive) {
            args.wavefront.at[0].shadow_rays.at[slot] = ray;
            args.wavefront.at[0].shadows.at[slot] = WavefrontShadow(irradiance, vec3(0.0f));
        }
    }
    args.wavefront.at[0].shadow_alive.at[slot] = alive ? 1u : 0u;
}
