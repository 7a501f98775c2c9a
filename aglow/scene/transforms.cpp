// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace aglow {
namespace {

using Value = std::array<double, 4>;  // a translation or scale leaves the last entry unused

/// The two keys around a time, and where between them it lies.
struct Span {
    size_t key = 0;
    size_t next = 0;
    double fraction = 0;  ///< 0..1
    double seconds = 0;   ///< from key to next
};

/// Held at the ends; at keys that share a time, the last one counts.
Span locate(const std::vector<float>& times, double time) {
    const auto after = std::upper_bound(times.begin(), times.end(), time,
                                        [](double t, float key) { return t < double{key}; });
    const size_t next = static_cast<size_t>(after - times.begin());
    if (next == 0) return {0, 0, 0, 0};
    if (next == times.size()) return {next - 1, next - 1, 0, 0};
    const double begin = times[next - 1], seconds = double{times[next]} - begin;
    return {next - 1, next, (time - begin) / seconds, seconds};
}

size_t width_of(const AnimationChannel& channel) { return channel.path == Path::rotation ? 4 : 3; }

/// Entry `part` (0 value; of cubic splines 0 in-tangent, 1 value, 2 out-tangent) of a key.
Value key_value(const AnimationChannel& channel, size_t key, size_t part) {
    const size_t width = width_of(channel);
    const size_t parts = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
    Value value{};
    for (size_t i = 0; i < width; ++i) value[i] = channel.values[(key * parts + part) * width + i];
    return value;
}

Value blend(const Value& a, double weight_a, const Value& b, double weight_b) {
    Value sum{};
    for (size_t i = 0; i < 4; ++i) sum[i] = a[i] * weight_a + b[i] * weight_b;
    return sum;
}

/// Spherical interpolation along the shorter arc (glTF 2.0, appendix C.4).
Value slerp(const Value& a, const Value& b, double t) {
    double cosine = 0;
    for (size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
    const double sign = cosine < 0 ? -1 : 1;
    const double angle = std::acos(std::min(1.0, cosine * sign));
    constexpr double kTiny = 1e-6;  // radians; below, the chord is the arc to double precision
    if (angle < kTiny) return blend(a, 1 - t, b, t * sign);
    const double sine = std::sin(angle);
    return blend(a, std::sin((1 - t) * angle) / sine, b, std::sin(t * angle) / sine * sign);
}

/// Hermite spline (glTF 2.0, appendix C.5).
Value spline(const AnimationChannel& channel, const Span& span) {
    const double t = span.fraction, t2 = t * t, t3 = t2 * t;
    const Value values = blend(key_value(channel, span.key, 1), 2 * t3 - 3 * t2 + 1,
                               key_value(channel, span.next, 1), -2 * t3 + 3 * t2);
    const Value tangents = blend(key_value(channel, span.key, 2), span.seconds * (t3 - 2 * t2 + t),
                                 key_value(channel, span.next, 0), span.seconds * (t3 - t2));
    return blend(values, 1, tangents, 1);
}

Value evaluate(const AnimationChannel& channel, double time) {
    const Span span = locate(channel.times, time);
    switch (channel.interpolation) {
        case Interpolation::step:
            return key_value(channel, span.key, 0);
        case Interpolation::cubic_spline:
            return spline(channel, span);
        case Interpolation::linear:
            break;
    }
    const Value a = key_value(channel, span.key, 0), b = key_value(channel, span.next, 0);
    if (channel.path == Path::rotation) return slerp(a, b, span.fraction);
    return blend(a, 1 - span.fraction, b, span.fraction);
}

vec4 unit_quaternion(const Value& q) {
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(length > 0)) return {0, 0, 0, 1};
    return {static_cast<float>(q[0] / length), static_cast<float>(q[1] / length),
            static_cast<float>(q[2] / length), static_cast<float>(q[3] / length)};
}

struct LocalPose {
    vec3 translation, scale;
    vec4 rotation;
};

void move(const Scene& scene, double time, std::vector<LocalPose>& poses) {
    for (const Animation& animation : scene.animations)
        for (const AnimationChannel& channel : animation.channels) {
            if (channel.path == Path::weights || channel.times.empty()) continue;
            LocalPose& pose = poses[static_cast<size_t>(channel.node)];
            const Value v = evaluate(channel, time);
            const vec3 vector{static_cast<float>(v[0]), static_cast<float>(v[1]),
                              static_cast<float>(v[2])};
            if (channel.path == Path::translation) pose.translation = vector;
            if (channel.path == Path::scale) pose.scale = vector;
            if (channel.path == Path::rotation) pose.rotation = unit_quaternion(v);
        }
}

/// A matrix in double: products along deep trees keep the precision of their factors.
using Matrix = std::array<double, 16>;

Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix product{};
    for (size_t column = 0; column < 4; ++column)
        for (size_t row = 0; row < 4; ++row)
            for (size_t k = 0; k < 4; ++k)
                product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    return product;
}

Matrix local_matrix(const Node& node, const LocalPose& pose) {
    const mat4 local =
        node.has_matrix ? node.matrix : compose(pose.translation, pose.rotation, pose.scale);
    Matrix wide;
    std::copy(local.m.begin(), local.m.end(), wide.begin());
    return wide;
}

}  // namespace

std::vector<mat4> world_transforms(const Scene& scene, double time) {
    std::vector<LocalPose> poses;
    poses.reserve(scene.nodes.size());
    for (const Node& node : scene.nodes)
        poses.push_back({node.translation, node.scale, node.rotation});
    if (time >= 0) move(scene, time, poses);

    // Parents come before their children; roots are multiplied with nothing.
    std::vector<size_t> open;
    for (size_t i = scene.nodes.size(); i-- > 0;)
        if (scene.nodes[i].parent < 0) open.push_back(i);
    std::vector<Matrix> world(scene.nodes.size());
    while (!open.empty()) {
        const size_t i = open.back();
        open.pop_back();
        const Node& node = scene.nodes[i];
        const Matrix local = local_matrix(node, poses[i]);
        world[i] = node.parent < 0 ? local : world[static_cast<size_t>(node.parent)] * local;
        for (const int child : node.children) open.push_back(static_cast<size_t>(child));
    }
    std::vector<mat4> result(world.size());
    for (size_t i = 0; i < world.size(); ++i)
        std::transform(world[i].begin(), world[i].end(), result[i].m.begin(),
                       [](double v) { return static_cast<float>(v); });
    return result;
}

}  // namespace aglow
