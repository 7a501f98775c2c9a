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

vec3 position0 = vec3(0.0f), u0 = vec3(0.0f), v0 = vec3(0.0f);
vec3 position1 = vec3(0.0f), u1 = vec3(0.0f), v1 = vec3(0.0f);

void add_row(uint weight, uint ring) {
    vec3 a = ring_rows[ring].xyz, b = ring_rows[ring + 1u].xyz;
    float u = args.u_weights.at[weight], v = args.v_weights.at[weight];
    u0 += u * a;
    v0 += v * a;
    u1 += u * b;
    v1 += v * b;
    if (kPositions == 1u) {
        float w = args.position_weights.at[weight];
        position0 += w * a;
        position1 += w * b;
    }
}

void store_face(SubdivideTile tile, uint face, ColumnPlace place, vec3 position, vec3 u, vec3 v) {
    uint vertex = vertex_of(tile, face, place);
    if (vertex == kNotOwned) return;
    vec3 normal = cross(u, v);
    float size = sqrt(dot(normal, normal));
    args.normals.at[vertex] = size > 0.0f ? normal / size : vec3(0.0f);
    if (kPositions == 0u) return;
    vec3 origin = args.from.at[args.ring.at[tile.ring + face * tile.ring_size]];
    args.positions.at[vertex] = origin + position;
}

void main() {
    SubdivideTile tile = args.tiles.at[group_index() / args.blocks];
    uint column = group_index() % args.blocks * kColumnLanes + column_lane();
    uint weight = tile.weights + min(column, args.stride - 1u);
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
    ColumnPlace place = column_place(column);
    store_face(tile, first_face(), place, position0, u0, v0);
    store_face(tile, first_face() + 1u, place, position1, u1, v1);
}
