// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/fair_mesh.h"

#include "aglow/accel/surface_distance.h"
#include "aglow/bake/fair/bake_maps.h"
#include "aglow/mesh/simplify.h"
#include "aglow/scene/image_file.h"
#include "aglow/scene/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>

namespace aglow {
namespace {

using bake::fair::CoarseSurface;
using bake::fair::Maps;

constexpr int kSmallestMap = 16, kLargestMap = 16384, kLargestAutomaticMap = 8192;
constexpr int kDeepest = 8;  // the finest pattern

Status check(const FairOptions& options) {
    if (!(options.ratio > 0 && options.ratio <= 1))
        return fail(Errc::bad_argument,
                    fmt::format("a ratio of {} is not above 0 and at most 1", options.ratio));
    if (!(options.max_error >= 0))
        return fail(Errc::bad_argument, fmt::format("a largest error of {}", options.max_error));
    if (options.map_size != 0 &&
        (options.map_size < kSmallestMap || options.map_size > kLargestMap))
        return fail(Errc::bad_argument, fmt::format("maps of {} texels: {} to {} are possible",
                                                    options.map_size, kSmallestMap, kLargestMap));
    return {};
}

/// Four texels for every vertex of the dense mesh, rounded up to a power of two.
int automatic_size(const Mesh& dense) {
    size_t vertices = 0;
    for (const Primitive& primitive : dense.primitives)
        vertices += std::min(primitive.positions.size(), primitive.triangles.size());
    const auto width = static_cast<unsigned>(std::sqrt(4.0 * static_cast<double>(vertices)));
    return std::clamp(static_cast<int>(std::bit_ceil(width)), kSmallestMap, kLargestAutomaticMap);
}

float diagonal_of(const Mesh& mesh) {
    Box box;
    for (const Primitive& primitive : mesh.primitives)
        for (const uvec3 t : primitive.triangles)
            for (const uint32_t v : {t.x, t.y, t.z}) box.add(primitive.positions[v]);
    return box.empty() ? 0 : length(box.size());
}

/// All triangles of a mesh over one array of vertices.
bake::fair::RefinedSurface joined(const Mesh& mesh) {
    bake::fair::RefinedSurface all;
    for (const Primitive& primitive : mesh.primitives) {
        const auto first = static_cast<uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), primitive.positions.begin(),
                             primitive.positions.end());
        for (const uvec3 t : primitive.triangles)
            all.triangles.push_back({t.x + first, t.y + first, t.z + first});
    }
    return all;
}

/// Refines the coarse mesh to as many triangles as the dense one has and compares them.
Status compare(const CoarseSurface& coarse, const Maps& maps, const Mesh& dense, size_t samples,
               FairMesh& report) {
    const size_t faces = coarse.control.topology.face_count();
    while (report.level < kDeepest && (faces << (2 * report.level)) < report.dense_triangles)
        ++report.level;
    const HeightMap heights = make_height_map(maps.heights, report.width, report.height);
    AG_TRY(const bake::fair::RefinedSurface refined,
           bake::fair::displaced(coarse, heights, report.level));
    report.refined_triangles = refined.triangles.size();
    const bake::fair::RefinedSurface original = joined(dense);
    AG_TRY(const SurfaceDifference difference,
           surface_difference({original.positions, original.triangles},
                              {refined.positions, refined.triangles}, samples));
    report.rms = difference.rms;
    report.hausdorff = difference.hausdorff;
    return {};
}

TextureImage normal_image(const Maps& maps, int width, int height, const std::string& name) {
    TextureImage image;
    image.name = name.empty() ? "normals" : name + " normals";
    image.width = width;
    image.height = height;
    image.rgba.reserve(maps.normals.size() / 3 * 4);
    for (size_t i = 0; i + 2 < maps.normals.size(); i += 3)
        image.rgba.insert(image.rgba.end(),
                          {maps.normals[i], maps.normals[i + 1], maps.normals[i + 2], 255});
    return image;
}

/// Gives every primitive the normal map in a material of its own, and the displacement map.
void attach(Scene& scene, Mesh& mesh, TextureImage normals) {
    Texture texture;
    texture.image = static_cast<int>(scene.images.size());
    texture.wrap_s = texture.wrap_t = Wrap::clamp_to_edge;
    scene.images.push_back(std::move(normals));
    const auto index = static_cast<int>(scene.textures.size());
    scene.textures.push_back(texture);
    for (Primitive& primitive : mesh.primitives) {
        const auto set = static_cast<int>(primitive.texcoords.size()) - 1;
        Material material;
        material.metallic = 0;
        if (primitive.material >= 0)
            material = scene.materials[static_cast<size_t>(primitive.material)];
        material.normal_texture = {};
        material.normal_texture.texture = index;
        material.normal_texture.texcoord = set;
        primitive.material = static_cast<int>(scene.materials.size());
        scene.materials.push_back(std::move(material));
        primitive.displacement = DisplacementRef{{}, set, 1, 0};
    }
}

Result<FairMesh> make_fair_mesh(Scene& scene, size_t index, const FairOptions& options,
                                const Monitor& monitor) {
    const Mesh dense = std::move(scene.meshes[index]);
    FairMesh report;
    report.mesh = static_cast<int>(index);
    report.diagonal = diagonal_of(dense);
    monitor("simplify", 0);
    AG_TRY(SimplifiedMesh coarse,
           simplify(dense, {options.ratio, options.max_error * report.diagonal}));
    report.dense_triangles = coarse.dense_triangles;
    report.triangles = coarse.triangles;
    monitor("unwrap", 0);
    const int size = options.map_size > 0 ? options.map_size : automatic_size(dense);
    AG_TRY(const CoarseSurface surface,
           bake::fair::make_coarse_surface(coarse.mesh, size, report.width, report.height));
    const float reach = std::max(0.1f * report.diagonal, 10 * coarse.error);
    AG_TRY(const Maps maps,
           bake::fair::bake_maps(surface, dense, report.width, report.height, reach, monitor));
    report.missed = maps.missed;
    monitor("compare", 0);
    if (options.samples > 0) AG_CHECK(compare(surface, maps, dense, options.samples, report));
    report.displacement = Image(report.width, report.height);
    for (size_t i = 0; i < maps.heights.size(); ++i)
        report.displacement.pixels[i] = vec3{1, 1, 1} * maps.heights[i];
    attach(scene, coarse.mesh, normal_image(maps, report.width, report.height, dense.name));
    scene.meshes[index] = std::move(coarse.mesh);
    return report;
}

/// Leaves out primitives without triangles, which a GLB cannot hold, and meshes without primitives.
void drop_empty(Scene& scene) {
    std::vector<int> number;
    std::vector<Mesh> meshes;
    for (Mesh& mesh : scene.meshes) {
        std::erase_if(mesh.primitives, [](const Primitive& p) { return p.triangles.empty(); });
        number.push_back(mesh.primitives.empty() ? -1 : static_cast<int>(meshes.size()));
        if (!mesh.primitives.empty()) meshes.push_back(std::move(mesh));
    }
    scene.meshes = std::move(meshes);
    for (Node& node : scene.nodes) {
        if (node.mesh >= 0) node.mesh = number[static_cast<size_t>(node.mesh)];
        if (node.mesh < 0) node.skin = -1, node.weights.clear();
    }
}

/// Items picked by their numbers, each once, in the order in which they are asked for.
template <class T>
class Picked {
public:
    explicit Picked(std::vector<T>& from) : from_(from), number_(from.size(), -1) {}

    /// Makes `index` the item's number among those picked; -1 stays.
    /// Result  the item if it had not been picked before, else null.
    T* pick(int& index) {
        if (index < 0) return nullptr;
        int& number = number_[static_cast<size_t>(index)];
        const bool added = number < 0;
        if (added) {
            number = static_cast<int>(items_.size());
            items_.push_back(std::move(from_[static_cast<size_t>(index)]));
        }
        index = number;
        return added ? &items_.back() : nullptr;
    }
    void finish() { from_ = std::move(items_); }

private:
    std::vector<T>& from_;
    std::vector<int> number_;
    std::vector<T> items_;
};

/// Leaves out materials, textures and images that nothing uses any more: among these are images
/// that loading did not decode.
void drop_unused(Scene& scene) {
    Picked materials(scene.materials);
    Picked textures(scene.textures);
    Picked images(scene.images);
    for (Mesh& mesh : scene.meshes)
        for (Primitive& primitive : mesh.primitives) {
            Material* material = materials.pick(primitive.material);
            if (!material) continue;
            for (TextureRef* use :
                 {&material->base_color_texture, &material->metallic_roughness_texture,
                  &material->emissive_texture, &material->normal_texture})
                if (Texture* texture = textures.pick(use->texture)) images.pick(texture->image);
        }
    materials.finish();
    textures.finish();
    images.finish();
}

Result<FairScene> all_fair(Scene dense, const FairOptions& options, const Monitor& monitor) {
    FairScene fair;
    fair.scene = std::move(dense);
    fair.scene.source = nullptr;
    drop_empty(fair.scene);
    for (size_t i = 0; i < fair.scene.meshes.size(); ++i) {
        if (monitor.cancelled()) return fail(Errc::cancelled, "stopped between meshes");
        Result<FairMesh> mesh = make_fair_mesh(fair.scene, i, options, monitor);
        if (!mesh) {
            mesh.error().message = fmt::format("mesh {}: {}", i, mesh.error().message);
            return tl::unexpected<Error>(std::move(mesh).error());
        }
        fair.meshes.push_back(std::move(*mesh));
    }
    drop_unused(fair.scene);
    return fair;
}

}  // namespace

Result<FairScene> make_fair(Scene dense, const FairOptions& options, const Monitor& monitor) {
    AG_CHECK(check(options));
    try {
        return all_fair(std::move(dense), options, monitor);
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory,
                    "the scene does not fit into memory; smaller maps "
                    "(--map-size) need less");
    }
}

Result<std::vector<std::filesystem::path>> write_fair(FairScene& fair,
                                                      const std::filesystem::path& path) {
    std::vector<std::filesystem::path> files;
    for (const FairMesh& mesh : fair.meshes) {
        std::string name = path.stem().string() + ".displacement";
        if (fair.meshes.size() > 1) name += fmt::format("-{}", mesh.mesh);
        files.push_back(path.parent_path() / (name + ".exr"));
        AG_CHECK(write_image(mesh.displacement, files.back()));
        for (Primitive& primitive : fair.scene.meshes[static_cast<size_t>(mesh.mesh)].primitives)
            if (primitive.displacement) primitive.displacement->file = files.back().filename();
    }
    AG_CHECK(write_glb(fair.scene, path));
    files.push_back(path);
    return files;
}

}  // namespace aglow
