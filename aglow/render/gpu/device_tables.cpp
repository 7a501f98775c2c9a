// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/device_tables.h"

#include "aglow/render/gpu/device_room.h"

#include <algorithm>
#include <array>

namespace aglow::render::gpu {
namespace {

/// Tables that wait for their memory, so that all of it is known before any is taken.
class Uploads {
public:
    /// `data` must live until run(); `address` is where the table's address goes.
    template <class T>
    void add(std::span<const T> data, uint64_t& address, std::string_view name) {
        if (data.empty()) return;
        pending_.push_back({std::as_bytes(data), &address, name});
        bytes_ += data.size_bytes();
    }

    uint64_t bytes() const { return bytes_; }

    Result<std::vector<vk::Buffer>> run(vk::Stream& stream) const {
        std::vector<vk::Buffer> buffers;
        for (const Pending& table : pending_) {
            AG_TRY(vk::Buffer buffer, vk::make_buffer_of(stream, table.data, table.name));
            *table.address = buffer.address();
            buffers.push_back(std::move(buffer));
        }
        return buffers;
    }

private:
    struct Pending {
        std::span<const std::byte> data;
        uint64_t* address;
        std::string_view name;
    };
    std::vector<Pending> pending_;
    uint64_t bytes_ = 0;
};

/// Posed vertices, triangles with their corners, and the structure's copy of these.
uint64_t geometry_bytes(const Surfaces& surfaces) {
    return surfaces.positions.size() * 2 * sizeof(vec3) +
           surfaces.triangles.size() * (sizeof(uvec3) + 2 * sizeof(shared::Triangle));
}

std::vector<float> linear_of_srgb() {
    std::vector<float> table(256);
    for (size_t i = 0; i < table.size(); ++i)
        table[i] = srgb_to_linear(static_cast<float>(i) / 255);
    return table;
}

std::vector<vec2> joined(const std::vector<std::vector<vec2>>& sets) {
    std::vector<vec2> all;
    for (const std::vector<vec2>& set : sets) all.insert(all.end(), set.begin(), set.end());
    return all;
}

std::vector<uint32_t> material_indices(const Surfaces& surfaces, const MaterialTable& table) {
    std::vector<uint32_t> indices;
    indices.reserve(surfaces.triangles.size());
    for (const uint32_t part : surfaces.part_of)
        indices.push_back(material_index(table, surfaces.parts[part]));
    return indices;
}

/// All but addresses.
shared::DeviceScene described(const TableSource& source) {
    shared::DeviceScene scene{};
    scene.vertex_count = static_cast<uint32_t>(source.surfaces.positions.size());
    scene.texcoord_sets = static_cast<uint32_t>(source.surfaces.texcoords.size());
    scene.has_colors = source.surfaces.colors.empty() ? 0 : 1;
    scene.emitter_count = static_cast<uint32_t>(source.emitters.triangles.size());
    if (source.stored) {
        scene.lightmap_width = source.stored->width;
        scene.lightmap_height = source.stored->height;
    }
    if (const auto& sky = source.scene.sky) {
        scene.sky_luminance = sky->luminance;
        scene.sky_width = sky->image ? sky->image->width : 0;
        scene.sky_height = sky->image ? sky->image->height : 0;
        scene.sky_sampled = source.sky.width > 0 ? 1 : 0;
    }
    return scene;
}

}  // namespace

Result<DeviceTables> DeviceTables::create(vk::Stream& stream, const TableSource& source) {
    DeviceTables tables;
    shared::DeviceScene& scene = tables.scene_ = described(source);
    const MaterialTable materials = material_table(source.scene);
    for (const shared::SurfaceMaterial& m : materials.materials)
        if (m.flags & (shared::kMaterialMask | shared::kMaterialBlend)) tables.has_alpha_ = true;
    const std::vector<float> from_srgb = linear_of_srgb();
    const std::vector<vec2> texcoords = joined(source.surfaces.texcoords);
    const std::vector<uint32_t> material_of = material_indices(source.surfaces, materials);

    Uploads uploads;
    const auto add = [&](const auto& values, uint64_t& address, std::string_view name) {
        uploads.add(std::span(values.data(), values.size()), address, name);
    };
    add(source.source_of, scene.source_of, "triangle numbers");
    add(material_of, scene.material_of, "materials of triangles");
    add(texcoords, scene.texcoords, "texture coordinates");
    add(source.surfaces.colors, scene.colors, "vertex colours");
    add(materials.materials, scene.materials, "materials");
    add(materials.textures, scene.textures, "textures");
    add(materials.texels, scene.texels, "texels");
    add(from_srgb, scene.from_srgb, "sRGB table");
    add(source.emitters.triangles, scene.emitters, "emissive triangles");
    add(source.emitters.cumulative, scene.emitter_sums, "shares of emissive triangles");
    add(source.sky.rows, scene.sky_rows, "shares of the sky's rows");
    add(source.sky.cells, scene.sky_cells, "shares of the sky's pixels");
    if (source.scene.sky && source.scene.sky->image)
        add(source.scene.sky->image->pixels, scene.sky, "sky");
    if (source.stored) {
        add(source.surfaces.lightmap_uvs, scene.lightmap_uvs, "lightmap coordinates");
        add(source.stored->pixels, scene.lightmap, "lightmap");
    }
    if (source.resting) add(source.resting->pixels, tables.resting_, "resting light");

    AG_CHECK(check_room(*stream.gpu(), uploads.bytes() + geometry_bytes(source.surfaces),
                        "the scene needs", "render it with --device cpu"));
    AG_TRY(tables.buffers_, uploads.run(stream));
    return tables;
}

shared::DeviceScene DeviceTables::scene(bool resting) const {
    shared::DeviceScene scene = scene_;
    if (resting && resting_ != 0) scene.lightmap = resting_;
    return scene;
}

}  // namespace aglow::render::gpu
