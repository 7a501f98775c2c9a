// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/builtin/toys.h"

#include <cmath>

namespace aglow::builtin {
namespace {

/// Normal at p of the image of a surface with normal n there, by differences.
vec3 image_normal(const std::function<vec3(vec3)>& image, vec3 p, vec3 n) {
    constexpr float kStep = 1e-3f;  // m; toys are a hundred times larger
    const Frame frame(n);
    const vec3 at = image(p);
    return normalize(
        cross(image(p + frame.tangent * kStep) - at, image(p + frame.bitangent * kStep) - at));
}

}  // namespace

void add_target(Primitive& primitive, const std::function<vec3(vec3)>& image) {
    MorphTarget target;
    for (size_t v = 0; v < primitive.positions.size(); ++v) {
        const vec3 p = primitive.positions[v], n = primitive.normals[v];
        target.positions.push_back(image(p) - p);
        target.normals.push_back(image_normal(image, p, n) - n);
    }
    primitive.targets.push_back(std::move(target));
}

}  // namespace aglow::builtin
