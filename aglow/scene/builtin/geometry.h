// SPDX-License-Identifier: Apache-2.0
// Shapes that the built-in scenes are made of, and the scene they are put into. All lengths in
// metres; every closed shape is watertight and faces outward; flip() turns it inside out.
#pragma once
#include "aglow/scene/scene.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aglow::builtin {

/// Triangles with normals and one UV set, before they have a material or a place.
struct Shape {
    std::vector<vec3> positions;
    std::vector<vec3> normals;    ///< [vertex_count] unit
    std::vector<vec2> texcoords;  ///< [vertex_count]
    std::vector<uvec3> triangles;

    void append(const Shape& other);
    /// The same for a moved copy: Shape is a value, so moves read as expressions.
    Shape moved(vec3 offset) const;
    Shape scaled(vec3 factors) const;  ///< positive factors
    /// About the axis through the origin, counter-clockwise seen from its tip.
    Shape turned(vec3 axis, float degrees) const;
    Shape flipped() const;                        ///< front becomes back
    Shape with_texcoord_scale(vec2 scale) const;  ///< multiplies every UV
};

/// Joins the corners of loose triangles into a shape: corners at one place share a normal unless
/// their faces meet at more than `crease_degrees`; triangles without area vanish.
Shape soup_to_shape(Shape soup, float crease_degrees);
/// Normals of the triangles round each vertex, weighted by area.
void set_smooth_normals(Shape& shape);

/// Quadrilateral a b c d, counter-clockwise seen from the front; UV (0, 1) at a, (1, 1) at b,
/// (1, 0) at c, (0, 0) at d: an image stands upright where a b is the lower edge.
Shape quad(vec3 a, vec3 b, vec3 c, vec3 d);
Shape box(vec3 lo, vec3 hi);
/// A box whose edges and corners are rounded with `radius`, with `segments` along each arc; its
/// faces bulge outward by `bulge` in the middle like a cushion.
Shape rounded_box(vec3 lo, vec3 hi, float radius, int segments, float bulge = 0);
Shape sphere(vec3 center, float radius, int slices, int stacks);
/// Closed with flat ends, from `base` up by `height`.
Shape cylinder(vec3 base, float radius, float height, int slices);
/// Surface of revolution about +Y of a profile of (radius, height), from bottom to top on the
/// outside; a profile that starts and ends on the axis, or at its start, is closed. Smooth except
/// where the profile turns by more than 40 degrees.
Shape lathe(std::span<const vec2> profile, int slices);
/// Tube along a path with a radius at every point; its ends are closed.
Shape tube(std::span<const vec3> path, std::span<const float> radii, int slices);
/// Open sheet point(u, v) for u, v in 0..1; its front is where du x dv points to.
Shape sheet(const std::function<vec3(float, float)>& point, int columns, int rows);

/// A solid cut out of a grid of boxes that need not be of one size: walls with openings, frames,
/// shelves. Neighbouring faces share their corners, so the surface is watertight.
struct Lattice {
    std::vector<float> x, y, z;  ///< increasing bounds of the cells
    /// Is the cell filled? Cells outside of the lattice have indices -1 and size - 1.
    std::function<bool(int i, int j, int k)> solid;

    /// Face between a solid cell and an open one: where it is and which way it faces.
    struct Face {
        vec3 center, normal;
    };
    /// Hands every face to the shape that `choose` picks; UVs are metres in the face's plane.
    void skin(const std::function<Shape&(const Face&)>& choose) const;
    Shape shape() const;  ///< all faces in one
};

/// Quaternion of a turn about an axis through the origin, counter-clockwise seen from its tip.
vec4 turn(vec3 axis, float degrees);
/// The turn `first`, and then `second`.
vec4 then(vec4 first, vec4 second);

/// Puts named shapes, materials, lights and the camera into a Scene, each object a root node unless
/// it is attached to another.
class SceneBuilder {
public:
    explicit SceneBuilder(std::string name) { scene_.name = std::move(name); }

    /// Diffuse (metallic 0, roughness 1), linear Rec. 709 reflectance.
    int diffuse(std::string name, vec3 reflectance);
    /// The same with a texture that multiplies `tint`; `image` is sRGB-coded.
    int textured(TextureImage image, vec3 tint = {1, 1, 1});
    int luminous(std::string name, vec3 reflectance, vec3 luminance);  ///< cd/m^2
    /// A quarter of its reflectance is diffuse: where reflections are not drawn it is not black.
    int metal(std::string name, vec3 reflectance, float roughness);
    /// A coat of paint under a clear gloss: diffuse, with dielectric reflections.
    int glossy(std::string name, vec3 reflectance, float roughness);
    Material& material(int index) { return scene_.materials[static_cast<size_t>(index)]; }

    /// An object of one material. Result: its node.
    int add(std::string name, const Shape& shape, int material);
    struct Part {
        const Shape& shape;
        int material;
    };
    /// An object of several materials, one primitive each.
    int add(std::string name, std::initializer_list<Part> parts);
    /// A mesh without a place, for several nodes.
    int add_mesh(std::string name, std::initializer_list<Part> parts);
    int add_node(std::string name, int mesh = -1);  ///< a root node; mesh -1: none
    void attach(int child, int parent);             ///< makes `child` a child node
    Node& node(int index) { return scene_.nodes[static_cast<size_t>(index)]; }
    Mesh& mesh(int index) { return scene_.meshes[static_cast<size_t>(index)]; }
    int add_skin(Skin skin);
    /// A channel of the scene's one animation.
    void animate(int node, Path path, std::vector<float> times, std::vector<float> values,
                 Interpolation interpolation = Interpolation::linear);
    /// `turns` whole turns about `axis` in `seconds`, on top of the node's own rotation.
    void spin(int node, vec3 axis, int turns, float seconds);
    void add_light(Light light, vec3 position);
    void add_spot(Light light, vec3 position, vec3 target);
    /// Light from infinity: azimuth clockwise from north (-Z), elevation above the horizon.
    void add_directional(Light light, float azimuth_degrees, float elevation_degrees);
    void look(vec3 eye, vec3 target, float y_fov_degrees);  ///< the scene's camera

    Scene take() { return std::move(scene_); }

private:
    Scene scene_;
};

/// sRGB-coded image of a linear colour at every (u, v) in 0..1, (0, 0) in the upper left corner.
TextureImage painted(std::string name, int width, int height,
                     const std::function<vec3(float u, float v)>& color);

/// Deterministic pseudo-random numbers in 0..1 for placing things.
/// Source  Steele, Lea & Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014.
class Dice {
public:
    explicit Dice(uint64_t seed) : state_(seed) {}
    float next();
    float between(float lo, float hi) { return lo + (hi - lo) * next(); }

private:
    uint64_t state_;
};

}  // namespace aglow::builtin
