// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/assert.h"
#include "aglow/vk/device.h"
#include "aglow/vk/stream.h"
#include "aglow/vk/stream_state.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace aglow::vk {

namespace {

/// Orders all that was done with the image before what the stage does with it, in that layout.
void prepare(VkCommandBuffer commands, const Image& image, VkImageLayout layout,
             VkPipelineStageFlags stage, VkAccessFlags access) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = access;
    barrier.oldLayout = image.layout();
    barrier.newLayout = layout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.get();
    barrier.subresourceRange = {image.aspect(), 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, stage, 0, 0, nullptr, 0,
                         nullptr, 1, &barrier);
    image.layout() = layout;
}

VkRenderingAttachmentInfo attachment(const Image& image, const VkClearValue* clear) {
    VkRenderingAttachmentInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    info.imageView = image.view();
    info.imageLayout = image.layout();
    info.loadOp = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    if (clear) info.clearValue = *clear;
    return info;
}

struct Clear {
    VkClearValue color{}, depth{};
};

void set_area(VkCommandBuffer commands, uint32_t width, uint32_t height) {
    // Of negative height: clip space then has y upwards.
    VkViewport viewport{
        0, static_cast<float>(height), static_cast<float>(width), -static_cast<float>(height), 0,
        1};
    VkRect2D all{{0, 0}, {width, height}};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &all);
}

/// What is recorded next draws into the target.
void begin_drawing(RecordTarget& record, PFN_vkCmdBeginRendering begin, const RenderTarget& target,
                   const Clear* clear) {
    const Image& color = target.color();
    const Image& depth = target.depth();
    VkImageView view = color.view() ? color.view() : depth.view();
    if (record.drawing == view && !clear) return;
    record.end_drawing();
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea.extent = {target.width(), target.height()};
    info.layerCount = 1;
    VkRenderingAttachmentInfo color_info, depth_info;
    if (color.view()) {
        prepare(record.commands, color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
        color_info = attachment(color, clear ? &clear->color : nullptr);
        info.colorAttachmentCount = 1;
        info.pColorAttachments = &color_info;
    }
    if (depth.view()) {
        prepare(
            record.commands, depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
            VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
            VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT);
        depth_info = attachment(depth, clear ? &clear->depth : nullptr);
        info.pDepthAttachment = &depth_info;
    }
    begin(record.commands, &info);
    set_area(record.commands, target.width(), target.height());
    record.drawing = view;
}

void bind(RecordTarget& record, const GraphicsPipeline& pipeline, std::span<const std::byte> args) {
    if (record.bound != pipeline.pipeline()) {
        vkCmdBindPipeline(record.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.pipeline());
        record.bound = pipeline.pipeline();
    }
    vkCmdPushConstants(record.commands, pipeline.layout(), pipeline.stages(), 0,
                       static_cast<uint32_t>(args.size()), args.data());
}

/// How a draw is cut: its "groups" are primitives.
struct DrawWork {
    uint64_t primitives = 0;  // of an instance
    uint64_t vertices = 0;    // of a primitive; 0: instances stay whole
    uint64_t groups = 0, grain = 1;
};

DrawWork work_of(const GraphicsPipeline& pipeline, const Draw& draw) {
    DrawWork work;
    work.vertices = pipeline.primitive_vertices();
    work.primitives = work.vertices > 0 ? draw.vertex_count / work.vertices : draw.vertex_count;
    work.groups = work.primitives * draw.instance_count;
    if (draw.whole || draw.instance_count > 1 || work.vertices == 0)
        work.grain = std::max(draw.whole ? work.groups : work.primitives, uint64_t{1});
    return work;
}

void record_piece(VkCommandBuffer commands, const Draw& draw, const DrawWork& work, uint64_t first,
                  uint64_t count) {
    Draw piece = draw;
    if (work.grain > 1) {
        piece.first_instance += static_cast<uint32_t>(first / work.primitives);
        piece.instance_count = static_cast<uint32_t>(count / work.primitives);
    } else if (draw.instance_count == 1 && work.vertices > 0) {
        piece.first_vertex += static_cast<uint32_t>(first * work.vertices);
        piece.vertex_count = static_cast<uint32_t>(count * work.vertices);
    } else {  // instances of one primitive
        piece.first_instance += static_cast<uint32_t>(first);
        piece.instance_count = static_cast<uint32_t>(count);
    }
    if (draw.indices) {
        vkCmdBindIndexBuffer(commands, draw.indices->get(), 0, VK_INDEX_TYPE_UINT32);
        vkCmdDrawIndexed(commands, piece.vertex_count, piece.instance_count, piece.first_vertex, 0,
                         piece.first_instance);
    } else {
        vkCmdDraw(commands, piece.vertex_count, piece.instance_count, piece.first_vertex,
                  piece.first_instance);
    }
}

}  // namespace

void Stream::draw_bytes(const GraphicsPipeline& pipeline, const RenderTarget& target,
                        std::span<const std::byte> args, const Draw& draw) {
    AG_ASSERT(pipeline.target() == target.format(), "pipelines are made for their targets");
    DrawWork work = work_of(pipeline, draw);
    PFN_vkCmdBeginRendering begin = gpu()->drawing().begin;
    auto record = [&](RecordTarget& into, uint64_t first, uint64_t count) {
        begin_drawing(into, begin, target, nullptr);
        bind(into, pipeline, args);
        record_piece(into.commands, draw, work, first, count);
    };
    state_->recorder->run(
        {pipeline.name(), pipeline.rate(), work.groups, work.grain, UINT32_MAX, true}, record);
}

void Stream::draw_groups_bytes(const GraphicsPipeline& pipeline, const RenderTarget& target,
                               std::span<const std::byte> args, uint64_t groups) {
    AG_ASSERT(pipeline.target() == target.format(), "pipelines are made for their targets");
    AG_ASSERT(groups <= UINT32_MAX, "first_group has 32 bits");
    std::array<std::byte, 128> push{};
    std::copy(args.begin(), args.end(), push.begin());
    const DrawingCommands& commands = gpu()->drawing();
    auto record = [&](RecordTarget& into, uint64_t first, uint64_t count) {
        uint32_t first_group = static_cast<uint32_t>(first);
        std::memcpy(push.data(), &first_group, sizeof first_group);
        begin_drawing(into, commands.begin, target, nullptr);
        bind(into, pipeline, std::span<const std::byte>(push.data(), args.size()));
        commands.draw_groups(into.commands, static_cast<uint32_t>(count), 1, 1);
    };
    Work work{pipeline.name(), pipeline.rate(), groups};
    work.draws = true;
    state_->recorder->run(work, record);
}

void Stream::capture_bytes(const GraphicsPipeline& pipeline, std::span<const std::byte> args,
                           const Draw& draw, const Capture& capture) {
    DrawWork work = work_of(pipeline, draw);
    AG_ASSERT(capture.offset + work.groups * capture.primitive_bytes <= capture.to.size(),
              "what is captured stays in its buffer");
    const DrawingCommands& commands = gpu()->drawing();
    VkRenderingInfo nothing{};
    nothing.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    nothing.renderArea.extent = {1, 1};
    nothing.layerCount = 1;
    auto record = [&](RecordTarget& into, uint64_t first, uint64_t count) {
        VkBuffer buffer = capture.to.get();
        uint64_t offset = capture.offset + first * capture.primitive_bytes;
        uint64_t bytes = count * capture.primitive_bytes;
        bind(into, pipeline, args);
        commands.bind_capture(into.commands, 0, 1, &buffer, &offset, &bytes);
        commands.begin(into.commands, &nothing);
        set_area(into.commands, 1, 1);
        commands.begin_capture(into.commands, 0, 0, nullptr, nullptr);
        record_piece(into.commands, draw, work, first, count);
        commands.end_capture(into.commands, 0, 0, nullptr, nullptr);
        commands.end(into.commands);
    };
    state_->recorder->run({pipeline.name(), pipeline.rate(), work.groups, work.grain, UINT32_MAX},
                          record);
}

void Stream::clear(const RenderTarget& target, const std::array<float, 4>& color, float depth) {
    Clear clear;
    std::copy(color.begin(), color.end(), clear.color.color.float32);
    clear.depth.depthStencil.depth = depth;
    const TargetFormat& format = target.format();
    uint64_t pixel = pixel_bytes(format.color) + pixel_bytes(format.depth);
    uint64_t bytes = pixel * format.samples * target.width() * target.height();
    uint64_t groups = group_count(bytes, kCopyUnit);
    PFN_vkCmdBeginRendering begin = gpu()->drawing().begin;
    auto record = [&](RecordTarget& into, uint64_t, uint64_t) {
        begin_drawing(into, begin, target, &clear);
    };
    state_->recorder->run({"clear", state_->clear_rate, groups, groups, groups, true}, record);
}

void Stream::read(const RenderTarget& target, const Buffer& to, uint64_t to_offset) {
    AG_ASSERT(to_offset + target.row_bytes() * target.height() <= to.size(),
              "pictures stay in their buffers");
    uint64_t bytes = target.row_bytes() * target.format().samples * target.height();
    uint64_t groups = group_count(bytes, kCopyUnit);
    auto record = [&](RecordTarget& into, uint64_t, uint64_t) {
        const Image& color = target.color();
        const Image& pixels = target.resolved();
        VkExtent3D extent{target.width(), target.height(), 1};
        prepare(into.commands, color, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
        if (color.samples() > 1) {
            prepare(into.commands, pixels, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                    VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
            VkImageResolve region{};
            region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.extent = extent;
            vkCmdResolveImage(into.commands, color.get(), color.layout(), pixels.get(),
                              pixels.layout(), 1, &region);
            prepare(into.commands, pixels, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                    VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
        }
        VkBufferImageCopy region{};
        region.bufferOffset = to_offset;
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = extent;
        vkCmdCopyImageToBuffer(into.commands, pixels.get(), pixels.layout(), to.get(), 1, &region);
    };
    state_->recorder->run({"read", state_->read_rate, groups, groups, groups}, record);
}

}  // namespace aglow::vk
