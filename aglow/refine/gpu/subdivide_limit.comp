// SPDX-License-Identifier: Apache-2.0
// Limit points and unit normals of the refined points of faces of one class: their class's three
// tables times their rings.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/subdivision.h"

layout(constant_id = 3) const uint kPositions = 1u;  // 0: normals alone
layout(push_constant, scalar) uniform Push { SubdivideLimitArgs args; };

const uint kFacesPerLane = 2u;

// Points as seen from the first of their ring: differences of these lose fewer digits.
vec3 load_point(uint ring, uint row) {
    return args.from.at[args.ring.at[ring + row]] - args.from.at[args.ring.at[ring]];
}

#include "aglow/refine/gpu/subdivide.glsl"

// [column * kFacesPerLane + face]
vec3 positions[kColumnsPerLane * kFacesPerLane];
vec3 us[kColumnsPerLane * kFacesPerLane], vs[kColumnsPerLane * kFacesPerLane];

void add_row(uint weight, uint ring) {
    vec3 points[kFacesPerLane];
    for (uint f = 0u; f < kFacesPerLane; ++f) points[f] = ring_rows[ring + f].xyz;
    for (uint c = 0u; c < kColumnsPerLane; ++c) {
        uint place = weight + c * kColumnLanes;
        float u = args.u_weights.at[place], v = args.v_weights.at[place];
        float w = kPositions == 1u ? args.position_weights.at[place] : 0.0f;
        for (uint f = 0u; f < kFacesPerLane; ++f) {
            uint i = c * kFacesPerLane + f;
            us[i] += u * points[f];
            vs[i] += v * points[f];
            if (kPositions == 1u) positions[i] += w * points[f];
        }
    }
}

void store_face(SubdivideTile tile, uint face, ColumnPlace place, vec3 position, vec3 u, vec3 v) {
    uint vertex = vertex_of(tile, face, place);
    if (vertex == kNotOwned) return;
    vec3 normal = cross(u, v);
    float size = sqrt(dot(normal, normal));
    args.normals.at[vertex] = size > 0.0f ? normal / size : vec3(0.0f);
    if (kPositions == 0u) return;
    vec3 origin = args.from.at[args.ring.at[tile.ring + face * tile.rows]];
    args.positions.at[vertex] = origin + position;
}

void main() {
    SubdivideTile tile = args.tiles.at[group_index() / args.blocks];
    uint weight = tile.weights + first_column();
    for (uint i = 0u; i < kColumnsPerLane * kFacesPerLane; ++i)
        positions[i] = us[i] = vs[i] = vec3(0.0f);
    for (uint first = 0u; first < tile.rows; first += kSubdivideRows) {
        if (first > 0u) barrier();
        load_rings(tile, first);
        barrier();
        uint ring = first_face();
        for (uint row = first; row < min(first + kSubdivideRows, tile.rows); ++row) {
            add_row(weight, ring);
            weight += args.stride;
            ring += kTileFaces;
        }
    }
    for (uint c = 0u; c < kColumnsPerLane; ++c) {
        ColumnPlace place = column_place(first_column() + c * kColumnLanes);
        for (uint f = 0u; f < kFacesPerLane; ++f) {
            uint i = c * kFacesPerLane + f;
            store_face(tile, first_face() + f, place, positions[i], us[i], vs[i]);
        }
    }
}
