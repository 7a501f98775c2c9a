// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/ray_scene.h"

#include "aglow/accel/cpu/embree_scene.h"

namespace aglow {

RayScene::RayScene(std::unique_ptr<accel::cpu::EmbreeScene> cpu) : cpu_(std::move(cpu)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

Result<RayScene> RayScene::create(const Scene& scene, const Surfaces& surfaces) {
    AG_TRY(auto cpu, accel::cpu::EmbreeScene::create(scene, surfaces));
    return RayScene(std::move(cpu));
}

std::optional<Hit> RayScene::intersect(const Ray& ray) const {
    accel::cpu::SurfaceHit hit;
    if (!cpu_->intersect(ray.origin, ray.direction, ray.far, hit)) return std::nullopt;
    return Hit{hit.at, hit.distance, hit.front};
}

float RayScene::visibility(const Ray& ray) const {
    return cpu_->visibility(ray.origin, ray.direction, ray.far);
}

float coordinate_magnitude(const Surfaces& surfaces, uint32_t triangle) {
    float magnitude = 0;
    for (int i = 0; i < 3; ++i) {
        const vec3 corner = surfaces.corner(triangle, i);
        for (const float component : {corner.x, corner.y, corner.z})
            magnitude = shared::max(magnitude, shared::abs(component));
    }
    return magnitude;
}

}  // namespace aglow
