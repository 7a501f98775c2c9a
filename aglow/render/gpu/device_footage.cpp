// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/device_footage.h"

#include "aglow/render/tables/tables.h"

#include <span>
#include <utility>

namespace aglow::render::gpu {

DeviceFootage::DeviceFootage(const Scene& scene, DeviceTables tables,
                             mesh::gpu::DeviceSurfaces surfaces)
    : scene_(&scene), tables_(std::move(tables)), surfaces_(std::move(surfaces)) {}

Result<DeviceFootage> DeviceFootage::create(vk::Stream& stream, const TableSource& source) {
    AG_TRY(DeviceTables tables, DeviceTables::create(stream, source));
    AG_TRY(auto surfaces, mesh::gpu::DeviceSurfaces::create(stream, source.scene, source.surfaces));
    DeviceFootage footage(source.scene, std::move(tables), std::move(surfaces));
    const LightTable lights = light_table(source.scene, -1);
    footage.light_count_ = static_cast<uint32_t>(lights.lights.size());
    AG_TRY(footage.lights_,
           stream.make_buffer(lights.lights.size() * sizeof(shared::PunctualLight), "lights"));
    AG_TRY(footage.photometry_,
           vk::make_buffer_of(stream, std::span(lights.photometry), "photometry"));
    AG_TRY(footage.device_scene_, stream.make_buffer(sizeof(shared::DeviceScene), "scene"));
    AG_CHECK(stream.finish());
    return footage;
}

Status DeviceFootage::pose(vk::Stream& stream, double time) {
    AG_CHECK(surfaces_.pose(stream, time));
    stream.barrier();
    return {};
}

void DeviceFootage::place(vk::Stream& stream, double time, bool resting) const {
    const LightTable lights = light_table(*scene_, time);
    shared::DeviceScene scene = tables_.scene(resting);
    scene.corners = surfaces_.corners();
    scene.normals = surfaces_.normals();
    scene.triangles = surfaces_.indices();
    scene.lights = lights_.address();
    scene.photometry = photometry_.address();
    scene.light_count = light_count_;
    stream.upload(std::span<const shared::PunctualLight>(lights.lights), lights_);
    stream.upload(std::span<const shared::DeviceScene>(&scene, 1), device_scene_);
}

}  // namespace aglow::render::gpu
