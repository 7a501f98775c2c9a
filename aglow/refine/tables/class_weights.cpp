// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/tables/class_weights.h"

#include "aglow/refine/tables/split.h"

#include <algorithm>

namespace aglow::refine {
namespace {

/// Calls visit(vertex of the split mesh, where it is) for those of a face: its corners, its edges
/// and, for quads, its middle. Places are those of the face's corners, twice as fine.
template <class Visit>
void visit_children(const Topology& mesh, uint32_t f, const std::vector<LatticePoint>& at,
                    const Visit& visit) {
    const uint32_t edges = mesh.vertex_count(), faces = edges + mesh.edge_count();
    const uint32_t first = mesh.face_begin[f], last = mesh.face_begin[f + 1];
    for (uint32_t h = first; h < last; ++h) {
        const LatticePoint a = at[mesh.vertex[h]], b = at[mesh.end(h)];
        visit(mesh.vertex[h], LatticePoint{2 * a.x, 2 * a.y});
        visit(edges + mesh.edge[h], LatticePoint{a.x + b.x, a.y + b.y});
    }
    if (last - first == 3) return;
    const LatticePoint a = at[mesh.vertex[first]], b = at[mesh.vertex[first + 2]];
    visit(faces + f, LatticePoint{a.x + b.x, a.y + b.y});
}

void child_terms(const Topology& mesh, Masks& masks, uint32_t fine_vertex, Terms& terms) {
    const uint32_t edges = mesh.vertex_count(), faces = edges + mesh.edge_count();
    if (fine_vertex < edges)
        masks.vertex(fine_vertex, terms);
    else if (fine_vertex < faces)
        masks.edge(fine_vertex - edges, terms);
    else
        masks.face(fine_vertex - faces, terms);
}

}  // namespace

void ClassWeights::start(Patch patch) {
    patch_ = std::move(patch);
    ring_ = static_cast<uint32_t>(patch_.source.size());
    rows_.assign(size_t{ring_} * ring_, 0.0);
    for (size_t r = 0; r < ring_; ++r) rows_[r * ring_ + r] = 1;
    at_.assign(ring_, {});
    at_[1] = {1, 0};
    at_[2] = points_.corners == 3 ? LatticePoint{0, 1} : LatticePoint{1, 1};
    if (points_.corners == 4) at_[3] = {0, 1};
}

void ClassWeights::sum(const Terms& terms, std::span<double> row) const {
    std::ranges::fill(row, 0.0);
    for (const Term& term : terms) {
        const double* from = rows_.data() + size_t{term.vertex} * ring_;
        for (size_t r = 0; r < row.size(); ++r) row[r] += term.weight * from[r];
    }
}

void ClassWeights::write(std::span<const double> row, uint32_t column, uint32_t stride,
                         std::span<float> table) const {
    for (size_t r = 0; r < row.size(); ++r) table[r * stride + column] = static_cast<float>(row[r]);
}

/// One level on, with all that touches the face there.
void ClassWeights::step() {
    const Topology fine = split(patch_.mesh, scheme_);
    std::vector<LatticePoint> at(fine.vertex_count());
    std::vector<uint32_t> inside;
    for (const uint32_t f : patch_.inside) {
        visit_children(patch_.mesh, f, at_, [&](uint32_t v, LatticePoint p) { at[v] = p; });
        for (uint32_t i = 0; i < 4; ++i) inside.push_back(4 * f + i);
    }
    Patch next = PatchCutter(fine).cut(inside);
    std::vector<double> rows(next.source.size() * ring_);
    at_.resize(next.source.size());
    Masks masks(patch_.mesh, scheme_);
    for (size_t v = 0; v < next.source.size(); ++v) {
        child_terms(patch_.mesh, masks, next.source[v], terms_);
        sum(terms_, std::span(rows).subspan(v * ring_, ring_));
        at_[v] = at[next.source[v]];
    }
    rows_ = std::move(rows);
    patch_ = std::move(next);
}

/// The last level, of which nothing but the face itself is wanted.
void ClassWeights::finish(uint32_t stride, std::span<float> table) {
    std::vector<double> row(ring_);
    std::vector<bool> done(points_.count(), false);
    Masks masks(patch_.mesh, scheme_);
    for (const uint32_t f : patch_.inside)
        visit_children(patch_.mesh, f, at_, [&](uint32_t v, LatticePoint p) {
            const uint32_t column = points_.at(p);
            if (done[column]) return;
            done[column] = true;
            child_terms(patch_.mesh, masks, v, terms_);
            sum(terms_, row);
            write(row, column, stride, table);
        });
}

void ClassWeights::refine(Patch patch, uint32_t stride, std::span<float> table) {
    start(std::move(patch));
    if (level_ == 0) {
        for (uint32_t v = 0; v < points_.corners; ++v) table[v * stride + points_.at(at_[v])] = 1;
        return;
    }
    for (int level = 1; level < level_; ++level) step();
    finish(stride, table);
}

/// [vertex] Where to start turning, so that creases along the face's edges show its own side: the
/// half-edge inside behind which there is none inside, if there is one. kNone: not inside.
std::vector<uint32_t> ClassWeights::limit_starts() const {
    const Topology& mesh = patch_.mesh;
    std::vector<bool> is_inside(mesh.face_count(), false);
    for (const uint32_t f : patch_.inside) is_inside[f] = true;
    std::vector<uint32_t> starts(mesh.vertex_count(), kNone);
    for (const uint32_t f : patch_.inside)
        for (uint32_t h = mesh.face_begin[f]; h < mesh.face_begin[f + 1]; ++h) {
            uint32_t& start = starts[mesh.vertex[h]];
            const bool first = mesh.twin[h] == kNone || !is_inside[mesh.face[mesh.twin[h]]];
            if (start == kNone || first) start = h;
        }
    return starts;
}

void ClassWeights::refine_limit(Patch patch, uint32_t stride, std::span<float> position,
                                std::span<float> u, std::span<float> v) {
    start(std::move(patch));
    for (int level = 0; level < level_; ++level) step();
    Masks masks(patch_.mesh, scheme_);
    Terms terms_u, terms_v;
    std::vector<double> row(ring_);
    const std::vector<uint32_t> starts = limit_starts();
    for (uint32_t i = 0; i < starts.size(); ++i) {
        if (starts[i] == kNone) continue;
        masks.limit(i, starts[i], terms_, terms_u, terms_v);
        const uint32_t column = points_.at(at_[i]);
        for (const auto& [terms, table] :
             {std::pair(&terms_, position), std::pair(&terms_u, u), std::pair(&terms_v, v)}) {
            sum(*terms, row);
            write(row, column, stride, table);
        }
    }
}

}  // namespace aglow::refine
