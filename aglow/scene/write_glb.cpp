// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/assert.h"
#include "aglow/core/file.h"
#include "aglow/scene/image_file.h"
#include "aglow/scene/photometry.h"
#include "aglow/scene/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <set>

namespace aglow {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the glTF 2.0 specification.
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kVertices = 34962, kIndices = 34963;  // buffer view targets
constexpr int kOther = 0;                           // a view without a target
constexpr uint32_t kMaxJoint = 0xffff;              // largest joint a vertex can name
constexpr int kNearest = 9728, kLinear = 9729, kLinearMipmapLinear = 9987;
constexpr uint32_t kMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;
constexpr float kOrthographicDepth = 1000;  // m; glTF asks for a far plane, the scene has none

Json to_json(vec2 v) { return Json::array({v.x, v.y}); }
Json to_json(vec3 v) { return Json::array({v.x, v.y, v.z}); }
Json to_json(vec4 v) { return Json::array({v.x, v.y, v.z, v.w}); }

int wrap_code(Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            return 10497;
        case Wrap::mirrored_repeat:
            return 33648;
        case Wrap::clamp_to_edge:
            break;
    }
    return 33071;
}

/// A file name as a URI: what is not allowed there by its bytes.
std::string percent_coded(const std::string& name) {
    std::string uri;
    for (const char c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_' || c == '~';
        uri += plain ? std::string(1, c)
                     : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<uint8_t>(c)));
    }
    return uri;
}

/// Collects the binary chunk and the JSON that describes it.
class GlbWriter {
public:
    explicit GlbWriter(const Scene& scene) : scene_(scene) {}

    Result<std::vector<uint8_t>> write() {
        json_["asset"] = {{"version", "2.0"}, {"generator", "Aglow"}};
        add_nodes();
        AG_CHECK(add_meshes());
        AG_CHECK(add_skins());
        add_animations();
        for (const Material& material : scene_.materials)
            json_["materials"].push_back(json_of(material));
        AG_CHECK(add_textures());
        for (const Camera& camera : scene_.cameras) json_["cameras"].push_back(json_of(camera));
        add_lights();
        if (!extensions_.empty()) json_["extensionsUsed"] = extensions_;
        if (!bin_.empty()) json_["buffers"] = Json::array({{{"byteLength", bin_.size()}}});
        return assemble();
    }

private:
    static void put_name(Json& object, const std::string& name) {
        if (!name.empty()) object["name"] = name;
    }

    void add_nodes() {
        Json roots = Json::array();
        for (size_t i = 0; i < scene_.nodes.size(); ++i) {
            const Node& node = scene_.nodes[i];
            json_["nodes"].push_back(json_of(node));
            if (node.parent < 0 && node.in_scene) roots.push_back(i);
        }
        json_["scene"] = 0;
        Json scene = Json::object();
        put_name(scene, scene_.name);
        if (!roots.empty()) scene["nodes"] = roots;
        json_["scenes"] = Json::array({scene});
    }

    Json json_of(const Node& node) {
        Json out = Json::object();
        put_name(out, node.name);
        if (!node.children.empty()) out["children"] = node.children;
        if (node.has_matrix && node.matrix != mat4{}) out["matrix"] = node.matrix.m;
        if (!node.has_matrix) {
            const Node rest;
            if (node.translation != rest.translation)
                out["translation"] = to_json(node.translation);
            if (node.rotation != rest.rotation) out["rotation"] = to_json(node.rotation);
            if (node.scale != rest.scale) out["scale"] = to_json(node.scale);
        }
        if (node.mesh >= 0) out["mesh"] = node.mesh;
        if (node.skin >= 0) out["skin"] = node.skin;
        if (!node.weights.empty()) out["weights"] = node.weights;
        if (node.camera >= 0) out["camera"] = node.camera;
        if (node.light >= 0) add_light(node, out);
        return out;
    }

    Status add_meshes() {
        for (size_t i = 0; i < scene_.meshes.size(); ++i) {
            const Mesh& mesh = scene_.meshes[i];
            Json out = Json::object();
            put_name(out, mesh.name);
            if (mesh.primitives.empty())
                return fail(Errc::bad_argument,
                            fmt::format("mesh {} \"{}\" has no primitives", i, mesh.name));
            for (const Primitive& primitive : mesh.primitives) {
                if (primitive.triangles.empty() || primitive.positions.empty())
                    return fail(
                        Errc::bad_argument,
                        fmt::format("mesh {} \"{}\": a primitive has no triangles", i, mesh.name));
                if (primitive.targets.size() != mesh.primitives[0].targets.size())
                    return fail(
                        Errc::bad_argument,
                        fmt::format("mesh {} \"{}\": its primitives differ in their number of "
                                    "morph targets",
                                    i, mesh.name));
                AG_CHECK(check_joints(primitive, i, mesh.name));
                out["primitives"].push_back(json_of(primitive));
            }
            if (!mesh.weights.empty()) out["weights"] = mesh.weights;
            json_["meshes"].push_back(std::move(out));
        }
        return {};
    }

    static Status check_joints(const Primitive& primitive, size_t mesh, const std::string& name) {
        for (const uint32_t joint : primitive.joints)
            if (joint > kMaxJoint)
                return fail(Errc::bad_argument,
                            fmt::format("mesh {} \"{}\": joint {} is beyond {}, the last a GLB can "
                                        "name",
                                        mesh, name, joint, kMaxJoint));
        return {};
    }

    Json json_of(const Primitive& primitive) {
        Json attributes = Json::object();
        attributes["POSITION"] = add_positions(primitive.positions);
        if (!primitive.normals.empty())
            attributes["NORMAL"] = add_accessor<vec3>(primitive.normals, "VEC3", kFloat, kVertices);
        if (!primitive.tangents.empty())
            attributes["TANGENT"] =
                add_accessor<vec4>(primitive.tangents, "VEC4", kFloat, kVertices);
        for (size_t set = 0; set < primitive.texcoords.size(); ++set)
            attributes[fmt::format("TEXCOORD_{}", set)] =
                add_accessor<vec2>(primitive.texcoords[set], "VEC2", kFloat, kVertices);
        if (!primitive.colors.empty())
            attributes["COLOR_0"] = add_accessor<vec4>(primitive.colors, "VEC4", kFloat, kVertices);
        add_influences(primitive, attributes);
        const auto add_tag = [&](const char* name, const std::vector<float>& tag) {
            if (!tag.empty())
                attributes[name] = add_accessor<float>(tag, "SCALAR", kFloat, kVertices);
        };
        add_tag("_SHARPNESS", primitive.sharpness);
        add_tag("_TENSION", primitive.tension);
        add_tag("_BIAS", primitive.bias);

        Json out = {{"attributes", std::move(attributes)}};
        std::vector<uint32_t> indices;
        indices.reserve(3 * primitive.triangles.size());
        for (const uvec3 t : primitive.triangles) indices.insert(indices.end(), {t.x, t.y, t.z});
        out["indices"] = add_accessor<uint32_t>(indices, "SCALAR", kUnsignedInt, kIndices);
        if (primitive.material >= 0) out["material"] = primitive.material;
        for (const MorphTarget& target : primitive.targets)
            out["targets"].push_back(json_of(target, primitive.positions.size()));
        add_sharp_tags(primitive, out);
        if (const auto& d = primitive.displacement)
            out["extras"]["displacement"] = {{"uri", percent_coded(d->file.filename().string())},
                                             {"texCoord", d->texcoord},
                                             {"scale", d->scale},
                                             {"bias", d->bias}};
        return out;
    }

    /// As docs/formats/creases.md has them. JSON has no infinite sharpness.
    static void add_sharp_tags(const Primitive& primitive, Json& out) {
        const auto finite = [](float s) { return std::min(s, std::numeric_limits<float>::max()); };
        for (const SharpEdge& crease : primitive.creases)
            out["extras"]["creases"].push_back(
                Json::array({crease.a, crease.b, finite(crease.sharpness)}));
        for (const SharpVertex& corner : primitive.corners)
            out["extras"]["corners"].push_back(
                Json::array({corner.vertex, finite(corner.sharpness)}));
    }

    size_t add_positions(const std::vector<vec3>& positions) {
        const size_t accessor = add_accessor<vec3>(positions, "VEC3", kFloat, kVertices);
        Box bounds;
        for (const vec3 p : positions) bounds.add(p);
        json_["accessors"][accessor]["min"] = to_json(bounds.lo);
        json_["accessors"][accessor]["max"] = to_json(bounds.hi);
        return accessor;
    }

    /// JOINTS_n and WEIGHTS_n: four influences a set.
    void add_influences(const Primitive& primitive, Json& attributes) {
        const auto influences = static_cast<size_t>(primitive.influences);
        for (size_t set = 0; 4 * set < influences && !primitive.joints.empty(); ++set) {
            std::vector<uint16_t> joints;
            std::vector<float> weights;
            for (size_t v = 0; v < primitive.positions.size(); ++v)
                for (size_t i = 4 * set; i < 4 * set + 4; ++i) {
                    const size_t at = v * influences + i;
                    joints.push_back(static_cast<uint16_t>(primitive.joints[at]));
                    weights.push_back(primitive.weights[at]);
                }
            attributes[fmt::format("JOINTS_{}", set)] =
                add_accessor<uint16_t>(joints, "VEC4", kUnsignedShort, kVertices, 4);
            attributes[fmt::format("WEIGHTS_{}", set)] =
                add_accessor<float>(weights, "VEC4", kFloat, kVertices, 4);
        }
    }

    Json json_of(const MorphTarget& target, size_t vertex_count) {
        Json out = Json::object();
        if (!target.normals.empty())
            out["NORMAL"] = add_accessor<vec3>(target.normals, "VEC3", kFloat, kVertices);
        if (!target.positions.empty())
            out["POSITION"] = add_positions(target.positions);
        else if (target.normals.empty())  // a target says something: that nothing moves
            out["POSITION"] = add_positions(std::vector<vec3>(vertex_count, vec3{0, 0, 0}));
        return out;
    }

    Status add_skins() {
        for (size_t i = 0; i < scene_.skins.size(); ++i) {
            const Skin& skin = scene_.skins[i];
            if (skin.joints.empty())
                return fail(Errc::bad_argument, fmt::format("skin {} has no joints", i));
            Json out = {{"joints", skin.joints}};
            if (!skin.inverse_bind.empty())
                out["inverseBindMatrices"] =
                    add_accessor<mat4>(skin.inverse_bind, "MAT4", kFloat, kOther);
            json_["skins"].push_back(std::move(out));
        }
        return {};
    }

    /// An animation without channels moves nothing and glTF has none: it is left out.
    void add_animations() {
        for (const Animation& animation : scene_.animations) {
            if (animation.channels.empty()) continue;
            Json out = Json::object();
            put_name(out, animation.name);
            size_t input = 0;
            for (size_t i = 0; i < animation.channels.size(); ++i) {
                const AnimationChannel& channel = animation.channels[i];
                if (i == 0 || channel.times != animation.channels[i - 1].times)
                    input = add_times(channel.times);
                add_channel(channel, input, out);
            }
            json_["animations"].push_back(std::move(out));
        }
    }

    size_t add_times(const std::vector<float>& times) {
        const size_t accessor = add_accessor<float>(times, "SCALAR", kFloat, kOther);
        json_["accessors"][accessor]["min"] = Json::array({times.front()});
        json_["accessors"][accessor]["max"] = Json::array({times.back()});
        return accessor;
    }

    void add_channel(const AnimationChannel& channel, size_t input, Json& animation) {
        constexpr const char* kModes[] = {"STEP", "LINEAR", "CUBICSPLINE"};
        constexpr const char* kPaths[] = {"translation", "rotation", "scale", "weights"};
        const bool scalar = channel.path == Path::weights;
        const size_t width = scalar ? 1 : channel.path == Path::rotation ? 4 : 3;
        const char* type = scalar ? "SCALAR" : width == 4 ? "VEC4" : "VEC3";
        const size_t output = add_accessor<float>(channel.values, type, kFloat, kOther, width);
        animation["samplers"].push_back(
            {{"input", input},
             {"output", output},
             {"interpolation", kModes[static_cast<size_t>(channel.interpolation)]}});
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size() - 1},
             {"target",
              {{"node", channel.node}, {"path", kPaths[static_cast<size_t>(channel.path)]}}}});
    }

    Json json_of(const Material& material) {
        Json out = Json::object();
        put_name(out, material.name);
        Json& pbr = out["pbrMetallicRoughness"];
        pbr = {{"baseColorFactor", to_json(material.base_color)},
               {"metallicFactor", material.metallic},
               {"roughnessFactor", material.roughness}};
        put_texture(pbr, "baseColorTexture", material.base_color_texture);
        put_texture(pbr, "metallicRoughnessTexture", material.metallic_roughness_texture);
        put_texture(out, "normalTexture", material.normal_texture);
        put_texture(out, "emissiveTexture", material.emissive_texture);
        const vec3 e = material.emission;
        const float strength = std::max({e.x, e.y, e.z, 1.0f});  // factors may not exceed 1
        if (e != vec3{0, 0, 0}) out["emissiveFactor"] = to_json(e / strength);
        if (strength > 1)
            use(out, "KHR_materials_emissive_strength")["emissiveStrength"] = strength;
        if (material.unlit) use(out, "KHR_materials_unlit") = Json::object();
        if (material.alpha_mode == AlphaMode::blend) out["alphaMode"] = "BLEND";
        if (material.alpha_mode == AlphaMode::mask) {
            out["alphaMode"] = "MASK";
            out["alphaCutoff"] = material.alpha_cutoff;
        }
        if (material.double_sided) out["doubleSided"] = true;
        return out;
    }

    void put_texture(Json& owner, const char* key, const TextureRef& reference) {
        if (reference.texture < 0) return;
        Json out = {{"index", reference.texture}};
        if (reference.texcoord != 0) out["texCoord"] = reference.texcoord;
        const TextureRef plain;
        if (reference.offset != plain.offset || reference.scale != plain.scale ||
            reference.rotation != plain.rotation)
            use(out, "KHR_texture_transform") = {{"offset", to_json(reference.offset)},
                                                 {"rotation", reference.rotation},
                                                 {"scale", to_json(reference.scale)}};
        owner[key] = std::move(out);
    }

    Status add_textures() {
        for (const Texture& texture : scene_.textures) {
            const bool smooth = texture.filter == Filter::linear;
            json_["samplers"].push_back({{"magFilter", smooth ? kLinear : kNearest},
                                         {"minFilter", smooth ? kLinearMipmapLinear : kNearest},
                                         {"wrapS", wrap_code(texture.wrap_s)},
                                         {"wrapT", wrap_code(texture.wrap_t)}});
            Json out = {{"sampler", json_["samplers"].size() - 1}};
            if (texture.image >= 0) out["source"] = texture.image;
            json_["textures"].push_back(std::move(out));
        }
        for (const TextureImage& image : scene_.images) {
            const std::vector<uint8_t> png = encode_png(image.rgba, image.width, image.height, 4);
            if (png.empty()) return fail(Errc::out_of_memory, "images do not fit into memory");
            Json out = Json::object();
            put_name(out, image.name);
            out["mimeType"] = "image/png";
            out["bufferView"] = add_view(png.data(), png.size());
            json_["images"].push_back(std::move(out));
        }
        return {};
    }

    static Json json_of(const Camera& camera) {
        Json out = Json::object();
        put_name(out, camera.name);
        if (camera.perspective) {
            out["type"] = "perspective";
            out["perspective"] = {{"yfov", camera.y_fov}, {"znear", camera.z_near}};
            if (camera.aspect > 0) out["perspective"]["aspectRatio"] = camera.aspect;
        } else {
            out["type"] = "orthographic";
            out["orthographic"] = {{"xmag", camera.x_mag},
                                   {"ymag", camera.y_mag},
                                   {"znear", camera.z_near},
                                   {"zfar", camera.z_near + kOrthographicDepth}};
        }
        return out;
    }

    /// The node's member that names its light: punctual ones are numbered without luminaires,
    /// whose factors stand in the node.
    void add_light(const Node& node, Json& out) {
        const auto index = static_cast<size_t>(node.light);
        const Light& light = scene_.lights[index];
        const bool luminaire = light.kind == LightKind::photometric;
        const auto number = std::count_if(
            scene_.lights.begin(), scene_.lights.begin() + node.light, [&](const Light& other) {
                return (other.kind == LightKind::photometric) == luminaire;
            });
        Json& extension = use(out, luminaire ? "EXT_lights_ies" : "KHR_lights_punctual");
        extension["light"] = number;
        if (!luminaire) return;
        const vec3 i = light.intensity;
        const float brightest = std::max({i.x, i.y, i.z});
        extension["multiplier"] = brightest;
        if (brightest > 0) extension["color"] = to_json(i / brightest);
    }

    void add_luminaire(const Light& light) {
        const std::string file = to_lm63(*light.photometry);
        const size_t view = add_view(file.data(), file.size());
        Json out = {{"bufferView", view}, {"mimeType", "application/x-ies-lm-63"}};
        put_name(out, light.photometry->name);
        use(json_, "EXT_lights_ies")["lights"].push_back(std::move(out));
    }

    void add_lights() {
        for (const Light& light : scene_.lights) {
            if (light.kind == LightKind::photometric) {
                add_luminaire(light);
                continue;
            }
            constexpr const char* kKinds[] = {"point", "spot", "directional"};
            const vec3 i = light.intensity;
            const float brightest = std::max({i.x, i.y, i.z});
            Json out = Json::object();
            put_name(out, light.name);
            out["type"] = kKinds[static_cast<size_t>(light.kind)];
            out["color"] = to_json(brightest > 0 ? i / brightest : vec3{1, 1, 1});
            out["intensity"] = brightest;
            if (light.range < kInfinity && light.range > 0) out["range"] = light.range;
            if (light.kind == LightKind::spot)
                out["spot"] = {{"innerConeAngle", light.inner_cone},
                               {"outerConeAngle", light.outer_cone}};
            use(json_, "KHR_lights_punctual")["lights"].push_back(std::move(out));
        }
    }

    Json& use(Json& owner, const char* extension) {
        extensions_.insert(extension);
        return owner["extensions"][extension];
    }

    /// `width` items make one element.
    template <class T>
    size_t add_accessor(const std::vector<T>& items, const char* type, int component, int target,
                        size_t width = 1) {
        const size_t view = add_view(items.data(), items.size() * sizeof(T));
        if (target != kOther) json_["bufferViews"][view]["target"] = target;
        json_["accessors"].push_back({{"bufferView", view},
                                      {"componentType", component},
                                      {"count", items.size() / width},
                                      {"type", type}});
        return json_["accessors"].size() - 1;
    }

    size_t add_view(const void* data, size_t size) {
        bin_.resize((bin_.size() + 3) / 4 * 4);  // accessors start at multiples of their type
        json_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", size}});
        const auto* bytes = static_cast<const uint8_t*>(data);
        bin_.insert(bin_.end(), bytes, bytes + size);
        return json_["bufferViews"].size() - 1;
    }

    Result<std::vector<uint8_t>> assemble() {
        // Names come from files; what is not UTF-8 in them must not stop the writing.
        std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        bin_.resize((bin_.size() + 3) / 4 * 4);
        const size_t total = 12 + 8 + text.size() + (bin_.empty() ? 0 : 8 + bin_.size());
        if (total > UINT32_MAX)
            return fail(Errc::bad_argument, "the scene needs more than the 4 GiB a GLB can hold");
        std::vector<uint8_t> glb;
        glb.reserve(total);
        const auto word = [&](size_t value) {
            for (int shift = 0; shift < 32; shift += 8)
                glb.push_back(static_cast<uint8_t>(value >> shift & 0xff));
        };
        word(kMagic), word(2), word(total);
        word(text.size()), word(kJsonChunk);
        glb.insert(glb.end(), text.begin(), text.end());
        if (!bin_.empty()) {
            word(bin_.size()), word(kBinChunk);
            glb.insert(glb.end(), bin_.begin(), bin_.end());
        }
        return glb;
    }

    const Scene& scene_;
    Json json_ = Json::object();
    std::vector<uint8_t> bin_;
    std::set<std::string> extensions_;
};

Status check_writable(const Scene& scene) {
    for (const Node& node : scene.nodes)
        if (!node.instances.empty())
            return fail(Errc::unsupported, "instances cannot be written as a new GLB");
    return {};
}

}  // namespace

Result<std::vector<uint8_t>> to_glb(const Scene& scene) {
    AG_CHECK(check_writable(scene));
    try {
        return GlbWriter(scene).write();
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the GLB does not fit into memory");
    } catch (const nlohmann::json::exception& error) {
        return fail(Errc::bad_argument,
                    fmt::format("the scene has no JSON form: {}", error.what()));
    }
}

Status write_glb(const Scene& scene, const std::filesystem::path& path) {
    Result<std::vector<uint8_t>> glb = to_glb(scene);
    if (!glb) {
        glb.error().context = path.string();
        return tl::unexpected<Error>(std::move(glb).error());
    }
    return write_file(path, *glb);
}

}  // namespace aglow
