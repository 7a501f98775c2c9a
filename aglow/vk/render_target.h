// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/devices.h"
#include "aglow/vk/image.h"

#include <cstdint>
#include <string_view>

namespace aglow::vk {

/// What is drawn into. VK_FORMAT_UNDEFINED: no such image.
struct TargetFormat {
    VkFormat color = VK_FORMAT_UNDEFINED;
    VkFormat depth = VK_FORMAT_UNDEFINED;
    uint32_t samples = 1;

    bool operator==(const TargetFormat&) const = default;
};

/// Colours without upper bound with depths: 32 bits for each of red, green, blue and alpha where
/// the device blends such, 16 otherwise; as many samples of a pixel as it takes, `samples` at most.
TargetFormat hdr_format(const Device& device, uint32_t samples);

/// Images to draw into together.
/// Lifetime  must not die between being recorded in a stream and the submit.
class RenderTarget {
public:
    /// Errors  unsupported (the device cannot draw, or not such images), out_of_memory.
    static Result<RenderTarget> create(const Gpu& gpu, uint32_t width, uint32_t height,
                                       const TargetFormat& format, std::string_view name);

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    const TargetFormat& format() const { return format_; }
    const Image& color() const { return color_; }
    const Image& depth() const { return depth_; }
    /// Means of the samples of each pixel, once Stream::read() has made them; color() where there
    /// is one sample.
    const Image& resolved() const { return format_.samples > 1 ? resolved_ : color_; }
    /// Of one row of pixels, as Stream::read() writes them.
    uint64_t row_bytes() const { return uint64_t{width_} * pixel_bytes(format_.color); }

private:
    RenderTarget() = default;
    uint32_t width_ = 0, height_ = 0;
    TargetFormat format_;
    Image color_, depth_, resolved_;
};

}  // namespace aglow::vk
