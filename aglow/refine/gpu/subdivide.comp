// SPDX-License-Identifier: Apache-2.0
// Refined points of faces of one class: their class's table times their rings. Every invocation makes
// some columns for some faces: what is read of the table serves all these faces, what is read of
// the rings all these columns.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/shared/subdivision.h"

layout(constant_id = 3) const uint kVec3 = 1u;  // 0: points have args.from_width numbers
layout(push_constant, scalar) uniform Push { SubdivideArgs args; };

const uint kFacesPerLane = 4u;

vec3 load_point(uint ring, uint row) {
    uint vertex = args.ring.at[ring + row];
    if (kVec3 == 1u) return vec3Ptr(args.from).at[vertex];
    uint first = vertex * args.from_width + args.from_channel;
    vec3 point = vec3(args.from.at[first], 0.0f, 0.0f);
    if (args.channels > 1u) point.y = args.from.at[first + 1u];
    if (args.channels > 2u) point.z = args.from.at[first + 2u];
    return point;
}

#include "aglow/refine/gpu/subdivide.glsl"

void store_point(uint vertex, vec3 point) {
    if (kVec3 == 1u) {
        vec3Ptr(args.to).at[vertex] = point;
        return;
    }
    uint first = vertex * args.to_width + args.to_channel;
    args.to.at[first] = point.x;
    if (args.channels > 1u) args.to.at[first + 1u] = point.y;
    if (args.channels > 2u) args.to.at[first + 2u] = point.z;
}

// [column * kFacesPerLane + face]
vec3 sums[kColumnsPerLane * kFacesPerLane];

void add_row(uint weight, uint ring) {
    vec3 points[kFacesPerLane];
    for (uint f = 0u; f < kFacesPerLane; ++f) points[f] = ring_rows[ring + f].xyz;
    for (uint c = 0u; c < kColumnsPerLane; ++c) {
        float w = args.weights.at[weight + c * kColumnLanes];
        for (uint f = 0u; f < kFacesPerLane; ++f) sums[c * kFacesPerLane + f] += w * points[f];
    }
}

void store_face(SubdivideTile tile, uint face, ColumnPlace place, vec3 point) {
    uint vertex = vertex_of(tile, face, place);
    if (vertex != kNotOwned) store_point(vertex, point);
}

void main() {
    SubdivideTile tile = args.tiles.at[group_index() / args.blocks];
    uint weight = tile.weights + first_column();
    for (uint i = 0u; i < kColumnsPerLane * kFacesPerLane; ++i) sums[i] = vec3(0.0f);
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
        for (uint f = 0u; f < kFacesPerLane; ++f)
            store_face(tile, first_face() + f, place, sums[c * kFacesPerLane + f]);
    }
}
