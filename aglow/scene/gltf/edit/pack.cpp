// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/pack.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>

namespace aglow::gltf::edit {
namespace {

/// Runs start at multiples of this in the source and in the result, so that data stays aligned.
constexpr size_t kAlignment = 8;

size_t align_up(size_t value) { return (value + kAlignment - 1) / kAlignment * kAlignment; }

/// A run of bytes of a source buffer and where it goes.
struct Run {
    size_t begin = 0, end = 0;
    size_t target = 0;
};

size_t member(const Json& view, const char* key) {
    const auto found = view.find(key);
    return found == view.end() ? 0 : found->get<size_t>();
}

/// The runs of one buffer that bufferViews show, disjoint and in order.
std::vector<Run> live_runs(const Document& document, size_t buffer, size_t size) {
    if (!document.may_reuse) return {{0, size}};
    std::vector<Run> runs;
    for (const Json& view : list_of(document.json, "bufferViews")) {
        if (member(view, "buffer") != buffer) continue;
        const size_t begin = member(view, "byteOffset");
        runs.push_back({begin / kAlignment * kAlignment, begin + member(view, "byteLength")});
    }
    std::ranges::sort(runs, {}, &Run::begin);
    std::vector<Run> merged;
    for (const Run& run : runs) {
        if (!merged.empty() && run.begin <= align_up(merged.back().end)) {
            merged.back().end = std::max(merged.back().end, run.end);
        } else {
            merged.push_back(run);
        }
    }
    return merged;
}

void copy_run(std::span<const uint8_t> source, Run& run, std::vector<uint8_t>& out) {
    out.resize(align_up(out.size()));
    run.target = out.size();
    out.resize(run.target + (run.end - run.begin));
    const size_t begin = std::min(run.begin, source.size());
    const size_t end = std::min(run.end, source.size());
    std::copy(source.begin() + static_cast<ptrdiff_t>(begin),
              source.begin() + static_cast<ptrdiff_t>(end),
              out.begin() + static_cast<ptrdiff_t>(run.target));
}

size_t new_offset(const std::vector<Run>& runs, size_t offset) {
    const auto after = std::ranges::upper_bound(runs, offset, {}, &Run::begin);
    if (after == runs.begin()) return offset;
    const Run& run = *std::prev(after);
    return run.target + (offset - run.begin);
}

void append_word(std::vector<uint8_t>& out, size_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        out.push_back(static_cast<uint8_t>((value >> shift) & 0xff));
}

void append_chunk(std::vector<uint8_t>& out, uint32_t kind, std::span<const uint8_t> bytes,
                  uint8_t padding) {
    append_word(out, (bytes.size() + 3) / 4 * 4);
    append_word(out, kind);
    out.insert(out.end(), bytes.begin(), bytes.end());
    out.resize((out.size() + 3) / 4 * 4, padding);
}

}  // namespace

std::string image_type(std::span<const uint8_t> bytes) {
    const auto has = [&](std::string_view magic, size_t at) {
        return bytes.size() >= at + magic.size() &&
               std::equal(magic.begin(), magic.end(), bytes.begin() + static_cast<ptrdiff_t>(at),
                          [](char a, uint8_t b) { return static_cast<uint8_t>(a) == b; });
    };
    if (has("\x89PNG", 0)) return "image/png";
    if (has("\xff\xd8\xff", 0)) return "image/jpeg";
    if (has("RIFF", 0) && has("WEBP", 8)) return "image/webp";
    if (has("\xabKTX 20", 0)) return "image/ktx2";
    return has("DDS ", 0) ? "image/vnd-ms.dds" : "";
}

void embed_images(Document& document) {
    const auto found = document.json.find("images");
    if (found == document.json.end()) return;
    for (size_t i = 0; i < found->size() && i < document.source->images.size(); ++i) {
        const auto& bytes = document.source->images[i];
        Json& image = document.json["images"][i];
        if (bytes.empty() || image.contains("bufferView")) continue;
        const std::string type = image_type(bytes);
        if (!type.empty()) image["mimeType"] = type;
        image.erase("uri");
        image["bufferView"] = add_view(document, bytes);
    }
}

std::vector<uint8_t> merge_buffers(Document& document) {
    std::vector<uint8_t> out;
    std::vector<std::vector<Run>> runs(document.source->buffers.size() + 1);
    for (size_t b = 0; b < runs.size(); ++b) {
        runs[b] = live_runs(document, b, document.buffer(b).size());
        for (Run& run : runs[b]) copy_run(document.buffer(b), run, out);
    }
    if (out.empty()) return out;
    for (Json& view : array_of(document.json, "bufferViews")) {
        const size_t offset =
            new_offset(runs.at(member(view, "buffer")), member(view, "byteOffset"));
        view["buffer"] = 0;
        view["byteOffset"] = offset;
    }
    Json& buffers = array_of(document.json, "buffers");
    Json first = buffers.empty() ? Json::object() : buffers.at(0);
    first.erase("uri");
    first["byteLength"] = out.size();
    buffers = Json::array({first});
    return out;
}

Result<std::vector<uint8_t>> to_glb_bytes(const Json& json, std::span<const uint8_t> binary) {
    const std::string text = to_text(json, -1);
    const size_t total = 28 + (text.size() + 3) / 4 * 4 + (binary.size() + 3) / 4 * 4;
    if (total > std::numeric_limits<uint32_t>::max())
        return fail(Errc::bad_argument,
                    "the scene exceeds the 4 GiB that a .glb can hold; write .gltf");
    std::vector<uint8_t> glb;
    glb.reserve(total);
    append_word(glb, 0x46546C67u);  // "glTF"
    append_word(glb, 2);
    append_word(glb, binary.empty() ? total - 8 : total);
    append_chunk(glb, 0x4E4F534Au, {reinterpret_cast<const uint8_t*>(text.data()), text.size()},
                 ' ');
    if (!binary.empty()) append_chunk(glb, 0x004E4942u, binary, 0);
    return glb;
}

std::string to_text(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string to_uri(std::string_view name) {
    std::string uri;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 || c == '-' || c == '.' || c == '_' || c == '~' || c == '/') {
            uri += c;
        } else {
            constexpr std::string_view kDigits = "0123456789ABCDEF";
            uri += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
        }
    }
    return uri;
}

std::filesystem::path path_of_uri(std::string_view uri) {
    std::string name;
    for (size_t i = 0; i < uri.size(); ++i) {
        int byte = 0;
        const char* digits = uri.data() + i + 1;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
            name += static_cast<char>(byte);
            i += 2;
        } else {
            name += uri[i];
        }
    }
    const bool has_scheme = uri.find(':') != std::string_view::npos;
    if (has_scheme || name.find('\0') != std::string::npos) return {};
    auto path = std::filesystem::path(name).lexically_normal();
    if (path.empty() || path.is_absolute() || *path.begin() == ".." || *path.begin() == ".")
        return {};
    return path;
}

}  // namespace aglow::gltf::edit
