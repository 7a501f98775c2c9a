// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/sharp_tags.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace aglow::gltf {
namespace {

/// One entry of a list: vertices, then perhaps a sharpness.
struct Tag {
    std::vector<uint32_t> vertices;
    std::optional<float> sharpness;
};

Result<Tag> read_tag(const Json& list, size_t i, size_t width, size_t vertex_count) {
    AG_TRY(const std::vector<double> numbers, list.numbers_at(i));
    if (numbers.size() != width && numbers.size() != width + 1)
        return list.wrong(fmt::format("entry {} must hold {} or {} numbers", i, width, width + 1));
    Tag tag;
    for (const double vertex : std::span(numbers).first(width)) {
        if (!(vertex >= 0 && vertex < static_cast<double>(vertex_count)) ||
            vertex != std::floor(vertex))
            return list.wrong(fmt::format("entry {}: vertex {} does not exist", i, vertex));
        tag.vertices.push_back(static_cast<uint32_t>(vertex));
    }
    if (numbers.size() == width) return tag;
    if (!(numbers[width] >= 0))
        return list.wrong(fmt::format("entry {} has the sharpness {}", i, numbers[width]));
    constexpr double kMost = std::numeric_limits<float>::max();
    tag.sharpness = static_cast<float>(std::min(numbers[width], kMost));
    return tag;
}

/// The entries of extras.<key> that follow the format.
std::vector<Tag> read_tags(const Json& extras, const char* key, size_t width, size_t vertex_count,
                           std::vector<std::string>& warnings) {
    std::vector<Tag> tags;
    const Result<Json> found = extras.array(key);
    if (!found) {
        warnings.push_back(found.error().message);
        return tags;
    }
    const Json list = found->named(fmt::format("{}: extras.{}", extras.element(), key));
    size_t wrong = 0;
    for (size_t i = 0; i < list.size(); ++i) {
        Result<Tag> tag = read_tag(list, i, width, vertex_count);
        if (tag)
            tags.push_back(std::move(*tag));
        else if (++wrong == 1)
            warnings.push_back(tag.error().message);
    }
    if (wrong > 0)
        warnings.push_back(
            fmt::format("{}: {} of {} entries are left out", list.element(), wrong, list.size()));
    return tags;
}

}  // namespace

void read_sharp_tags(const Json& json, Primitive& primitive, std::vector<std::string>& warnings) {
    const Result<Json> extras = json.object("extras");
    if (!extras || !extras->exists()) return;
    const size_t count = primitive.positions.size();
    for (const Tag& tag : read_tags(*extras, "creases", 2, count, warnings)) {
        SharpEdge crease{tag.vertices[0], tag.vertices[1]};
        crease.sharpness = tag.sharpness.value_or(crease.sharpness);
        primitive.creases.push_back(crease);
    }
    for (const Tag& tag : read_tags(*extras, "corners", 1, count, warnings)) {
        SharpVertex corner{tag.vertices[0]};
        corner.sharpness = tag.sharpness.value_or(corner.sharpness);
        primitive.corners.push_back(corner);
    }
}

}  // namespace aglow::gltf
