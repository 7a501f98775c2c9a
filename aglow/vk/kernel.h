// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/devices.h"
#include "aglow/vk/handle.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace aglow::vk {

class KernelRate;  // what streams have measured of it

/// A compute shader. All it reads and writes arrives in one struct of push constants, at most 128
/// bytes of scalar layout, whose first member is `uint first_group`: a stream may run the groups of
/// one dispatch in several pieces and sets first_group for each. Shaders include
/// aglow/vk/kernel.glsl and call group_index() instead of reading gl_WorkGroupID.
/// Lifetime  when it dies its pipeline goes as soon as all work that was submitted has finished; it
///           must not die between a stream's run() and the submit.
class Kernel {
public:
    /// `constants[i]` is the value of constant_id i.
    /// Errors  unsupported (the device's compiler refuses it), out_of_memory.
    static Result<Kernel> create(const Gpu& gpu, std::string_view name,
                                 std::span<const uint32_t> spirv,
                                 std::span<const uint32_t> constants = {});
    Kernel(Kernel&&) noexcept;
    Kernel& operator=(Kernel&& other) noexcept;
    ~Kernel();

    const std::string& name() const { return name_; }
    VkPipeline pipeline() const { return owned_->pipeline.get(); }
    VkPipelineLayout layout() const { return owned_->layout.get(); }
    const std::shared_ptr<KernelRate>& rate() const { return rate_; }

private:
    struct Owned {
        PipelineLayout layout;
        Pipeline pipeline;
    };
    Kernel() = default;
    Gpu gpu_;
    std::string name_;
    std::shared_ptr<Owned> owned_;
    std::shared_ptr<KernelRate> rate_;
};

/// How many groups of `size` cover `count` items.
inline uint64_t group_count(uint64_t count, uint64_t size) { return (count + size - 1) / size; }

}  // namespace aglow::vk
