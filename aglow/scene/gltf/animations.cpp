// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/animations.h"

#include <fmt/format.h>

#include <optional>

namespace aglow::gltf {
namespace {

/// One sampler, not yet bound to what it moves.
struct Sampler {
    Interpolation interpolation = Interpolation::linear;
    int input = -1;
    int output = -1;
};

Result<Sampler> read_sampler(const Json& json, const Accessors& accessors) {
    Sampler sampler;
    AG_TRY(sampler.input, json.required_index("input", accessors.size(), "accessor"));
    AG_TRY(sampler.output, json.required_index("output", accessors.size(), "accessor"));
    AG_TRY(const std::string mode, json.text("interpolation", "LINEAR"));
    if (mode == "STEP")
        sampler.interpolation = Interpolation::step;
    else if (mode == "CUBICSPLINE")
        sampler.interpolation = Interpolation::cubic_spline;
    else if (mode != "LINEAR")
        return json.wrong(fmt::format("interpolation \"{}\" does not exist", mode.substr(0, 20)));
    return sampler;
}

std::optional<Path> path_of(std::string_view name) {
    if (name == "translation") return Path::translation;
    if (name == "rotation") return Path::rotation;
    if (name == "scale") return Path::scale;
    if (name == "weights") return Path::weights;
    return std::nullopt;
}

/// Numbers per key of a channel.
size_t width_of(const Scene& scene, int node, Path path) {
    if (path == Path::rotation) return 4;
    if (path != Path::weights) return 3;
    const int mesh = scene.nodes[static_cast<size_t>(node)].mesh;
    return mesh < 0 ? 0 : scene.meshes[static_cast<size_t>(mesh)].weights.size();
}

Status read_keys(const Json& json, Accessors& accessors, const Sampler& sampler, size_t width,
                 AnimationChannel& channel) {
    if (accessors[sampler.input].components != 1) return json.wrong("input must be of type SCALAR");
    const int components = channel.path == Path::weights ? 1 : static_cast<int>(width);
    if (accessors[sampler.output].components != components)
        return json.wrong(fmt::format("output must have {} components", components));
    AG_TRY(channel.times, accessors.floats(sampler.input));
    AG_TRY(channel.values, accessors.floats(sampler.output));
    channel.interpolation = sampler.interpolation;
    if (channel.times.empty()) return json.wrong("has no keys");
    for (size_t k = 1; k < channel.times.size(); ++k)
        if (channel.times[k] < channel.times[k - 1])
            return json.wrong(fmt::format("time of key {} is before that of key {}", k, k - 1));
    const size_t per_key = sampler.interpolation == Interpolation::cubic_spline ? 3 * width : width;
    if (channel.values.size() != channel.times.size() * per_key)
        return json.wrong(fmt::format("has {} numbers for {} keys of {}", channel.values.size(),
                                      channel.times.size(), per_key));
    return {};
}

/// The channel, or nothing where it moves no node.
Result<std::optional<AnimationChannel>> read_channel(const Json& json, Accessors& accessors,
                                                     std::span<const Sampler> samplers,
                                                     Scene& scene) {
    AG_TRY(const int sampler, json.required_index("sampler", samplers.size(), "sampler"));
    AG_TRY(const Json target, json.object("target"));
    if (!target.exists()) return json.wrong("target is missing");
    AnimationChannel channel;
    AG_TRY(channel.node, target.index("node", scene.nodes.size(), "node"));
    AG_TRY(const std::string name, target.text("path", ""));
    const std::optional<Path> path = path_of(name);
    if (channel.node < 0 || name == "pointer") return std::optional<AnimationChannel>();
    if (!path) return json.wrong(fmt::format("path \"{}\" does not exist", name.substr(0, 20)));
    channel.path = *path;
    const size_t width = width_of(scene, channel.node, channel.path);
    if (width == 0) return json.wrong("moves morph targets of a node that has none");
    AG_CHECK(read_keys(json, accessors, samplers[static_cast<size_t>(sampler)], width, channel));
    const Node& node = scene.nodes[static_cast<size_t>(channel.node)];
    if (node.has_matrix && channel.path != Path::weights) {
        scene.warnings.push_back(fmt::format("{}: node {} has a matrix and does not move",
                                             json.element(), channel.node));
        return std::optional<AnimationChannel>();
    }
    return std::optional(std::move(channel));
}

}  // namespace

Status read_animations(const Json& root, Accessors& accessors, Scene& scene) {
    AG_TRY(const std::vector<Json> list, elements(root, "animations", "animation"));
    for (const Json& json : list) {
        Animation animation;
        AG_TRY(animation.name, json.text("name", ""));
        AG_TRY(const Json sampler_list, json.array("samplers"));
        std::vector<Sampler> samplers;
        for (size_t i = 0; i < sampler_list.size(); ++i) {
            AG_TRY(const Json entry,
                   sampler_list.entry(i, fmt::format("{} sampler {}", json.element(), i)));
            AG_TRY(const Sampler sampler, read_sampler(entry, accessors));
            samplers.push_back(sampler);
        }
        AG_TRY(const Json channel_list, json.array("channels"));
        for (size_t i = 0; i < channel_list.size(); ++i) {
            AG_TRY(const Json entry,
                   channel_list.entry(i, fmt::format("{} channel {}", json.element(), i)));
            AG_TRY(auto channel, read_channel(entry, accessors, samplers, scene));
            if (channel) animation.channels.push_back(std::move(*channel));
        }
        scene.animations.push_back(std::move(animation));
    }
    return {};
}

}  // namespace aglow::gltf
