// SPDX-License-Identifier: Apache-2.0
// A model set onto the faces of a mesh.
#pragma once
#include "aglow/core/result.h"
#include "aglow/mesh/control_mesh.h"
#include "aglow/refine/mesh_on_mesh.h"
#include "aglow/refine/refine_scene.h"
#include "aglow/refine/scene/refined_surface.h"

#include <span>

namespace aglow::refine {

/// The model on every triangle and quad of a control mesh: in the middle of a face, or of each cell
/// of repeats x repeats, as wide as the face, its inner circle on triangles. What stands on a face
/// of mean size keeps its proportions.
/// Errors  bad_argument  a face of more than four corners
Result<RaisedMesh> raise_model(const ControlMesh& control, const Shape& rest,
                               std::span<const shared::ShapeTags> tags, RefineScheme scheme,
                               const SurfaceModel& model);

}  // namespace aglow::refine
