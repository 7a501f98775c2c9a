// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/tables/build.h"

#include "aglow/core/parallel.h"
#include "aglow/refine/tables/class_weights.h"

#include <algorithm>
#include <bit>
#include <unordered_map>

namespace aglow::refine {
namespace {

/// One term for every vertex, in the order in which they come first.
void merge(Terms& terms) {
    size_t count = 0;
    for (size_t i = 0; i < terms.size(); ++i) {
        const Term term = terms[i];
        const auto kept = terms.begin() + static_cast<std::ptrdiff_t>(count);
        const auto same = std::find_if(terms.begin(), kept,
                                       [&](const Term& t) { return t.vertex == term.vertex; });
        if (same != kept)
            same->weight += term.weight;
        else
            terms[count++] = term;
    }
    terms.resize(count);
}

void append(Stencils& stencils, Terms& terms) {
    merge(terms);
    for (const Term& term : terms) {
        stencils.index.push_back(term.vertex);
        stencils.weight.push_back(static_cast<float>(term.weight));
    }
    stencils.begin.push_back(static_cast<uint32_t>(stencils.index.size()));
}

struct KeyHash {
    size_t operator()(const std::vector<uint32_t>& key) const {
        uint64_t hash = key.size();
        for (const uint32_t word : key) {
            hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 32;
        }
        return hash;
    }
};

/// Gives faces their rings and classes.
class Classes {
public:
    Classes(const Topology& mesh, FaceTables& tables, std::vector<uint32_t>& class_face)
        : mesh_(mesh), ring_(mesh), tables_(tables), class_face_(class_face) {}

    void find() {
        tables_.ring_begin.push_back(0);
        for (uint32_t f = 0; f < mesh_.face_count(); ++f) {
            ring_.find(f);
            const std::span<const uint32_t> ring = ring_.vertices();
            tables_.ring.insert(tables_.ring.end(), ring.begin(), ring.end());
            tables_.ring_begin.push_back(tables_.ring.size());
            tables_.face_class.push_back(class_of(f));
        }
    }

private:
    uint32_t class_of(uint32_t f) {
        const auto [known, is_new] =
            numbers_.try_emplace(ring_.key(), static_cast<uint32_t>(class_face_.size()));
        if (is_new) {
            class_face_.push_back(f);
            tables_.rows.push_back(static_cast<uint32_t>(ring_.vertices().size()));
        }
        return known->second;
    }

    const Topology& mesh_;
    FaceRing ring_;
    FaceTables& tables_;
    std::vector<uint32_t>& class_face_;
    std::unordered_map<std::vector<uint32_t>, uint32_t, KeyHash> numbers_;
};

std::span<float> table_of(const FaceTables& faces, uint32_t k, Weights& weights) {
    const size_t begin = faces.weight_begin[k];
    return floats(weights).subspan(begin, faces.weight_begin[k + 1] - begin);
}

/// Calls refine(ClassWeights, patch, class) for every class.
template <class Refine>
void for_each_class(const Topology& mesh, Scheme scheme, const FaceTables& faces,
                    const std::vector<uint32_t>& class_face, const Refine& refine) {
    constexpr size_t kGrain = 16;
    const FacePoints points = face_points(faces.corners, faces.segments);
    parallel_for(class_face.size(), kGrain, [&](size_t begin, size_t end) {
        PatchCutter cutter(mesh);
        ClassWeights weights(scheme, points, std::countr_zero(faces.segments));
        for (size_t k = begin; k < end; ++k)
            refine(weights, cutter.cut(std::span(&class_face[k], 1)), static_cast<uint32_t>(k));
    });
}

}  // namespace

Stencils split_stencils(const Topology& mesh, Scheme scheme) {
    Stencils stencils;
    Masks masks(mesh, scheme);
    Terms terms;
    for (uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        masks.vertex(v, terms);
        append(stencils, terms);
    }
    for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
        masks.edge(e, terms);
        append(stencils, terms);
    }
    if (scheme == Scheme::loop) return stencils;
    for (uint32_t f = 0; f < mesh.face_count(); ++f) {
        masks.face(f, terms);
        append(stencils, terms);
    }
    return stencils;
}

FaceTables face_tables(const Topology& mesh, Scheme scheme, int level,
                       std::vector<uint32_t>& class_face) {
    FaceTables faces;
    faces.corners = scheme == Scheme::loop ? 3 : 4;
    faces.segments = 1u << level;
    const uint32_t n = faces.segments;
    faces.interior = scheme == Scheme::loop ? (n - 1) * (n - 2) / 2 : (n - 1) * (n - 1);
    const uint32_t columns = faces.corners * n + faces.interior;
    faces.stride = (columns + kColumnBlock - 1) / kColumnBlock * kColumnBlock;
    Classes(mesh, faces, class_face).find();
    faces.weight_begin.push_back(0);
    for (const uint32_t rows : faces.rows)
        faces.weight_begin.push_back(faces.weight_begin.back() + size_t{rows} * faces.stride);
    faces.weights.resize(faces.weight_begin.back() / kColumnBlock);
    for_each_class(
        mesh, scheme, faces, class_face, [&](ClassWeights& weights, Patch patch, uint32_t k) {
            weights.refine(std::move(patch), faces.stride, table_of(faces, k, faces.weights));
        });
    return faces;
}

LimitWeights limit_weights(const Topology& mesh, Scheme scheme, const FaceTables& faces,
                           const std::vector<uint32_t>& class_face) {
    LimitWeights limit;
    for (Weights* weights : {&limit.position, &limit.tangent_u, &limit.tangent_v})
        weights->resize(faces.weights.size());
    for_each_class(
        mesh, scheme, faces, class_face, [&](ClassWeights& weights, Patch patch, uint32_t k) {
            weights.refine_limit(std::move(patch), faces.stride, table_of(faces, k, limit.position),
                                 table_of(faces, k, limit.tangent_u),
                                 table_of(faces, k, limit.tangent_v));
        });
    return limit;
}

}  // namespace aglow::refine
