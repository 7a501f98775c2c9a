// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/geometry.h"

#include <array>

namespace aglow::builtin {
namespace {

using Cell = std::array<int, 3>;

vec2 planar_uv(vec3 p, size_t axis) {
    return axis == 0 ? vec2{p.z, -p.y} : axis == 1 ? vec2{p.x, p.z} : vec2{p.x, -p.y};
}

struct Bounds {
    std::array<float, 3> lo, hi;
};

/// The face of `cell` across `axis`, towards its upper or lower neighbour.
Shape face_quad(const Bounds& cell, size_t axis, bool upper) {
    const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto corner = [&](bool u_high, bool v_high) {
        std::array<float, 3> p{};
        p[axis] = upper ? cell.hi[axis] : cell.lo[axis];
        p[u] = u_high ? cell.hi[u] : cell.lo[u];
        p[v] = v_high ? cell.hi[v] : cell.lo[v];
        return vec3{p[0], p[1], p[2]};
    };
    const vec3 a = corner(false, false), b = corner(true, false), c = corner(true, true),
               d = corner(false, true);
    Shape shape = upper ? quad(a, b, c, d) : quad(a, d, c, b);
    for (size_t i = 0; i < shape.positions.size(); ++i)
        shape.texcoords[i] = planar_uv(shape.positions[i], axis);
    return shape;
}

}  // namespace

void Lattice::skin(const std::function<Shape&(const Face&)>& choose) const {
    const std::array<const std::vector<float>*, 3> bounds = {&x, &y, &z};
    const auto count = [&](size_t axis) { return static_cast<int>(bounds[axis]->size()) - 1; };
    const auto each_face = [&](Cell cell) {
        Bounds box{};
        for (size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = (*bounds[axis])[static_cast<size_t>(cell[axis])];
            box.hi[axis] = (*bounds[axis])[static_cast<size_t>(cell[axis]) + 1];
        }
        const bool is_solid = solid(cell[0], cell[1], cell[2]);
        for (size_t axis = 0; axis < 3; ++axis)
            for (const bool upper : {false, true}) {
                Cell next = cell;
                next[axis] += upper ? 1 : -1;
                const bool next_is_solid = solid(next[0], next[1], next[2]);
                if (is_solid == next_is_solid) continue;
                // Open cells make a face only where no solid cell of the lattice does.
                const bool at_rim = next[axis] < 0 || next[axis] >= count(axis);
                if (!is_solid && !at_rim) continue;
                Shape shape = face_quad(box, axis, upper);
                if (!is_solid) shape = shape.flipped();
                const vec3 center = (shape.positions[0] + shape.positions[2]) * 0.5f;
                choose({center, shape.normals[0]}).append(shape);
            }
    };
    for (int k = 0; k < count(2); ++k)
        for (int j = 0; j < count(1); ++j)
            for (int i = 0; i < count(0); ++i) each_face({i, j, k});
}

Shape Lattice::shape() const {
    Shape all;
    skin([&](const Face&) -> Shape& { return all; });
    return all;
}

}  // namespace aglow::builtin
