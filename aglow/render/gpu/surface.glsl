// SPDX-License-Identifier: Apache-2.0
// What a ray met: the twin of render/cpu/surface.h.
#ifndef AGLOW_RENDER_GPU_SURFACE_GLSL
#define AGLOW_RENDER_GPU_SURFACE_GLSL
#include "aglow/render/gpu/textures.glsl"

// A constant that is 0 where no material has a texture: software devices run the code of textures
// even where no invocation needs it.
#ifndef AG_TEXTURED
#define AG_TEXTURED 1u
#endif

struct SurfacePoint {
    uint triangle;
    uvec3 vertices;
    vec3 weights;  // of the vertices
};

struct Surface {
    bool front;  // the side that the ray came from
    uint flags;  // of its material
    vec3 position;
    vec3 geometric_normal, normal;  // unit, towards the front; the second interpolated
    Triangle corners;
    vec3 normals[3];  // of the corners
    float magnitude;  // see magnitude_of()
    float curvature;  // 1/m, positive where the side that the ray sees is convex
    vec2 barycentrics;
    SurfaceColor color;
};

SurfacePoint surface_point(DeviceScenePtr scene, uint triangle, vec2 b) {
    return SurfacePoint(triangle, scene.at[0].triangles.at[triangle],
                        vec3(1.0f - b.x - b.y, b.x, b.y));
}

// Largest absolute coordinate of the corners.
float magnitude_of(Triangle t) {
    vec3 most = max(max(abs(t.a), abs(t.b)), abs(t.c));
    return max(max(most.x, most.y), most.z);
}

// How far off a surface with coordinates up to `magnitude` a ray has to start or end, m; see
// accel/ray_scene.h.
float clearance(float magnitude) { return 3.81469727e-6f * magnitude; }

vec3 triangle_normal(Triangle t) {
    vec3 n = cross(t.b - t.a, t.c - t.a);
    float size = length(n);
    return size > 0.0f ? n / size : vec3(0.0f);
}

// How wide the ray is on the triangle that it met.
struct Footprint {
    float triangle_area, width, cosine;
};

vec4 material_texel(DeviceScenePtr scene, TextureUse use, SurfacePoint at, Footprint footprint) {
    TextureLevels texture = scene.at[0].textures.at[use.texture];
    if (use.texcoord >= scene.at[0].texcoord_sets)
        return filtered_texture(scene, texture, texture_coordinates(use, vec2(0.0f)), 0.0f);
    uint set = use.texcoord * scene.at[0].vertex_count;
    vec2 a = scene.at[0].texcoords.at[set + at.vertices.x];
    vec2 b = scene.at[0].texcoords.at[set + at.vertices.y];
    vec2 c = scene.at[0].texcoords.at[set + at.vertices.z];
    float level = texture_level(texture, texture_coordinates(use, a), texture_coordinates(use, b),
                                texture_coordinates(use, c), footprint.triangle_area,
                                footprint.width, footprint.cosine);
    vec2 uv = a * at.weights.x + b * at.weights.y + c * at.weights.z;
    return filtered_texture(scene, texture, texture_coordinates(use, uv), level);
}

const uint kBaseColor = 1u;
const uint kMetallicRoughness = 2u;
const uint kEmissive = 4u;

// What a material's textures show at a point; 1 where there is none.
struct MaterialTexels {
    vec4 base_color, metallic_roughness, emissive;
};

// Reads those of the textures that are `wanted` and there, in a loop, so that the code of textures
// is there once and takes as long as the largest number of textures in a subgroup.
MaterialTexels material_texels(DeviceScenePtr scene, SurfaceMaterial material, SurfacePoint at,
                               Footprint footprint, uint wanted) {
    MaterialTexels texels = MaterialTexels(vec4(1.0f), vec4(1.0f), vec4(1.0f));
    if (AG_TEXTURED == 0u) return texels;
    if (material.base_color_texture.texture == kNoTexture) wanted &= ~kBaseColor;
    if (material.metallic_roughness_texture.texture == kNoTexture) wanted &= ~kMetallicRoughness;
    if (material.emissive_texture.texture == kNoTexture) wanted &= ~kEmissive;
    while (wanted != 0u) {
        uint which = wanted & (0u - wanted);
        wanted ^= which;
        TextureUse use = material.base_color_texture;
        if (which == kMetallicRoughness) use = material.metallic_roughness_texture;
        if (which == kEmissive) use = material.emissive_texture;
        vec4 texel = material_texel(scene, use, at, footprint);
        if (which == kBaseColor) texels.base_color = texel;
        if (which == kMetallicRoughness) texels.metallic_roughness = texel;
        if (which == kEmissive) texels.emissive = texel;
    }
    return texels;
}

vec4 vertex_color(DeviceScenePtr scene, SurfacePoint at) {
    if (scene.at[0].has_colors == 0u) return vec4(1.0f);
    vec4Ptr colors = scene.at[0].colors;
    return colors.at[at.vertices.x] * at.weights.x + colors.at[at.vertices.y] * at.weights.y +
           colors.at[at.vertices.z] * at.weights.z;
}

// 0 to 1; 0 or 1 for masks.
float opacity_of(SurfaceMaterial material, vec4 texel, vec4 color) {
    if ((material.flags & (kMaterialMask | kMaterialBlend)) == 0u) return 1.0f;
    float alpha = material.base_color.a * texel.a * color.a;
    if ((material.flags & kMaterialMask) != 0u) return alpha >= material.alpha_cutoff ? 1.0f : 0.0f;
    return clamp(alpha, 0.0f, 1.0f);
}

// Textures at their full resolution.
const Footprint kSharp = Footprint(1.0f, 0.0f, 1.0f);

SurfaceMaterial material_of(DeviceScenePtr scene, uint triangle) {
    return scene.at[0].materials.at[scene.at[0].material_of.at[triangle]];
}

SurfaceColor color_at(DeviceScenePtr scene, SurfaceMaterial material, SurfacePoint at,
                      Footprint footprint, bool emits) {
    emits = emits && material.emission != vec3(0.0f);
    uint wanted = kBaseColor | kMetallicRoughness | (emits ? kEmissive : 0u);
    MaterialTexels texels = material_texels(scene, material, at, footprint, wanted);
    SurfaceColor color;
    color.base_color =
        (material.base_color * texels.base_color * vertex_color(scene, at)).rgb;
    color.metallic = clamp(material.metallic * texels.metallic_roughness.b, 0.0f, 1.0f);
    color.roughness = clamp(material.roughness * texels.metallic_roughness.g, 0.0f, 1.0f);
    color.emitted = emits ? material.emission * texels.emissive.rgb : vec3(0.0f);
    return color;
}

// `cone` is the ray's where it meets the surface.
Surface surface_at(DeviceScenePtr scene, RayHit hit, vec3 direction, RayCone cone) {
    SurfacePoint at = surface_point(scene, hit.triangle, hit.barycentrics);
    SurfaceMaterial material = material_of(scene, hit.triangle);
    Surface s;
    s.flags = material.flags;
    s.barycentrics = hit.barycentrics;
    s.corners = scene.at[0].corners.at[hit.triangle];
    s.position = s.corners.a * at.weights.x + s.corners.b * at.weights.y +
                 s.corners.c * at.weights.z;
    vec3 perpendicular = cross(s.corners.b - s.corners.a, s.corners.c - s.corners.a);
    s.geometric_normal = triangle_normal(s.corners);
    s.front = dot(perpendicular, direction) < 0.0f;
    s.normals[0] = scene.at[0].normals.at[at.vertices.x];
    s.normals[1] = scene.at[0].normals.at[at.vertices.y];
    s.normals[2] = scene.at[0].normals.at[at.vertices.z];
    vec3 normal = s.normals[0] * at.weights.x + s.normals[1] * at.weights.y +
                  s.normals[2] * at.weights.z;
    float size = length(normal);
    s.normal = size > 1e-6f ? normal / size : s.geometric_normal;
    s.magnitude = magnitude_of(s.corners);
    s.curvature = triangle_curvature(s.corners, s.normals[0], s.normals[1], s.normals[2]) *
                  (s.front ? 1.0f : -1.0f);
    Footprint footprint =
        Footprint(0.5f * length(perpendicular), cone.width, dot(s.geometric_normal, direction));
    bool emits = s.front || (material.flags & kMaterialDoubleSided) != 0u;
    s.color = color_at(scene, material, at, footprint, emits);
    return s;
}

// Where shadow rays start that leave on the front (1) or back (-1).
vec3 shadow_origin(Surface s, float side) {
    vec3 lifted = lifted_point(s.position, s.barycentrics, s.corners, s.normals[0] * side,
                               s.normals[1] * side, s.normals[2] * side);
    return lifted + s.geometric_normal * (side * clearance(s.magnitude));
}

#endif
