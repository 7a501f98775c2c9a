// SPDX-License-Identifier: Apache-2.0
// Vertices of triangles that lie in memory.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/render/gpu/raster/raster.glsl"

invariant gl_Position;  // faces of several materials meet
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 barycentrics;  // on the face
layout(location = 3) flat out uint face;

void main() {
    RasterGeometryPtr geometry = args.geometry;
    uint corner = uint(gl_VertexIndex) % 3u;
    face = face_at(uint(gl_VertexIndex) / 3u);
    uvec3 triangle = geometry.at[0].triangles.at[face];
    uint vertex = corner == 0u ? triangle.x : corner == 1u ? triangle.y : triangle.z;
    position = geometry.at[0].positions.at[vertex];
    normal = geometry.at[0].normals.at[vertex];
    barycentrics = vec2(corner == 1u ? 1.0f : 0.0f, corner == 2u ? 1.0f : 0.0f);
    gl_Position = clip_position(position);
}
