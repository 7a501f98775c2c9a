// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/topology.h"
#include "aglow/refine/subdivision.h"

#include <cstdint>
#include <vector>

namespace aglow::refine {

/// A part of a weighted sum of vertices. A vertex may occur more than once.
struct Term {
    uint32_t vertex;
    double weight;
};
using Terms = std::vector<Term>;

/// An edge at a vertex.
struct Spoke {
    uint32_t half;    ///< that starts at the vertex; of a boundary's last edge, the one that ends
    uint32_t end;     ///< the vertex at the other end
    float sharpness;  ///< kSharp at a boundary
};

/// The masks of both schemes on a mesh: what its vertices, edges and faces become one level on, as
/// sums of its vertices. Sums are those of OpenSubdiv: uniform creases, of which the fractional
/// part blends between the rules before and after; at boundaries only the curve's own vertices
/// count, whatever the valence (1/8, 3/4, 1/8 at vertices, 1/2, 1/2 on edges, also for Loop).
/// All replace `terms`.
class Masks {
public:
    Masks(const Topology& mesh, Scheme scheme) : mesh_(mesh), scheme_(scheme) {}

    void vertex(uint32_t v, Terms& terms);
    void edge(uint32_t e, Terms& terms);
    void face(uint32_t f, Terms& terms);

    /// Where a vertex goes in the limit and two tangents there; u x v points to the front. Where
    /// the surface has a crease or a corner they are of the part that is met first when turning
    /// counter-clockwise from half-edge `start` (on a boundary: from the boundary).
    /// Faces that touch a vertex have three corners for Loop, four for Catmull-Clark.
    /// Source  Hoppe et al., "Piecewise Smooth Surface Reconstruction", SIGGRAPH 1994; Biermann,
    ///         Levin & Zorin, "Piecewise Smooth Subdivision Surfaces with Normal Control",
    ///         SIGGRAPH 2000.
    void limit(uint32_t v, uint32_t start, Terms& position, Terms& u, Terms& w);

private:
    enum class Rule { smooth, crease, corner };

    void walk(uint32_t start);
    Rule rule(float vertex_sharpness, const std::vector<float>& sharpness) const;
    void add_rule(Rule rule, const std::vector<float>& sharpness, uint32_t v, double scale,
                  Terms& terms) const;
    void add_smooth(uint32_t v, double scale, Terms& terms) const;
    void add_face(uint32_t f, double weight, Terms& terms) const;
    double blend(float vertex_sharpness) const;
    void smooth_limit(uint32_t v, Terms& position, Terms& u, Terms& w) const;
    void crease_limit(uint32_t v, Terms& position, Terms& u, Terms& w) const;
    void loop_cross(uint32_t v, size_t first, size_t last, Terms& w) const;
    void catmull_clark_cross(uint32_t v, size_t first, size_t last, Terms& w) const;
    uint32_t opposite(const Spoke& spoke) const;

    const Topology& mesh_;
    Scheme scheme_;
    std::vector<Spoke> spokes_;              ///< of the vertex at hand, counter-clockwise
    std::vector<float> sharp_, sharp_next_;  ///< of the spokes; and one level on
};

}  // namespace aglow::refine
