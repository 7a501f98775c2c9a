// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/scene/skin.h"

#include <algorithm>
#include <map>

namespace aglow::refine {
namespace {

// Joints that are interpolated in one go.
constexpr size_t kColumns = 6;

/// Weights by vertex for each joint that moves any.
using Columns = std::map<uint32_t, std::vector<std::pair<uint32_t, float>>>;

Columns columns_of(const Mesh& mesh, const ControlMesh& control) {
    Columns columns;
    for (uint32_t v = 0; v < control.vertices.size(); ++v) {
        const VertexOf from = control.vertices[v];
        const Primitive& p = mesh.primitives[from.primitive];
        if (p.joints.empty()) continue;
        const auto width = static_cast<size_t>(p.influences);
        for (size_t i = from.vertex * width; i < (from.vertex + 1) * width; ++i)
            if (p.weights[i] > 0) columns[p.joints[i]].emplace_back(v, p.weights[i]);
    }
    return columns;
}

/// Keeps the largest weights of a vertex, in falling order; of equal ones those that came first.
void insert(std::span<uint32_t> joints, std::span<float> weights, uint32_t joint, float weight) {
    for (size_t i = 0; i < weights.size(); ++i) {
        if (!(weight > weights[i])) continue;
        std::swap(weight, weights[i]);
        std::swap(joint, joints[i]);
    }
}

/// Makes the sum 1, as nearly as floats can.
void normalise(std::span<float> weights) {
    double sum = 0;
    for (const float w : weights) sum += static_cast<double>(w);
    if (!(sum > 0)) return;
    double rest = 1;
    for (float& w : weights.subspan(1)) {
        w = static_cast<float>(static_cast<double>(w) / sum);
        rest -= static_cast<double>(w);
    }
    weights[0] = static_cast<float>(rest);
}

int influences_of(const Mesh& mesh) {
    int most = 0;
    for (const Primitive& p : mesh.primitives)
        if (!p.joints.empty()) most = std::max(most, p.influences);
    return most == 0 ? 0 : most <= 4 ? 4 : 8;
}

}  // namespace

Result<RefinedSkin> refine_skin(const Mesh& mesh, const ControlMesh& control,
                                const RefinedSurface& surface) {
    RefinedSkin skin;
    skin.influences = influences_of(mesh);
    if (skin.influences == 0) return skin;
    const Columns columns = columns_of(mesh, control);
    const auto width = static_cast<size_t>(skin.influences);
    std::vector<float> values, refined;
    auto next = columns.begin();
    do {
        const auto first = next;
        size_t used = 0;
        values.assign(control.vertices.size() * kColumns, 0.0f);
        for (; next != columns.end() && used < kColumns; ++next, ++used)
            for (const auto& [v, weight] : next->second) values[v * kColumns + used] += weight;
        AG_CHECK(surface.interpolate(Layer::whole, values, static_cast<int>(kColumns), refined));
        const size_t count = refined.size() / kColumns;
        skin.joints.resize(count * width, 0);
        skin.weights.resize(count * width, 0);
        size_t column = 0;
        for (auto joint = first; joint != next; ++joint, ++column)
            for (size_t v = 0; v < count; ++v)
                insert(std::span(skin.joints).subspan(v * width, width),
                       std::span(skin.weights).subspan(v * width, width), joint->first,
                       refined[v * kColumns + column]);
    } while (next != columns.end());
    for (size_t v = 0; v < skin.weights.size() / width; ++v)
        normalise(std::span(skin.weights).subspan(v * width, width));
    return skin;
}

}  // namespace aglow::refine
