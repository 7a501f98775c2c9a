// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/transport/lights.h"
#include "aglow/transport/lights/light_tree.h"
#include "aglow/transport/lights/triangle_sampling.h"

#include <optional>

namespace aglow::transport {

/// The emissive triangles of posed surfaces.
class Emitters {
public:
    /// Keeps references to both.
    Emitters(const Scene& scene, const Surfaces& surfaces);

    bool empty() const { return emitters_.empty(); }

    /// Luminance that leaves a surface, cd/m^2, where one hits it.
    vec3 emitted(const SurfacePoint& at, bool front) const;

private:
    friend class EmittersSeen;
    /// An emissive triangle, with what sampling needs of it.
    struct Emitter {
        uint32_t triangle;
        vec3 corner[3];
        vec3 normal;
        float magnitude;  ///< see coordinate_magnitude()
        bool even;        ///< emits `emission` all over, from its front only
        vec3 emission;
    };
    static constexpr uint32_t kNotEmitting = 0xffffffffu;

    const Material* material(uint32_t triangle) const;

    const Scene& scene_;
    const Surfaces& surfaces_;
    std::vector<Emitter> emitters_;     // in the order of the tree's
    std::vector<uint32_t> emitter_of_;  // [triangle] the reverse, or kNotEmitting
    LightTree tree_;
};

/// Emissive triangles as a receiver at `p` whose plane has normal `n` sees them. What all samples
/// for one receiver share is worked out once, where the emitters are few.
class EmittersSeen {
public:
    /// Keeps a reference to `all`.
    EmittersSeen(const Emitters& all, vec3 p, vec3 n);

    /// A point on one of them, chosen by importance (distance, orientation, power), from three
    /// uniform numbers in [0, 1).
    LightSample sample(vec3 u) const;
    /// 1/sr with which sample() draws the direction to the point `at`; 0 for triangles that do not
    /// emit.
    float pdf(const SurfacePoint& at) const;

private:
    static constexpr size_t kFew = 4;
    struct Choice {
        uint32_t emitter = 0;
        float probability = 0;
    };
    Choice choose(float u) const;
    TriangleSampler sampler_of(uint32_t emitter) const;

    const Emitters& all_;
    vec3 p_, n_;
    bool few_;
    float probability_[kFew] = {};                  // [emitter], where they are few
    std::optional<TriangleSampler> sampler_[kFew];  // ... and can send light here
};

}  // namespace aglow::transport
