// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/refine/refine_scene.h"

namespace aglow::refine {

/// One mesh of a scene, refined. What was odd is added to `warnings`.
/// Errors  as refine_scene()
Result<Mesh> refine_mesh(const Mesh& mesh, const RefineOptions& options,
                         std::vector<std::string>& warnings);

}  // namespace aglow::refine
