// SPDX-License-Identifier: Apache-2.0
// Ray-triangle test that lets no ray through between triangles that share an edge.
//
// Source: Woop, Benthin & Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. The ray
// becomes the +z axis by a shear and a permutation of axes; which side of an edge it passes then
// is the sign of a 2D cross product, which the two triangles of an edge compute from the same
// products. Rounding is monotone, so the difference of two rounded products has the right sign or
// is zero, and where it is zero the products' rounding errors decide: the test is exact for the
// sheared corners. A ray right through an edge hits both its triangles. Which way a triangle turns
// does not matter, so neither does the handedness of the permuted axes.
#ifndef AGLOW_SHARED_TRIANGLE_H
#define AGLOW_SHARED_TRIANGLE_H
#include "aglow/shared/ray.h"
AG_NAMESPACE_BEGIN

// A ray made ready for many triangles.
struct ShearedRay {
    vec3 origin;
    vec3 shear;  // of the permuted axes
    uint axis;   // the largest component of the direction: 0, 1 or 2
};

struct TriangleHit {
    uint hit;  // 1 where the ray meets the triangle
    float t;
    vec2 barycentrics;
};

// The components x y z of v in the cyclic order that makes `axis` the last one.
AG_FN vec3 permuted(vec3 v, uint axis) {
    vec3 r;
    r.x = axis == 0u ? v.y : axis == 1u ? v.z : v.x;
    r.y = axis == 0u ? v.z : axis == 1u ? v.x : v.y;
    r.z = axis == 0u ? v.x : axis == 1u ? v.y : v.z;
    return r;
}

// Coordinates beyond this, m, are taken for damage: the test below would overflow on them.
AG_CONST float kFarthestCorner = 1e12f;

AG_FN bool is_usable_corner(vec3 p) {
    return abs(p.x) <= kFarthestCorner && abs(p.y) <= kFarthestCorner &&
           abs(p.z) <= kFarthestCorner;  // false for what is not a number
}

// Whether a ray can hit the triangle at all. Structures leave out those that none can.
AG_FN bool is_usable_triangle(Triangle t) {
    return is_usable_corner(t.a) && is_usable_corner(t.b) && is_usable_corner(t.c) && t.a != t.b &&
           t.b != t.c && t.c != t.a;
}

AG_FN ShearedRay sheared_ray(vec3 origin, vec3 direction) {
    ShearedRay ray;
    float x = abs(direction.x);
    float y = abs(direction.y);
    float z = abs(direction.z);
    ray.origin = origin;
    ray.axis = x > y ? (x > z ? 0u : 2u) : (y > z ? 1u : 2u);
    vec3 d = permuted(direction, ray.axis);
    ray.shear.x = d.x / d.z;
    ray.shear.y = d.y / d.z;
    ray.shear.z = 1.0f / d.z;
    return ray;
}

// a * b - product, where product is a * b rounded. Source: Dekker, "A Floating-Point Technique for
// Extending the Available Precision", Numerische Mathematik 18, 1971.
AG_FN float product_error(float a, float b, float product) {
    AG_PRECISE float split_a = 4097.0f * a;
    AG_PRECISE float split_b = 4097.0f * b;
    AG_PRECISE float high_a = split_a - (split_a - a);
    AG_PRECISE float high_b = split_b - (split_b - b);
    AG_PRECISE float low_a = a - high_a;
    AG_PRECISE float low_b = b - high_b;
    AG_PRECISE float rest = high_a * high_b - product;
    AG_PRECISE float error = ((rest + high_a * low_b) + low_a * high_b) + low_a * low_b;
    return error;
}

// px * qy - py * qx, not zero unless it is.
AG_FN float exact_cross(float px, float py, float qx, float qy) {
    AG_PRECISE float left = px * qy;
    AG_PRECISE float right = py * qx;
    float rounded = left - right;
    return rounded != 0.0f ? rounded : product_error(px, qy, left) - product_error(py, qx, right);
}

// Where the ray meets the plane of a triangle whose corners are permuted and seen from its origin;
// `interpolated` is the same from the corners' depths.
//
// Interpolating errs by the rounding of a needle's area over that area, which puts hits of rays
// that start near its middle before or behind them; the plane errs by the rounding of one product,
// if its normal comes from the two shorter edges, whose products do not cancel, and its distance
// from the nearest corner. Where the needle is so thin that the rounding of its corners turns the
// plane, or the ray runs along a triangle that is none, depths are the better answer. No answer
// leaves the triangle.
AG_FN float plane_distance(ShearedRay ray, vec3 a, vec3 b, vec3 c, float interpolated) {
    vec3 ab = b - a;
    vec3 bc = c - b;
    vec3 ca = a - c;
    float ab2 = dot(ab, ab);
    float bc2 = dot(bc, bc);
    float ca2 = dot(ca, ca);
    vec3 first = ab;
    vec3 second = bc;
    if (ab2 > bc2 && ab2 >= ca2) {
        first = bc;
        second = ca;
    } else if (bc2 > ca2) {
        first = ca;
        second = ab;
    }
    vec3 nearest = dot(b, b) < dot(a, a) ? b : a;
    nearest = dot(c, c) < dot(nearest, nearest) ? c : nearest;
    vec3 normal = cross(first, second);
    float longest = max(ab2, max(bc2, ca2));
    float thinnest = 3.7252903e-9f * (dot(a, a) + longest);  // (2^-14 of the distance)^2
    float squared = dot(normal, normal);
    float across = normal.x * ray.shear.x + normal.y * ray.shear.y + normal.z;
    bool along = across * across < 0.00390625f * squared;   // 2^-8: within 4 degrees or so
    bool narrow = squared < 0.015625f * longest * longest;  // less than an eighth as high as long
    if ((along && !narrow) || across == 0.0f || !(squared > longest * thinnest))
        return interpolated;
    float depth = dot(normal, nearest) / across;
    float low = min(a.z, min(b.z, c.z));
    float high = max(a.z, max(b.z, c.z));
    if (depth < low) depth = low;  // clamp() would make a number of what is none
    if (depth > high) depth = high;
    return depth * ray.shear.z;
}

// Both sides of a triangle are hit; one that the ray sees edge-on, or with a corner that is not
// finite, is not.
AG_FN TriangleHit intersect_triangle(ShearedRay ray, Triangle triangle, float near, float far) {
    vec3 a = permuted(triangle.a - ray.origin, ray.axis);
    vec3 b = permuted(triangle.b - ray.origin, ray.axis);
    vec3 c = permuted(triangle.c - ray.origin, ray.axis);
    AG_PRECISE float ax = a.x - ray.shear.x * a.z;
    AG_PRECISE float ay = a.y - ray.shear.y * a.z;
    AG_PRECISE float bx = b.x - ray.shear.x * b.z;
    AG_PRECISE float by = b.y - ray.shear.y * b.z;
    AG_PRECISE float cx = c.x - ray.shear.x * c.z;
    AG_PRECISE float cy = c.y - ray.shear.y * c.z;
    AG_PRECISE float u = cx * by - cy * bx;
    AG_PRECISE float v = ax * cy - ay * cx;
    AG_PRECISE float w = bx * ay - by * ax;
    if (u == 0.0f || v == 0.0f || w == 0.0f) {  // rare
        u = exact_cross(cx, cy, bx, by);
        v = exact_cross(ax, ay, cx, cy);
        w = exact_cross(bx, by, ax, ay);
    }

    TriangleHit result;
    result.hit = 0u;
    result.t = far;
    result.barycentrics.x = 0.0f;
    result.barycentrics.y = 0.0f;
    if ((u < 0.0f || v < 0.0f || w < 0.0f) && (u > 0.0f || v > 0.0f || w > 0.0f)) return result;
    float determinant = u + v + w;
    if (determinant == 0.0f) return result;
    float scale = 1.0f / determinant;
    float depth = (u * a.z + v * b.z + w * c.z) * scale;
    float t = plane_distance(ray, a, b, c, depth * ray.shear.z);
    if (!(t > near && t < far)) return result;
    result.hit = 1u;
    result.t = t;
    result.barycentrics.x = v * scale;
    result.barycentrics.y = w * scale;
    return result;
}

AG_NAMESPACE_END
#endif
