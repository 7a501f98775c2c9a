// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"
#include "aglow/refine/subdivision.h"
#include "aglow/refine/testing/open_subdiv_headers.h"

#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

/// OpenSubdiv as the reference for subdivision.
namespace aglow::refine::testing {

namespace osd = OpenSubdiv;

/// A point as OpenSubdiv wants it.
template <class Real>
struct BasicOsdPoint {
    Real x = 0, y = 0, z = 0;
    // NOLINTBEGIN(readability-identifier-naming): the names that OpenSubdiv calls.
    void Clear() { x = y = z = 0; }
    void AddWithWeight(const BasicOsdPoint& p, Real w) {
        x += w * p.x;
        y += w * p.y;
        z += w * p.z;
    }
    // NOLINTEND(readability-identifier-naming)
};
/// In double precision, since tangents are small differences.
using OsdPoint = BasicOsdPoint<double>;

inline std::unique_ptr<osd::Far::TopologyRefiner> make_refiner(const Topology& mesh, Scheme scheme,
                                                               Corners corners) {
    std::vector<int> sizes, vertices, ends, sharp_vertices;
    std::vector<float> edge_sharpness, vertex_sharpness;
    for (uint32_t f = 0; f < mesh.face_count(); ++f)
        sizes.push_back(static_cast<int>(mesh.face_size(f)));
    for (const uint32_t v : mesh.vertex) vertices.push_back(static_cast<int>(v));
    for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
        if (mesh.edge_sharpness[e] <= 0) continue;
        ends.push_back(static_cast<int>(mesh.vertex[mesh.edge_half[e]]));
        ends.push_back(static_cast<int>(mesh.end(mesh.edge_half[e])));
        edge_sharpness.push_back(mesh.edge_sharpness[e]);
    }
    for (uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        if (mesh.vertex_sharpness[v] <= 0) continue;
        sharp_vertices.push_back(static_cast<int>(v));
        vertex_sharpness.push_back(mesh.vertex_sharpness[v]);
    }
    osd::Far::TopologyDescriptor d;
    d.numVertices = static_cast<int>(mesh.vertex_count());
    d.numFaces = static_cast<int>(mesh.face_count());
    d.numVertsPerFace = sizes.data();
    d.vertIndicesPerFace = vertices.data();
    d.numCreases = static_cast<int>(edge_sharpness.size());
    d.creaseVertexIndexPairs = ends.data();
    d.creaseWeights = edge_sharpness.data();
    d.numCorners = static_cast<int>(vertex_sharpness.size());
    d.cornerVertexIndices = sharp_vertices.data();
    d.cornerWeights = vertex_sharpness.data();
    using Sdc = osd::Sdc::Options;
    Sdc options;
    options.SetVtxBoundaryInterpolation(corners == Corners::sharp
                                            ? Sdc::VTX_BOUNDARY_EDGE_AND_CORNER
                                            : Sdc::VTX_BOUNDARY_EDGE_ONLY);
    using Factory = osd::Far::TopologyRefinerFactory<osd::Far::TopologyDescriptor>;
    const auto type = scheme == Scheme::loop ? osd::Sdc::SCHEME_LOOP : osd::Sdc::SCHEME_CATMARK;
    return std::unique_ptr<osd::Far::TopologyRefiner>(
        Factory::Create(d, Factory::Options(type, options)));
}

inline void refine_uniform(osd::Far::TopologyRefiner& refiner, int level) {
    osd::Far::TopologyRefiner::UniformOptions options(level);
    options.fullTopologyInLastLevel = true;
    refiner.RefineUniform(options);
}

/// The refined faces of a subdivision as polygons.
inline PolygonList refined_faces(const Subdivision& subdivision) {
    PolygonList list;
    list.vertex_count = subdivision.vertex_count();
    const auto add = [&](std::initializer_list<uint32_t> corners) {
        list.corners.insert(list.corners.end(), corners);
        list.face_begin.push_back(static_cast<uint32_t>(list.corners.size()));
    };
    for (const uvec3& t : subdivision.triangles()) add({t.x, t.y, t.z});
    for (const auto& q : subdivision.quads()) add({q[0], q[1], q[2], q[3]});
    return list;
}

inline PolygonList refined_faces(const osd::Far::TopologyLevel& level) {
    PolygonList list;
    list.vertex_count = static_cast<uint32_t>(level.GetNumVertices());
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        for (const int v : level.GetFaceVertices(f))
            list.corners.push_back(static_cast<uint32_t>(v));
        list.face_begin.push_back(static_cast<uint32_t>(list.corners.size()));
    }
    return list;
}

/// The face of the last level at corner 0 of a control face, and that vertex.
inline std::pair<int, int> first_descendant(const osd::Far::TopologyRefiner& refiner, int level,
                                            int face) {
    int v = refiner.GetLevel(0).GetFaceVertices(face)[0];
    for (int step = 0; step < level; ++step) {
        const auto& coarse = refiner.GetLevel(step);
        v = coarse.GetVertexChildVertex(v);
        for (const int child : coarse.GetFaceChildFaces(face))
            if (refiner.GetLevel(step + 1).GetFaceVertices(child).FindIndex(v) >= 0) {
                face = child;
                break;
            }
    }
    return {face, v};
}

/// [refined vertex of the subdivision] the one of OpenSubdiv's last level, kNone where no face is.
/// Found by walking over the refined faces of both at once, from the corners of control faces: so
/// faces and their neighbours are the same, too.
inline std::vector<uint32_t> match_vertices(const Topology& control, const Subdivision& subdivision,
                                            const osd::Far::TopologyRefiner& refiner, int level) {
    const Topology ours = build_topology(refined_faces(subdivision))->topology;
    const Topology theirs = build_topology(refined_faces(refiner.GetLevel(level)))->topology;
    std::vector<uint32_t> match(ours.half_edge_count(), kNone), stack;
    const auto meet = [&](uint32_t a, uint32_t b) {
        if (a == kNone || b == kNone || match[a] != kNone) return;
        match[a] = b;
        stack.push_back(a);
    };
    const bool triangles = subdivision.quads().empty();
    const uint32_t segments = 1u << (triangles ? level : level - 1);
    for (uint32_t f = 0; f < control.face_count(); ++f) {
        const auto [face, v] = first_descendant(refiner, level, static_cast<int>(f));
        uint32_t h = theirs.face_begin[static_cast<uint32_t>(face)];
        while (theirs.vertex[h] != static_cast<uint32_t>(v)) h = theirs.next(h);
        const uint32_t part = triangles ? f : control.face_begin[f];
        meet(ours.face_begin[part * segments * segments], h);
        while (!stack.empty()) {
            const uint32_t a = stack.back(), b = match[a];
            stack.pop_back();
            meet(ours.next(a), theirs.next(b));
            meet(ours.twin[a], theirs.twin[b]);
        }
    }
    std::vector<uint32_t> vertices(subdivision.vertex_count(), kNone);
    for (uint32_t h = 0; h < ours.half_edge_count(); ++h)
        vertices[ours.vertex[h]] = match[h] == kNone ? kNone : theirs.vertex[match[h]];
    return vertices;
}

struct Refined {
    std::vector<OsdPoint> points;       ///< of the last level
    std::vector<OsdPoint> limit, u, v;  ///< there
};

inline Refined refine_points(const osd::Far::TopologyRefiner& refiner, int level,
                             std::span<const vec3> control) {
    const osd::Far::PrimvarRefinerReal<double> primvar(refiner);
    Refined refined;
    for (const vec3 p : control) refined.points.push_back({double(p.x), double(p.y), double(p.z)});
    for (int k = 1; k <= level; ++k) {
        std::vector<OsdPoint> next(static_cast<size_t>(refiner.GetLevel(k).GetNumVertices()));
        primvar.Interpolate(k, refined.points, next);
        refined.points = std::move(next);
    }
    for (auto* points : {&refined.limit, &refined.u, &refined.v})
        points->resize(refined.points.size());
    primvar.Limit(refined.points, refined.limit, refined.u, refined.v);
    return refined;
}

}  // namespace aglow::refine::testing
