// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/gltf/accessors.h"
#include "aglow/scene/gltf/draco.h"
#include "aglow/scene/gltf/json.h"

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aglow::gltf {

/// Decompressed attributes of a primitive, in the order of `names`.
struct DracoPrimitive {
    DracoMesh mesh;
    std::vector<std::string> names;
};

/// Decodes the primitive's KHR_draco_mesh_compression; nothing where it has none.
/// Errors  malformed, out_of_memory.
Result<std::optional<DracoPrimitive>> read_draco(const Json& primitive, const Json& attributes,
                                                 std::span<const BufferView> views,
                                                 Accessors& accessors);

/// Reads the attributes of a primitive, morph target or instancing extension as floats, from
/// compressed data where it has them and from accessors otherwise, and sees to it that all have
/// the same number of elements.
/// Lifetime  of its arguments.
class AttributeReader {
public:
    /// The first attribute read decides the number of elements; Draco's does where it is given.
    AttributeReader(Json attributes, Accessors& accessors, const DracoPrimitive* draco)
        : attributes_(std::move(attributes)), accessors_(accessors), draco_(draco) {
        if (draco) count_ = draco->mesh.vertex_count;
    }
    AttributeReader(Json attributes, Accessors& accessors, std::optional<size_t> count)
        : attributes_(std::move(attributes)), accessors_(accessors), count_(count) {}

    /// All numbers of attribute `name`, or none where it is absent or has no elements. `widths`
    /// are the numbers of components allowed.
    /// Errors  malformed (wrong type or number of elements), out_of_memory.
    Result<std::vector<float>> read(const std::string& name, std::initializer_list<int> widths);

    /// One more than the largest n of attributes named `prefix` n.
    size_t set_count(std::string_view prefix) const;

    Status charge(uint64_t numbers) { return accessors_.charge(numbers, attributes_.element()); }

private:
    Json attributes_;
    Accessors& accessors_;
    const DracoPrimitive* draco_ = nullptr;
    std::optional<size_t> count_;
};

}  // namespace aglow::gltf
