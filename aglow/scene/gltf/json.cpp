// SPDX-License-Identifier: Apache-2.0
// nlohmann::json reads the document, not tinygltf 2.7. On untrusted files tinygltf skips members
// and whole primitives of the wrong type (which shifts the indices of all that follow), truncates
// integers to 32 bits, recurses over `extras` without bound, and reads images beyond their buffer;
// as packaged it refuses Draco and meshopt files that leave out what they may leave out; and
// Debian's libdraco exports another version's tinygltf symbols, so that a program that links both
// crashes or not by link order. nlohmann::json parses and destroys iteratively.
#include "aglow/scene/gltf/json.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

namespace aglow::gltf {
namespace {

using Node = nlohmann::json;

constexpr size_t kMaxDepth = 256;  // glTF itself needs about ten levels; extras rarely more

const Node& node(const void* value) { return *static_cast<const Node*>(value); }

const Node* find(const void* value, const char* key) {
    if (!value || !node(value).is_object()) return nullptr;
    const auto member = node(value).find(key);
    return member == node(value).end() ? nullptr : &*member;
}

/// Brackets outside of strings, counted before parsing: the depth of the tree to come.
bool too_deep(std::string_view text) {
    size_t depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > kMaxDepth) return true;
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
    return false;
}

/// Non-negative integer, also when it is written with a fraction of zero (3.0).
std::optional<uint64_t> as_size(const Node& value) {
    if (value.is_number_unsigned()) return value.get<uint64_t>();
    if (!value.is_number_float()) return std::nullopt;
    const double number = value.get<double>();
    if (!(number >= 0 && number < 9007199254740992.0) || number != std::floor(number))
        return std::nullopt;
    return static_cast<uint64_t>(number);
}

std::optional<float> as_float(const Node& value) {
    if (!value.is_number()) return std::nullopt;
    const float number = static_cast<float>(value.get<double>());
    return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

}  // namespace

bool Json::has(const char* key) const { return find(value_, key) != nullptr; }

bool Json::is_text(const char* key) const {
    const Node* member = find(value_, key);
    return member && member->is_string();
}

tl::unexpected<Error> Json::wrong(std::string_view what) const {
    return fail(Errc::malformed,
                element_.empty() ? std::string(what) : fmt::format("{}: {}", element_, what));
}

Result<Json> Json::object(const char* key) const {
    const Node* member = find(value_, key);
    if (!member) return Json(nullptr, element_);
    if (!member->is_object()) return wrong(fmt::format("{} must be an object", key));
    return Json(member, element_);
}

Result<Json> Json::array(const char* key) const {
    const Node* member = find(value_, key);
    if (!member) return Json(nullptr, element_);
    if (!member->is_array()) return wrong(fmt::format("{} must be an array", key));
    return Json(member, element_);
}

Result<Json> Json::extension(const char* name) const {
    AG_TRY(const Json extensions, object("extensions"));
    return extensions.object(name);
}

size_t Json::size() const { return value_ ? node(value_).size() : 0; }

Result<Json> Json::entry(size_t i, std::string element) const {
    const Node& value = node(value_)[i];
    if (!value.is_object()) return fail(Errc::malformed, element + ": must be an object");
    return Json(&value, std::move(element));
}

std::vector<std::string> Json::keys() const {
    std::vector<std::string> keys;
    if (!value_ || !node(value_).is_object()) return keys;
    for (const auto& member : node(value_).items()) keys.push_back(member.key());
    return keys;
}

Result<std::string> Json::text_at(size_t i) const {
    const Node& value = node(value_)[i];
    if (!value.is_string()) return wrong(fmt::format("entry {} must be a string", i));
    return value.get<std::string>();
}

Result<std::vector<double>> Json::numbers_at(size_t i) const {
    const Node& list = node(value_)[i];
    if (!list.is_array()) return wrong(fmt::format("entry {} must be an array", i));
    std::vector<double> numbers;
    for (const Node& value : list) {
        if (!value.is_number()) return wrong(fmt::format("entry {} must hold numbers", i));
        numbers.push_back(value.get<double>());
    }
    return numbers;
}

Result<int> Json::index(const char* key, size_t count, const char* kind) const {
    const Node* member = find(value_, key);
    if (!member) return -1;
    const auto i = as_size(*member);
    if (!i) return wrong(fmt::format("{} must be an index", key));
    if (*i >= count) return wrong(fmt::format("{} {} does not exist", kind, *i));
    return static_cast<int>(*i);
}

Result<int> Json::required_index(const char* key, size_t count, const char* kind) const {
    if (!has(key)) return wrong(fmt::format("{} is missing", key));
    return index(key, count, kind);
}

Result<std::vector<int>> Json::indices(const char* key, size_t count, const char* kind) const {
    AG_TRY(const Json list, array(key));
    std::vector<int> indices;
    for (size_t k = 0; k < list.size(); ++k) {
        const auto i = as_size(node(list.value_)[k]);
        if (!i) return wrong(fmt::format("{} must hold indices", key));
        if (*i >= count) return wrong(fmt::format("{} {} does not exist", kind, *i));
        indices.push_back(static_cast<int>(*i));
    }
    return indices;
}

Result<uint64_t> Json::size(const char* key, uint64_t fallback) const {
    const Node* member = find(value_, key);
    if (!member) return fallback;
    const auto size = as_size(*member);
    if (!size) return wrong(fmt::format("{} must be a non-negative integer", key));
    return *size;
}

Result<uint64_t> Json::required_size(const char* key) const {
    if (!has(key)) return wrong(fmt::format("{} is missing", key));
    return size(key, 0);
}

Result<float> Json::number(const char* key, float fallback) const {
    const Node* member = find(value_, key);
    if (!member) return fallback;
    const auto number = as_float(*member);
    if (!number) return wrong(fmt::format("{} must be a finite number", key));
    return *number;
}

Result<bool> Json::boolean(const char* key, bool fallback) const {
    const Node* member = find(value_, key);
    if (!member) return fallback;
    if (!member->is_boolean()) return wrong(fmt::format("{} must be true or false", key));
    return member->get<bool>();
}

Result<std::string> Json::text(const char* key, std::string_view fallback) const {
    const Node* member = find(value_, key);
    if (!member) return std::string(fallback);
    if (!member->is_string()) return wrong(fmt::format("{} must be a string", key));
    return member->get<std::string>();
}

Status Json::numbers(const char* key, std::span<float> out) const {
    if (!has(key)) return {};
    AG_TRY(const std::vector<float> list, number_list(key));
    if (list.size() != out.size())
        return wrong(fmt::format("{} must hold {} numbers, not {}", key, out.size(), list.size()));
    std::copy(list.begin(), list.end(), out.begin());
    return {};
}

Result<std::vector<float>> Json::number_list(const char* key) const {
    AG_TRY(const Json list, array(key));
    std::vector<float> numbers;
    for (size_t i = 0; i < list.size(); ++i) {
        const auto number = as_float(node(list.value_)[i]);
        if (!number) return wrong(fmt::format("{} must hold finite numbers", key));
        numbers.push_back(*number);
    }
    return numbers;
}

Result<JsonDocument> JsonDocument::parse(std::string_view text) {
    if (too_deep(text))
        return fail(Errc::malformed, fmt::format("JSON is nested deeper than {}", kMaxDepth));
    try {
        auto root = std::make_shared<const Node>(Node::parse(text));
        if (!root->is_object()) return fail(Errc::malformed, "JSON root must be an object");
        JsonDocument document;
        document.root_ = std::move(root);
        return document;
    } catch (const nlohmann::json::exception& error) {
        return fail(Errc::malformed, fmt::format("JSON does not parse: {}", error.what()));
    }
}

Json JsonDocument::root() const { return {root_.get(), ""}; }

Result<std::vector<Json>> elements(const Json& root, const char* key, const char* kind) {
    AG_TRY(const Json list, root.array(key));
    std::vector<Json> result;
    result.reserve(list.size());
    for (size_t i = 0; i < list.size(); ++i) {
        AG_TRY(const Json entry, list.entry(i, element_name(kind, i, "")));
        AG_TRY(const std::string name, entry.text("name", ""));
        result.push_back(entry.named(element_name(kind, i, name)));
    }
    return result;
}

std::string element_name(std::string_view kind, size_t index, std::string_view name) {
    constexpr size_t kMaxLength = 80;
    if (name.empty()) return fmt::format("{} {}", kind, index);
    std::string clean(name.substr(0, kMaxLength));
    for (char& c : clean)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return fmt::format("{} {} \"{}{}\"", kind, index, clean, name.size() > kMaxLength ? "..." : "");
}

}  // namespace aglow::gltf
