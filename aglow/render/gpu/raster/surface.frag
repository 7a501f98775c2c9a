// SPDX-License-Identifier: Apache-2.0
// How a surface looks without reflections: the twin of shade.comp and finish.comp, but for light
// that is not baked, which no shadow ray is traced for.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/render/gpu/raster/raster.glsl"

layout(constant_id = 0) const uint kTextured = 1u;
layout(constant_id = 1) const uint kAlpha = 1u;  // 0: no material is cut out or blended

layout(location = 0) centroid in vec3 position;
layout(location = 1) centroid in vec3 normal;
layout(location = 2) centroid in vec2 barycentrics;
layout(location = 3) flat in uint face;
layout(location = 0) out vec4 color;

#define AG_TEXTURED kTextured
#include "aglow/render/gpu/surface.glsl"
#include "aglow/render/gpu/raster/direct_light.glsl"

vec3 baked_irradiance(SurfacePoint at) {
    vec2Ptr uvs = args.scene.at[0].lightmap_uvs;
    return lightmap_at(args.scene, uvs.at[at.vertices.x] * at.weights.x +
                                       uvs.at[at.vertices.y] * at.weights.y +
                                       uvs.at[at.vertices.z] * at.weights.z);
}

// How wide a pixel is where it shows this point.
Footprint pixel_footprint(Triangle corners) {
    CameraView view = args.frame.at[0].view;
    vec3 to_point = position - view.to_world.t;
    vec3 direction = view.perspective != 0u ? normalize(to_point) : -view.to_world.z;
    RayCone cone = advanced_cone(camera_cone(view, 1u), length(to_point));
    vec3 perpendicular = cross(corners.b - corners.a, corners.c - corners.a);
    return Footprint(0.5f * length(perpendicular), cone.width,
                     dot(triangle_normal(corners), direction));
}

float opacity(SurfaceMaterial material, SurfacePoint at) {
    if ((material.flags & (kMaterialMask | kMaterialBlend)) == 0u) return 1.0f;
    vec4 texel = material_texels(args.scene, material, at, kSharp, kBaseColor).base_color;
    return opacity_of(material, texel, vertex_color(args.scene, at));
}

void main() {
    SurfacePoint at = surface_point(args.scene, face, barycentrics);
    SurfaceMaterial material = material_of(args.scene, face);
    bool both_sides = (material.flags & kMaterialDoubleSided) != 0u;
    float alpha = 1.0f;
    if (kAlpha != 0u) {
        alpha = opacity(material, at);
        if (alpha == 0.0f || !(gl_FrontFacing || both_sides)) discard;
    }
    Footprint footprint = pixel_footprint(args.scene.at[0].corners.at[face]);
    SurfaceColor surface =
        color_at(args.scene, material, at, footprint, gl_FrontFacing || both_sides);
    vec3 luminance = surface.base_color * kUnlitLuminance;
    if ((material.flags & kMaterialUnlit) == 0u) {
        vec3 seen = normalize(gl_FrontFacing ? normal : -normal);
        vec3 irradiance = args.frame.at[0].baked != 0u ? baked_irradiance(at)
                                                       : direct_irradiance(position, seen);
        luminance = surface.emitted + matte_look(surface).diffuse * irradiance;
    }
    color = vec4(min(luminance, vec3(args.frame.at[0].most_luminance)) * alpha, alpha);
}
