// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/textures.h"

#include "aglow/core/parallel.h"
#include "aglow/scene/gltf/image.h"
#include "aglow/scene/gltf/uri.h"

#include <fmt/format.h>

#include <set>

namespace aglow::gltf {
namespace {

Result<Wrap> read_wrap(const Json& json, const char* key) {
    AG_TRY(const uint64_t code, json.size(key, 10497));
    switch (code) {
        case 10497:
            return Wrap::repeat;
        case 33071:
            return Wrap::clamp_to_edge;
        case 33648:
            return Wrap::mirrored_repeat;
        default:
            return json.wrong(fmt::format("{} {} does not exist", key, code));
    }
}

Status read_sampler(const Json& json, Texture& texture) {
    AG_TRY(texture.wrap_s, read_wrap(json, "wrapS"));
    AG_TRY(texture.wrap_t, read_wrap(json, "wrapT"));
    AG_TRY(const uint64_t filter, json.size("magFilter", 9729));
    if (filter != 9728 && filter != 9729)
        return json.wrong(fmt::format("magFilter {} does not exist", filter));
    texture.filter = filter == 9728 ? Filter::nearest : Filter::linear;
    return {};
}

Result<std::vector<Texture>> read_samplers(const Json& root) {
    AG_TRY(const std::vector<Json> list, elements(root, "samplers", "sampler"));
    std::vector<Texture> samplers;
    for (const Json& json : list) {
        Texture sampler;
        AG_CHECK(read_sampler(json, sampler));
        samplers.push_back(sampler);
    }
    return samplers;
}

/// The image of `texture` that can be decoded: its WebP one first, as the extension wants.
Result<int> choose_image(const Json& texture, const EncodedImages& images) {
    const size_t count = images.bytes.size();
    AG_TRY(const int source, texture.index("source", count, "image"));
    AG_TRY(const Json webp, texture.extension("EXT_texture_webp"));
    AG_TRY(const int webp_source, webp.index("source", count, "image"));
    AG_TRY(const Json basisu, texture.extension("KHR_texture_basisu"));
    AG_TRY([[maybe_unused]] const int unread, basisu.index("source", count, "image"));
    return webp_source >= 0 ? webp_source : source;
}

void mark(const TextureRef& reference, std::span<const Texture> textures, std::vector<bool>& used) {
    if (reference.texture < 0) return;
    const int image = textures[static_cast<size_t>(reference.texture)].image;
    if (image >= 0) used[static_cast<size_t>(image)] = true;
}

/// Images grow with their files, but a tiny one may still decode to millions of pixels.
Status check_total(const EncodedImages& images, const std::vector<bool>& used) {
    constexpr uint64_t kFreePixels = 1 << 26;
    constexpr uint64_t kPixelsPerByte = 8192;  // of one-bit PNG at the best ratio of deflate
    uint64_t pixels = 0, bytes = 0;
    std::set<const uint8_t*> counted;  // many images may share the bytes of one view
    for (size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        AG_TRY(const ImageSize size, image_size(images.bytes[i], images.elements[i]));
        pixels += static_cast<uint64_t>(size.width) * static_cast<uint64_t>(size.height);
        if (counted.insert(images.bytes[i].data()).second) bytes += images.bytes[i].size();
        if (pixels > kFreePixels + kPixelsPerByte * bytes)
            return fail(Errc::out_of_memory, images.elements[i] +
                                                 ": decodes to far more pixels than its file has "
                                                 "bytes");
    }
    return {};
}

}  // namespace

Result<EncodedImages> read_images(const Json& root, std::span<const BufferView> views,
                                  const std::filesystem::path& folder) {
    AG_TRY(const std::vector<Json> list, elements(root, "images", "image"));
    EncodedImages images;
    images.files.resize(list.size());
    for (size_t i = 0; i < list.size(); ++i) {
        const Json& json = list[i];
        AG_TRY(const int view, json.index("bufferView", views.size(), "bufferView"));
        AG_TRY(const std::string uri, json.text("uri", ""));
        AG_TRY(std::string name, json.text("name", ""));
        if (json.has("uri") && view >= 0) return json.wrong("has both a uri and a bufferView");
        if (json.has("uri")) {
            auto file = read_uri(uri, folder);
            if (!file) return fail(file.error().code, json.element() + ": " + file.error().message);
            images.files[i] = std::move(*file);
        }
        images.bytes.push_back(view >= 0 ? views[static_cast<size_t>(view)].bytes
                                         : std::span<const uint8_t>(images.files[i]));
        images.elements.push_back(json.element());
        images.names.push_back(std::move(name));
    }
    return images;
}

Result<std::vector<Texture>> read_textures(const Json& root, const EncodedImages& images) {
    AG_TRY(const std::vector<Texture> samplers, read_samplers(root));
    AG_TRY(const std::vector<Json> list, elements(root, "textures", "texture"));
    std::vector<Texture> textures;
    for (const Json& json : list) {
        AG_TRY(const int sampler, json.index("sampler", samplers.size(), "sampler"));
        Texture texture = sampler < 0 ? Texture() : samplers[static_cast<size_t>(sampler)];
        AG_TRY(texture.image, choose_image(json, images));
        textures.push_back(texture);
    }
    return textures;
}

Result<std::vector<TextureImage>> decode_used_images(const EncodedImages& images,
                                                     std::span<const Texture> textures,
                                                     std::span<const Material> materials) {
    std::vector<bool> used(images.bytes.size(), false);
    for (const Material& material : materials) {
        mark(material.base_color_texture, textures, used);
        mark(material.metallic_roughness_texture, textures, used);
        mark(material.emissive_texture, textures, used);
    }
    AG_CHECK(check_total(images, used));
    std::vector<Result<TextureImage>> decoded(used.size());
    parallel_for(used.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            if (used[i]) decoded[i] = decode_image(images.bytes[i], images.elements[i]);
    });
    std::vector<TextureImage> result;
    for (size_t i = 0; i < decoded.size(); ++i) {
        AG_TRY(TextureImage image, std::move(decoded[i]));
        image.name = images.names[i];
        result.push_back(std::move(image));
    }
    return result;
}

}  // namespace aglow::gltf
