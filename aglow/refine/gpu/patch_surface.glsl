// SPDX-License-Identifier: Apache-2.0
// A vertex of a pattern on the patch of a face: for compute and vertex shaders alike. Faces that
// meet compute the vertices of their edge from the same numbers in the same order of operations, so
// that they agree bitwise within one shader.
//
// Who includes it declares two uints, best as constant_ids: kPatchDisplacement, a k...Displacement,
// what the mesh is displaced by; and kPatchCorners, 3 or 4 where all faces have so many, else 0.
#include "aglow/shared/device_patch.h"
#include "aglow/shared/pn_quad.h"

struct SurfaceVertex {
    vec3 position;
    vec3 normal;
    vec2 coordinates;  // Pattern::coordinates
};

// Of patch_vertex() where all edges have the segments of the pattern.
PatchLevels uniform_levels() {
    PatchLevels levels;
    for (int i = 0; i < 4; ++i) levels.edge[i] = 0.0f;
    levels.inner = 1.0f;
    levels.continuous = kUniformLevels;
    return levels;
}

// Control points are read where they lie: arrays of a shader's own, indexed by what only the
// invocation knows, are slow.
PatchPoints triangle_points(PatchMesh mesh, uint index) {
    PatchPoints c;
    for (int i = 0; i < 10; ++i) c.p[i] = mesh.patches.at[index].p[i];
    return c;
}

QuadPoints quad_points(PatchMesh mesh, uint index) {
    QuadPoints c;
    for (int i = 0; i < 12; ++i) c.p[i] = mesh.patches.at[index].p[i];
    return c;
}

vec3 inner_position(PatchMesh mesh, uint index, uint corners, vec2 at) {
    if (corners == 3u)
        return patch_position(triangle_points(mesh, index), 1.0f - at.x - at.y, at.x, at.y);
    return quad_position(quad_points(mesh, index), at.x, at.y);
}

// Of a face with these vectors at its corners and edges; a triangle has the first six of them.
vec3 normal_within(QuadNormals c, uint corners, vec2 at) {
    if (corners != 3u) return quad_normal(c, at.x, at.y);
    PatchNormals triangle;
    for (int i = 0; i < 6; ++i) triangle.n[i] = c.n[i];
    return patch_normal(triangle, 1.0f - at.x - at.y, at.x, at.y);
}

vec3 inner_normal(PatchMesh mesh, uint index, uint corners, vec2 at) {
    QuadNormals c;
    for (int i = 0; i < 8; ++i) c.n[i] = mesh.patches.at[index].n[i];
    return normal_within(c, corners, at);
}

vec3 inner_direction(PatchMesh mesh, uint index, uint corners, vec2 at) {
    QuadNormals c;
    for (int i = 0; i < 8; ++i) c.n[i] = mesh.patch_directions.at[index].n[i];
    return normal_within(c, corners, at);
}

float height_of_level(PatchMesh mesh, TextureLevels map, vec2 uv, uint level) {
    TexelQuad q = texel_quad(map, uv, level, 1u);
    return mix(mix(mesh.heights.at[q.upper_left], mesh.heights.at[q.upper_right], q.right),
               mix(mesh.heights.at[q.lower_left], mesh.heights.at[q.lower_right], q.right), q.down);
}

// The height map's displacement at uv.
float map_height(PatchMesh mesh, Displacement d, vec2 uv) {
    float level = clamp(d.level, 0.0f, float(d.map.level_count - 1u));
    uint lower = uint(level);
    float rest = level - float(lower);
    float height = height_of_level(mesh, d.map, uv, lower);
    if (rest > 0.0f) height = mix(height, height_of_level(mesh, d.map, uv, lower + 1u), rest);
    return d.amplitude * (height - d.middle);
}

vec2 uv_between(PatchMesh mesh, uint start, uint end, bool reversed, float t) {
    vec2 a = mesh.uvs.at[reversed ? end : start];
    vec2 b = mesh.uvs.at[reversed ? start : end];
    return a * (1.0f - t) + b * t;
}

// The mean of both sides of an edge, that of its lower half-edge first, so that both agree.
float map_height_on_edge(PatchMesh mesh, Displacement d, PatchFace face, uint edge, float t) {
    uint next = edge + 1u == face.corners ? 0u : edge + 1u;
    bool reversed = ((face.reversed >> edge) & 1u) != 0u;
    uint start = face.first + edge;
    uint end = face.first + next;
    uvec2 beyond = mesh.across.at[start];
    bool beyond_first = beyond.y < start;  // half-edge `beyond.y` runs the other way
    uvec2 one = beyond_first ? beyond : uvec2(start, end);
    uvec2 other = beyond_first ? uvec2(start, end) : beyond;
    float height = map_height(mesh, d, uv_between(mesh, one.x, one.y, reversed, t));
    if (beyond.x == start) return height;
    return 0.5f * (height + map_height(mesh, d, uv_between(mesh, other.x, other.y, reversed, t)));
}

vec2 uv_at(PatchMesh mesh, PatchFace face, vec2 at) {
    vec2 a = mesh.uvs.at[face.first];
    vec2 b = mesh.uvs.at[face.first + 1u];
    vec2 c = mesh.uvs.at[face.first + 2u];
    if (face.corners == 3u) return a * (1.0f - at.x - at.y) + b * at.x + c * at.y;
    vec2 d = mesh.uvs.at[face.first + 3u];
    return (a * (1.0f - at.x) + b * at.x) * (1.0f - at.y) + (d * (1.0f - at.x) + c * at.x) * at.y;
}

// On the surface, of a height map: differences over one texel, by the chain rule.
vec3 map_gradient(PatchMesh mesh, Displacement d, PatchFace face, uint index, vec2 at) {
    float texel = exp2(d.level);
    vec2 stride = vec2(0.5f * texel / float(d.map.width), 0.5f * texel / float(d.map.height));
    vec2 uv = uv_at(mesh, face, at);
    float by_u = (map_height(mesh, d, vec2(uv.x + stride.x, uv.y)) -
                  map_height(mesh, d, vec2(uv.x - stride.x, uv.y))) /
                 (2.0f * stride.x);
    float by_v = (map_height(mesh, d, vec2(uv.x, uv.y + stride.y)) -
                  map_height(mesh, d, vec2(uv.x, uv.y - stride.y))) /
                 (2.0f * stride.y);
    vec2 uv_x = uv_at(mesh, face, vec2(1.0f, at.y)) - uv_at(mesh, face, vec2(0.0f, at.y));
    vec2 uv_y = uv_at(mesh, face, vec2(at.x, 1.0f)) - uv_at(mesh, face, vec2(at.x, 0.0f));
    vec3 by_x;
    vec3 by_y;
    if (face.corners == 3u) {
        PatchPoints c = triangle_points(mesh, index);
        by_x = patch_derivative_v(c, 1.0f - at.x - at.y, at.x, at.y);
        by_y = patch_derivative_w(c, 1.0f - at.x - at.y, at.x, at.y);
    } else {
        QuadPoints c = quad_points(mesh, index);
        by_x = quad_derivative_x(c, at.x, at.y);
        by_y = quad_derivative_y(c, at.x, at.y);
    }
    return surface_gradient(by_x, by_y, by_u * uv_x.x + by_v * uv_x.y,
                            by_u * uv_y.x + by_v * uv_y.y);
}

// The map's height at a pattern's point: that of the vertex, of the edge or of the face itself.
float map_height_at(PatchMesh mesh, Displacement d, PatchFace face, PatternPoint point) {
    if (point.edge == kInsidePattern)
        return map_height(mesh, d, uv_at(mesh, face, vec2(point.x, point.y)));
    if (point.t > 0.0f && point.t < 1.0f)
        return map_height_on_edge(mesh, d, face, point.edge, point.t);
    uint next = point.edge + 1u == face.corners ? 0u : point.edge + 1u;
    bool reversed = ((face.reversed >> point.edge) & 1u) != 0u;
    bool at_end = (point.t > 0.0f) != reversed;
    return mesh.vertex_heights.at[face.vertex[at_end ? next : point.edge]];
}

// Moves a vertex by the mesh's displacement.
SurfaceVertex displaced(PatchMesh mesh, PatchFace face, uint index, PatternPoint point,
                        SurfaceVertex vertex, vec3 direction) {
    Displacement d = mesh.displacement.at[0];
    d.kind = kPatchDisplacement;
    Field height = displacement_at(d, vertex.position);
    if (kPatchDisplacement == kHeightMapDisplacement) {
        height.value = map_height_at(mesh, d, face, point);
        height.gradient = map_gradient(mesh, d, face, index, vertex.coordinates);
    }
    vertex.position += direction * height.value;
    vertex.normal = displaced_normal(vertex.normal, height.gradient);
    return vertex;
}

// The two ends of an edge of a face and the edge's own place in its arrays, in the edge's direction.
struct EdgePlaces {
    uint a, b;
    uint first, second;  // control points
    uint middle;         // normal
};

EdgePlaces edge_places(PatchFace face, uint edge) {
    uint next = edge + 1u == face.corners ? 0u : edge + 1u;
    bool reversed = ((face.reversed >> edge) & 1u) != 0u;
    uint points = face.corners + 2u * edge;
    EdgePlaces r;
    r.a = reversed ? next : edge;
    r.b = reversed ? edge : next;
    r.first = reversed ? points + 1u : points;
    r.second = reversed ? points : points + 1u;
    r.middle = face.corners + edge;
    return r;
}

vec3 direction_at(PatchMesh mesh, PatchFace face, uint index, PatternPoint point) {
    if (point.edge == kInsidePattern)
        return inner_direction(mesh, index, face.corners, vec2(point.x, point.y));
    EdgePlaces at = edge_places(face, point.edge);
    return edge_normal(mesh.patch_directions.at[index].n[at.a],
                       mesh.patch_directions.at[index].n[at.middle],
                       mesh.patch_directions.at[index].n[at.b], point.t);
}

SurfaceVertex edge_vertex(PatchMesh mesh, PatchFace face, uint index, PatternPoint point) {
    EdgePlaces at = edge_places(face, point.edge);
    EdgePoints e;
    e.first = mesh.patches.at[index].p[at.first];
    e.second = mesh.patches.at[index].p[at.second];
    SurfaceVertex r;
    r.coordinates = vec2(point.x, point.y);
    r.position = edge_position(mesh.patches.at[index].p[at.a], e, mesh.patches.at[index].p[at.b],
                               point.t);
    r.normal = edge_normal(mesh.patches.at[index].n[at.a], mesh.patches.at[index].n[at.middle],
                           mesh.patches.at[index].n[at.b], point.t);
    return r;
}

// Vertex `steps` (Pattern::steps) of a pattern of `segments` on face `index` of the mesh.
SurfaceVertex patch_vertex(PatchMesh mesh, uint index, uint steps, uint segments,
                           PatchLevels levels) {
    PatchFace face = mesh.faces.at[index];
    if (kPatchCorners != 0u) face.corners = kPatchCorners;
    uint i = steps & 0xffffu;
    uint j = steps >> 16u;
    PatternPoint point;
    if (face.corners == 3u)
        point = triangle_pattern_point(i, j, segments, levels, face.reversed);
    else
        point = quad_pattern_point(i, j, segments, levels, face.reversed);
    SurfaceVertex vertex;
    if (point.edge == kInsidePattern) {
        vertex.coordinates = vec2(point.x, point.y);
        vertex.position = inner_position(mesh, index, face.corners, vertex.coordinates);
        vertex.normal = inner_normal(mesh, index, face.corners, vertex.coordinates);
    } else {
        vertex = edge_vertex(mesh, face, index, point);
    }
    if (kPatchDisplacement == kNoDisplacement) return vertex;
    return displaced(mesh, face, index, point, vertex, direction_at(mesh, face, index, point));
}
