// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/handle.h"
#include "aglow/vk/memory_pool.h"

#include <cstdint>
#include <memory>
#include <utility>

namespace aglow::vk {

class Device;

struct ImageOptions {
    uint32_t width = 1, height = 1;
    VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< a depth format makes an image of depths
    uint32_t samples = 1;                             ///< of each pixel: 1, 2, 4, ...
};

/// A two-dimensional image that can be drawn into and copied. Move only. Lives and dies as Buffer
/// does; used by one stream at a time.
class Image {
public:
    Image() = default;  ///< no memory: width 0
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image&& other) noexcept {
        Image taken(std::move(other));
        swap(taken);
        return *this;
    }
    ~Image();

    uint32_t width() const { return owned_ ? owned_->options.width : 0; }
    uint32_t height() const { return owned_ ? owned_->options.height : 0; }
    VkFormat format() const { return owned_ ? owned_->options.format : VK_FORMAT_UNDEFINED; }
    uint32_t samples() const { return owned_ ? owned_->options.samples : 0; }
    VkImage get() const { return owned_ ? owned_->image.get() : VK_NULL_HANDLE; }
    VkImageView view() const { return owned_ ? owned_->view.get() : VK_NULL_HANDLE; }
    VkImageAspectFlags aspect() const;
    /// The layout in which what is recorded so far leaves it. Who records a change writes it here.
    VkImageLayout& layout() const { return owned_->layout; }

private:
    friend class Device;
    struct Owned {
        ~Owned();
        MemoryPool* pool = nullptr;
        ImageOptions options;
        Allocation allocation;
        ImageHandle image;
        ImageView view;
        VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    };
    void swap(Image& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(owned_, other.owned_);
    }

    Device* device_ = nullptr;
    std::shared_ptr<Owned> owned_;
};

/// Bytes of one pixel (one sample of it) of the formats that images have here; 0: another format.
uint32_t pixel_bytes(VkFormat format);
bool is_depth(VkFormat format);

}  // namespace aglow::vk
