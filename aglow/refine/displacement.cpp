// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/displacement.h"

#include "aglow/core/assert.h"
#include "aglow/scene/image_file.h"

#include <algorithm>
#include <cmath>

namespace aglow {
namespace {

/// PNG and JPEG are read as colours that are coded for the eye; heights are not.
bool is_coded(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

float of_level(const HeightMap& map, vec2 uv, uint32_t level) {
    const shared::TexelQuad q = shared::texel_quad(map.levels, uv, level, 1);
    const auto texel = [&](uint32_t i) { return map.texels[i]; };
    return shared::mix(shared::mix(texel(q.upper_left), texel(q.upper_right), q.right),
                       shared::mix(texel(q.lower_left), texel(q.lower_right), q.right), q.down);
}

}  // namespace

Result<HeightMap> read_height_map(const std::filesystem::path& path) {
    AG_TRY(const Image image, read_image(path));
    const bool coded = is_coded(path);
    std::vector<float> heights;
    heights.reserve(image.pixels.size());
    for (const vec3 pixel : image.pixels)
        heights.push_back(coded ? linear_to_srgb(pixel.x) : pixel.x);
    return make_height_map(heights, image.width, image.height);
}

HeightMap make_height_map(std::span<const float> heights, int width, int height) {
    AG_ASSERT(width > 0 && height > 0, "a map with texels");
    AG_ASSERT(heights.size() == static_cast<size_t>(width) * static_cast<size_t>(height),
              "one height per texel");
    HeightMap map;
    map.levels = {.first_texel = 0,
                  .width = width,
                  .height = height,
                  .level_count = 1,
                  .wrap_s = shared::kWrapRepeat,
                  .wrap_t = shared::kWrapRepeat,
                  .nearest = 0,
                  .srgb = 0};
    map.texels.assign(heights.begin(), heights.end());
    size_t from = 0;
    while (width > 1 || height > 1) {
        const int w = std::max(width / 2, 1), h = std::max(height / 2, 1);
        const size_t to = map.texels.size();
        const auto texel = [&](int x, int y) {
            const size_t row = static_cast<size_t>(std::min(y, height - 1));
            return map.texels[from + row * static_cast<size_t>(width) +
                              static_cast<size_t>(std::min(x, width - 1))];
        };
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                map.texels.push_back(0.25f *
                                     (texel(2 * x, 2 * y) + texel(2 * x + 1, 2 * y) +
                                      texel(2 * x, 2 * y + 1) + texel(2 * x + 1, 2 * y + 1)));
        from = to;
        width = w;
        height = h;
        ++map.levels.level_count;
    }
    return map;
}

float sample(const HeightMap& map, vec2 uv, float level) {
    const float most = static_cast<float>(map.levels.level_count - 1);
    const float at = std::clamp(level, 0.0f, most);
    const auto lower = static_cast<uint32_t>(at);
    const float rest = at - static_cast<float>(lower);
    const float height = of_level(map, uv, lower);
    return rest > 0 ? shared::mix(height, of_level(map, uv, lower + 1), rest) : height;
}

float fitting_level(const HeightMap& map, const Topology& topology, std::span<const vec2> uvs,
                    int segments) {
    AG_ASSERT(uvs.size() == topology.half_edge_count(), "coordinates for every corner");
    double texels = 0;
    for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
        const vec2 along = uvs[topology.next(h)] - uvs[h];
        texels += double(std::hypot(along.x * static_cast<float>(map.levels.width),
                                    along.y * static_cast<float>(map.levels.height)));
    }
    const double steps = double(segments) * std::max<double>(topology.half_edge_count(), 1);
    return static_cast<float>(std::max(0.0, std::log2(std::max(texels / steps, 1.0))));
}

}  // namespace aglow
