// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/tables/face_points.h"
#include "aglow/refine/tables/face_ring.h"
#include "aglow/refine/tables/masks.h"

#include <span>
#include <vector>

namespace aglow::refine {

/// Finds the weights with which a ring makes the refined points of a face, by subdividing the ring:
/// every vertex of the patch carries its weights of the ring's vertices.
class ClassWeights {
public:
    ClassWeights(Scheme scheme, const FacePoints& points, int level)
        : scheme_(scheme), points_(points), level_(level) {}

    /// Shapes  patch: of one face; table [ring * stride]: all 0 before.
    void refine(Patch patch, uint32_t stride, std::span<float> table);
    /// Likewise for where the refined points go in the limit and their tangents.
    void refine_limit(Patch patch, uint32_t stride, std::span<float> position, std::span<float> u,
                      std::span<float> v);

private:
    void start(Patch patch);
    void step();
    void finish(uint32_t stride, std::span<float> table);
    void sum(const Terms& terms, std::span<double> row) const;
    void write(std::span<const double> row, uint32_t column, uint32_t stride,
               std::span<float> table) const;
    std::vector<uint32_t> limit_starts() const;

    Scheme scheme_;
    const FacePoints& points_;
    int level_;

    Patch patch_;
    uint32_t ring_ = 0;
    std::vector<LatticePoint> at_;  ///< [vertex of the patch] of those inside
    std::vector<double> rows_;      ///< [vertex of the patch][ring]
    Terms terms_;
};

}  // namespace aglow::refine
