// SPDX-License-Identifier: Apache-2.0
// Materials, textures and images.
#include "aglow/scene/glb/builder.h"
#include "aglow/scene/image_file.h"

#include <algorithm>

namespace aglow::glb {
namespace {

constexpr int kNearest = 9728, kLinear = 9729, kLinearMipmapLinear = 9987;

int wrap_code(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return 10497;
        case Wrap::mirrored_repeat:
            return 33648;
        case Wrap::clamp_to_edge:
            break;
    }
    return 33071;
}

void put_texture(Builder& glb, Json& owner, const char* key, const TextureRef& reference) {
    if (reference.texture < 0) return;
    Json out = {{"index", reference.texture}};
    if (reference.texcoord != 0) out["texCoord"] = reference.texcoord;
    const TextureRef plain;
    if (reference.offset != plain.offset || reference.scale != plain.scale ||
        reference.rotation != plain.rotation)
        glb.use(out, "KHR_texture_transform") = {{"offset", to_json(reference.offset)},
                                                 {"rotation", reference.rotation},
                                                 {"scale", to_json(reference.scale)}};
    owner[key] = std::move(out);
}

Json json_of(Builder& glb, const Material& material) {
    Json out = Json::object();
    put_name(out, material.name);
    Json& pbr = out["pbrMetallicRoughness"];
    pbr = {{"baseColorFactor", to_json(material.base_color)},
           {"metallicFactor", material.metallic},
           {"roughnessFactor", material.roughness}};
    put_texture(glb, pbr, "baseColorTexture", material.base_color_texture);
    put_texture(glb, pbr, "metallicRoughnessTexture", material.metallic_roughness_texture);
    put_texture(glb, out, "normalTexture", material.normal_texture);
    put_texture(glb, out, "emissiveTexture", material.emissive_texture);
    const vec3 e = material.emission;
    const float strength = std::max({e.x, e.y, e.z, 1.0f});  // factors may not exceed 1
    if (e != vec3{0, 0, 0}) out["emissiveFactor"] = to_json(e / strength);
    if (strength > 1)
        glb.use(out, "KHR_materials_emissive_strength")["emissiveStrength"] = strength;
    if (material.unlit) glb.use(out, "KHR_materials_unlit") = Json::object();
    if (material.alpha_mode == AlphaMode::blend) out["alphaMode"] = "BLEND";
    if (material.alpha_mode == AlphaMode::mask) {
        out["alphaMode"] = "MASK";
        out["alphaCutoff"] = material.alpha_cutoff;
    }
    if (material.double_sided) out["doubleSided"] = true;
    return out;
}

Status add_images(Builder& glb, const Scene& scene) {
    for (const TextureImage& image : scene.images) {
        const std::vector<uint8_t> png = encode_png(image.rgba, image.width, image.height, 4);
        if (png.empty()) return fail(Errc::out_of_memory, "images do not fit into memory");
        Json out = Json::object();
        put_name(out, image.name);
        out["mimeType"] = "image/png";
        out["bufferView"] = glb.add_view(png.data(), png.size());
        glb.json["images"].push_back(std::move(out));
    }
    return {};
}

}  // namespace

void add_materials(Builder& glb, const Scene& scene) {
    for (const Material& material : scene.materials)
        glb.json["materials"].push_back(json_of(glb, material));
}

Status add_textures(Builder& glb, const Scene& scene) {
    for (const Texture& texture : scene.textures) {
        const bool smooth = texture.filter == Filter::linear;
        glb.json["samplers"].push_back({{"magFilter", smooth ? kLinear : kNearest},
                                        {"minFilter", smooth ? kLinearMipmapLinear : kNearest},
                                        {"wrapS", wrap_code(texture.wrap_s)},
                                        {"wrapT", wrap_code(texture.wrap_t)}});
        Json out = {{"sampler", glb.json["samplers"].size() - 1}};
        if (texture.image >= 0) out["source"] = texture.image;
        glb.json["textures"].push_back(std::move(out));
    }
    return add_images(glb, scene);
}

}  // namespace aglow::glb
