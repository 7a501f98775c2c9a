// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/scene/gltf/edit/document.h"

namespace aglow::gltf::edit {

/// The elements of one accessor as they lie in the file, tightly packed: quantised and normalised
/// numbers keep their bits.
struct Elements {
    int component_type = kFloat;
    std::string type = "SCALAR";
    size_t size = 4;  ///< bytes of one element
    size_t count = 0;
    std::vector<uint8_t> bytes;  ///< [count * size]
};

/// Bytes of one element of the type, padding of matrix columns included; 0 for an unknown type.
size_t element_size(int component_type, std::string_view type);

/// Reads an accessor with its stride and its sparse part.
/// Errors  malformed (a range that leaves its buffer; names the accessor).
Result<Elements> read_elements(const Document& document, int accessor);

/// Adds an accessor that holds `elements` at `vertices`, in that order, with everything else taken
/// from the accessor `like`. min and max are written where `bounds` is set or `like` has them.
int add_gathered(Document& document, const Elements& elements, std::span<const uint32_t> vertices,
                 const Json& like, bool bounds);

/// Adds a float accessor for vertices.
int add_floats(Document& document, std::span<const float> values, const char* type, int target);

/// Adds the indices of a triangle list.
int add_indices(Document& document, std::span<const uint32_t> indices, size_t vertex_count);

}  // namespace aglow::gltf::edit
