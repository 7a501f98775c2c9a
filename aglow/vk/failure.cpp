// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/failure.h"

#include <fmt/format.h>

namespace aglow::vk {

tl::unexpected<Error> failure(VkResult result, std::string_view doing) {
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return fail(Errc::out_of_memory,
                        fmt::format("the machine's memory is full while {}", doing));
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return fail(Errc::out_of_memory,
                        fmt::format("the GPU's memory is full while {}", doing));
        case VK_ERROR_EXTENSION_NOT_PRESENT:
        case VK_ERROR_FEATURE_NOT_PRESENT:
        case VK_ERROR_LAYER_NOT_PRESENT:
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return fail(Errc::unsupported,
                        fmt::format("the driver lacks what is needed (Vulkan error {}) while {}",
                                    static_cast<int>(result), doing));
        case VK_ERROR_DEVICE_LOST:
            return fail(Errc::device_lost,
                        fmt::format("the GPU stopped working while {}; what it held is gone, "
                                    "so run again, or on another device",
                                    doing));
        default:
            return fail(Errc::device_lost,
                        fmt::format("the driver failed (Vulkan error {}) while {}",
                                    static_cast<int>(result), doing));
    }
}

}  // namespace aglow::vk
