// SPDX-License-Identifier: Apache-2.0
// The same by the groups of a mesh shader, which share a pattern as pattern_groups() says.
#include "aglow/shared/pattern_group.h"

layout(local_size_x = kPatternGroup) in;
layout(triangles, max_vertices = kGroupVertices, max_primitives = kGroupTriangles) out;
out gl_MeshPerVertexEXT { invariant vec4 gl_Position; } gl_MeshVerticesEXT[];
layout(location = 0) out vec3 position[];
layout(location = 1) out vec3 normal[];
layout(location = 2) out vec2 barycentrics[];
layout(location = 3) flat out uint face[];

// Steps of a tile's point in the pattern of its face.
uint point_steps(RasterPattern pattern, PatternGroups groups, uint tile, uint point) {
    uvec3 corners = pattern.triangles.at[tile % (groups.sides * groups.sides)];
    return tile_steps(pattern.steps.at[corners.x], pattern.steps.at[corners.y],
                      pattern.steps.at[corners.z], pattern.steps.at[point], groups.segments);
}

void put_vertex(PatternGroups groups, uint tile, uint point, uint to) {
    RasterPattern pattern = drawn_pattern();
    uint its_face = face_at(args.first_face + tile / (groups.sides * groups.sides));
    uint patch_index = pattern.patch_of.at[its_face];
    face[to] = its_face;
    if (patch_index != kNoTriangle) {
        SurfaceVertex vertex =
            face_vertex(pattern, patch_index, point_steps(pattern, groups, tile, point));
        position[to] = vertex.position;
        normal[to] = vertex.normal;
        barycentrics[to] = vertex.coordinates;
        gl_MeshVerticesEXT[to].gl_Position = clip_position(vertex.position);
    } else {
        position[to] = normal[to] = vec3(0.0f);
        barycentrics[to] = vec2(0.0f);
        gl_MeshVerticesEXT[to].gl_Position = vec4(0.0f, 0.0f, -1.0f, 1.0f);  // clipped
    }
}

void main() {
    RasterPattern pattern = drawn_pattern();
    PatternGroups groups = pattern_groups(args.segments);
    uint points = (groups.segments + 1u) * (groups.segments + 2u) / 2u;
    uint triangles = groups.segments * groups.segments;
    uint first = (args.first_group + gl_WorkGroupID.x) * groups.tiles;
    uint count = min(groups.tiles, args.face_count * groups.sides * groups.sides - first);
    SetMeshOutputsEXT(count * points, count * triangles);
    for (uint v = gl_LocalInvocationIndex; v < count * points; v += kPatternGroup)
        put_vertex(groups, first + v / points, v % points, v);
    for (uint t = gl_LocalInvocationIndex; t < count * triangles; t += kPatternGroup)
        gl_PrimitiveTriangleIndicesEXT[t] =
            pattern.triangles.at[t % triangles] + t / triangles * points;
}
