// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aglow::gltf {

/// View of one value of a JSON document, together with the name that messages give to the element
/// it belongs to, such as `node 4 "lamp"`. Every read checks type and range: the text is
/// untrusted. Absent members are no error for the optional reads; members of the wrong type are.
/// Lifetime  valid as long as its JsonDocument.
class Json {
public:
    Json() = default;
    Json(const void* value, std::string element) : value_(value), element_(std::move(element)) {}

    bool exists() const { return value_ != nullptr; }
    bool has(const char* key) const;
    bool is_text(const char* key) const;
    const std::string& element() const { return element_; }
    Json named(std::string element) const { return {value_, std::move(element)}; }

    /// Members that are themselves objects or arrays; not existing where absent.
    Result<Json> object(const char* key) const;
    Result<Json> array(const char* key) const;
    /// Object `extensions.<name>`; not existing where absent.
    Result<Json> extension(const char* name) const;

    /// Entries of an array (or object member of that type), and the keys of an object.
    size_t size() const;
    /// Entry `i` of an array, which must be an object; its element is `element`.
    Result<Json> entry(size_t i, std::string element) const;
    std::vector<std::string> keys() const;
    /// Entry `i` of an array of strings.
    Result<std::string> text_at(size_t i) const;
    /// Entry `i` of an array, itself an array of numbers.
    Result<std::vector<double>> numbers_at(size_t i) const;

    /// Index into a list of `count` things called `kind`, or -1 where absent.
    Result<int> index(const char* key, size_t count, const char* kind) const;
    Result<int> required_index(const char* key, size_t count, const char* kind) const;
    Result<std::vector<int>> indices(const char* key, size_t count, const char* kind) const;
    /// Non-negative integer.
    Result<uint64_t> size(const char* key, uint64_t fallback) const;
    Result<uint64_t> required_size(const char* key) const;
    /// Finite as a float.
    Result<float> number(const char* key, float fallback) const;
    Result<bool> boolean(const char* key, bool fallback) const;
    Result<std::string> text(const char* key, std::string_view fallback) const;
    /// Exactly out.size() numbers; `out` stays as it is where the member is absent.
    Status numbers(const char* key, std::span<float> out) const;
    Result<std::vector<float>> number_list(const char* key) const;

    /// Errc::malformed: `<element>: <what>`.
    tl::unexpected<Error> wrong(std::string_view what) const;

private:
    const void* value_ = nullptr;
    std::string element_;
};

/// A parsed JSON text whose root is an object.
class JsonDocument {
public:
    /// Errors  malformed: not JSON, not UTF-8, a number no double holds, not an object, or nested
    ///         deeper than any glTF is (which would exhaust the stack of recursive writers).
    static Result<JsonDocument> parse(std::string_view text);
    Json root() const;

private:
    std::shared_ptr<const void> root_;
};

/// Objects of the root's array `key`, each with element `<kind> <i> "<name>"`.
Result<std::vector<Json>> elements(const Json& root, const char* key, const char* kind);

/// `kind 4`, or `kind 4 "name"`; control characters and overlong names are shortened.
std::string element_name(std::string_view kind, size_t index, std::string_view name);

}  // namespace aglow::gltf
