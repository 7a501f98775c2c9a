// SPDX-License-Identifier: Apache-2.0
// A vertex of a pattern on the patch of a face: for compute and vertex shaders alike. Faces that
// meet compute the vertices of their edge from the same numbers in the same order of operations, so
// that they agree bitwise within one shader.
//
// Who includes it declares two uints, best as constant_ids: kPatchDisplacement, a k...Displacement,
// DevicePatches::displacement(); and kPatchCorners, 3 or 4 where all faces have so many, else 0.
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

// The height map's displacement at uv on this mip level.
float map_height(PatchMesh mesh, Displacement d, vec2 uv, float mip) {
    float level = clamp(mip, 0.0f, float(d.map.level_count - 1u));
    uint lower = uint(level);
    float rest = level - float(lower);
    float height = 0.0f;
    for (uint i = 0u; i < 2u; ++i) {
        float share = i == 0u ? 1.0f - rest : rest;
        if (share > 0.0f) height += share * height_of_level(mesh, d.map, uv, lower + i);
    }
    return d.amplitude * (height - d.middle);
}

vec2 uv_between(PatchMesh mesh, uint start, uint end, bool reversed, float t) {
    vec2 a = mesh.uvs.at[reversed ? end : start];
    vec2 b = mesh.uvs.at[reversed ? start : end];
    return a * (1.0f - t) + b * t;
}

// The mean of both sides of an edge, that of its lower half-edge first, so that both agree.
float map_height_on_edge(PatchMesh mesh, Displacement d, PatchFace face, uint edge, float t,
                         float mip) {
    uint next = edge + 1u == face.corners ? 0u : edge + 1u;
    bool reversed = ((face.reversed >> edge) & 1u) != 0u;
    uint start = face.first + edge;
    uint end = face.first + next;
    uvec2 beyond = mesh.across.at[start];
    bool beyond_first = beyond.y < start;  // half-edge `beyond.y` runs the other way
    uvec2 one = beyond_first ? beyond : uvec2(start, end);
    uvec2 other = beyond_first ? uvec2(start, end) : beyond;
    float height = map_height(mesh, d, uv_between(mesh, one.x, one.y, reversed, t), mip);
    if (beyond.x == start) return height;
    return 0.5f *
           (height + map_height(mesh, d, uv_between(mesh, other.x, other.y, reversed, t), mip));
}

vec2 uv_at(PatchMesh mesh, PatchFace face, vec2 at) {
    vec2 a = mesh.uvs.at[face.first];
    vec2 b = mesh.uvs.at[face.first + 1u];
    vec2 c = mesh.uvs.at[face.first + 2u];
    if (face.corners == 3u) return a * (1.0f - at.x - at.y) + b * at.x + c * at.y;
    vec2 d = mesh.uvs.at[face.first + 3u];
    return (a * (1.0f - at.x) + b * at.x) * (1.0f - at.y) + (d * (1.0f - at.x) + c * at.x) * at.y;
}

// Derivatives of a height map's displacement by a face's parameters: differences over one texel,
// by the chain rule. Loops are not unrolled: compilers take seconds for that.
vec2 map_slopes(PatchMesh mesh, Displacement d, PatchFace face, vec2 at, float mip) {
    vec2 stride = 0.5f * exp2(mip) / vec2(float(d.map.width), float(d.map.height));
    vec2 uv = uv_at(mesh, face, at);
    vec2 by_uv = vec2(0.0f);
    for (int i = 0; i < 4; ++i) {
        vec2 side = i < 2 ? vec2(i == 0 ? 1.0f : -1.0f, 0.0f) : vec2(0.0f, i == 2 ? 1.0f : -1.0f);
        by_uv += side * map_height(mesh, d, uv + side * stride, mip);
    }
    by_uv /= 2.0f * stride;
    vec2 uv_x = uv_at(mesh, face, vec2(1.0f, at.y)) - uv_at(mesh, face, vec2(0.0f, at.y));
    vec2 uv_y = uv_at(mesh, face, vec2(at.x, 1.0f)) - uv_at(mesh, face, vec2(at.x, 0.0f));
    return vec2(by_uv.x * uv_x.x + by_uv.y * uv_x.y, by_uv.x * uv_y.x + by_uv.y * uv_y.y);
}

float longest_edge(PatchMesh mesh, TextureLevels map, PatchFace face) {
    vec2 size = vec2(float(map.width), float(map.height));
    float longest = 0.0f;
    for (uint i = 0u; i < face.corners; ++i) {
        uint next = i + 1u == face.corners ? 0u : i + 1u;
        vec2 along = mesh.uvs.at[face.first + next] - mesh.uvs.at[face.first + i];
        longest = max(longest, length(along * size));
    }
    return longest;
}

// The same of a flat face: see slope_share().
vec2 flat_slopes(PatchMesh mesh, Displacement d, PatchFace face, vec2 at, float mip) {
    float share = slope_share(exp2(mip), longest_edge(mesh, d.map, face));
    vec2 slopes = vec2(0.0f);
    for (uint i = 0u; i < face.corners; ++i) {
        vec2 corner = vec2(i == 1u || i == 2u && face.corners == 4u ? 1.0f : 0.0f,
                           i > 1u ? 1.0f : 0.0f);
        float height = map_height(mesh, d, uv_at(mesh, face, slope_corner(at, corner, share)), mip);
        vec2 weight = vec2(i == 0u ? -1.0f : i == 1u ? 1.0f : 0.0f,
                           i == 0u ? -1.0f : i == 2u ? 1.0f : 0.0f);
        if (face.corners == 4u)
            weight = vec2((corner.x * 2.0f - 1.0f) * (corner.y > 0.0f ? at.y : 1.0f - at.y),
                          (corner.y * 2.0f - 1.0f) * (corner.x > 0.0f ? at.x : 1.0f - at.x));
        slopes += weight * height;
    }
    return slopes / share;
}

// The map's height at a pattern's point: that of the vertex, of the edge or of the face itself.
float map_height_at(PatchMesh mesh, Displacement d, PatchFace face, PatternPoint point,
                    PatchMips mips) {
    if (point.edge == kInsidePattern)
        return map_height(mesh, d, uv_at(mesh, face, vec2(point.x, point.y)), mips.inner);
    if (point.t > 0.0f && point.t < 1.0f)
        return map_height_on_edge(mesh, d, face, point.edge, point.t, mips.edge[point.edge]);
    uint next = point.edge + 1u == face.corners ? 0u : point.edge + 1u;
    bool reversed = ((face.reversed >> point.edge) & 1u) != 0u;
    bool at_end = (point.t > 0.0f) != reversed;
    return mesh.vertex_heights.at[face.vertex[at_end ? next : point.edge]];
}

// The direction of displacement over a flat face: that of its corners, interpolated.
UnitField corner_directions(PatchMesh mesh, uint index, uint corners, vec2 at) {
    vec3 a = mesh.patch_directions.at[index].n[0];
    vec3 b = mesh.patch_directions.at[index].n[1];
    vec3 c = mesh.patch_directions.at[index].n[2];
    if (corners == 3u)
        return unit_field(a * (1.0f - at.x - at.y) + b * at.x + c * at.y, b - a, c - a);
    vec3 d = mesh.patch_directions.at[index].n[3];
    vec3 low = a * (1.0f - at.x) + b * at.x;
    vec3 high = d * (1.0f - at.x) + c * at.x;
    return unit_field(low * (1.0f - at.y) + high * at.y, (b - a) * (1.0f - at.y) + (c - d) * at.y,
                      high - low);
}

// The normal of a flat face where it is raised to this height.
vec3 raised_flat_normal(PatchMesh mesh, uint index, PatchFace face, vec2 at, float height) {
    Displacement d = mesh.kinds.at[face.kind].displacement;
    vec2 slopes = flat_slopes(mesh, d, face, at, mesh.mips.at[index].inner);
    vec3 a = mesh.patches.at[index].p[0];
    vec3 by_x = mesh.patches.at[index].p[1] - a;
    vec3 by_y = mesh.patches.at[index].p[2] - a;
    if (face.corners == 4u) {
        vec3 left = mesh.patches.at[index].p[3] - a;
        vec3 top = by_y - left;
        by_y = left * (1.0f - at.x) + (by_y - by_x) * at.x;
        by_x = by_x * (1.0f - at.y) + top * at.y;
    }
    return raised_normal(by_x, by_y, corner_directions(mesh, index, face.corners, at), height,
                         slopes.x, slopes.y, mesh.patches.at[index].n[0]);
}

vec2 corner_place(uint corner, uint corners) {
    bool right = corner == 1u || (corner == 2u && corners == 4u);
    return vec2(right ? 1.0f : 0.0f, corner > 1u ? 1.0f : 0.0f);
}

// Do two faces that meet at corners have one normal there?
bool same_normal(PatchMesh mesh, uint face, uint corner, uint other, uint other_corner) {
    return dot(mesh.patches.at[face].n[corner], mesh.patches.at[other].n[other_corner]) > 0.9999f;
}

// The normal of a flat face at a pattern's point: on edges the mean of both sides', at corners that
// of all round them, but for creases. Texels reach over edges and hide how the slopes differ there.
vec3 smooth_flat_normal(PatchMesh mesh, uint index, PatchFace face, PatternPoint point,
                        float height) {
    vec3 normal =
        raised_flat_normal(mesh, index, face, vec2(point.x, point.y), height);
    if (point.edge == kInsidePattern) return normal;
    uint next = point.edge + 1u == face.corners ? 0u : point.edge + 1u;
    bool reversed = ((face.reversed >> point.edge) & 1u) != 0u;
    if (!(point.t > 0.0f && point.t < 1.0f)) {
        bool at_end = (point.t > 0.0f) != reversed;
        return mesh.raised_normals.at[face.first + (at_end ? next : point.edge)];
    }
    uvec2 beyond = mesh.across.at[face.first + point.edge];
    uint other = mesh.face_of.at[beyond.x];
    if (other == index) return normal;
    PatchFace there = mesh.faces.at[other];
    uvec2 corner = beyond - there.first;
    if (!same_normal(mesh, index, point.edge, other, corner.x) ||
        !same_normal(mesh, index, next, other, corner.y))
        return normal;
    vec2 at = mix(corner_place(corner.x, there.corners), corner_place(corner.y, there.corners),
                  reversed ? 1.0f - point.t : point.t);
    return normalize(normal + raised_flat_normal(mesh, other, there, at, height));
}

// Moves a vertex by a height map. Normals of flat faces follow from where they go; those of curved
// ones, which are smoother than the surface that they stand on, are tilted.
SurfaceVertex raised(PatchMesh mesh, PatchFace face, uint index, PatternPoint point,
                     SurfaceVertex vertex, vec3 direction, PatchKind kind) {
    PatchMips mips = mesh.mips.at[index];
    vec2 at = vertex.coordinates;
    float height = map_height_at(mesh, kind.displacement, face, point, mips);
    vertex.position += direction * height;
    if (kind.shape == kFlatPatch) {
        vertex.normal = smooth_flat_normal(mesh, index, face, point, height);
        return vertex;
    }
    vec2 slopes = map_slopes(mesh, kind.displacement, face, at, mips.inner);
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
    vertex.normal =
        displaced_normal(vertex.normal, surface_gradient(by_x, by_y, slopes.x, slopes.y));
    return vertex;
}

// Moves a vertex by the displacement of its face.
SurfaceVertex displaced(PatchMesh mesh, PatchFace face, uint index, PatternPoint point,
                        SurfaceVertex vertex, vec3 direction) {
    PatchKind kind = mesh.kinds.at[face.kind];
    if (kPatchDisplacement != kMixedDisplacement) kind.displacement.kind = kPatchDisplacement;
    if (kind.displacement.kind == kNoDisplacement) return vertex;
    if (kind.displacement.kind == kHeightMapDisplacement)
        return raised(mesh, face, index, point, vertex, direction, kind);
    Field height = displacement_at(kind.displacement, vertex.position);
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
