// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/tables/face_points.h"

namespace aglow::refine {
namespace {

void add(FacePoints& face, uint32_t x, uint32_t y) {
    face.column[y * (face.segments + 1) + x] = face.count();
    face.points.push_back({x, y});
}

void add_triangles(FacePoints& face) {
    const uint32_t n = face.segments;
    for (uint32_t k = 0; k < n; ++k) add(face, k, 0);
    for (uint32_t k = 0; k < n; ++k) add(face, n - k, k);
    for (uint32_t k = 0; k < n; ++k) add(face, 0, n - k);
    for (uint32_t y = 1; y < n; ++y)
        for (uint32_t x = 1; x + y < n; ++x) add(face, x, y);
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x + y < n; ++x) {
            face.faces.push_back({face.at({x, y}), face.at({x + 1, y}), face.at({x, y + 1}), 0});
            if (x + y + 1 < n)
                face.faces.push_back(
                    {face.at({x + 1, y}), face.at({x + 1, y + 1}), face.at({x, y + 1}), 0});
        }
}

void add_quads(FacePoints& face) {
    const uint32_t n = face.segments;
    for (uint32_t k = 0; k < n; ++k) add(face, k, 0);
    for (uint32_t k = 0; k < n; ++k) add(face, n, k);
    for (uint32_t k = 0; k < n; ++k) add(face, n - k, n);
    for (uint32_t k = 0; k < n; ++k) add(face, 0, n - k);
    for (uint32_t y = 1; y < n; ++y)
        for (uint32_t x = 1; x < n; ++x) add(face, x, y);
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x)
            face.faces.push_back({face.at({x, y}), face.at({x + 1, y}), face.at({x + 1, y + 1}),
                                  face.at({x, y + 1})});
}

}  // namespace

FacePoints face_points(uint32_t corners, uint32_t segments) {
    FacePoints face{corners, segments, {}, {}, {}};
    face.column.resize(size_t{segments + 1} * (segments + 1));
    if (corners == 3)
        add_triangles(face);
    else
        add_quads(face);
    return face;
}

}  // namespace aglow::refine
