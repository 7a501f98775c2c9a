// SPDX-License-Identifier: Apache-2.0
// Skins and animations.
#include "aglow/scene/glb/builder.h"

#include <fmt/format.h>

namespace aglow::glb {
namespace {

size_t add_times(Builder& glb, const std::vector<float>& times) {
    const size_t accessor = glb.add_accessor<float>(times, "SCALAR", kFloat, kOther);
    glb.json["accessors"][accessor]["min"] = Json::array({times.front()});
    glb.json["accessors"][accessor]["max"] = Json::array({times.back()});
    return accessor;
}

void add_channel(Builder& glb, const AnimationChannel& channel, size_t input, Json& animation) {
    constexpr const char* kModes[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    constexpr const char* kPaths[] = {"translation", "rotation", "scale", "weights"};
    const bool scalar = channel.path == Path::weights;
    const size_t width = scalar ? 1 : channel.path == Path::rotation ? 4 : 3;
    const char* type = scalar ? "SCALAR" : width == 4 ? "VEC4" : "VEC3";
    const size_t output = glb.add_accessor<float>(channel.values, type, kFloat, kOther, width);
    animation["samplers"].push_back(
        {{"input", input},
         {"output", output},
         {"interpolation", kModes[static_cast<size_t>(channel.interpolation)]}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1},
         {"target",
          {{"node", channel.node}, {"path", kPaths[static_cast<size_t>(channel.path)]}}}});
}

}  // namespace

Status add_skins(Builder& glb, const Scene& scene) {
    for (size_t i = 0; i < scene.skins.size(); ++i) {
        const Skin& skin = scene.skins[i];
        if (skin.joints.empty())
            return fail(Errc::bad_argument, fmt::format("skin {} has no joints", i));
        Json out = {{"joints", skin.joints}};
        if (!skin.inverse_bind.empty())
            out["inverseBindMatrices"] =
                glb.add_accessor<mat4>(skin.inverse_bind, "MAT4", kFloat, kOther);
        glb.json["skins"].push_back(std::move(out));
    }
    return {};
}

/// An animation without channels moves nothing and glTF has none: it is left out.
void add_animations(Builder& glb, const Scene& scene) {
    for (const Animation& animation : scene.animations) {
        if (animation.channels.empty()) continue;
        Json out = Json::object();
        put_name(out, animation.name);
        size_t input = 0;
        for (size_t i = 0; i < animation.channels.size(); ++i) {
            const AnimationChannel& channel = animation.channels[i];
            if (i == 0 || channel.times != animation.channels[i - 1].times)
                input = add_times(glb, channel.times);
            add_channel(glb, channel, input, out);
        }
        glb.json["animations"].push_back(std::move(out));
    }
}

}  // namespace aglow::glb
