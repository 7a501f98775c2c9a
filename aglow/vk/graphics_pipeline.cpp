// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/graphics_pipeline.h"

#include "aglow/core/assert.h"
#include "aglow/vk/device.h"
#include "aglow/vk/failure.h"
#include "aglow/vk/kernel_rate.h"
#include "aglow/vk/shader_module.h"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

namespace aglow::vk {

namespace {

constexpr uint32_t kPushBytes = 128;  // every device has as many

uint32_t vertices_of(const GraphicsState& state) {
    switch (state.topology) {
        case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
            return 1;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
            return 2;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
            return 3;
        case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
            return 4;
        case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
            return 6;
        case VK_PRIMITIVE_TOPOLOGY_PATCH_LIST:
            return state.patch_points;
        default:
            return 0;
    }
}

/// What the pipeline takes of the device beyond drawing as such.
Status check_features(const Device& device, std::string_view name, const GraphicsShaders& shaders,
                      const GraphicsState& state) {
    const DrawingFeatures& has = device.physical().drawing;
    const char* lacks = nullptr;
    if (!shaders.geometry.empty() && !has.geometry_shader) lacks = "geometry shaders";
    if (!shaders.tessellation_control.empty() && !has.tessellation_shader)
        lacks = "tessellation shaders";
    if (!shaders.mesh.empty() && !has.mesh_shader) lacks = "mesh shaders";
    bool captures =
        state.target.color == VK_FORMAT_UNDEFINED && state.target.depth == VK_FORMAT_UNDEFINED;
    if (captures && !has.transform_feedback) lacks = "transform feedback";
    if (state.lines && !has.lines) lacks = "outlines of polygons";
    if (!lacks) return {};
    return fail(Errc::unsupported, fmt::format("pipeline \"{}\" needs {}, which GPU \"{}\" lacks",
                                               name, lacks, device.info().name));
}

/// Modules and what refers to them while a pipeline is made.
class Stages {
public:
    explicit Stages(std::span<const uint32_t> constants) {
        for (uint32_t i = 0; i < constants.size(); ++i) entries_.push_back({i, i * 4, 4});
        values_.mapEntryCount = static_cast<uint32_t>(entries_.size());
        values_.pMapEntries = entries_.data();
        values_.dataSize = constants.size_bytes();
        values_.pData = constants.data();
    }
    Stages(const Stages&) = delete;
    Stages& operator=(const Stages&) = delete;
    ~Stages() = default;

    Status add(VkDevice device, VkShaderStageFlagBits stage, std::span<const uint32_t> spirv,
               std::string_view doing) {
        if (spirv.empty()) return {};
        AG_TRY(ShaderModule module, make_module(device, spirv, doing));
        VkPipelineShaderStageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage = stage;
        info.module = module.get();
        info.pName = "main";
        info.pSpecializationInfo = entries_.empty() ? nullptr : &values_;
        infos_.push_back(info);
        modules_.push_back(std::move(module));
        flags_ |= stage;
        return {};
    }
    const std::vector<VkPipelineShaderStageCreateInfo>& infos() const { return infos_; }
    VkShaderStageFlags flags() const { return flags_; }

private:
    std::vector<VkSpecializationMapEntry> entries_;
    VkSpecializationInfo values_{};
    std::vector<ShaderModule> modules_;
    std::vector<VkPipelineShaderStageCreateInfo> infos_;
    VkShaderStageFlags flags_ = 0;
};

VkPipelineColorBlendAttachmentState blending(Blend blend) {
    VkPipelineColorBlendAttachmentState state{};
    state.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                           VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    state.blendEnable = blend == Blend::over;
    state.srcColorBlendFactor = state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    state.dstColorBlendFactor = state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    state.colorBlendOp = state.alphaBlendOp = VK_BLEND_OP_ADD;
    return state;
}

Result<Pipeline> make_pipeline(VkDevice device, VkPipelineLayout layout, const Stages& stages,
                               const GraphicsState& state, bool shade_samples,
                               std::string_view doing) {
    const TargetFormat& target = state.target;
    bool colors = target.color != VK_FORMAT_UNDEFINED;
    bool depths = target.depth != VK_FORMAT_UNDEFINED;

    // Vertices: read by address, so there are no attributes.
    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = state.topology;
    VkPipelineTessellationStateCreateInfo patches{};
    patches.sType = VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO;
    patches.patchControlPoints = state.patch_points;

    // From triangles to samples. The part of the picture is set when drawing.
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.rasterizerDiscardEnable = !colors && !depths;
    raster.polygonMode = state.lines ? VK_POLYGON_MODE_LINE : VK_POLYGON_MODE_FILL;
    raster.cullMode = state.cull;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = static_cast<VkSampleCountFlagBits>(target.samples);
    samples.sampleShadingEnable = shade_samples;
    samples.minSampleShading = 1;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = depths;
    depth.depthWriteEnable = depths && state.write_depth;
    depth.depthCompareOp = state.nearer;

    // Into the images.
    VkPipelineColorBlendAttachmentState attachment = blending(state.blend);
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = colors;
    blend.pAttachments = &attachment;
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = colors;
    rendering.pColorAttachmentFormats = &target.color;
    rendering.depthAttachmentFormat = target.depth;
    std::array dynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo set_later{};
    set_later.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    set_later.dynamicStateCount = static_cast<uint32_t>(dynamic.size());
    set_later.pDynamicStates = dynamic.data();

    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.stageCount = static_cast<uint32_t>(stages.infos().size());
    info.pStages = stages.infos().data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pTessellationState = &patches;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &set_later;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkResult result =
        vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
    if (result != VK_SUCCESS) return pipeline_failure(result, doing);
    return Pipeline(device, pipeline);
}

}  // namespace

GraphicsPipeline::GraphicsPipeline(GraphicsPipeline&&) noexcept = default;
GraphicsPipeline& GraphicsPipeline::operator=(GraphicsPipeline&& other) noexcept {
    GraphicsPipeline taken(std::move(other));
    std::swap(gpu_, taken.gpu_);
    std::swap(name_, taken.name_);
    std::swap(stages_, taken.stages_);
    std::swap(target_, taken.target_);
    std::swap(primitive_vertices_, taken.primitive_vertices_);
    std::swap(owned_, taken.owned_);
    std::swap(rate_, taken.rate_);
    return *this;
}
GraphicsPipeline::~GraphicsPipeline() {
    if (owned_) gpu_->retire(std::move(owned_));
}

Result<GraphicsPipeline> GraphicsPipeline::create(const Gpu& gpu, std::string_view name,
                                                  const GraphicsShaders& shaders,
                                                  const GraphicsState& state) {
    AG_CHECK(gpu->check_drawing());
    AG_CHECK(check_features(*gpu, name, shaders, state));
    std::string doing = fmt::format("compiling pipeline \"{}\"", name);
    VkDevice device = gpu->get();
    Stages stages(state.constants);
    const std::array<std::pair<VkShaderStageFlagBits, std::span<const uint32_t>>, 6> all{{
        {VK_SHADER_STAGE_VERTEX_BIT, shaders.vertex},
        {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, shaders.tessellation_control},
        {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, shaders.tessellation_evaluation},
        {VK_SHADER_STAGE_GEOMETRY_BIT, shaders.geometry},
        {VK_SHADER_STAGE_MESH_BIT_EXT, shaders.mesh},
        {VK_SHADER_STAGE_FRAGMENT_BIT, shaders.fragment},
    }};
    for (const auto& [stage, spirv] : all) AG_CHECK(stages.add(device, stage, spirv, doing));
    AG_ASSERT(shaders.vertex.empty() != shaders.mesh.empty(),
              "a pipeline has either a vertex or a mesh shader");

    GraphicsPipeline pipeline;
    pipeline.gpu_ = gpu;
    pipeline.name_ = name;
    pipeline.stages_ = stages.flags();
    pipeline.target_ = state.target;
    pipeline.primitive_vertices_ = vertices_of(state);
    pipeline.owned_ = std::make_shared<Owned>();
    AG_TRY(pipeline.owned_->layout, make_layout(device, stages.flags(), kPushBytes, doing));
    AG_TRY(pipeline.owned_->pipeline,
           make_pipeline(device, pipeline.layout(), stages, state,
                         state.sample_shading && gpu->physical().drawing.sample_shading, doing));
    pipeline.rate_ = std::make_shared<KernelRate>();
    gpu->set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(pipeline.pipeline()), name);
    return pipeline;
}

}  // namespace aglow::vk
