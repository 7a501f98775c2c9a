// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/encode/lightmap.h"
#include "aglow/mesh/unwrap.h"
#include "aglow/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace aglow {

enum class LitForm : uint8_t {
    lightmap,  ///< MOZ_lightmap on materials and MX_lightmap on nodes
    unlit,  ///< base colour x light in one texture under KHR_materials_unlit: any viewer shows it
};

struct LitOptions {
    LitForm form = LitForm::lightmap;
    float exposure_ev =
        0;               ///< of the unlit form: display value = 2^EV * luminance / reference white
    std::string method;  ///< solver, for the manifest
    std::string json_settings = "{}";  ///< the options used, for the manifest
};

struct LitFiles {
    std::vector<std::filesystem::path> outputs;  ///< all files written, the scene first
    double clipped_share = 0;  ///< of the covered texels whose value exceeds what the PNG can hold
};

/// Writes the lit scene: OUT.glb (or OUT.gltf with OUT.bin), OUT.exr (full range irradiance, lux),
/// OUT.lightmap.png (sRGB-coded, E = intensity * texel) and OUT.manifest.json. Starts from the
/// scene's GltfSource where there is one, so that all the input held is kept; adds second UVs
/// (TEXCOORD_1, vertices split as unwrap() asked), the texture and the extensions of
/// docs/formats/lightmap.md. Errors  unreadable (cannot write; nothing is left behind),
/// out_of_memory.
Result<LitFiles> write_lit_gltf(const Scene& scene, const Surfaces& surfaces, const Atlas& atlas,
                                const Texels& texels, const Lightmap& lightmap,
                                const std::filesystem::path& path, const LitOptions& options);

/// Reads back the light of a lit scene written by write_lit_gltf: the full-range EXR named in
/// the extras, or intensity * PNG where the EXR is gone; fills Primitive::lightmap_uvs of `scene`
/// from TEXCOORD_1 and `atlas` from MX_lightmap.
struct Lit {
    Image irradiance;  ///< lux
    Atlas atlas;
};
/// Errors  malformed, unreadable; bad_argument where the scene carries no light.
Result<Lit> read_lit_gltf(Scene& scene, const std::filesystem::path& path);

}  // namespace aglow
