// SPDX-License-Identifier: Apache-2.0
// Vertices of a subdivided surface, drawn as one instance for each face: its refined points lie in
// memory, each once, so that faces meet exactly.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/render/gpu/raster/raster.glsl"
#include "aglow/shared/raster_subdivision.h"

invariant gl_Position;  // faces of several materials meet
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 barycentrics;  // on the face
layout(location = 3) flat out uint face;

uint point_at(RasterSubdividedFacePtr faces, uint place, uint edge_points) {
    uint at = place & ((1u << kPlaceBits) - 1u);
    uint step = place >> kPlaceBits;
    bool reversed = ((faces.at[face].reversed >> at) & 1u) != 0u;
    return faces.at[face].first[at] + (reversed ? edge_points - 1u - step : step);
}

void main() {
    RasterSubdivision surface = RasterSubdivisionPtr(args.geometry).at[0];
    face = face_at(uint(gl_InstanceIndex));
    position = normal = vec3(0.0f);
    barycentrics = vec2(0.0f);
    gl_Position = vec4(0.0f, 0.0f, -1.0f, 1.0f);  // clipped: a face without area is not refined
    if (surface.faces.at[face].first[0] == kNoTriangle) return;
    uint place = surface.places.at[gl_VertexIndex];
    position = surface.positions.at[point_at(surface.faces, place, surface.edge_points)];
    normal = surface.normals.at[point_at(surface.normal_faces, place, surface.edge_points)];
    barycentrics = surface.barycentrics.at[gl_VertexIndex];
    gl_Position = clip_position(position);
}
