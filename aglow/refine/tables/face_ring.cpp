// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/tables/face_ring.h"

#include <algorithm>
#include <bit>

namespace aglow::refine {
namespace {

/// Calls visit(h) for the half-edges that start at that of `start`, counter-clockwise: from the
/// boundary if there is one, from `start` if not.
template <class Visit>
void turn_round(const Topology& mesh, uint32_t start, const Visit& visit) {
    const uint32_t v = mesh.vertex[start];
    const uint32_t first = mesh.on_boundary(v) ? mesh.vertex_half[v] : start;
    uint32_t h = first;
    do {
        visit(h);
        h = mesh.twin[mesh.previous(h)];
    } while (h != kNone && h != first);
}

}  // namespace

uint32_t FaceRing::place(uint32_t v) {
    if (last_face_[v] != face_) {
        last_face_[v] = face_;
        places_[v] = static_cast<uint32_t>(vertices_.size());
        vertices_.push_back(v);
    }
    return places_[v];
}

void FaceRing::turn(uint32_t start) {
    const size_t head = key_.size();
    key_.push_back(0);
    uint32_t faces = 0, last = start;
    turn_round(mesh_, start, [&](uint32_t h) {
        for (uint32_t g = mesh_.next(h); g != h; g = mesh_.next(g))
            key_.push_back(place(mesh_.vertex[g]));
        key_.push_back(std::bit_cast<uint32_t>(mesh_.edge_sharpness[mesh_.edge[h]]));
        ++faces;
        last = h;
    });
    const uint32_t behind = mesh_.previous(last);
    const bool open = mesh_.twin[behind] == kNone;
    key_[head] = 2 * faces + (open ? 1 : 0);
    key_.push_back(std::bit_cast<uint32_t>(mesh_.vertex_sharpness[mesh_.vertex[start]]));
}

void FaceRing::find(uint32_t face) {
    face_ = face;
    vertices_.clear();
    key_.clear();
    for (uint32_t h = mesh_.face_begin[face]; h < mesh_.face_begin[face + 1]; ++h)
        place(mesh_.vertex[h]);
    for (uint32_t h = mesh_.face_begin[face]; h < mesh_.face_begin[face + 1]; ++h) turn(h);
}

PatchCutter::PatchCutter(const Topology& mesh)
    : mesh_(mesh),
      new_face_(mesh.face_count(), kNone),
      new_vertex_(mesh.vertex_count(), kNone),
      new_edge_(mesh.edge_count(), kNone) {}

Patch PatchCutter::cut(std::span<const uint32_t> inside) {
    Patch patch;
    for (const uint32_t f : inside) add_corners(f, patch);
    turned_.assign(patch.source.size(), false);
    for (const uint32_t f : inside)
        for (uint32_t h = mesh_.face_begin[f]; h < mesh_.face_begin[f + 1]; ++h) add_fan(h, patch);
    for (const uint32_t f : inside) patch.inside.push_back(new_face_[f]);
    link(patch);
    forget(patch);
    return patch;
}

void PatchCutter::add_corners(uint32_t f, Patch& patch) {
    for (uint32_t h = mesh_.face_begin[f]; h < mesh_.face_begin[f + 1]; ++h)
        add_vertex(mesh_.vertex[h], patch);
}

void PatchCutter::add_vertex(uint32_t v, Patch& patch) {
    if (new_vertex_[v] != kNone) return;
    new_vertex_[v] = static_cast<uint32_t>(patch.source.size());
    patch.source.push_back(v);
}

void PatchCutter::add_fan(uint32_t start, Patch& patch) {
    const uint32_t v = new_vertex_[mesh_.vertex[start]];
    if (turned_[v]) return;
    turned_[v] = true;
    turn_round(mesh_, start, [&](uint32_t h) {
        const uint32_t f = mesh_.face[h];
        if (new_face_[f] == kNone) {
            new_face_[f] = static_cast<uint32_t>(faces_.size());
            faces_.push_back(f);
        }
        // In the order in which FaceRing meets them.
        for (uint32_t g = mesh_.next(h); g != h; g = mesh_.next(g))
            add_vertex(mesh_.vertex[g], patch);
    });
}

uint32_t PatchCutter::new_half(uint32_t h, const Topology& cut) const {
    if (h == kNone || new_face_[mesh_.face[h]] == kNone) return kNone;
    const uint32_t f = mesh_.face[h];
    return cut.face_begin[new_face_[f]] + h - mesh_.face_begin[f];
}

void PatchCutter::link(Patch& patch) {
    Topology& cut = patch.mesh;
    for (const uint32_t f : faces_)
        cut.face_begin.push_back(cut.face_begin.back() + mesh_.face_size(f));
    for (const uint32_t f : faces_)
        for (uint32_t h = mesh_.face_begin[f]; h < mesh_.face_begin[f + 1]; ++h) add_half(h, cut);
    for (const uint32_t v : patch.source) {
        cut.vertex_half.push_back(new_half(mesh_.vertex_half[v], cut));
        cut.vertex_sharpness.push_back(mesh_.vertex_sharpness[v]);
    }
}

void PatchCutter::add_half(uint32_t h, Topology& cut) {
    uint32_t& e = new_edge_[mesh_.edge[h]];
    if (e == kNone) {
        e = cut.edge_count();
        cut.edge_half.push_back(cut.half_edge_count());
        cut.edge_sharpness.push_back(mesh_.edge_sharpness[mesh_.edge[h]]);
    }
    cut.vertex.push_back(new_vertex_[mesh_.vertex[h]]);
    cut.twin.push_back(new_half(mesh_.twin[h], cut));
    cut.edge.push_back(e);
    cut.face.push_back(new_face_[mesh_.face[h]]);
}

/// Back to how it was made, at the cost of what was touched.
void PatchCutter::forget(const Patch& patch) {
    for (const uint32_t v : patch.source) new_vertex_[v] = kNone;
    for (const uint32_t f : faces_) {
        new_face_[f] = kNone;
        for (uint32_t h = mesh_.face_begin[f]; h < mesh_.face_begin[f + 1]; ++h)
            new_edge_[mesh_.edge[h]] = kNone;
    }
    faces_.clear();
}

}  // namespace aglow::refine
