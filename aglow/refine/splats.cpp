// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/splats.h"

#include "aglow/core/assert.h"

#include <algorithm>

namespace aglow {
namespace {

/// The greatest distance of a point of the triangle from its nearest corner: for an acute one that
/// of the centre of the circle through its corners. In an obtuse one it is on the longest edge, no
/// further from a corner than half of it.
float covering_radius(vec3 a, vec3 b, vec3 c) {
    const float ab = length(b - a), bc = length(c - b), ca = length(a - c);
    const float longest = std::max({ab, bc, ca});
    const float twice_area = length(cross(b - a, c - a));
    const bool acute = ab * ab + bc * bc + ca * ca > 2 * longest * longest;
    return acute && twice_area > 0 ? ab * bc * ca / (2 * twice_area) : 0.5f * longest;
}

}  // namespace

std::vector<Splat> make_splats(std::span<const vec3> positions, std::span<const vec3> normals,
                               std::span<const uvec3> triangles) {
    AG_ASSERT(positions.size() == normals.size(), "a normal per vertex");
    std::vector<Splat> splats(positions.size());
    for (size_t v = 0; v < splats.size(); ++v) splats[v] = {positions[v], normals[v], 0};
    for (const uvec3 t : triangles) {
        const float radius = covering_radius(positions[t.x], positions[t.y], positions[t.z]);
        for (const uint32_t v : {t.x, t.y, t.z})
            splats[v].radius = std::max(splats[v].radius, radius);
    }
    return splats;
}

SplatRadii splat_radii(const Scene& scene) {
    SplatRadii radii;
    for (const Mesh& mesh : scene.meshes) {
        auto& of_mesh = radii.emplace_back();
        for (const Primitive& p : mesh.primitives) {
            auto& of_primitive = of_mesh.emplace_back();
            if (p.triangles.empty()) continue;
            for (const Splat& splat : make_splats(p.positions, p.normals, p.triangles))
                of_primitive.push_back(splat.radius);
        }
    }
    return radii;
}

}  // namespace aglow
