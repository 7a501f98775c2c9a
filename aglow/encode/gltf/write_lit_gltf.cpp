// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/assert.h"
#include "aglow/core/file.h"
#include "aglow/encode/gltf/forms.h"
#include "aglow/encode/gltf/light_coding.h"
#include "aglow/encode/gltf/unlit_picture.h"
#include "aglow/encode/lit_gltf.h"
#include "aglow/scene/gltf/edit/guard.h"
#include "aglow/scene/gltf/edit/pack.h"
#include "aglow/scene/gltf/edit/scene_files.h"
#include "aglow/scene/image_file.h"

namespace aglow {
namespace {

namespace fs = std::filesystem;
using encode::Json;

/// The files that stand beside each other under one stem.
struct Names {
    encode::SceneFiles scene;
    fs::path exr, png, manifest;
};

Result<Names> names_of(const fs::path& path, LitForm form) {
    AG_TRY(auto scene, encode::scene_files(path));
    const auto beside = [&](const char* tail) {
        return path.parent_path() / (path.stem().string() + tail);
    };
    const char* png = form == LitForm::unlit ? ".unlit.png" : ".lightmap.png";
    return Names{std::move(scene), beside(".exr"), beside(png), beside(".manifest.json")};
}

std::string text_of(const fs::path& path) { return path.filename().string(); }

Result<Json> manifest(const Names& names, const Atlas& atlas, const Texels& texels,
                      const encode::CodedLight& coded, const LitOptions& options) {
    const Json settings = Json::parse(options.json_settings, nullptr, false);
    if (settings.is_discarded())
        return fail(Errc::bad_argument, "the settings for the manifest are no JSON");
    Json files = {{"scene", text_of(names.scene.scene)},
                  {"exr", text_of(names.exr)},
                  {"png", text_of(names.png)}};
    if (!names.scene.binary) files["buffer"] = text_of(names.scene.buffer);
    const bool unlit = options.form == LitForm::unlit;
    Json json = {{"generator", "Aglow"},
                 {"quantity", "irradiance"},
                 {"units", "lux"},
                 {"color_space", "linear Rec. 709"},
                 {"form", unlit ? "unlit" : "lightmap"},
                 {"encoding", {{"exr", "linear, 32-bit float, lux"}}}};
    if (unlit) {
        json["encoding"]["png"] = "8-bit sRGB, 2^exposure_ev * luminance / reference_white";
        json["exposure_ev"] = options.exposure_ev;
        json["reference_white"] = kReferenceWhite;
    } else {
        json["encoding"]["png"] = "8-bit sRGB, lux = intensity * linear texel";
        json["intensity"] = coded.intensity;
        json["clipped_share"] = coded.clipped_share;
    }
    json["texel_size_m"] = atlas.texel_size;
    json["atlas"] = {atlas.width, atlas.height};
    json["texels"] = texels.element_count();
    json["charts"] = atlas.chart_count;
    json["files"] = std::move(files);
    json["method"] = options.method;
    json["settings"] = settings;
    return json;
}

struct Light {
    encode::CodedLight coded;  ///< of the lightmap, whatever the form
    std::vector<uint8_t> png;  ///< what the scene's texture shows
};

Result<Light> code(const Scene& scene, const Surfaces& surfaces, const Texels& texels,
                   const Lightmap& lightmap, const LitOptions& options) {
    Light light;
    if (options.form == LitForm::unlit) {
        AG_TRY(light.png,
               encode::unlit_picture(scene, surfaces, texels, lightmap, options.exposure_ev));
    } else {
        AG_TRY(light.coded, encode::code_light(lightmap));
        light.png = light.coded.png;
    }
    return light;
}

Result<LitFiles> write(const Scene& scene, const Surfaces& surfaces, const Atlas& atlas,
                       const Texels& texels, const Lightmap& lightmap, const fs::path& path,
                       const LitOptions& options) {
    AG_TRY(const Names names, names_of(path, options.form));
    AG_TRY(auto lit, encode::open_lit_scene(scene, atlas));
    AG_CHECK(encode::protect_input(scene, lit.document, names.scene,
                                   {names.exr, names.png, names.manifest}));
    AG_TRY(const Light light, code(scene, surfaces, texels, lightmap, options));
    AG_TRY(const Json about, manifest(names, atlas, texels, light.coded, options));

    encode::add_light_texture(lit, light.png,
                              names.scene.binary ? "" : encode::to_uri(text_of(names.png)));
    if (options.form == LitForm::unlit) {
        encode::apply_unlit_form(lit);
    } else {
        encode::apply_lightmap_form(lit,
                                    {light.coded.intensity, text_of(names.exr), atlas.texel_size});
    }
    encode::OutputSet outputs;
    AG_CHECK(encode::add_scene(lit.document, names.scene, outputs));
    AG_CHECK(outputs.add(names.exr,
                         [&](const fs::path& to) { return write_image(lightmap.irradiance, to); }));
    AG_CHECK(outputs.add(names.png, light.png));
    AG_CHECK(outputs.add(names.manifest, encode::bytes_of(encode::to_text(about, 2) + "\n")));
    AG_TRY(auto written, outputs.commit());
    return LitFiles{std::move(written), light.coded.clipped_share, light.coded.intensity};
}

}  // namespace

Result<LitFiles> write_lit_gltf(const Scene& scene, const Surfaces& surfaces, const Atlas& atlas,
                                const Texels& texels, const Lightmap& lightmap,
                                const fs::path& path, const LitOptions& options) {
    AG_ASSERT(lightmap.irradiance.width == atlas.width, "the lightmap is the atlas's");
    AG_ASSERT(lightmap.irradiance.height == atlas.height, "the lightmap is the atlas's");
    return encode::guarded(scene, path, [&] {
        return write(scene, surfaces, atlas, texels, lightmap, path, options);
    });
}

}  // namespace aglow
