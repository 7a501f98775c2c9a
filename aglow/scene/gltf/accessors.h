// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/buffers.h"
#include "aglow/scene/gltf/json.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace aglow::gltf {

enum class ComponentType : uint16_t { i8 = 5120, u8, i16, u16, u32 = 5125, f32 };

/// Where the elements that a sparse accessor replaces are, and by what.
struct SparsePart {
    size_t count = 0;
    ComponentType index_type = ComponentType::u32;
    std::span<const uint8_t> indices;
    std::span<const uint8_t> values;
};

/// A typed view of buffer bytes, its range checked.
struct Accessor {
    std::string element;  ///< `accessor 3`
    size_t count = 0;
    int components = 1;  ///< per element: 1 to 4, 9, 16
    bool matrix = false;
    ComponentType type = ComponentType::f32;
    bool normalized = false;
    std::span<const uint8_t> bytes;  ///< from its first element on; empty: all elements are zero
    size_t stride = 0;               ///< bytes from one element to the next
    SparsePart sparse;
};

/// The accessors of one file. Decoding counts what it makes against a bound that grows with the
/// size of the file, so that a short file cannot ask for all memory.
class Accessors {
public:
    /// Errors  malformed (names the accessor).
    static Result<Accessors> read(const Json& root, std::span<const BufferView> views,
                                  size_t file_bytes);

    size_t size() const { return list_.size(); }
    const Accessor& operator[](int i) const { return list_[static_cast<size_t>(i)]; }

    /// All numbers of accessor `i`, sparse parts applied, normalised integers as 0..1 or -1..1.
    /// Shapes  [count * components]
    /// Errors  malformed (a number is not finite, an index of the sparse part is out of range),
    ///         out_of_memory (beyond the bound).
    Result<std::vector<float>> floats(int i);
    /// The same for unsigned integers. Errors: also malformed where it holds anything else.
    Result<std::vector<uint32_t>> uints(int i);

    /// Counts `numbers` against the bound. Errors: out_of_memory.
    Status charge(uint64_t numbers, const std::string& element);

private:
    std::vector<Accessor> list_;
    uint64_t budget_ = 0;
};

/// Bytes of one number. `type` is one that glTF knows.
size_t component_bytes(ComponentType type);

/// Largest value of a normalised integer type, which stands for 1; 1 for floats.
float normalizer(ComponentType type);

}  // namespace aglow::gltf
