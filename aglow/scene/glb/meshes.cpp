// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/glb/builder.h"
#include "aglow/scene/gltf/edit/pack.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace aglow::glb {
namespace {

constexpr uint32_t kMaxJoint = 0xffff;  // largest joint a vertex can name

/// What of a mesh glTF cannot say.
Status check(const Mesh& mesh) {
    if (mesh.primitives.empty()) return fail(Errc::bad_argument, "it has no primitives");
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.triangles.empty() || primitive.positions.empty())
            return fail(Errc::bad_argument, "a primitive has no triangles");
        if (primitive.targets.size() != mesh.primitives[0].targets.size())
            return fail(Errc::bad_argument,
                        "its primitives differ in their number of morph targets");
        for (const uint32_t joint : primitive.joints)
            if (joint > kMaxJoint)
                return fail(Errc::bad_argument,
                            fmt::format("joint {} is beyond {}, the last a GLB can name", joint,
                                        kMaxJoint));
    }
    return {};
}

size_t add_positions(Builder& glb, const std::vector<vec3>& positions) {
    const size_t accessor = glb.add_accessor<vec3>(positions, "VEC3", kFloat, kVertices);
    Box bounds;
    for (const vec3 p : positions) bounds.add(p);
    glb.json["accessors"][accessor]["min"] = to_json(bounds.lo);
    glb.json["accessors"][accessor]["max"] = to_json(bounds.hi);
    return accessor;
}

/// JOINTS_n and WEIGHTS_n: four influences a set.
void add_influences(Builder& glb, const Primitive& primitive, Json& attributes) {
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
            glb.add_accessor<uint16_t>(joints, "VEC4", kUnsignedShort, kVertices, 4);
        attributes[fmt::format("WEIGHTS_{}", set)] =
            glb.add_accessor<float>(weights, "VEC4", kFloat, kVertices, 4);
    }
}

Json attributes_of(Builder& glb, const Primitive& primitive) {
    Json out = Json::object();
    const auto add = [&](const std::string& name, const auto& values, const char* type) {
        if (!values.empty()) out[name] = glb.add_accessor(values, type, kFloat, kVertices);
    };
    out["POSITION"] = add_positions(glb, primitive.positions);
    add("NORMAL", primitive.normals, "VEC3");
    add("TANGENT", primitive.tangents, "VEC4");
    for (size_t set = 0; set < primitive.texcoords.size(); ++set)
        add(fmt::format("TEXCOORD_{}", set), primitive.texcoords[set], "VEC2");
    add("COLOR_0", primitive.colors, "VEC4");
    add_influences(glb, primitive, out);
    add("_SHARPNESS", primitive.sharpness, "SCALAR");
    add("_TENSION", primitive.tension, "SCALAR");
    add("_BIAS", primitive.bias, "SCALAR");
    return out;
}

size_t add_indices(Builder& glb, const std::vector<uvec3>& triangles) {
    std::vector<uint32_t> indices;
    indices.reserve(3 * triangles.size());
    for (const uvec3 t : triangles) indices.insert(indices.end(), {t.x, t.y, t.z});
    return glb.add_accessor<uint32_t>(indices, "SCALAR", kUnsignedInt, kIndices);
}

Json json_of(Builder& glb, const MorphTarget& target, size_t vertex_count) {
    Json out = Json::object();
    if (!target.normals.empty())
        out["NORMAL"] = glb.add_accessor<vec3>(target.normals, "VEC3", kFloat, kVertices);
    if (!target.positions.empty())
        out["POSITION"] = add_positions(glb, target.positions);
    else if (target.normals.empty())  // a target says something: that nothing moves
        out["POSITION"] = add_positions(glb, std::vector<vec3>(vertex_count, vec3{0, 0, 0}));
    return out;
}

/// As docs/formats/creases.md has them. JSON has no infinite sharpness.
void put_sharp_tags(const Primitive& primitive, Json& out) {
    const auto finite = [](float s) { return std::min(s, std::numeric_limits<float>::max()); };
    for (const SharpEdge& crease : primitive.creases)
        out["extras"]["creases"].push_back(
            Json::array({crease.a, crease.b, finite(crease.sharpness)}));
    for (const SharpVertex& corner : primitive.corners)
        out["extras"]["corners"].push_back(Json::array({corner.vertex, finite(corner.sharpness)}));
}

Json json_of(Builder& glb, const Primitive& primitive) {
    Json out = {{"attributes", attributes_of(glb, primitive)}};
    out["indices"] = add_indices(glb, primitive.triangles);
    if (primitive.material >= 0) out["material"] = primitive.material;
    for (const MorphTarget& target : primitive.targets)
        out["targets"].push_back(json_of(glb, target, primitive.positions.size()));
    put_sharp_tags(primitive, out);
    if (const auto& d = primitive.displacement)
        out["extras"]["displacement"] = {{"uri", gltf::edit::to_uri(d->file.filename().string())},
                                         {"texCoord", d->texcoord},
                                         {"scale", d->scale},
                                         {"bias", d->bias}};
    return out;
}

}  // namespace

Status add_meshes(Builder& glb, const Scene& scene) {
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i];
        if (const Status status = check(mesh); !status)
            return fail(status.error().code,
                        fmt::format("mesh {} \"{}\": {}", i, mesh.name, status.error().message));
        Json out = Json::object();
        put_name(out, mesh.name);
        for (const Primitive& primitive : mesh.primitives)
            out["primitives"].push_back(json_of(glb, primitive));
        if (!mesh.weights.empty()) out["weights"] = mesh.weights;
        glb.json["meshes"].push_back(std::move(out));
    }
    return {};
}

}  // namespace aglow::glb
