// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/devices.h"

#include <vulkan/vulkan.h>

#include <cstdint>

namespace aglow::vk {

/// What a device can draw with.
struct DrawingFeatures {
    bool draws = false;                ///< its queue draws, with dynamic rendering
    bool rendering_extension = false;  ///< and that takes an extension
    bool geometry_shader = false;
    bool tessellation_shader = false;
    bool transform_feedback = false;  ///< implies geometry_shader
    bool mesh_shader = false;
    bool shader_stores = false;   ///< vertex and fragment shaders can write to buffers
    bool sample_shading = false;  ///< fragment shaders can run for every sample
    bool lines = false;           ///< polygons can be drawn as their outlines
    uint64_t granularity = 1;     ///< bytes that keep images and buffers apart in memory
};

/// A device that a driver offers, and what opening it needs to know.
struct PhysicalDevice {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    GpuInfo info;
    uint32_t queue_family = 0;              ///< one that computes
    bool full_subgroups = false;            ///< they can be required of a kernel
    bool full_subgroups_extension = false;  ///< and that takes an extension
    bool fixed_subgroups = false;           ///< and of info.subgroup_size
    bool int64 = false;                     ///< shaders have 64-bit integers
    float timestamp_period = 0;             ///< ns; 0: the queue has no timestamps
    uint64_t timestamp_mask = 0;            ///< the bits of a timestamp that count
    uint64_t max_allocation_bytes = 0;      ///< of one piece of memory
    uint32_t max_group_size = 0;            ///< invocations
    DrawingFeatures drawing;
};

PhysicalDevice examine(VkPhysicalDevice handle);

/// Is `a` before `b` in list_gpus()?
bool better(const PhysicalDevice& a, const PhysicalDevice& b);

}  // namespace aglow::vk
