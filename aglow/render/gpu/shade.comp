// SPDX-License-Identifier: Apache-2.0
// What the paths in the queue have met: the sky, or a surface with what it emits and how it is to
// be lit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/wavefront.h"

layout(constant_id = 0) const uint kTextured = 1u;

layout(local_size_x = kWavefrontGroupSize) in;
layout(push_constant, scalar) uniform Push { WavefrontArgs args; };

#define AG_TEXTURED kTextured
#include "aglow/render/gpu/surface.glsl"

vec3 stored_irradiance(SurfacePoint at) {
    if (args.frame.at[0].stored == kStoredNothing) return vec3(0.0f);
    vec2Ptr uvs = args.scene.at[0].lightmap_uvs;
    return lightmap_at(args.scene, uvs.at[at.vertices.x] * at.weights.x +
                                       uvs.at[at.vertices.y] * at.weights.y +
                                       uvs.at[at.vertices.z] * at.weights.z);
}

WavefrontSurface to_be_lit(Surface s, SurfacePoint at, WavefrontPath path, vec3 direction) {
    float side = s.front ? 1.0f : -1.0f;
    WavefrontSurface lit;
    lit.position = s.position;
    lit.normal = s.normal;
    lit.geometric_normal = s.geometric_normal;
    lit.front_origin = shadow_origin(s, 1.0f);
    lit.back_origin = shadow_origin(s, -1.0f);
    lit.magnitude = s.magnitude;
    lit.front = s.front ? 1u : 0u;
    lit.to_viewer = -direction;
    lit.glossy = args.frame.at[0].reflections > 0u ? 1u : 0u;
    lit.f0 = normal_reflectance(s.color);
    lit.alpha = lobe_alpha(s.color.roughness, s.curvature, path.cone.width);
    uint mirrors = args.frame.at[0].reflections - min(args.depth, args.frame.at[0].reflections);
    lit.look = lit.glossy != 0u
                   ? surface_look(s.color, dot(s.normal * side, -direction), path.weight, mirrors)
                   : matte_look(s.color);
    lit.mirrored = reflected_cone(path.cone, s.curvature, s.color.roughness);
    lit.irradiance = stored_irradiance(at);
    lit.punctual = vec3(0.0f);
    lit.highlights = vec3(0.0f);
    return lit;
}

void main() {
    uint i = global_index();
    if (i >= args.wavefront.at[0].queued.at[0]) return;
    uint index = args.wavefront.at[0].queue.at[i];
    WavefrontPath path = args.wavefront.at[0].paths.at[index];
    RayHit hit = args.wavefront.at[0].hits.at[index];
    vec3 direction = args.wavefront.at[0].rays.at[index].direction;
    if (hit.triangle == kNoTriangle) {
        path.luminance += path.weight * sky_at(args.scene, direction);
        args.wavefront.at[0].paths.at[index] = path;
        return;
    }
    path.cone = advanced_cone(path.cone, hit.t);
    Surface s = surface_at(args.scene, hit, direction, path.cone);
    if ((s.flags & kMaterialUnlit) != 0u) {
        path.luminance += path.weight * s.color.base_color * kUnlitLuminance;
    } else {
        path.luminance += path.weight * s.color.emitted;
        args.wavefront.at[0].surfaces.at[index] =
            to_be_lit(s, surface_point(args.scene, hit.triangle, hit.barycentrics), path, direction);
        args.wavefront.at[0].lit.at[index] = 1u;
    }
    args.wavefront.at[0].paths.at[index] = path;
}
