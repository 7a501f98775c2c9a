// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/obj/obj.h"

#include "aglow/core/file.h"
#include "aglow/scene/obj/materials.h"
#include "aglow/scene/obj/polygon.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <new>
#include <sstream>
#include <tuple>

namespace aglow {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxCorners = 4096;  // of one polygon; bounds the time to triangulate it

/// Indices of one corner, from 0; -1 where the file gives none.
struct Corner {
    int position, texcoord, normal;
};

struct Face {
    uint32_t first_corner, corner_count;
    int material;
};

struct Object {
    std::string name;
    std::vector<Face> faces;
};

/// tinyobjloader tells what it reads line by line; indices are resolved and checked here.
struct Parser {
    std::vector<vec3> positions, normals;
    std::vector<vec2> texcoords;
    std::vector<Corner> corners;
    std::vector<Object> objects{{}};
    obj::MaterialLibrary* library = nullptr;
    bool has_object_lines = false;
    int material = -1;
    size_t face_count = 0, tiny_faces = 0;
    std::string problem;

    void start_object(const std::string& name) {
        if (objects.back().faces.empty())
            objects.back().name = name;
        else
            objects.push_back({name, {}});
    }

    /// Index from 0 of a raw one: from 1, or from the end where negative; 0 stands for "none".
    static int resolved(int raw, size_t count) {
        if (raw > 0) return raw - 1;
        return raw < 0 ? static_cast<int>(count) + raw : -1;
    }

    void add_face(const tinyobj::index_t* indices, size_t count) {
        ++face_count;
        if (!problem.empty()) return;
        if (count < 3) {
            ++tiny_faces;
            return;
        }
        if (count > kMaxCorners) {
            problem = fmt::format("face {} has {} corners; {} are the most", face_count, count,
                                  kMaxCorners);
            return;
        }
        const auto first = static_cast<uint32_t>(corners.size());
        for (size_t i = 0; i < count; ++i) {
            const Corner corner{resolved(indices[i].vertex_index, positions.size()),
                                resolved(indices[i].texcoord_index, texcoords.size()),
                                resolved(indices[i].normal_index, normals.size())};
            check(indices[i], corner);
            corners.push_back(corner);
        }
        objects.back().faces.push_back({first, static_cast<uint32_t>(count), material});
    }

    void check(const tinyobj::index_t& raw, const Corner& corner) {
        const auto check_one = [&](const char* what, int given, int index, size_t count) {
            const bool none = given == 0 && index < 0;
            if (!none && (index < 0 || static_cast<size_t>(index) >= count))
                problem = fmt::format("face {}: {} {} does not exist", face_count, what, given);
        };
        check_one("texture coordinate", raw.texcoord_index, corner.texcoord, texcoords.size());
        check_one("normal", raw.normal_index, corner.normal, normals.size());
        if (raw.vertex_index == 0)
            problem = fmt::format("face {}: vertices are counted from 1", face_count);
        else
            check_one("vertex", raw.vertex_index, corner.position, positions.size());
    }
};

Parser& parser_of(void* user) { return *static_cast<Parser*>(user); }

tinyobj::callback_t callbacks() {
    tinyobj::callback_t c;
    c.vertex_cb = [](void* user, float x, float y, float z, float) {
        parser_of(user).positions.push_back({x, y, z});
    };
    c.normal_cb = [](void* user, float x, float y, float z) {
        parser_of(user).normals.push_back({x, y, z});
    };
    c.texcoord_cb = [](void* user, float u, float v, float) {
        parser_of(user).texcoords.push_back({u, 1 - v});  // glTF counts from the image's top
    };
    c.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
        parser_of(user).add_face(indices, static_cast<size_t>(count));
    };
    c.usemtl_cb = [](void* user, const char* name, int) {
        parser_of(user).material = parser_of(user).library->find(name);
    };
    c.object_cb = [](void* user, const char* name) {
        parser_of(user).has_object_lines = true;
        parser_of(user).start_object(name);
    };
    c.group_cb = [](void* user, const char** names, int count) {
        if (!parser_of(user).has_object_lines)
            parser_of(user).start_object(count > 0 ? names[0] : "");
    };
    return c;
}

/// Reads MTL files of the OBJ's folder only.
class MaterialReader : public tinyobj::MaterialReader {
public:
    MaterialReader(Scene& scene, fs::path folder, obj::MaterialLibrary& library)
        : scene_(scene), folder_(std::move(folder)), library_(library) {}

    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* index_of, std::string* warning,
                    std::string* error) override {
        const Result<fs::path> path = obj::path_in_folder(name, folder_);
        if (!path) return skip(path.error());
        const Result<std::vector<uint8_t>> bytes = read_file(*path);
        if (!bytes) return skip(bytes.error());
        std::istringstream text(std::string(bytes->begin(), bytes->end()));
        const size_t first = materials->size();
        tinyobj::LoadMtl(index_of, materials, &text, warning, error);
        for (size_t i = first; i < materials->size(); ++i)
            if (!(*materials)[i].name.empty()) library_.add((*materials)[i]);
        return !materials->empty();
    }

private:
    bool skip(const Error& error) {
        scene_.warnings.push_back("materials are left out: " + to_string(error));
        return false;
    }

    Scene& scene_;
    fs::path folder_;
    obj::MaterialLibrary& library_;
};

/// Builds one primitive: corners that agree in all they have share a vertex.
class PrimitiveBuilder {
public:
    explicit PrimitiveBuilder(const Parser& parser, int material) : parser_(parser) {
        primitive_.material = material;
    }

    void add(const Face& face, int face_number) {
        const auto corners =
            std::span(parser_.corners).subspan(face.first_corner, face.corner_count);
        outline_.clear();
        for (const Corner& c : corners) outline_.push_back(position(c));
        for (const uvec3 t : obj::triangulate(outline_)) {
            const vec3 flat = cross(outline_[t.y] - outline_[t.x], outline_[t.z] - outline_[t.x]);
            primitive_.triangles.push_back({vertex(corners[t.x], flat, face_number),
                                            vertex(corners[t.y], flat, face_number),
                                            vertex(corners[t.z], flat, face_number)});
        }
    }

    Primitive take() {
        if (has_texcoords_) primitive_.texcoords = {std::move(texcoords_)};
        for (vec3& n : primitive_.normals) {
            const float size = length(n);
            n = size > 0 && std::isfinite(size) ? n / size : vec3{0, 1, 0};
        }
        return std::move(primitive_);
    }

private:
    vec3 position(const Corner& c) const {
        return parser_.positions[static_cast<size_t>(c.position)];
    }

    /// Faces without normals do not share vertices with others: each has a flat normal, the sum
    /// over its triangles.
    uint32_t vertex(const Corner& c, vec3 flat_normal, int face_number) {
        const auto next = static_cast<uint32_t>(primitive_.positions.size());
        const int own = c.normal < 0 ? face_number : -1;
        const auto [at, is_new] =
            known_.try_emplace(std::tuple(c.position, c.texcoord, c.normal, own), next);
        if (is_new) {
            primitive_.positions.push_back(position(c));
            primitive_.normals.push_back(
                c.normal < 0 ? vec3{0, 0, 0} : parser_.normals[static_cast<size_t>(c.normal)]);
            texcoords_.push_back(
                c.texcoord < 0 ? vec2{0, 0} : parser_.texcoords[static_cast<size_t>(c.texcoord)]);
            has_texcoords_ = has_texcoords_ || c.texcoord >= 0;
        }
        if (c.normal < 0) primitive_.normals[at->second] += flat_normal;
        return at->second;
    }

    const Parser& parser_;
    Primitive primitive_;
    std::vector<vec2> texcoords_;
    std::vector<vec3> outline_;
    std::map<std::tuple<int, int, int, int>, uint32_t> known_;
    bool has_texcoords_ = false;
};

Mesh to_mesh(const Parser& parser, const Object& object) {
    std::map<int, PrimitiveBuilder> builders;  // by material
    int face_number = 0;
    for (const Face& face : object.faces)
        builders.try_emplace(face.material, parser, face.material)
            .first->second.add(face, face_number++);
    Mesh mesh;
    mesh.name = object.name;
    for (auto& [material, builder] : builders) mesh.primitives.push_back(builder.take());
    return mesh;
}

Status check_finite(const Parser& parser) {
    const auto check = [](const char* what, const auto& items, auto is_finite) -> Status {
        const auto bad = std::find_if_not(items.begin(), items.end(), is_finite);
        if (bad == items.end()) return {};
        return fail(Errc::malformed,
                    fmt::format("{} {} is not finite", what, bad - items.begin() + 1));
    };
    const auto finite3 = [](vec3 v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    AG_CHECK(check("vertex", parser.positions, finite3));
    AG_CHECK(check("normal", parser.normals, finite3));
    return check("texture coordinate", parser.texcoords,
                 [](vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); });
}

Result<Scene> parse(const std::vector<uint8_t>& bytes, const fs::path& path) {
    Scene scene;
    scene.name = path.filename().string();
    obj::MaterialLibrary library(scene, path.parent_path());
    MaterialReader reader(scene, path.parent_path(), library);
    Parser parser;
    parser.library = &library;
    std::istringstream text(std::string(bytes.begin(), bytes.end()));
    std::string warning, error;
    if (!tinyobj::LoadObjWithCallback(text, callbacks(), &parser, &reader, &warning, &error))
        return fail(Errc::malformed, error.empty() ? "is no OBJ" : error);
    if (!warning.empty()) scene.warnings.push_back(warning.substr(0, warning.find('\n')));
    if (!parser.problem.empty()) return fail(Errc::malformed, parser.problem);
    AG_CHECK(check_finite(parser));
    if (parser.tiny_faces > 0)
        scene.warnings.push_back(
            fmt::format("{} faces have fewer than three corners", parser.tiny_faces));

    for (const Object& object : parser.objects) {
        if (object.faces.empty()) continue;
        Node node;
        node.name = object.name;
        node.mesh = static_cast<int>(scene.meshes.size());
        scene.nodes.push_back(std::move(node));
        scene.meshes.push_back(to_mesh(parser, object));
    }
    if (scene.meshes.empty()) return fail(Errc::malformed, "has no faces");
    return scene;
}

}  // namespace

Result<Scene> load_obj(const fs::path& path) {
    AG_TRY(const std::vector<uint8_t> bytes, read_file(path));
    const auto with_name = [&](Errc code, std::string message) {
        return fail(code, std::move(message), path.filename().string());
    };
    try {
        Result<Scene> scene = parse(bytes, path);
        if (!scene) return with_name(scene.error().code, scene.error().message);
        return scene;
    } catch (const std::bad_alloc&) {
        return with_name(Errc::out_of_memory, "does not fit into memory");
    } catch (const std::exception& error) {
        return with_name(Errc::malformed, fmt::format("cannot be parsed: {}", error.what()));
    }
}

}  // namespace aglow
