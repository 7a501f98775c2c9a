// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/encode/gltf/lit_meshes.h"

namespace aglow::encode {

/// What the extensions say about the light.
struct LightInfo {
    double intensity = 1;  ///< lux
    std::string exr;       ///< name of the full-range file beside the scene
    float texel_size = 0;  ///< m
};

/// Puts the light into the document as MOZ_lightmap on materials and MX_lightmap on nodes.
void apply_lightmap_form(LitScene& lit, const LightInfo& info);

/// Puts the light into the document as unlit materials, one copy of a mesh for each placement.
/// The texture holds the colour that is shown.
void apply_unlit_form(LitScene& lit);

}  // namespace aglow::encode
