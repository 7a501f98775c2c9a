// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aglow::gltf {
namespace {

/// Beyond it the squared area of a triangle exceeds a float.
constexpr float kMaxCoordinate = 1e9f;  // metres

Box bounds(const Mesh& mesh) {
    Box box;
    for (const Primitive& primitive : mesh.primitives)
        for (const vec3 p : primitive.positions) box.add(p);
    return box;
}

/// Largest coordinate that the corners of `box` reach under `t`; infinite where one overflows.
float reach(const mat4& t, const Box& box) {
    float largest = 0;
    for (int i = 0; i < 8; ++i) {
        const vec3 corner{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y,
                          i & 4 ? box.hi.z : box.lo.z};
        const vec3 p = transform_point(t, corner);
        for (const float v : {p.x, p.y, p.z}) {
            if (!std::isfinite(v)) return kInfinity;
            largest = std::max(largest, std::abs(v));
        }
    }
    return largest;
}

bool is_finite(const mat4& t) {
    return std::all_of(t.m.begin(), t.m.end(), [](float v) { return std::isfinite(v); });
}

Status check_reach(const std::string& element, float largest) {
    if (largest <= kMaxCoordinate) return {};
    return fail(Errc::unsupported,
                fmt::format("{}: its mesh reaches {:.3g} m; coordinates beyond {:.0e} m are not "
                            "supported",
                            element, largest, kMaxCoordinate));
}

}  // namespace

Status check_extent(const Scene& scene) {
    std::vector<Box> boxes;
    for (const Mesh& mesh : scene.meshes) boxes.push_back(bounds(mesh));
    const std::vector<mat4> world = world_transforms(scene);
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (!is_finite(world[i]))
            return fail(Errc::malformed, element_name("node", i, node.name) +
                                             ": its transform to the world is not finite");
        if (node.mesh < 0) continue;
        const Box& box = boxes[static_cast<size_t>(node.mesh)];
        if (box.empty()) continue;
        const std::string element = element_name("node", i, node.name);
        float largest = node.instances.empty() ? reach(world[i], box) : 0;
        for (const mat4& instance : node.instances)
            largest = std::max(largest, reach(world[i] * instance, box));
        AG_CHECK(check_reach(element, largest));
    }
    return {};
}

}  // namespace aglow::gltf
