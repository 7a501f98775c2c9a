// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/draco.h"

#include "aglow/core/math.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

namespace aglow::gltf {
namespace {

Result<std::unique_ptr<draco::Mesh>> decode_mesh(std::span<const uint8_t> bytes,
                                                 const std::string& element) {
    try {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok())
            return fail(Errc::malformed, element + ": Draco data does not decode: " +
                                             decoded.status().error_msg_string());
        return std::move(decoded).value();
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, element + ": no memory to decode Draco data");
    } catch (const std::exception& error) {
        return fail(Errc::malformed,
                    element + ": Draco data does not decode: " + std::string(error.what()));
    }
}

Result<std::vector<float>> read_values(const draco::Mesh& mesh, const DracoRequest& request,
                                       const std::string& element) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(request.id);
    if (!attribute)
        return fail(Errc::malformed, fmt::format("{}: Draco data has no attribute {} for {}",
                                                 element, request.id, request.name));
    if (attribute->num_components() != request.components)
        return fail(Errc::malformed,
                    fmt::format("{}: {} has {} components in Draco data, not {}", element,
                                request.name, attribute->num_components(), request.components));
    // Draco itself divides integers that it knows to be normalised, and leaves floats alone.
    const bool divide = draco::IsDataTypeIntegral(attribute->data_type()) &&
                        !attribute->normalized() && request.one != 1;
    const float one = divide ? request.one : 1.0f;
    const float lowest = divide ? -1.0f : -kInfinity;
    const size_t width = static_cast<size_t>(request.components);
    std::vector<float> values(mesh.num_points() * width);
    for (uint32_t point = 0; point < mesh.num_points(); ++point) {
        const draco::AttributeValueIndex index = attribute->mapped_index(draco::PointIndex(point));
        float* out = &values[point * width];
        if (index.value() >= attribute->size() ||
            !attribute->ConvertValue<float>(index, static_cast<int8_t>(request.components), out))
            return fail(Errc::malformed, fmt::format("{}: {} does not decode from Draco data",
                                                     element, request.name));
        for (size_t i = 0; i < width; ++i) {
            out[i] = std::max(out[i] / one, lowest);
            if (!std::isfinite(out[i]))
                return fail(Errc::malformed, fmt::format("{}: {} of vertex {} is not finite",
                                                         element, request.name, point));
        }
    }
    return values;
}

}  // namespace

Result<DracoMesh> decode_draco(std::span<const uint8_t> bytes,
                               std::span<const DracoRequest> requests, const std::string& element) {
    AG_TRY(const std::unique_ptr<draco::Mesh> mesh, decode_mesh(bytes, element));
    DracoMesh result;
    result.vertex_count = mesh->num_points();
    result.indices.reserve(3 * static_cast<size_t>(mesh->num_faces()));
    for (uint32_t f = 0; f < mesh->num_faces(); ++f)
        for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(f))) {
            if (corner.value() >= result.vertex_count)
                return fail(Errc::malformed, element + ": Draco data names a vertex it lacks");
            result.indices.push_back(corner.value());
        }
    for (const DracoRequest& request : requests) {
        AG_TRY(std::vector<float> values, read_values(*mesh, request, element));
        result.values.push_back(std::move(values));
    }
    return result;
}

}  // namespace aglow::gltf
