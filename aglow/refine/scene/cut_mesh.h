// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/topology.h"
#include "aglow/refine/subdivision.h"
#include "aglow/refine/tessellation.h"

#include <functional>
#include <span>
#include <vector>

namespace aglow::refine {

/// Which corners round a vertex belong together: those of faces that meet at an edge for which
/// joined(corner, corner of the next face) holds.
/// Result  [half-edge] the lowest corner of its group.
std::vector<uint32_t> corner_groups(const Topology& topology,
                                    const std::function<bool(uint32_t, uint32_t)>& joined);

/// The same faces over vertices that are one in both groupings of corners.
/// Errors  out_of_memory
Result<Topology> cut_by(const Topology& topology, std::span<const uint32_t> groups,
                        std::span<const uint32_t> other_groups);

/// Where the vertices of a subdivided mesh are, in the form of a tessellation without triangles.
Tessellation subdivided_order(const Topology& topology, Scheme scheme, int level);

/// Numbers refined vertices of `whole`, as faces of a control face name them, as those of `cut`.
class CutNumbers {
public:
    CutNumbers(const Topology& cut, const Tessellation& cut_order, const Topology& whole,
               const Tessellation& whole_order)
        : cut_(cut), cut_order_(cut_order), whole_(whole), whole_order_(whole_order) {}

    uint32_t operator()(uint32_t face, uint32_t refined) const;

private:
    uint32_t on_edge(uint32_t face, uint32_t refined) const;

    const Topology& cut_;
    const Tessellation& cut_order_;
    const Topology& whole_;
    const Tessellation& whole_order_;
};

}  // namespace aglow::refine
