// SPDX-License-Identifier: Apache-2.0
// The fraction of the light that leaves a small surface element and lands on a polygon with nothing
// in between; equally, the irradiance that a polygon of uniform luminance L gives the element is
// pi L F. Dimensionless, 0 <= F <= 1.
//
// Source: Baum, Rushmeier & Winget, "Improving Radiosity Solutions Through the Use of Analytically
// Determined Form-Factors", SIGGRAPH 1989; the boundary sum is Lambert's, 1760.
#ifndef AGLOW_SHARED_FORM_FACTOR_H
#define AGLOW_SHARED_FORM_FACTOR_H
#include "aglow/shared/triangle.h"
AG_NAMESPACE_BEGIN

// What one edge adds to the boundary sum, radians: `n` is the unit normal of the element, `a` and
// `b` are the ends of the edge relative to it. An edge whose line passes through the element has no
// direction to turn in and adds 0.
AG_FN float form_factor_edge(vec3 n, vec3 a, vec3 b) {
    vec3 axis = cross(a, b);
    float sine = length(axis);
    float theta = atan(sine, dot(a, b));  // stable near 0 and pi, where acos is not
    return sine > 0.0f ? theta * dot(n, axis) / sine : 0.0f;
}

// Where the segment between p and q, which lie on different sides of the plane, meets it.
AG_FN vec3 horizon_crossing(vec3 n, vec3 p, vec3 q) {
    float height = dot(n, p);
    return p + (q - p) * (height / (height - dot(n, q)));
}

// Of a triangle, seen from `p` on a plane with unit normal n; only the part above that plane
// counts. Positive where the triangle turns its front (counter-clockwise) to p, negative where its
// back.
AG_FN float signed_form_factor(vec3 p, vec3 n, Triangle triangle) {
    vec3 corner[3];
    corner[0] = triangle.a - p;
    corner[1] = triangle.b - p;
    corner[2] = triangle.c - p;
    vec3 leave = corner[0];  // the outline dips below the horizon here ...
    vec3 enter = corner[0];  // ... and comes back up here
    float boundary = 0.0f;
    for (int i = 0; i < 3; ++i) {
        vec3 a = corner[i];
        vec3 b = corner[(i + 1) % 3];
        bool a_below = dot(n, a) < 0.0f;
        bool b_below = dot(n, b) < 0.0f;
        if (a_below && b_below) continue;
        if (a_below) {
            enter = horizon_crossing(n, a, b);
            a = enter;
        }
        if (b_below) {
            leave = horizon_crossing(n, a, b);
            b = leave;
        }
        boundary = boundary + form_factor_edge(n, a, b);
    }
    boundary = boundary + form_factor_edge(n, leave, enter);  // along the horizon; 0 if never cut
    return boundary * -0.159154943f;
}

AG_NAMESPACE_END
#endif
