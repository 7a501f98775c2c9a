// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/meshes.h"

#include "aglow/scene/gltf/attributes.h"
#include "aglow/scene/gltf/displacement_tag.h"
#include "aglow/scene/gltf/sharp_tags.h"
#include "aglow/scene/gltf/triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace aglow::gltf {
namespace {

constexpr int kTriangles = 4, kFan = 6;

/// What reading one primitive needs to know besides its JSON.
struct Reader {
    std::span<const BufferView> views;
    Accessors& accessors;
    size_t material_count;
    std::vector<std::string>& warnings;

    void warn(const Json& json, std::string_view what) const {
        warnings.push_back(fmt::format("{}: {}", json.element(), what));
    }
};

Status read_positions(AttributeReader& attributes, Primitive& primitive) {
    AG_TRY(const std::vector<float> values, attributes.read("POSITION", {3}));
    primitive.positions.reserve(values.size() / 3);
    for (size_t i = 0; i + 2 < values.size(); i += 3)
        primitive.positions.push_back({values[i], values[i + 1], values[i + 2]});
    return {};
}

Status read_texcoords(AttributeReader& attributes, Primitive& primitive) {
    const size_t count = primitive.positions.size();
    const size_t sets = attributes.set_count("TEXCOORD_");
    AG_CHECK(attributes.charge(2 * count * sets));
    primitive.texcoords.resize(sets);
    for (size_t set = 0; set < sets; ++set) {
        AG_TRY(const std::vector<float> values,
               attributes.read(fmt::format("TEXCOORD_{}", set), {2}));
        // A gap in the numbering reads as zeros: every set has its place.
        primitive.texcoords[set].assign(count, vec2{0, 0});
        for (size_t i = 0; 2 * i < values.size(); ++i)
            primitive.texcoords[set][i] = {values[2 * i], values[2 * i + 1]};
    }
    return {};
}

Status read_colors(const Reader& reader, const Json& json, AttributeReader& attributes,
                   Primitive& primitive) {
    AG_TRY(const std::vector<float> values, attributes.read("COLOR_0", {3, 4}));
    if (values.empty()) return {};
    const size_t count = primitive.positions.size();
    const size_t width = values.size() / count;
    bool clamped = false;
    const auto channel = [&](size_t i, size_t k) {
        const float v = k < width ? values[i * width + k] : 1.0f;
        clamped = clamped || v < 0 || v > 1;
        return std::clamp(v, 0.0f, 1.0f);
    };
    for (size_t i = 0; i < count; ++i)
        primitive.colors.push_back({channel(i, 0), channel(i, 1), channel(i, 2), channel(i, 3)});
    if (clamped) reader.warn(json, "COLOR_0 is clamped to 0..1");
    return {};
}

/// Sets JOINTS_n and WEIGHTS_n side by side: influences 4 n .. 4 n + 3 of each vertex.
Status read_influences(const Json& json, AttributeReader& attributes, Primitive& primitive) {
    const size_t sets = attributes.set_count("JOINTS_");
    if (sets != attributes.set_count("WEIGHTS_"))
        return json.wrong("JOINTS and WEIGHTS differ in their number of sets");
    constexpr size_t kMaxSets = 64;
    if (sets > kMaxSets) return json.wrong("has too many sets of joints");
    const size_t count = primitive.positions.size(), width = 4 * sets;
    primitive.influences = static_cast<int>(width);
    AG_CHECK(attributes.charge(2 * count * width));
    primitive.joints.assign(count * width, 0);
    primitive.weights.assign(count * width, 0);
    for (size_t set = 0; set < sets; ++set) {
        AG_TRY(const std::vector<float> joints,
               attributes.read(fmt::format("JOINTS_{}", set), {4}));
        AG_TRY(const std::vector<float> weights,
               attributes.read(fmt::format("WEIGHTS_{}", set), {4}));
        if (joints.empty() || weights.empty()) continue;
        for (size_t i = 0; i < 4 * count; ++i) {
            const size_t at = i / 4 * width + 4 * set + i % 4;
            if (joints[i] < 0 || joints[i] > 65535) return json.wrong("a joint is out of range");
            if (weights[i] < 0) return json.wrong("a joint's weight is negative");
            primitive.weights[at] = weights[i];
            // The joint of a weight of zero says nothing and need not exist.
            primitive.joints[at] = weights[i] > 0 ? static_cast<uint32_t>(joints[i]) : 0;
        }
    }
    return {};
}

/// Names that begin with an underscore are free for all: another meaning is no fault of the file.
Result<std::vector<float>> read_scalar_tag(const Reader& reader, const Json& json,
                                           AttributeReader& attributes, const std::string& name) {
    Result<std::vector<float>> values = attributes.read(name, {1});
    if (values || values.error().code != Errc::malformed) return values;
    reader.warn(json, fmt::format("{} is left out: {}", name, values.error().message));
    return std::vector<float>();
}

Status read_scalar_tags(const Reader& reader, const Json& json, AttributeReader& attributes,
                        Primitive& primitive) {
    AG_TRY(primitive.sharpness, read_scalar_tag(reader, json, attributes, "_SHARPNESS"));
    AG_TRY(primitive.tension, read_scalar_tag(reader, json, attributes, "_TENSION"));
    AG_TRY(primitive.bias, read_scalar_tag(reader, json, attributes, "_BIAS"));
    return {};
}

std::vector<vec3> as_vectors(std::span<const float> values) {
    std::vector<vec3> vectors;
    for (size_t i = 0; i + 2 < values.size(); i += 3)
        vectors.push_back({values[i], values[i + 1], values[i + 2]});
    return vectors;
}

Status read_targets(const Reader& reader, const Json& json, Primitive& primitive) {
    AG_TRY(const Json list, json.array("targets"));
    for (size_t i = 0; i < list.size(); ++i) {
        AG_TRY(const Json target, list.entry(i, fmt::format("{} target {}", json.element(), i)));
        AttributeReader attributes(target, reader.accessors, primitive.positions.size());
        MorphTarget morph;
        AG_TRY(const std::vector<float> positions, attributes.read("POSITION", {3}));
        AG_TRY(const std::vector<float> normals, attributes.read("NORMAL", {3}));
        morph.positions = as_vectors(positions);
        morph.normals = as_vectors(normals);
        primitive.targets.push_back(std::move(morph));
    }
    return {};
}

Result<std::vector<uint32_t>> read_indices(const Reader& reader, const Json& json,
                                           const DracoMesh* draco, size_t vertex_count) {
    if (draco) return draco->indices;
    AG_TRY(const int accessor, json.index("indices", reader.accessors.size(), "accessor"));
    std::vector<uint32_t> indices;
    if (accessor < 0) {
        AG_CHECK(reader.accessors.charge(vertex_count, json.element()));
        indices.resize(vertex_count);
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }
    if (reader.accessors[accessor].components != 1)
        return json.wrong("indices must be of type SCALAR");
    AG_TRY(indices, reader.accessors.uints(accessor));
    for (size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= vertex_count)
            return json.wrong(fmt::format("index {} is {}, but there are {} vertices", i,
                                          indices[i], vertex_count));
    return indices;
}

/// Points and lines block no light: nothing of them is kept but the number of morph targets.
void make_empty(Primitive& primitive) {
    Primitive empty;
    empty.material = primitive.material;
    empty.targets.resize(primitive.targets.size());
    primitive = std::move(empty);
}

Status read_vertices(const Reader& reader, const Json& json, AttributeReader& attributes,
                     Primitive& primitive) {
    AG_CHECK(read_positions(attributes, primitive));
    AG_TRY(const std::vector<float> normals, attributes.read("NORMAL", {3}));
    primitive.normals = as_vectors(normals);
    AG_CHECK(read_texcoords(attributes, primitive));
    AG_CHECK(read_colors(reader, json, attributes, primitive));
    AG_CHECK(read_influences(json, attributes, primitive));
    AG_CHECK(read_scalar_tags(reader, json, attributes, primitive));
    read_sharp_tags(json, primitive, reader.warnings);
    read_displacement_tag(json, primitive, reader.warnings);
    return read_targets(reader, json, primitive);
}

/// Numbers that flat shading will write: all attributes of three vertices per triangle.
uint64_t flat_numbers(const Primitive& primitive) {
    const size_t attributes = 13 + 2 * primitive.texcoords.size() +
                              2 * static_cast<size_t>(primitive.influences) +
                              3 * primitive.targets.size();
    return 3 * attributes * primitive.triangles.size();
}

Status make_normals(const Reader& reader, const Json& json, Primitive& primitive) {
    if (primitive.normals.empty()) {
        AG_CHECK(reader.accessors.charge(flat_numbers(primitive), json.element()));
        make_flat(primitive);
        return {};
    }
    const size_t repaired = repair_normals(primitive);
    if (repaired > 0)
        reader.warn(json, fmt::format("{} normals of length zero are replaced", repaired));
    return {};
}

Result<Primitive> read_primitive(const Reader& reader, const Json& json) {
    Primitive primitive;
    AG_TRY(primitive.material, json.index("material", reader.material_count, "material"));
    AG_TRY(const uint64_t mode, json.size("mode", kTriangles));
    if (mode > kFan) return json.wrong(fmt::format("mode {} does not exist", mode));
    AG_TRY(const Json attribute_list, json.object("attributes"));
    if (!attribute_list.has("POSITION")) {
        reader.warn(json, "has no POSITION and is left out");
        AG_TRY(const Json targets, json.array("targets"));
        primitive.targets.resize(targets.size());
        return primitive;
    }
    AG_TRY(const auto draco, read_draco(json, attribute_list, reader.views, reader.accessors));
    AttributeReader attributes(attribute_list, reader.accessors, draco ? &*draco : nullptr);
    AG_CHECK(read_vertices(reader, json, attributes, primitive));
    AG_TRY(const std::vector<uint32_t> indices,
           read_indices(reader, json, draco ? &draco->mesh : nullptr, primitive.positions.size()));
    // Draco stores triangles whatever the mode of the primitive was.
    primitive.triangles = triangles_of(draco ? kTriangles : static_cast<int>(mode), indices);
    if (mode == kTriangles && indices.size() % 3 != 0)
        reader.warn(json, "the last triangle is incomplete and is left out");
    AG_CHECK(make_normals(reader, json, primitive));
    if (primitive.triangles.empty()) make_empty(primitive);
    return primitive;
}

Result<Mesh> read_mesh(const Reader& reader, const Json& json) {
    Mesh mesh;
    AG_TRY(mesh.name, json.text("name", ""));
    AG_TRY(mesh.weights, json.number_list("weights"));
    AG_TRY(const Json list, json.array("primitives"));
    for (size_t i = 0; i < list.size(); ++i) {
        AG_TRY(const Json entry, list.entry(i, fmt::format("{} primitive {}", json.element(), i)));
        AG_TRY(Primitive primitive, read_primitive(reader, entry));
        if (i > 0 && primitive.targets.size() != mesh.primitives[0].targets.size())
            return entry.wrong("differs from primitive 0 in its number of morph targets");
        mesh.primitives.push_back(std::move(primitive));
    }
    const size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives[0].targets.size();
    if (!mesh.weights.empty() && mesh.weights.size() != targets)
        return json.wrong(
            fmt::format("has {} weights for {} morph targets", mesh.weights.size(), targets));
    mesh.weights.resize(targets, 0.0f);
    return mesh;
}

}  // namespace

Result<std::vector<Mesh>> read_meshes(const Json& root, std::span<const BufferView> views,
                                      Accessors& accessors, size_t material_count,
                                      std::vector<std::string>& warnings) {
    const Reader reader{views, accessors, material_count, warnings};
    AG_TRY(const std::vector<Json> list, elements(root, "meshes", "mesh"));
    std::vector<Mesh> meshes;
    for (const Json& json : list) {
        AG_TRY(Mesh mesh, read_mesh(reader, json));
        meshes.push_back(std::move(mesh));
    }
    return meshes;
}

}  // namespace aglow::gltf
