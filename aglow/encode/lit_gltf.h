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

/// Luminance that the unlit form shows as full white at exposure 0, cd/m^2.
inline constexpr float kReferenceWhite = 100;

struct LitOptions {
    LitForm form = LitForm::lightmap;
    /// Of the unlit form: display value = 2^EV * luminance / kReferenceWhite, clipped at 1.
    float exposure_ev = 0;
    std::string method;                ///< solver, for the manifest
    std::string json_settings = "{}";  ///< the options used, for the manifest
};

struct LitFiles {
    std::vector<std::filesystem::path> outputs;  ///< all files written, the scene first
    double clipped_share = 0;  ///< of the covered texels whose value exceeds what the PNG can hold
    double intensity = 1;      ///< lux that the PNG's white stands for (lightmap form)
};

/// Writes the lit scene: OUT.glb (or OUT.gltf with OUT.bin), OUT.exr (full range irradiance, lux),
/// OUT.lightmap.png (sRGB-coded, E = intensity * texel; OUT.unlit.png in the unlit form) and
/// OUT.manifest.json. A .glb holds the PNG too and stands alone; a .gltf names it. Starts from the
/// scene's GltfSource where there is one, so that all the input held is kept; adds second UVs
/// (TEXCOORD_1, or the next set where a material reads that one; vertices split as unwrap() asked),
/// the texture and the extensions of docs/formats/lightmap.md. Images that a .gltf names are copied
/// where its folder differs from that of the input.
///
/// Shapes  surfaces, texels and lightmap are those of `atlas`.
/// Result  All files appear together, or none is left behind.
/// Errors  bad_argument  another ending than .glb or .gltf, settings that are no JSON, more than
///                       4 GiB in a .glb, an output that would overwrite a file of the input
///         malformed     the source has data that loading did not need and that is damaged
///         unreadable    cannot write
///         out_of_memory
/// Repeat  same bytes for the same input.
Result<LitFiles> write_lit_gltf(const Scene& scene, const Surfaces& surfaces, const Atlas& atlas,
                                const Texels& texels, const Lightmap& lightmap,
                                const std::filesystem::path& path, const LitOptions& options);

/// The light of a lit scene.
struct Lit {
    Image irradiance;  ///< lux
    Atlas atlas;
};

/// Reads back the light of a lit scene, `scene` as loaded from `path`: the full-range EXR named in
/// the extras, or intensity * PNG (with a warning in scene.warnings) where the EXR is gone or
/// damaged. Fills Primitive::lightmap_uvs from the UV set that the extensions name, and the
/// atlas's placements from MX_lightmap, so that pose(scene, time, &atlas) gives texel coordinates.
///
/// Also reads files of others that carry MOZ_lightmap alone; their texture is taken as sRGB-coded.
/// Errors  bad_argument  the scene carries no light
///         malformed     an extension names what does not exist, or an EXR outside the folder
///         unsupported   more than one lightmap
///         out_of_memory
Result<Lit> read_lit_gltf(Scene& scene, const std::filesystem::path& path);

}  // namespace aglow
