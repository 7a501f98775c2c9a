// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/buffers.h"

#include "aglow/scene/gltf/meshopt.h"
#include "aglow/scene/gltf/uri.h"

#include <fmt/format.h>

#include <algorithm>

namespace aglow::gltf {
namespace {

Result<bool> is_fallback(const Json& buffer) {
    AG_TRY(const Json meshopt, buffer.extension("EXT_meshopt_compression"));
    return meshopt.boolean("fallback", false);
}

Result<std::vector<uint8_t>> read_buffer(const Json& json, bool first,
                                         std::optional<std::span<const uint8_t>> binary,
                                         const std::filesystem::path& folder) {
    AG_TRY(const uint64_t length, json.required_size("byteLength"));
    AG_TRY(const bool fallback, is_fallback(json));
    if (fallback) return std::vector<uint8_t>();
    AG_TRY(const std::string uri, json.text("uri", ""));
    std::vector<uint8_t> bytes;
    if (json.has("uri")) {
        auto read = read_uri(uri, folder);
        if (!read) return fail(read.error().code, json.element() + ": " + read.error().message);
        bytes = std::move(*read);
    } else if (first && binary) {
        const size_t size = static_cast<size_t>(std::min<uint64_t>(length, binary->size()));
        bytes.assign(binary->begin(), binary->begin() + static_cast<ptrdiff_t>(size));
    } else {
        return json.wrong("has neither a uri nor a GLB chunk");
    }
    if (bytes.size() < length)
        return json.wrong(
            fmt::format("byteLength is {}, but there are {} bytes", length, bytes.size()));
    bytes.resize(static_cast<size_t>(length));
    return bytes;
}

/// Where a buffer view lies, before its bytes are at hand.
struct Range {
    size_t buffer = 0;
    size_t offset = 0;
    size_t length = 0;
    size_t stride = 0;
};

Result<Range> read_range(const Json& json, std::span<const uint64_t> lengths) {
    AG_TRY(const int buffer, json.required_index("buffer", lengths.size(), "buffer"));
    AG_TRY(const uint64_t offset, json.size("byteOffset", 0));
    AG_TRY(const uint64_t length, json.required_size("byteLength"));
    AG_TRY(const uint64_t stride, json.size("byteStride", 0));
    const uint64_t available = lengths[static_cast<size_t>(buffer)];
    if (offset > available || length > available - offset)
        return json.wrong(fmt::format("{} bytes from {} on exceed buffer {}, which has {}", length,
                                      offset, buffer, available));
    if (stride > available) return json.wrong("byteStride exceeds the buffer");
    return Range{static_cast<size_t>(buffer), static_cast<size_t>(offset),
                 static_cast<size_t>(length), static_cast<size_t>(stride)};
}

/// Reads the compressed twin of `range`. Its source must be a buffer that holds bytes.
Result<MeshoptBlock> read_meshopt(const Json& json, const Range& range,
                                  const std::vector<std::vector<uint8_t>>& buffers,
                                  std::span<const uint64_t> lengths,
                                  const std::vector<bool>& fallback) {
    AG_TRY(const Json extension, json.extension("EXT_meshopt_compression"));
    if (!extension.exists()) return json.wrong("lies in a fallback buffer but is not compressed");
    AG_TRY(const int buffer, extension.required_index("buffer", buffers.size(), "buffer"));
    if (fallback[static_cast<size_t>(buffer)])
        return json.wrong("compressed bytes lie in a fallback buffer");
    AG_TRY(const Range source, read_range(extension, lengths));
    MeshoptBlock block;
    AG_TRY(block.count, extension.required_size("count"));
    AG_TRY(block.mode, extension.text("mode", ""));
    AG_TRY(block.filter, extension.text("filter", "NONE"));
    block.stride = source.stride;
    block.bytes = std::span(buffers[source.buffer]).subspan(source.offset, source.length);
    if (block.stride == 0 || block.count > range.length / block.stride ||
        block.count * block.stride != range.length)
        return json.wrong("count * byteStride of the compressed data is not byteLength");
    AG_CHECK(check(block, json));
    return block;
}

struct Compressed {
    size_t view;
    MeshoptBlock block;
};

/// Fallback buffers grow to what their views fill: byteLength itself proves nothing.
Status allocate_fallbacks(std::span<const Compressed> compressed, std::span<const Json> views,
                          std::span<const Range> ranges,
                          std::vector<std::vector<uint8_t>>& buffers) {
    constexpr uint64_t kSlack = 1 << 16;  // bytes of padding a file may leave between its views
    std::vector<uint64_t> filled(buffers.size(), 0), end(buffers.size(), 0);
    for (const Compressed& c : compressed) {
        const Range& range = ranges[c.view];
        filled[range.buffer] += range.length;
        end[range.buffer] = std::max<uint64_t>(end[range.buffer], range.offset + range.length);
    }
    for (const Compressed& c : compressed) {
        const size_t buffer = ranges[c.view].buffer;
        if (end[buffer] > 2 * filled[buffer] + kSlack)
            return views[c.view].wrong(fmt::format("fallback buffer {} is mostly empty", buffer));
        buffers[buffer].resize(static_cast<size_t>(end[buffer]));
    }
    return {};
}

Status decompress(const Json& root, std::span<const Json> views, std::span<const Range> ranges,
                  std::vector<std::vector<uint8_t>>& buffers) {
    AG_TRY(const std::vector<Json> list, elements(root, "buffers", "buffer"));
    std::vector<bool> fallback;
    for (const Json& buffer : list) {
        AG_TRY(const bool missing, is_fallback(buffer));
        fallback.push_back(missing);
    }
    std::vector<uint64_t> lengths;
    lengths.reserve(buffers.size());
    for (const auto& buffer : buffers) lengths.push_back(buffer.size());
    std::vector<Compressed> compressed;
    for (size_t i = 0; i < views.size(); ++i) {
        if (!fallback[ranges[i].buffer]) continue;
        AG_TRY(MeshoptBlock block, read_meshopt(views[i], ranges[i], buffers, lengths, fallback));
        compressed.push_back({i, std::move(block)});
    }
    AG_CHECK(allocate_fallbacks(compressed, views, ranges, buffers));
    for (const Compressed& c : compressed) {
        const Range& range = ranges[c.view];
        const auto out = std::span(buffers[range.buffer]).subspan(range.offset, range.length);
        AG_CHECK(decode(c.block, out, views[c.view]));
    }
    return {};
}

}  // namespace

Result<std::vector<std::vector<uint8_t>>> read_buffers(
    const Json& root, std::optional<std::span<const uint8_t>> binary,
    const std::filesystem::path& folder) {
    AG_TRY(const std::vector<Json> list, elements(root, "buffers", "buffer"));
    std::vector<std::vector<uint8_t>> buffers;
    for (const Json& json : list) {
        AG_TRY(auto bytes, read_buffer(json, buffers.empty(), binary, folder));
        buffers.push_back(std::move(bytes));
    }
    return buffers;
}

Result<std::vector<BufferView>> read_buffer_views(const Json& root,
                                                  std::vector<std::vector<uint8_t>>& buffers) {
    AG_TRY(const std::vector<Json> buffer_list, elements(root, "buffers", "buffer"));
    std::vector<uint64_t> lengths;
    for (const Json& json : buffer_list) {
        AG_TRY(const uint64_t length, json.required_size("byteLength"));
        lengths.push_back(length);
    }
    AG_TRY(const std::vector<Json> list, elements(root, "bufferViews", "bufferView"));
    std::vector<Range> ranges;
    for (const Json& json : list) {
        AG_TRY(const Range range, read_range(json, lengths));
        ranges.push_back(range);
    }
    AG_CHECK(decompress(root, list, ranges, buffers));
    std::vector<BufferView> views;
    for (const Range& range : ranges) {
        const auto bytes = std::span<const uint8_t>(buffers[range.buffer]);
        views.push_back({bytes.subspan(range.offset, range.length), range.stride});
    }
    return views;
}

}  // namespace aglow::gltf
