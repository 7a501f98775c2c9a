// SPDX-License-Identifier: Apache-2.0
// What the kernels share that multiply tables by rings. They include this behind their push
// constants and define kFacesPerLane, and load_point(vertex).

layout(constant_id = 0) const uint kFaceLanes = 1u;  // sets of kColumnLanes invocations
layout(local_size_x_id = 1) in;                      // kColumnLanes * kFaceLanes
layout(constant_id = 2) const uint kColumnsPerLane = 1u;
const uint kColumnLanes = kSubdivideColumnLanes;

const uint kTileFaces = kFaceLanes * kFacesPerLane;
// The rows at hand of the tile's rings, those of one row side by side.
shared vec4 ring_rows[kSubdivideRows * kTileFaces];

// The first column of the invocation; the others come kColumnLanes apart. Columns behind the last
// read what lies behind the row, and are written nowhere.
uint first_column() {
    return group_index() % args.blocks * (kColumnLanes * kColumnsPerLane) +
           gl_LocalInvocationID.x % kColumnLanes;
}
// The first face of the invocation in the tile.
uint first_face() { return gl_LocalInvocationID.x / kColumnLanes * kFacesPerLane; }

// Rings of faces that the tile lacks are 0.
void load_rings(SubdivideTile tile, uint first_row) {
    for (uint i = gl_LocalInvocationID.x; i < kSubdivideRows * kTileFaces;
         i += gl_WorkGroupSize.x) {
        uint face = i % kTileFaces, row = first_row + i / kTileFaces;
        if (row >= tile.rows) break;
        vec3 point = vec3(0.0f);
        if (face < tile.face_count) point = load_point(tile.ring + face * tile.rows, row);
        ring_rows[i] = vec4(point, 0.0f);
    }
}

// Where the points of a column are in a face's output.
struct ColumnPlace {
    uint first;  // place in SubdivideFace.first
    uint step;   // from there
    uint bit;    // of SubdivideFace.owned; 0: of no face
};

ColumnPlace column_place(uint column) {
    uint outer = args.corners << args.segment_bits;
    uint side = column >> args.segment_bits;
    uint step = column & ((1u << args.segment_bits) - 1u);
    ColumnPlace place;
    place.first = step == 0u ? side : 4u + side;
    place.step = step == 0u ? 0u : step - 1u;
    if (column >= outer) {
        place.first = kSubdivideInside;
        place.step = column - outer;
    }
    place.bit = column < args.columns ? 1u << place.first : 0u;
    return place;
}

// The refined vertex that a face of the tile writes there; kNotOwned: none.
const uint kNotOwned = ~0u;
uint vertex_of(SubdivideTile tile, uint face, ColumnPlace place) {
    if (face >= tile.face_count) return kNotOwned;
    uint words = (tile.first_face + face) * kSubdivideFaceWords;
    uint owned = args.faces.at[words + kSubdivideFaceWords - 1u];
    if ((owned & place.bit) == 0u) return kNotOwned;
    return args.faces.at[words + place.first] + place.step;
}
