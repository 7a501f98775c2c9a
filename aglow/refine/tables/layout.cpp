// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/tables/layout.h"

namespace aglow::refine {
namespace {

/// Refined vertices inside a face of `corners` corners, without those on its edges.
uint64_t inside(Scheme scheme, uint64_t corners, uint64_t segments) {
    if (segments < 2) return 0;
    if (scheme == Scheme::loop) return (segments - 1) * (segments - 2) / 2;
    const uint64_t half = segments / 2;
    return 1 + corners * half * (half - 1);
}

}  // namespace

uint64_t refined_count(const Topology& mesh, Scheme scheme, uint64_t segments) {
    uint64_t count = mesh.vertex_count() + mesh.edge_count() * (segments - 1);
    for (uint32_t f = 0; f < mesh.face_count(); ++f)
        count += inside(scheme, mesh.face_size(f), segments);
    return count;
}

Layout control_layout(const Topology& mesh, Scheme scheme, uint32_t segments) {
    Layout layout{segments, {}, {}, {}};
    layout.vertex.resize(mesh.vertex_count());
    layout.edge.resize(mesh.edge_count());
    layout.face.resize(mesh.face_count());
    uint32_t next = 0;
    for (uint32_t& v : layout.vertex) v = next++;
    for (uint32_t& e : layout.edge) {
        e = next;
        next += segments - 1;
    }
    for (uint32_t f = 0; f < mesh.face_count(); ++f) {
        layout.face[f] = next;
        next += static_cast<uint32_t>(inside(scheme, mesh.face_size(f), segments));
    }
    return layout;
}

Layout split_layout(const Topology& mesh, Scheme scheme, const Layout& coarse) {
    const uint32_t half = coarse.segments / 2;
    Layout fine{half, coarse.vertex, {}, {}};
    const auto add_edges = [&](uint32_t first, uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) fine.edge.push_back(first + i * (half - 1));
    };
    for (const uint32_t first : coarse.edge) {
        fine.vertex.push_back(first + half - 1);
        fine.edge.push_back(first);
        fine.edge.push_back(first + half);
    }
    for (uint32_t f = 0; f < mesh.face_count(); ++f) {
        const bool loop = scheme == Scheme::loop;
        const uint32_t size = mesh.face_size(f), children = loop ? 4 : size;
        uint32_t next = coarse.face[f];
        if (!loop) fine.vertex.push_back(next++);
        add_edges(next, size);
        next += size * (half - 1);
        const uint32_t each =
            loop ? static_cast<uint32_t>(inside(scheme, 3, half)) : (half - 1) * (half - 1);
        for (uint32_t i = 0; i < children; ++i) fine.face.push_back(next + i * each);
    }
    return fine;
}

std::vector<FaceOutput> face_outputs(const Topology& mesh, const Layout& layout) {
    std::vector<FaceOutput> outputs(mesh.face_count());
    for (uint32_t f = 0; f < mesh.face_count(); ++f) {
        FaceOutput& output = outputs[f];
        output.interior = layout.face[f];
        for (uint32_t i = 0; i < mesh.face_size(f); ++i) {
            const uint32_t h = mesh.face_begin[f] + i;
            const uint32_t v = mesh.vertex[h], e = mesh.edge[h];
            output.corner[i] = layout.vertex[v];
            output.edge[i] = layout.edge[e];
            if (mesh.vertex_half[v] == h && layout.vertex[v] != kNone) output.owned |= 1u << i;
            if (mesh.edge_half[e] == h && layout.segments > 1) output.owned |= 16u << i;
        }
    }
    return outputs;
}

}  // namespace aglow::refine
