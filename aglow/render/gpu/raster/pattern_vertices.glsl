// SPDX-License-Identifier: Apache-2.0
// A vertex shader that draws a pattern as one instance for each face. Who includes it says where
// vertices are: drawn_pattern() and face_vertex().
invariant gl_Position;  // faces of several materials meet
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 barycentrics;  // on the face
layout(location = 3) flat out uint face;

void main() {
    RasterPattern pattern = drawn_pattern();
    face = face_at(uint(gl_InstanceIndex));
    position = normal = vec3(0.0f);
    barycentrics = vec2(0.0f);
    gl_Position = vec4(0.0f, 0.0f, -1.0f, 1.0f);  // clipped: a face without area has no patch
    uint patch_index = pattern.patch_of.at[face];
    if (patch_index == kNoTriangle) return;
    SurfaceVertex vertex = face_vertex(pattern, patch_index, pattern.steps.at[gl_VertexIndex]);
    position = vertex.position;
    normal = vertex.normal;
    barycentrics = vertex.coordinates;
    gl_Position = clip_position(position);
}
