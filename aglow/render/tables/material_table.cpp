// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/image.h"
#include "aglow/render/tables/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace aglow::render {
namespace {

std::array<float, 256> linear_of_srgb() {
    std::array<float, 256> table{};
    for (size_t i = 0; i < table.size(); ++i)
        table[i] = srgb_to_linear(static_cast<float>(i) / 255.0f);
    return table;
}

/// One mip level as linear values; alpha is linear in any coding.
struct Level {
    int width, height;
    std::vector<vec4> texels;

    const vec4& at(int x, int y) const {
        return texels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
};

Level full_level(const TextureImage& image, bool srgb) {
    const std::array<float, 256> decoded = linear_of_srgb();
    const auto color = [&](uint8_t v) { return srgb ? decoded[v] : static_cast<float>(v) / 255; };
    Level level{image.width, image.height, {}};
    level.texels.reserve(image.rgba.size() / 4);
    for (size_t i = 0; i + 3 < image.rgba.size(); i += 4)
        level.texels.push_back({color(image.rgba[i]), color(image.rgba[i + 1]),
                                color(image.rgba[i + 2]),
                                static_cast<float>(image.rgba[i + 3]) / 255});
    return level;
}

/// Mean of the texels that texel i of a side of half the length covers: two, or of an odd length
/// three with the outer ones shared between neighbours.
struct Taps {
    int first, count;
    float weight[3];
};

Taps taps_of(int i, int length) {
    if (length == 1) return {0, 1, {1, 0, 0}};
    if (length % 2 == 0) return {2 * i, 2, {0.5f, 0.5f, 0}};
    // The polyphase box filter: half = (length - 1) / 2 texels cover `length`.
    const float half = static_cast<float>(length / 2), whole = static_cast<float>(length);
    const float at = static_cast<float>(i);
    return {2 * i, 3, {(half - at) / whole, half / whole, (at + 1) / whole}};
}

Level half_level(const Level& level) {
    Level half{std::max(1, level.width / 2), std::max(1, level.height / 2), {}};
    half.texels.reserve(static_cast<size_t>(half.width) * static_cast<size_t>(half.height));
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            const Taps across = taps_of(x, level.width), down = taps_of(y, level.height);
            vec4 sum{0, 0, 0, 0};
            for (int k = 0; k < down.count; ++k)
                for (int i = 0; i < across.count; ++i)
                    sum = sum + level.at(across.first + i, down.first + k) *
                                    (across.weight[i] * down.weight[k]);
            half.texels.push_back(sum);
        }
    return half;
}

uint32_t byte_of(float value) {
    return static_cast<uint32_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
}

void append(const Level& level, bool srgb, std::vector<uint32_t>& texels) {
    const auto color = [&](float v) { return byte_of(srgb ? linear_to_srgb(v) : v); };
    for (const vec4& t : level.texels)
        texels.push_back(color(t.x) | color(t.y) << 8 | color(t.z) << 16 | byte_of(t.w) << 24);
}

uint32_t shared_wrap(Wrap wrap) {
    switch (wrap) {
        case Wrap::mirrored_repeat:
            return shared::kWrapMirrored;
        case Wrap::clamp_to_edge:
            return shared::kWrapClamp;
        case Wrap::repeat:
            break;
    }
    return shared::kWrapRepeat;
}

/// Fills a MaterialTable, each image once in each coding that it is read in.
class Builder {
public:
    explicit Builder(const Scene& scene) : scene_(scene) {}

    shared::SurfaceMaterial material(const Material& m) {
        shared::SurfaceMaterial result{};
        result.base_color = m.base_color;
        result.emission = m.unlit ? vec3{0, 0, 0} : m.emission;
        result.metallic = m.metallic;
        result.roughness = m.roughness;
        result.alpha_cutoff = m.alpha_cutoff;
        result.flags = (m.unlit ? shared::kMaterialUnlit : 0u) |
                       (m.double_sided ? shared::kMaterialDoubleSided : 0u) |
                       (m.alpha_mode == AlphaMode::mask ? shared::kMaterialMask : 0u) |
                       (m.alpha_mode == AlphaMode::blend ? shared::kMaterialBlend : 0u);
        result.base_color_texture = use(m.base_color_texture, true);
        result.metallic_roughness_texture = use(m.metallic_roughness_texture, false);
        result.emissive_texture = use(m.emissive_texture, true);
        return result;
    }

    MaterialTable table;

private:
    struct Pyramid {
        uint32_t first_texel, level_count;
    };

    shared::TextureUse use(const TextureRef& reference, bool srgb) {
        shared::TextureUse result{};
        result.texture = shared::kNoTexture;
        if (reference.texture < 0) return result;
        result.texture = texture(reference.texture, srgb);
        result.texcoord = static_cast<uint32_t>(reference.texcoord);
        // KHR_texture_transform: scale, then rotate, then offset. V points down in glTF images, so
        // a counter-clockwise turn of the UVs takes (1, 0) to (0, -1).
        const float c = std::cos(reference.rotation), s = std::sin(reference.rotation);
        result.to_s = {c * reference.scale.x, s * reference.scale.y};
        result.to_t = {-s * reference.scale.x, c * reference.scale.y};
        result.offset = reference.offset;
        return result;
    }

    uint32_t texture(int index, bool srgb) {
        const auto [known, fresh] = texture_of_.try_emplace({index, srgb}, shared::kNoTexture);
        if (!fresh) return known->second;
        const Texture& texture = scene_.textures[static_cast<size_t>(index)];
        if (texture.image < 0) return shared::kNoTexture;
        const TextureImage& image = scene_.images[static_cast<size_t>(texture.image)];
        if (image.rgba.empty()) return shared::kNoTexture;
        const Pyramid pyramid = pyramid_of(texture.image, srgb);
        known->second = static_cast<uint32_t>(table.textures.size());
        table.textures.push_back({pyramid.first_texel, image.width, image.height,
                                  pyramid.level_count, shared_wrap(texture.wrap_s),
                                  shared_wrap(texture.wrap_t),
                                  texture.filter == Filter::nearest ? 1u : 0u, srgb ? 1u : 0u});
        return known->second;
    }

    Pyramid pyramid_of(int index, bool srgb) {
        const auto [known, fresh] = pyramid_of_.try_emplace({index, srgb}, Pyramid{});
        if (!fresh) return known->second;
        Level level = full_level(scene_.images[static_cast<size_t>(index)], srgb);
        Pyramid pyramid{static_cast<uint32_t>(table.texels.size()), 1};
        append(level, srgb, table.texels);
        for (; level.width > 1 || level.height > 1; ++pyramid.level_count) {
            level = half_level(level);
            append(level, srgb, table.texels);
        }
        return known->second = pyramid;
    }

    const Scene& scene_;
    std::map<std::pair<int, bool>, uint32_t> texture_of_;
    std::map<std::pair<int, bool>, Pyramid> pyramid_of_;
};

}  // namespace

MaterialTable material_table(const Scene& scene) {
    Builder builder(scene);
    std::vector<shared::SurfaceMaterial> materials;
    for (const Material& m : scene.materials) materials.push_back(builder.material(m));
    // glTF's default material is fully metallic; for light, a surface without one is white.
    Material white;
    white.metallic = 0;
    materials.push_back(builder.material(white));
    builder.table.materials = std::move(materials);
    return std::move(builder.table);
}

}  // namespace aglow::render
