// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/simplify.h"

#include "aglow/mesh/control_mesh.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <new>
#include <vector>

namespace aglow {
namespace {

constexpr size_t kFewest = 4;  // triangles of the simplest closed surface

template <class T>
std::vector<T> picked(const std::vector<T>& values, std::span<const uint32_t> sources,
                      size_t width = 1) {
    std::vector<T> result;
    if (values.empty()) return result;
    result.reserve(sources.size() * width);
    for (const uint32_t v : sources)
        for (size_t i = v * width; i < (v + size_t{1}) * width; ++i) result.push_back(values[i]);
    return result;
}

/// Of each primitive, its faces as indices of seam vertices.
std::vector<std::vector<uint32_t>> indices_by_primitive(const ControlMesh& control,
                                                        size_t primitive_count) {
    std::vector<std::vector<uint32_t>> indices(primitive_count);
    for (uint32_t f = 0; f < control.seams.face_count(); ++f)
        for (uint32_t h = control.seams.face_begin[f]; h < control.seams.face_begin[f + 1]; ++h)
            indices[control.face_primitive[f]].push_back(control.seams.vertex[h]);
    return indices;
}

/// Collapses edges of one primitive; its error is relative to `scale`.
float collapse(std::vector<uint32_t>& indices, const std::vector<vec3>& positions, float scale,
               const SimplifyOptions& options, unsigned flags) {
    const size_t count = indices.size() / 3;
    const auto share = static_cast<size_t>(options.ratio * static_cast<float>(count));
    const size_t wanted = std::clamp(share, std::min(kFewest, count), count);
    if (wanted == count || !(scale > 0)) return 0;
    std::vector<uint32_t> coarse(indices.size());
    float error = 0;
    const size_t left = meshopt_simplify(coarse.data(), indices.data(), indices.size(),
                                         &positions.data()->x, positions.size(), sizeof(vec3),
                                         3 * wanted, options.max_error / scale, flags, &error);
    if (left == 0) return 0;
    coarse.resize(left);
    indices = std::move(coarse);
    return error * scale;
}

/// A primitive of the faces that are left, its vertices in the order of their first use.
Primitive rebuilt(const Primitive& dense, const ControlMesh& control,
                  const std::vector<uint32_t>& indices) {
    std::vector<uint32_t> number(control.seam_vertices.size(), kNone), sources;
    std::vector<uint32_t> corners;
    for (const uint32_t v : indices) {
        if (number[v] == kNone) {
            number[v] = static_cast<uint32_t>(sources.size());
            sources.push_back(control.seam_vertices[v].vertex);
        }
        corners.push_back(number[v]);
    }
    Primitive coarse = copied_vertices(dense, sources);
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
        coarse.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    return coarse;
}

Result<SimplifiedMesh> simplified(const Mesh& mesh, const SimplifyOptions& options) {
    AG_TRY(const ControlMesh control, make_control_mesh(mesh));
    std::vector<vec3> positions;
    positions.reserve(control.seam_vertices.size());
    for (const VertexOf& v : control.seam_vertices)
        positions.push_back(mesh.primitives[v.primitive].positions[v.vertex]);
    const float scale = positions.empty() ? 0.0f
                                          : meshopt_simplifyScale(&positions.data()->x,
                                                                  positions.size(), sizeof(vec3));
    const unsigned flags = mesh.primitives.size() > 1 ? unsigned{meshopt_SimplifyLockBorder} : 0u;
    std::vector<std::vector<uint32_t>> indices =
        indices_by_primitive(control, mesh.primitives.size());
    SimplifiedMesh result;
    result.mesh.name = mesh.name;
    result.mesh.weights = mesh.weights;
    for (size_t p = 0; p < mesh.primitives.size(); ++p) {
        result.dense_triangles += mesh.primitives[p].triangles.size();
        result.error =
            std::max(result.error, collapse(indices[p], positions, scale, options, flags));
        result.mesh.primitives.push_back(rebuilt(mesh.primitives[p], control, indices[p]));
        result.triangles += result.mesh.primitives.back().triangles.size();
    }
    return result;
}

}  // namespace

Primitive copied_vertices(const Primitive& from, std::span<const uint32_t> sources) {
    const auto influences = static_cast<size_t>(from.influences);
    Primitive to;
    to.material = from.material;
    to.influences = from.influences;
    to.positions = picked(from.positions, sources);
    to.normals = picked(from.normals, sources);
    to.tangents = picked(from.tangents, sources);
    for (const auto& set : from.texcoords) to.texcoords.push_back(picked(set, sources));
    to.colors = picked(from.colors, sources);
    to.joints = picked(from.joints, sources, influences);
    to.weights = picked(from.weights, sources, influences);
    to.lightmap_uvs = picked(from.lightmap_uvs, sources);
    to.sharpness = picked(from.sharpness, sources);
    to.tension = picked(from.tension, sources);
    to.bias = picked(from.bias, sources);
    for (const MorphTarget& target : from.targets)
        to.targets.push_back({picked(target.positions, sources), picked(target.normals, sources)});
    return to;
}

Result<SimplifiedMesh> simplify(const Mesh& mesh, const SimplifyOptions& options) {
    if (!(options.ratio > 0 && options.ratio <= 1))
        return fail(Errc::bad_argument,
                    fmt::format("a ratio of {} is not above 0 and at most 1", options.ratio));
    try {
        return simplified(mesh, options);
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the mesh does not fit into memory");
    }
}

}  // namespace aglow
