// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/control_mesh.h"
#include "aglow/refine/patches.h"
#include "aglow/refine/refine_scene.h"
#include "aglow/refine/scene/cut_mesh.h"
#include "aglow/shared/tagged_triangle.h"

#include <memory>
#include <span>
#include <vector>

namespace aglow::refine {

/// A shape of a control mesh: at rest, or under a morph target.
struct Shape {
    std::vector<vec3> positions;       ///< [vertex of ControlMesh::topology]
    std::vector<vec3> corner_normals;  ///< [half-edge] unit
};

struct RefinedShape {
    std::vector<vec3> positions;  ///< [refined vertex of the cut mesh]
    std::vector<vec3> normals;    ///< [likewise] unit, or 0 where the surface has none
};

/// Which vertices values are given at.
enum class Layer : uint8_t {
    whole,  ///< of ControlMesh::topology
    seams,  ///< of ControlMesh::seams
};

/// A mesh refined by one scheme, cut open where attributes or normals part. Refined vertices are
/// numbered by those of the cut mesh, except where it says otherwise.
class RefinedSurface {
public:
    virtual ~RefinedSurface() = default;

    virtual Status place(const Shape& shape, RefinedShape& refined) const = 0;
    /// Attributes, linear in those of the control mesh.
    /// Shapes  control [vertex of the layer * width], refined [its refined vertex * width]
    virtual Status interpolate(Layer layer, std::span<const float> control, int width,
                               std::vector<float>& refined) const = 0;

    uint32_t vertex_count() const { return static_cast<uint32_t>(whole.size()); }
    /// Refined vertices along the edge of a half-edge, from one end to the other.
    std::vector<uint32_t> edge_vertices(uint32_t half_edge) const;

    Topology cut;                  ///< the control mesh cut open
    Tessellation order;            ///< of the refined vertices over it, without triangles
    std::vector<uint32_t> whole;   ///< [refined vertex] that of ControlMesh::topology
    std::vector<uint32_t> seams;   ///< [refined vertex] that of ControlMesh::seams
    std::vector<uvec3> triangles;  ///< face after face
    std::vector<uint32_t> face_triangle = {0};  ///< [face + 1]
};

/// Errors  those of Subdivision::create(), Patches::create() and Tessellation::uniform()
Result<std::unique_ptr<RefinedSurface>> subdivision_surface(const ControlMesh& control,
                                                            const RefineOptions& options);
/// What patches of a scheme are.
PatchOptions patch_options(RefineScheme scheme);
/// `rest` says where normals part; `tags` [vertex] may be empty.
Result<std::unique_ptr<RefinedSurface>> patch_surface(const ControlMesh& control,
                                                      const RefineOptions& options,
                                                      const Shape& rest,
                                                      std::vector<shared::ShapeTags> tags);

}  // namespace aglow::refine
