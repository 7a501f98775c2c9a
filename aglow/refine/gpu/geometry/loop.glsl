// SPDX-License-Identifier: Apache-2.0
// Loop subdivision of a triangle, factored: every edge is halved (linear), every vertex becomes a
// mean of its new neighbours (average), and is moved on by a factor of its valence (correct). Two
// levels are unrolled. Forms differ in neighbour(), which they define behind this file's inputs.
// Source  Warren & Schaefer, "A Factored Approach to Subdivision Surfaces", IEEE CG&A 2004;
//         Concheiro et al., "Synthesis of Multiresolution Scenes with Global Illumination on a
//         GPU", GRAPP 2010.
#include "aglow/refine/gpu/geometry/vertex.glsl"

layout(constant_id = 0) const uint kLevels = 2u;  // 1 or 2
layout(triangle_strip, max_vertices = 48) out;
layout(location = 0) in uvec3 fan[];  // first, count, kind
layout(location = 1) in float correction[];
layout(location = 0, xfb_buffer = 0, xfb_stride = 12, xfb_offset = 0) out vec3 point;

vec3 corner_point(uint corner) { return gl_in[corner * kInputStep].gl_Position.xyz; }
uint valence(uint corner) { return fan[corner * kInputStep].y; }
uint kind(uint corner) { return fan[corner * kInputStep].z; }
bool is_open(uint corner) { return (kind(corner) & 1u) == 1u; }

// Which of a corner's neighbours is the next corner; the one after that is the third.
uint start_of(uint corner) {
    return args.starts.at[3u * (args.first_primitive + gl_PrimitiveIDIn) + corner];
}

vec3 stored_neighbour(uint corner, uint k) {
    return args.points.at[args.fans.at[fan[corner * kInputStep].x + k]];
}

vec3 neighbour(uint corner, uint start, uint k);

vec3 middle(vec3 a, vec3 b) { return 0.5f * (a + b); }

// The new vertex on an edge a-b between the opposite vertices c and d: it has six neighbours.
vec3 edge_point(vec3 a, vec3 b, vec3 c, vec3 d) {
    vec3 around = a + b + middle(a, c) + middle(a, d) + middle(b, c) + middle(b, d);
    return 0.25f * middle(a, b) + 0.125f * around;
}

// A vertex after averaging the sum of the middles of its edges, of a boundary of its two edges on
// it, and correcting.
vec3 vertex_point(uint corner, vec3 v, vec3 middles) {
    if ((kind(corner) & kLoopCorner) != 0u) return v;
    if (is_open(corner)) return 0.5f * v + 0.25f * middles;
    vec3 averaged = 0.25f * v + 0.75f / float(valence(corner)) * middles;
    return v + correction[corner * kInputStep] * (averaged - v);
}

struct Corner {
    vec3 once, twice;    // after one level and after two
    vec3 edge;           // after one level: the vertex on the edge to the next corner
    vec3 before, after;  // likewise on the edges that follow outside of the triangle
    bool edge_open;      // the edge to the next corner is on a boundary
};

// Turns round a corner once.
Corner refined_corner(uint i) {
    uint n = valence(i), start = start_of(i);
    bool open = is_open(i);
    vec3 v = corner_point(i), first = neighbour(i, start, 0u);
    vec3 previous = neighbour(i, start, n - 1u), here = first;
    vec3 middles = vec3(0.0f), spokes = vec3(0.0f);
    Corner corner;
    corner.edge = corner.before = corner.after = vec3(0.0f);
    for (uint k = 0u; k < n; ++k) {
        vec3 next = first;
        if (k + 1u < n) next = neighbour(i, start, k + 1u);
        bool outer = open && (k == 0u || k + 1u == n);
        vec3 spoke = outer ? middle(v, here) : edge_point(v, here, previous, next);
        if (outer || !open) {
            middles += middle(v, here);
            spokes += spoke;
        }
        if (k == start) corner.edge = spoke;
        if (k + 1u == start || k + 1u == start + n) corner.before = spoke;
        if (k == start + 2u || k + n == start + 2u) corner.after = spoke;
        previous = here;
        here = next;
    }
    corner.once = vertex_point(i, v, middles);
    float count = open ? 2.0f : float(n);
    corner.twice = vertex_point(i, corner.once, 0.5f * (count * corner.once + spokes));
    corner.edge_open = open && start == 0u;
    return corner;
}

void emit(vec3 p) {
    point = p;
    gl_Position = vec4(p, 1.0f);
    EmitVertex();
}

void emit_triangle(vec3 a, vec3 b, vec3 c) {
    emit(a);
    emit(b);
    emit(c);
    EndPrimitive();
}

// A triangle in four, in the order of refine::split(): those of its corners, then the middle.
void emit_four(vec3 a, vec3 b, vec3 c, vec3 ab, vec3 bc, vec3 ca) {
    emit_triangle(a, ab, ca);
    emit_triangle(b, bc, ab);
    emit_triangle(c, ca, bc);
    emit_triangle(ab, bc, ca);
}

// Of the vertices of the second level on the edge from corner a to corner b.
struct Edge {
    vec3 first, middle, second;  // first: in the half next to a
};

Edge refined_edge(Corner a, Corner b, Corner c) {
    Edge edge;
    edge.first = middle(a.once, a.edge);
    edge.second = middle(a.edge, b.once);
    edge.middle = 0.5f * (a.edge + middle(edge.first, edge.second));
    if (a.edge_open) return edge;
    vec3 around = edge.first + edge.second + middle(a.edge, b.edge) + middle(a.edge, c.edge) +
                  middle(a.edge, a.before) + middle(a.edge, b.after);
    edge.middle = 0.25f * a.edge + 0.125f * around;
    edge.first = edge_point(a.once, a.edge, c.edge, a.before);
    edge.second = edge_point(a.edge, b.once, b.edge, b.after);
    return edge;
}

void refine_triangle() {
    Corner a = refined_corner(0u), b = refined_corner(1u), c = refined_corner(2u);
    if (kLevels == 1u) {
        emit_four(a.once, b.once, c.once, a.edge, b.edge, c.edge);
        return;
    }
    Edge ab = refined_edge(a, b, c), bc = refined_edge(b, c, a), ca = refined_edge(c, a, b);
    vec3 at_a = edge_point(a.edge, c.edge, a.once, b.edge);
    vec3 at_b = edge_point(b.edge, a.edge, b.once, c.edge);
    vec3 at_c = edge_point(c.edge, b.edge, c.once, a.edge);
    emit_four(a.twice, ab.middle, ca.middle, ab.first, at_a, ca.second);
    emit_four(b.twice, bc.middle, ab.middle, bc.first, at_b, ab.second);
    emit_four(c.twice, ca.middle, bc.middle, ca.first, at_c, bc.second);
    emit_four(ab.middle, bc.middle, ca.middle, at_b, at_c, at_a);
}
