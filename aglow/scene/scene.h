// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/image.h"
#include "aglow/core/math.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace aglow {

/// Everything light needs to know of a glTF scene, as a plain value: copy it, change it, hand it
/// on. Indices of meshes, primitives, nodes, materials, textures, images, skins, cameras and
/// animations are those of the glTF file; -1 means "none". Loaders leave only valid indices,
/// finite numbers and acyclic node trees behind, so no later stage checks them again.
/// Units  metres, cd/m^2, candela, lux, radians, seconds; colours linear Rec. 709.
struct Scene;

/// 8-bit RGBA as decoded from PNG, JPEG or WebP. Which channels are sRGB-coded depends on use:
/// base colour and emission are, metallic-roughness is not. Images that no material's light depends
/// on (normal maps, occlusion) are not decoded and have 0 x 0 pixels.
struct TextureImage {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<uint8_t> rgba;  ///< [height * width * 4], row 0 on top
};

enum class Wrap : uint8_t { repeat, mirrored_repeat, clamp_to_edge };
enum class Filter : uint8_t { nearest, linear };

struct Texture {
    int image = -1;
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
    Filter filter = Filter::linear;  ///< of magnification
};

/// Use of a texture by a material, with KHR_texture_transform resolved.
struct TextureRef {
    int texture = -1;  ///< -1: no texture, every channel reads 1
    int texcoord = 0;
    vec2 offset = {0, 0};
    vec2 scale = {1, 1};
    float rotation = 0;  ///< radians, as KHR_texture_transform defines it
};

enum class AlphaMode : uint8_t { opaque, mask, blend };

struct Material {
    std::string name;
    vec4 base_color = {1, 1, 1, 1};
    TextureRef base_color_texture;  ///< sRGB-coded
    float metallic = 1;
    float roughness = 1;
    TextureRef metallic_roughness_texture;  ///< metallic in blue, roughness in green
    vec3 emission = {0, 0, 0};    ///< luminance, cd/m^2: emissiveFactor * emissive strength
    TextureRef emissive_texture;  ///< sRGB-coded, multiplies `emission`
    TextureRef normal_texture;    ///< written, not loaded: no light depends on it
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool unlit = false;  ///< KHR_materials_unlit: reflects its base colour, does not emit
};

struct MorphTarget {
    std::vector<vec3> positions;  ///< [vertex_count] displacements, or empty
    std::vector<vec3> normals;    ///< [vertex_count] displacements, or empty
    bool operator==(const MorphTarget&) const = default;
};

/// An edge, by its ends, that subdivision keeps sharp for `sharpness` levels; 10 and above for
/// ever.
struct SharpEdge {
    uint32_t a = 0, b = 0;  ///< vertices of the primitive, in any order
    float sharpness = 10;
    bool operator==(const SharpEdge&) const = default;
};

/// Likewise a vertex.
struct SharpVertex {
    uint32_t vertex = 0;
    float sharpness = 10;
    bool operator==(const SharpVertex&) const = default;
};

/// Where the heights of a displaced surface are: docs/formats/displacement.md.
struct DisplacementRef {
    std::filesystem::path file;  ///< of the image, below the folder of the glTF file
    int texcoord = 0;
    float scale = 1, bias = 0;  ///< m; height = bias + scale * red
    bool operator==(const DisplacementRef&) const = default;
};

/// No real surface reflects more; light would not die out. Surfaces clamp their diffuse reflectance
/// to it, and loaders warn of it.
inline constexpr float kMaxReflectance = 0.98f;

/// Triangles of one material. Strips and fans are resolved into triangles; points and lines give
/// a primitive without triangles.
struct Primitive {
    int material = -1;             ///< -1: the default material (white, metallic 0 for light)
    std::vector<uvec3> triangles;  ///< counter-clockwise seen from the front
    std::vector<vec3> positions;   ///< [vertex_count] m
    std::vector<vec3>
        normals;  ///< [vertex_count] unit; flat ones (vertices split) where the file has none
    std::vector<std::vector<vec2>> texcoords;  ///< [set][vertex_count], TEXCOORD_n at index n
    std::vector<vec4> colors;                  ///< [vertex_count] linear COLOR_0, or empty
    std::vector<uint32_t>
        joints;  ///< [vertex_count * influences] indices into the skin's joints, or empty
    std::vector<float> weights;  ///< [vertex_count * influences], or empty
    int influences = 0;          ///< joints per vertex: 4 for each JOINTS_n set
    std::vector<MorphTarget> targets;
    /// [vertex_count] _SHARPNESS, _TENSION and _BIAS, the scalar tags of curved triangles; or empty
    std::vector<float> sharpness, tension, bias;
    std::vector<SharpEdge> creases;    ///< tagged in the file: docs/formats/creases.md
    std::vector<SharpVertex> corners;  ///< likewise
    std::optional<DisplacementRef> displacement;
    /// [vertex_count] for Material::normal_texture, as glTF has them; written, not loaded
    std::vector<vec4> tangents;

    /// Vertex of the glTF primitive that each vertex is a copy of; unwrapping and flat shading
    /// split vertices. Empty: vertex i is the file's vertex i.
    std::vector<uint32_t> source_vertex;
    /// [vertex_count] second UV set for light, in the unit square of the mesh; filled by unwrap().
    std::vector<vec2> lightmap_uvs;
};

/// Are they alike in all but their material?
bool same_geometry(const Primitive& a, const Primitive& b);

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> weights;  ///< default morph weights
};

struct Node {
    std::string name;
    int parent = -1;
    std::vector<int> children;
    /// Local transform. With `has_matrix` it is `matrix` (not animatable), else T * R * S.
    bool has_matrix = false;
    mat4 matrix;
    vec3 translation = {0, 0, 0};
    vec4 rotation = {0, 0, 0, 1};
    vec3 scale = {1, 1, 1};
    int mesh = -1;
    int skin = -1;
    int camera = -1;
    int light = -1;
    std::vector<float> weights;  ///< morph weights; empty: the mesh's
    std::vector<mat4>
        instances;         ///< EXT_mesh_gpu_instancing, local to the node; empty: one, identity
    bool in_scene = true;  ///< reachable from the active scene's roots
};

struct Skin {
    std::vector<int> joints;         ///< node indices
    std::vector<mat4> inverse_bind;  ///< [joint]
};

enum class Interpolation : uint8_t { step, linear, cubic_spline };
enum class Path : uint8_t { translation, rotation, scale, weights };

struct AnimationChannel {
    int node = -1;
    Path path = Path::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times;   ///< [key_count] seconds, increasing
    std::vector<float> values;  ///< [key_count * width], three per key (in-tangent, value,
                                ///< out-tangent) for cubic_spline
};

struct Animation {
    std::string name;
    std::vector<AnimationChannel> channels;
};

struct Camera {
    std::string name;
    bool perspective = true;
    float y_fov = 0.8f;          ///< radians (perspective)
    float aspect = 0;            ///< 0: the image's
    float x_mag = 1, y_mag = 1;  ///< half extents, m (orthographic)
    float z_near = 0.01f;
};

enum class LightKind : uint8_t { point, spot, directional, photometric };

struct Photometry;  // aglow/scene/photometry.h

/// KHR_lights_punctual, or a luminaire of EXT_lights_ies. Shines along -Z of its node.
struct Light {
    std::string name;
    LightKind kind = LightKind::point;
    vec3 intensity = {1, 1, 1};  ///< color * intensity: candela (point, spot), lux (directional);
                                 ///< a factor for a photometric light
    float range = kInfinity;     ///< m; recorded, but light does not end there (see docs)
    float inner_cone = 0;        ///< radians, spot
    float outer_cone = kPi / 4;  ///< radians, spot
    std::shared_ptr<const Photometry> photometry = nullptr;  ///< of a photometric light
};

/// Light from infinity all round: a uniform luminance, or an equirectangular image with -Z
/// (north) at its centre column, +X (east) to the right of it and +Y on top.
struct Sky {
    vec3 luminance = {0, 0, 0};          ///< cd/m^2; multiplies the image where there is one
    std::shared_ptr<const Image> image;  ///< cd/m^2, or none
};

/// The file a scene came from, kept whole so that a writer can give back all that it held.
struct GltfSource;

struct Scene {
    std::string name;  ///< file name without folder, or the built-in scene's name
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<TextureImage> images;
    std::vector<Skin> skins;
    std::vector<Animation> animations;
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::optional<Sky> sky;
    std::vector<std::string> warnings;         ///< what was odd but could be handled
    std::shared_ptr<const GltfSource> source;  ///< none for scenes made by code or read from OBJ
};

/// World transform of every node at `time` seconds into all animations (each held at its ends;
/// negative: the rest pose). Iterative: node chains may be of any depth.
/// Shapes  result has scene.nodes.size() entries.
std::vector<mat4> world_transforms(const Scene& scene, double time = -1);

/// Adds an isotropic point light of `flux` lumen at `position` (a light and a root node).
void add_point_light(Scene& scene, vec3 position, float flux);
/// Adds a luminaire at `position` that is aimed straight down, with C0 to the east (+X) and C90 to
/// the north (-Z).
void add_luminaire(Scene& scene, vec3 position, std::shared_ptr<const Photometry> photometry);
/// Adds the sun as a directional light. Azimuth clockwise from north (-Z), elevation above the
/// horizon, degrees; `illuminance` in lux on a plane that faces the sun.
void add_sun(Scene& scene, float azimuth_degrees, float elevation_degrees, float illuminance);
/// Makes every surface an opaque two-sided-blocking diffuse grey of reflectance `rho`; emission
/// is kept, textures of reflectance and vertex colours are not.
void apply_clay(Scene& scene, float rho);

}  // namespace aglow
