// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/ray_scene.h"
#include "aglow/core/math.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/transport/lights.h"

#include <cstdint>
#include <vector>

namespace aglow {

/// A posed scene, ready to carry light. Refers to its parts; they must outlive it.
struct World {
    const Scene& scene;
    const Surfaces& surfaces;
    const RayScene& rays;
    const Lights& lights;
};

/// A point that receives light on one side: a sensor, or a sample point of a texel.
struct Receiver {
    vec3 position;          ///< m
    vec3 normal;            ///< unit; irradiance is measured on the plane it stands on
    vec3 geometric_normal;  ///< unit; directions below its plane bring nothing. Equal to `normal`
                            ///< for sensors
    float magnitude =
        0;  ///< largest coordinate nearby, see offset_origin(); 0 for a sensor in the open
};

/// The receiver on the front of a surface.
Receiver receiver_at(const Surfaces& surfaces, SurfacePoint at);

/// Irradiance in lux per colour channel.
struct Irradiance {
    vec3 direct = {0, 0,
                   0};  ///< from lights, emissive surfaces, sky and sun without any reflection
    vec3 indirect = {0, 0, 0};  ///< after one diffuse reflection or more
    vec3 total() const { return direct + indirect; }
};

/// Irradiance of a set of receivers or texels and what it took to find it.
struct IrradianceField {
    std::vector<Irradiance> values;     ///< [receiver_count] or [element_count]
    std::vector<float> standard_error;  ///< [same] of the luminance of the total, lux; empty if the
                                        ///< method does not know it
    uint64_t ray_count = 0;
    int bounces = 0;     ///< diffuse reflections accounted for
    double samples = 0;  ///< mean number of hemisphere samples per receiver
};

/// Number of diffuse reflections; kConverged follows light until it has died out.
inline constexpr int kConverged = -1;

}  // namespace aglow
