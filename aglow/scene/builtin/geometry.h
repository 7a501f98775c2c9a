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

/// Puts named shapes, materials, lights and the camera into a Scene, each object a root node.
class SceneBuilder {
public:
    explicit SceneBuilder(std::string name) { scene_.name = std::move(name); }

    /// Diffuse (metallic 0, roughness 1), linear Rec. 709 reflectance.
    int diffuse(std::string name, vec3 reflectance);
    /// The same with a texture that multiplies `tint`; `image` is sRGB-coded.
    int textured(TextureImage image, vec3 tint = {1, 1, 1});
    int luminous(std::string name, vec3 reflectance, vec3 luminance);  ///< cd/m^2
    Material& material(int index) { return scene_.materials[static_cast<size_t>(index)]; }

    /// An object of one material.
    void add(std::string name, const Shape& shape, int material);
    struct Part {
        const Shape& shape;
        int material;
    };
    /// An object of several materials, one primitive each.
    void add(std::string name, std::initializer_list<Part> parts);
    void add_light(Light light, vec3 position);
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
