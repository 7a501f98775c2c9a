// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/image.h"

#include "aglow/vk/device.h"
#include "aglow/vk/failure.h"

#include <fmt/format.h>

#include <algorithm>

namespace aglow::vk {

namespace {

VkImageCreateInfo image_info(const ImageOptions& options) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = options.format;
    info.extent = {options.width, options.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = static_cast<VkSampleCountFlagBits>(options.samples);
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                 (is_depth(options.format) ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                           : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    return info;
}

/// Can the device make such an image, and blend what is drawn into it?
Status check_support(VkPhysicalDevice device, const ImageOptions& options, std::string_view name) {
    VkImageCreateInfo info = image_info(options);
    VkImageFormatProperties limits;
    VkResult result = vkGetPhysicalDeviceImageFormatProperties(
        device, info.format, info.imageType, info.tiling, info.usage, info.flags, &limits);
    VkFormatProperties format;
    vkGetPhysicalDeviceFormatProperties(device, options.format, &format);
    bool blends = is_depth(options.format) ||
                  (format.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT);
    if (result != VK_SUCCESS || !blends) {
        return fail(Errc::unsupported,
                    fmt::format("image \"{}\": this GPU cannot draw into images of format {}", name,
                                static_cast<int>(options.format)));
    }
    if (!(limits.sampleCounts & options.samples)) {
        return fail(Errc::unsupported,
                    fmt::format("image \"{}\": this GPU cannot draw {} samples of a pixel", name,
                                options.samples));
    }
    if (options.width > limits.maxExtent.width || options.height > limits.maxExtent.height) {
        return fail(Errc::unsupported,
                    fmt::format("image \"{}\" has {} x {} pixels; this GPU draws {} x {} at most",
                                name, options.width, options.height, limits.maxExtent.width,
                                limits.maxExtent.height));
    }
    return {};
}

Result<ImageView> make_view(VkDevice device, VkImage image, VkFormat format,
                            VkImageAspectFlags aspect, std::string_view doing) {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.subresourceRange = {aspect, 0, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    VkResult result = vkCreateImageView(device, &info, nullptr, &view);
    if (result != VK_SUCCESS) return failure(result, doing);
    return ImageView(device, view);
}

}  // namespace

uint32_t pixel_bytes(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R32G32B32A32_SFLOAT:
            return 16;
        case VK_FORMAT_R16G16B16A16_SFLOAT:
            return 8;
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R32_SFLOAT:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_D32_SFLOAT:
            return 4;
        default:
            return 0;
    }
}

bool is_depth(VkFormat format) { return format == VK_FORMAT_D32_SFLOAT; }

Image::Owned::~Owned() {
    view = {};
    image = {};  // before the memory that it is bound to
    if (allocation.block) pool->free(allocation);
}

Image::~Image() {
    if (owned_) device_->retire(std::move(owned_));
}

VkImageAspectFlags Image::aspect() const {
    return is_depth(format()) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

Result<Image> Device::make_image(const ImageOptions& options, std::string_view name) {
    if (allocation_count_++ == faults_.fail_allocation) {
        return fail(Errc::out_of_memory,
                    fmt::format("image \"{}\" needs GPU memory, and tests ask that there is none; "
                                "{} bytes are in use",
                                name, bytes_in_use()));
    }
    reap();
    AG_CHECK(check_support(physical_.handle, options, name));
    std::string doing = fmt::format("making image \"{}\"", name);
    VkImageCreateInfo info = image_info(options);
    VkImage handle = VK_NULL_HANDLE;
    VkResult result = vkCreateImage(device_, &info, nullptr, &handle);
    if (result != VK_SUCCESS) return failure(result, doing);
    Image image;
    image.device_ = this;
    image.owned_ = std::make_shared<Image::Owned>();
    Image::Owned& owned = *image.owned_;
    owned.pool = pool_.get();
    owned.options = options;
    owned.image = ImageHandle(device_, handle);
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_, handle, &needs);
    // Buffers may lie next to it in memory, but not in the same piece of `granularity` bytes.
    uint64_t grain = physical_.drawing.granularity;
    needs.alignment = std::max(needs.alignment, grain);
    needs.size = (needs.size + grain - 1) / grain * grain;
    AG_TRY(owned.allocation, pool_->allocate(needs, Memory::device, name, "image"));
    result = vkBindImageMemory(device_, handle, owned.allocation.memory, owned.allocation.offset);
    if (result != VK_SUCCESS) return failure(result, doing);
    AG_TRY(owned.view, make_view(device_, handle, options.format, image.aspect(), doing));
    set_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(handle), name);
    return image;
}

}  // namespace aglow::vk
