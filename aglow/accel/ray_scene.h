// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/mesh/surfaces.h"

#include <memory>
#include <optional>

namespace aglow {

namespace accel::cpu {
class EmbreeScene;
}

struct Ray {
    vec3 origin;
    vec3 direction;  ///< unit
    float far = kInfinity;
};

struct Hit {
    SurfacePoint at;
    float distance = 0;
    bool front = true;  ///< the ray came from the triangle's front
};

/// What a ray hits: all triangles of posed surfaces. Surfaces block from both sides. Alpha masks
/// block where their texture says so. A blended surface lets the share 1 - alpha of light pass, and
/// is hit with probability alpha, decided by a hash of the ray, so that a repeated ray gets the
/// same answer.
/// Thread safety  all const members may be called from any thread.
class RayScene {
public:
    /// Keeps references: `scene` and `surfaces` must outlive the result and stay as they are.
    /// Errors  out_of_memory.   Cost  O(n log n) in triangles.   Repeat  same hits every run.
    static Result<RayScene> create(const Scene& scene, const Surfaces& surfaces);
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;
    ~RayScene();

    std::optional<Hit> intersect(const Ray& ray) const;
    /// Share of light that passes all that stands within (0, ray.far): 0 where something opaque
    /// does.
    float visibility(const Ray& ray) const;

    const accel::cpu::EmbreeScene& cpu() const { return *cpu_; }  ///< for kernels in cpu/ folders

private:
    explicit RayScene(std::unique_ptr<accel::cpu::EmbreeScene> cpu);
    std::unique_ptr<accel::cpu::EmbreeScene> cpu_;
};

/// How far off a surface a ray has to start or end, m: just more than the rounding error that a
/// point on a triangle with coordinates up to `magnitude` can carry. Relative to the coordinates,
/// so that a scene of millimetres and one of kilometres behave alike. Source  Waechter & Binder, "A
/// Fast and Robust Method for Avoiding Self-Intersection",
///         Ray Tracing Gems, 2019.
inline float clearance(float magnitude) {
    // A point made of three weighted corners errs by up to 4 half units in the last place, 2^-22 of
    // the largest coordinate, and so does the plane that a ray test sees; 2^-18 is 8 times both.
    return 0x1p-18f * magnitude;
}

/// `p` moved off its surface along the unit normal `n` by the clearance. A ray that starts there
/// meets neither its own triangle nor one that coincides with it.
inline vec3 offset_origin(vec3 p, vec3 n, float magnitude) { return p + n * clearance(magnitude); }

/// Largest absolute coordinate of the triangle's corners: the `magnitude` for points on it.
float coordinate_magnitude(const Surfaces& surfaces, uint32_t triangle);

}  // namespace aglow
