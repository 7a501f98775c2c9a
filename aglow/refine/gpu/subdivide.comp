// SPDX-License-Identifier: Apache-2.0
// Refined points of faces of one class: their class's table times their rings. A weight that is
// read serves all faces of an invocation.
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

vec3 sum0 = vec3(0.0f), sum1 = vec3(0.0f), sum2 = vec3(0.0f), sum3 = vec3(0.0f);

void add_row(uint weight, uint ring) {
    float w = args.weights.at[weight];
    sum0 += w * ring_rows[ring].xyz;
    sum1 += w * ring_rows[ring + 1u].xyz;
    sum2 += w * ring_rows[ring + 2u].xyz;
    sum3 += w * ring_rows[ring + 3u].xyz;
}

void store_face(SubdivideTile tile, uint face, ColumnPlace place, vec3 point) {
    uint vertex = vertex_of(tile, face, place);
    if (vertex != kNotOwned) store_point(vertex, point);
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
        for (uint row = first; row < min(first + kSubdivideRows, tile.rows);
             row += kSubdivideRowStep) {
            add_row(weight, ring);
            add_row(weight + args.stride, ring + kTileFaces);
            add_row(weight + 2u * args.stride, ring + 2u * kTileFaces);
            add_row(weight + 3u * args.stride, ring + 3u * kTileFaces);
            weight += kSubdivideRowStep * args.stride;
            ring += kSubdivideRowStep * kTileFaces;
        }
    }
    ColumnPlace place = column_place(column);
    store_face(tile, first_face(), place, sum0);
    store_face(tile, first_face() + 1u, place, sum1);
    store_face(tile, first_face() + 2u, place, sum2);
    store_face(tile, first_face() + 3u, place, sum3);
}
