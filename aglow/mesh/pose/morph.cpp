// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/pose/morph.h"

#include <algorithm>

namespace aglow::mesh {
namespace {

/// Where `time` lies between two keys; before == after outside the keys.
struct KeySpan {
    size_t before = 0, after = 0;
    double fraction = 0, duration = 0;
};

KeySpan find_keys(const std::vector<float>& times, double time) {
    const auto next = std::upper_bound(times.begin(), times.end(), time,
                                       [](double t, float key) { return t < double(key); });
    const auto after = static_cast<size_t>(next - times.begin());
    if (after == 0) return {};
    if (after == times.size()) return {after - 1, after - 1, 0, 0};
    const double start = double(times[after - 1]), duration = double(times[after]) - start;
    return {after - 1, after, duration > 0 ? (time - start) / duration : 0, duration};
}

/// Cubic Hermite spline with tangents per second.
double hermite(double t, double p0, double m0, double p1, double m1) {
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * p0 + (t3 - 2 * t2 + t) * m0 + (3 * t2 - 2 * t3) * p1 +
           (t3 - t2) * m1;
}

}  // namespace

std::vector<float> channel_value(const AnimationChannel& channel, double time, size_t width) {
    const bool cubic = channel.interpolation == Interpolation::cubic_spline;
    const size_t stride = cubic ? 3 * width : width;
    std::vector<float> result(width, 0.0f);
    if (channel.times.empty() || channel.values.size() < channel.times.size() * stride)
        return result;
    const KeySpan span = find_keys(channel.times, time);
    const size_t value_at = cubic ? width : 0;
    for (size_t i = 0; i < width; ++i) {
        const auto read = [&](size_t key, size_t part) {
            return double(channel.values[key * stride + part + i]);
        };
        const double p0 = read(span.before, value_at), p1 = read(span.after, value_at);
        double value = p0;
        if (cubic)
            value = hermite(span.fraction, p0, span.duration * read(span.before, 2 * width), p1,
                            span.duration * read(span.after, 0));
        else if (channel.interpolation == Interpolation::linear)
            value = p0 + (p1 - p0) * span.fraction;
        result[i] = static_cast<float>(value);
    }
    return result;
}

std::vector<std::vector<float>> morph_weights(const Scene& scene, double time) {
    std::vector<std::vector<float>> weights(scene.nodes.size());
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        if (!node.weights.empty())
            weights[n] = node.weights;
        else if (node.mesh >= 0)
            weights[n] = scene.meshes[static_cast<size_t>(node.mesh)].weights;
    }
    if (time < 0) return weights;
    for (const Animation& animation : scene.animations)
        for (const AnimationChannel& channel : animation.channels) {
            if (channel.path != Path::weights || channel.node < 0 || channel.times.empty())
                continue;
            const size_t values_per_key =
                channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
            const size_t width = channel.values.size() / (channel.times.size() * values_per_key);
            weights[static_cast<size_t>(channel.node)] = channel_value(channel, time, width);
        }
    return weights;
}

}  // namespace aglow::mesh
