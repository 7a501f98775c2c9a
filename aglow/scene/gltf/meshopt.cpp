// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace aglow::gltf {
namespace {

bool is_stride_valid(const MeshoptBlock& block) {
    if (block.mode == "ATTRIBUTES")
        return block.stride % 4 == 0 && block.stride >= 4 && block.stride <= 256;
    return block.stride == 2 || block.stride == 4;
}

bool is_filter_valid(const MeshoptBlock& block) {
    if (block.filter == "NONE") return true;
    if (block.mode != "ATTRIBUTES") return false;
    if (block.filter == "OCTAHEDRAL") return block.stride == 4 || block.stride == 8;
    if (block.filter == "QUATERNION") return block.stride == 8;
    return block.filter == "EXPONENTIAL";  // whose stride is a multiple of 4 as for all attributes
}

/// The codecs spend at least two bits on 16 bytes of attributes and a byte on a triangle, so that
/// a short block cannot ask for much memory.
bool can_hold(const MeshoptBlock& block) {
    constexpr size_t kMaxRatio = 64;
    constexpr size_t kTailBytes = 1 << 14;
    return block.count * block.stride <= kMaxRatio * block.bytes.size() + kTailBytes;
}

int run_decoder(const MeshoptBlock& block, void* out) {
    const uint8_t* bytes = block.bytes.data();
    const size_t size = block.bytes.size();
    if (block.mode == "ATTRIBUTES")
        return meshopt_decodeVertexBuffer(out, block.count, block.stride, bytes, size);
    if (block.mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(out, block.count, block.stride, bytes, size);
    return meshopt_decodeIndexSequence(out, block.count, block.stride, bytes, size);
}

}  // namespace

Status check(const MeshoptBlock& block, const Json& owner) {
    if (block.mode != "ATTRIBUTES" && block.mode != "TRIANGLES" && block.mode != "INDICES")
        return owner.wrong(fmt::format("compression mode \"{}\" does not exist", block.mode));
    if (!is_stride_valid(block))
        return owner.wrong(fmt::format("byteStride {} does not fit compression mode {}",
                                       block.stride, block.mode));
    if (!is_filter_valid(block))
        return owner.wrong(fmt::format("filter \"{}\" does not fit mode {} and byteStride {}",
                                       block.filter, block.mode, block.stride));
    if (block.mode == "TRIANGLES" && block.count % 3 != 0)
        return owner.wrong("count of compressed triangle indices is not a multiple of 3");
    if (!can_hold(block)) return owner.wrong("compressed data is too short for its count");
    return {};
}

Status decode(const MeshoptBlock& block, std::span<uint8_t> out, const Json& owner) {
    if (block.count == 0) return {};
    if (run_decoder(block, out.data()) != 0) return owner.wrong("compressed data does not decode");
    if (block.filter == "OCTAHEDRAL")
        meshopt_decodeFilterOct(out.data(), block.count, block.stride);
    if (block.filter == "QUATERNION")
        meshopt_decodeFilterQuat(out.data(), block.count, block.stride);
    if (block.filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(out.data(), block.count, block.stride);
    return {};
}

}  // namespace aglow::gltf
