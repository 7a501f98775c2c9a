// SPDX-License-Identifier: Apache-2.0
// Which triangles a ray passes: the twin of the filters of accel/cpu/embree_scene.cpp. To be
// included before accel/gpu/trace.glsl, after the shader's `args`.
layout(constant_id = 0) const uint kTextured = 1u;
layout(constant_id = 1) const uint kKinds = 7u;
layout(constant_id = 2) const uint kAlpha = 1u;  // 0: no material is cut out or blended

#define AG_TEXTURED kTextured
#include "aglow/render/gpu/surface.glsl"
#include "aglow/shared/ray_hash.h"

RayQuery traced;  // the ray that is being traced

float opacity_at(uint triangle, vec2 barycentrics) {
    SurfaceMaterial material = material_of(args.scene, triangle);
    if ((material.flags & (kMaterialMask | kMaterialBlend)) == 0u) return 1.0f;
    SurfacePoint at = surface_point(args.scene, triangle, barycentrics);
    vec4 texel = material_texels(args.scene, material, at, kSharp, kBaseColor).base_color;
    return opacity_of(material, texel, vertex_color(args.scene, at));
}
