// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/devices.h"
#include "aglow/vk/handle.h"
#include "aglow/vk/render_target.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace aglow::vk {

class KernelRate;  // what streams have measured of it

/// SPIR-V of each stage; empty: the pipeline does without. Read by create() only.
struct GraphicsShaders {
    std::span<const uint32_t> vertex = {};
    std::span<const uint32_t> tessellation_control = {}, tessellation_evaluation = {};
    std::span<const uint32_t> geometry = {};
    std::span<const uint32_t> mesh = {};      ///< instead of all above: see Stream::draw_groups()
    std::span<const uint32_t> fragment = {};  ///< none: no colours are drawn
};

enum class Blend : uint8_t {
    none,
    over,  ///< colours that are multiplied by their alpha, over what is there
};

struct GraphicsState {
    TargetFormat target;  ///< no images: nothing is drawn, Stream::capture() keeps the vertices
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;  ///< not of mesh shaders
    uint32_t patch_points = 3;                   ///< of VK_PRIMITIVE_TOPOLOGY_PATCH_LIST
    VkCullModeFlags cull = VK_CULL_MODE_NONE;    ///< fronts run counter-clockwise as seen
    VkCompareOp nearer = VK_COMPARE_OP_GREATER;  ///< which depths are drawn over which
    bool write_depth = true;
    Blend blend = Blend::none;
    /// Fragment shaders run for every sample, where the device can do that.
    bool sample_shading = false;
    bool lines = false;                     ///< outlines of polygons
    std::span<const uint32_t> constants{};  ///< [i] is the value of constant_id i, in all stages
};

/// Shaders that draw. Vertices come from no vertex buffers: the vertex stage reads what it needs by
/// address with gl_VertexIndex and gl_InstanceIndex. All that a draw reads arrives in one struct of
/// push constants, at most 128 bytes of scalar layout, that every stage sees.
/// Conventions  clip space as Vulkan has it but with y upwards; fronts run counter-clockwise as
///              they are seen in the picture. Depth is 1 near and 0 far, unless `nearer` says
///              otherwise: floating point so keeps its precision where it is needed.
/// Lifetime     as vk::Kernel.
class GraphicsPipeline {
public:
    /// Errors  unsupported (the device cannot draw, lacks a stage, or refuses a shader),
    ///         out_of_memory.
    static Result<GraphicsPipeline> create(const Gpu& gpu, std::string_view name,
                                           const GraphicsShaders& shaders,
                                           const GraphicsState& state);
    GraphicsPipeline(GraphicsPipeline&&) noexcept;
    GraphicsPipeline& operator=(GraphicsPipeline&& other) noexcept;
    ~GraphicsPipeline();

    const std::string& name() const { return name_; }
    VkPipeline pipeline() const { return owned_->pipeline.get(); }
    VkPipelineLayout layout() const { return owned_->layout.get(); }
    VkShaderStageFlags stages() const { return stages_; }
    const TargetFormat& target() const { return target_; }
    /// Vertices of one primitive; 0: a strip or fan, whose primitives share vertices.
    uint32_t primitive_vertices() const { return primitive_vertices_; }
    const std::shared_ptr<KernelRate>& rate() const { return rate_; }

private:
    struct Owned {
        PipelineLayout layout;
        Pipeline pipeline;
    };
    GraphicsPipeline() = default;
    Gpu gpu_;
    std::string name_;
    VkShaderStageFlags stages_ = 0;
    TargetFormat target_;
    uint32_t primitive_vertices_ = 0;
    std::shared_ptr<Owned> owned_;
    std::shared_ptr<KernelRate> rate_;
};

}  // namespace aglow::vk
