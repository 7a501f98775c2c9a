// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/geometry.h"

namespace aglow::builtin {

TextureImage painted(std::string name, int width, int height,
                     const std::function<vec3(float, float)>& color) {
    TextureImage image;
    image.name = std::move(name);
    image.width = width;
    image.height = height;
    image.rgba.reserve(static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
    const auto byte = [](float linear) {
        return static_cast<uint8_t>(linear_to_srgb(linear) * 255 + 0.5f);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const vec3 c = color((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                 (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
            image.rgba.insert(image.rgba.end(), {byte(c.x), byte(c.y), byte(c.z), 255});
        }
    return image;
}

}  // namespace aglow::builtin
