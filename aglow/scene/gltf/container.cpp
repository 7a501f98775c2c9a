// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/container.h"

#include <fmt/format.h>

#include <algorithm>

namespace aglow::gltf {
namespace {

constexpr uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr uint32_t kBinChunk = 0x004E4942;   // "BIN"
constexpr size_t kHeaderBytes = 12;
constexpr size_t kChunkHeaderBytes = 8;

uint32_t read_u32(std::span<const uint8_t> bytes, size_t at) {
    return static_cast<uint32_t>(bytes[at]) | static_cast<uint32_t>(bytes[at + 1]) << 8 |
           static_cast<uint32_t>(bytes[at + 2]) << 16 | static_cast<uint32_t>(bytes[at + 3]) << 24;
}

struct Chunk {
    uint32_t type;
    std::span<const uint8_t> bytes;
};

/// Takes one chunk off the front of `rest`.
Result<Chunk> next_chunk(std::span<const uint8_t>& rest) {
    if (rest.size() < kChunkHeaderBytes)
        return fail(Errc::malformed, "GLB is cut off in a chunk header");
    const size_t length = read_u32(rest, 0);
    const uint32_t type = read_u32(rest, 4);
    rest = rest.subspan(kChunkHeaderBytes);
    if (length > rest.size())
        return fail(Errc::malformed,
                    fmt::format("GLB chunk of {} bytes is cut off after {}", length, rest.size()));
    const Chunk chunk{type, rest.first(length)};
    rest = rest.subspan(std::min(rest.size(), (length + 3) / 4 * 4));
    return chunk;
}

Result<Container> split_glb(std::span<const uint8_t> bytes) {
    if (bytes.size() < kHeaderBytes) return fail(Errc::malformed, "GLB header is cut off");
    const uint32_t version = read_u32(bytes, 4);
    if (version != 2)
        return fail(Errc::unsupported, fmt::format("GLB version {} is not supported", version));
    const size_t length = read_u32(bytes, 8);
    if (length > bytes.size() || length < kHeaderBytes)
        return fail(Errc::malformed,
                    fmt::format("GLB header says {} bytes, the file has {}", length, bytes.size()));
    auto rest = bytes.subspan(kHeaderBytes, length - kHeaderBytes);

    AG_TRY(const Chunk json, next_chunk(rest));
    if (json.type != kJsonChunk) return fail(Errc::malformed, "first GLB chunk is not JSON");
    Container container{std::string(json.bytes.begin(), json.bytes.end()), std::nullopt};
    // Chunks of other types may follow and are to be ignored.
    while (!rest.empty() && !container.binary) {
        AG_TRY(const Chunk chunk, next_chunk(rest));
        if (chunk.type == kBinChunk) container.binary = chunk.bytes;
    }
    return container;
}

}  // namespace

bool is_glb(std::span<const uint8_t> bytes) {
    return bytes.size() >= 4 && read_u32(bytes, 0) == kMagic;
}

bool is_json(std::span<const uint8_t> bytes) {
    size_t i = 0;
    if (bytes.size() >= 3 && bytes[0] == 0xEF && bytes[1] == 0xBB && bytes[2] == 0xBF) i = 3;
    while (i < bytes.size() && (bytes[i] == ' ' || (bytes[i] >= '\t' && bytes[i] <= '\r'))) ++i;
    return i < bytes.size() && bytes[i] == '{';
}

Result<Container> split(std::span<const uint8_t> bytes) {
    if (is_glb(bytes)) return split_glb(bytes);
    return Container{std::string(bytes.begin(), bytes.end()), std::nullopt};
}

}  // namespace aglow::gltf
