// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/render_target.h"

#include "aglow/vk/device.h"

#include <fmt/format.h>

namespace aglow::vk {

namespace {

/// The sample counts of such images, bits as VkSampleCountFlagBits; 0: it cannot draw into them.
VkSampleCountFlags sample_counts(VkPhysicalDevice device, VkFormat format) {
    VkFormatProperties features;
    vkGetPhysicalDeviceFormatProperties(device, format, &features);
    bool depth = is_depth(format);
    VkFormatFeatureFlags needed = depth ? VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT
                                        : VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    if (!(features.optimalTilingFeatures & needed)) return 0;
    VkImageUsageFlags usage =
        depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    VkImageFormatProperties limits;
    VkResult result = vkGetPhysicalDeviceImageFormatProperties(
        device, format, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL, usage, 0, &limits);
    return result == VK_SUCCESS ? limits.sampleCounts : 0;
}

}  // namespace

TargetFormat hdr_format(const Device& device, uint32_t samples) {
    VkPhysicalDevice physical = device.physical().handle;
    TargetFormat format{VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_D32_SFLOAT, samples};
    VkSampleCountFlags wide = sample_counts(physical, format.color);
    VkSampleCountFlags half = sample_counts(physical, VK_FORMAT_R16G16B16A16_SFLOAT);
    if (!(wide & samples) && (wide == 0 || (half & samples)))
        format.color = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkSampleCountFlags counts =
        sample_counts(physical, format.color) & sample_counts(physical, format.depth);
    while (format.samples > 1 && !(counts & format.samples)) format.samples /= 2;
    return format;
}

Result<RenderTarget> RenderTarget::create(const Gpu& gpu, uint32_t width, uint32_t height,
                                          const TargetFormat& format, std::string_view name) {
    AG_CHECK(gpu->check_drawing());
    RenderTarget target;
    target.width_ = width;
    target.height_ = height;
    target.format_ = format;
    ImageOptions options{width, height, format.color, format.samples};
    if (format.color != VK_FORMAT_UNDEFINED) {
        AG_TRY(target.color_, gpu->make_image(options, fmt::format("{} colours", name)));
    }
    if (format.depth != VK_FORMAT_UNDEFINED) {
        options.format = format.depth;
        AG_TRY(target.depth_, gpu->make_image(options, fmt::format("{} depths", name)));
    }
    if (format.color != VK_FORMAT_UNDEFINED && format.samples > 1) {
        options = {width, height, format.color, 1};
        AG_TRY(target.resolved_, gpu->make_image(options, fmt::format("{} pixels", name)));
    }
    return target;
}

}  // namespace aglow::vk
