// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/uri.h"

#include "aglow/core/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

namespace aglow::gltf {
namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::optional<std::string> percent_decode(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded.push_back(text[i]);
            continue;
        }
        if (i + 2 >= text.size()) return std::nullopt;
        const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
        if (high < 0 || low < 0) return std::nullopt;
        decoded.push_back(static_cast<char>(high * 16 + low));
        i += 2;
    }
    return decoded;
}

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    return c == '/' ? 63 : -1;
}

std::optional<std::vector<uint8_t>> base64_decode(std::string_view text) {
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::vector<uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        const int digit = base64_digit(c);
        if (digit < 0) return std::nullopt;
        bits = (bits << 6 | static_cast<uint32_t>(digit)) & 0xFFFFFF;
        bit_count += 6;
        if (bit_count < 8) continue;
        bit_count -= 8;
        bytes.push_back(static_cast<uint8_t>(bits >> bit_count));
    }
    return bytes;
}

/// What a message shows of a URI: not the megabytes of a data: URI.
std::string shown(std::string_view uri) {
    constexpr size_t kMaxLength = 100;
    std::string text(uri.substr(0, kMaxLength));
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return uri.size() > kMaxLength ? text + "..." : text;
}

bool has_scheme(std::string_view uri) {
    const size_t colon = uri.find(':');
    return colon != std::string_view::npos && colon < uri.find('/');
}

bool is_data_uri(std::string_view uri) {
    constexpr std::string_view kScheme = "data:";
    return uri.size() >= kScheme.size() &&
           std::equal(kScheme.begin(), kScheme.end(), uri.begin(),
                      [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b + 32 : b); });
}

}  // namespace

Result<std::vector<uint8_t>> decode_data_uri(std::string_view uri) {
    const size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == std::string_view::npos)
        return fail(Errc::malformed, fmt::format("\"{}\" is not a data: URI", shown(uri)));
    const std::string_view payload = uri.substr(comma + 1);
    if (uri.substr(0, comma).ends_with(";base64")) {
        // Some writers escape the signs of base64 that URLs give a meaning to.
        const bool escaped = payload.find('%') != std::string_view::npos;
        const auto unescaped = escaped ? percent_decode(payload) : std::nullopt;
        auto bytes = base64_decode(unescaped ? std::string_view(*unescaped) : payload);
        if (!bytes) return fail(Errc::malformed, "data: URI is not valid base64");
        return std::move(*bytes);
    }
    const auto text = percent_decode(payload);
    if (!text) return fail(Errc::malformed, "data: URI has a broken percent escape");
    return std::vector<uint8_t>(text->begin(), text->end());
}

Result<std::filesystem::path> relative_path(std::string_view uri) {
    const auto refuse = [&](std::string_view why) {
        return fail(Errc::unreadable, fmt::format("URI \"{}\" {}", shown(uri), why));
    };
    if (uri.empty()) return refuse("names no file");
    if (has_scheme(uri)) return refuse("has a scheme; only data: and relative URIs are read");
    const auto text = percent_decode(uri);
    if (!text) return refuse("has a broken percent escape");
    const bool control = std::any_of(text->begin(), text->end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    });
    if (control) return refuse("holds control characters");
    if (text->front() == '/' || text->find('\\') != std::string::npos)
        return refuse("is not relative to the scene's folder");
    const std::filesystem::path path = std::filesystem::path(*text).lexically_normal();
    if (path.is_absolute() || (!path.empty() && *path.begin() == ".."))
        return refuse("leaves the scene's folder");
    if (path.empty() || path == "." || !path.has_filename()) return refuse("names no file");
    return path;
}

Result<std::vector<uint8_t>> read_uri(std::string_view uri, const std::filesystem::path& folder) {
    if (is_data_uri(uri)) return decode_data_uri(uri);
    AG_TRY(const std::filesystem::path path, relative_path(uri));
    if (folder.empty())
        return fail(Errc::unreadable,
                    fmt::format("URI \"{}\" cannot be read: the scene has no folder", shown(uri)));
    return read_file(folder / path);
}

}  // namespace aglow::gltf
