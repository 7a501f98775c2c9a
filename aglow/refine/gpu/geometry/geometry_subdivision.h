// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/refine/gpu_subdivision.h"
#include "aglow/vk/graphics_pipeline.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <span>
#include <vector>

namespace aglow::refine::gpu {

/// Loop subdivision in a geometry shader, as SubdivisionForm says: two levels at a time, kept by
/// transform feedback. Points come as three for each triangle, those of a control face after each
/// other.
/// Lifetime  must not die between record() and the submit.
class GeometrySubdivision {
public:
    /// `form` is not compute. Waits until all is on the device.
    /// Errors  unsupported (creases, levels below 1, no geometry shaders or transform feedback),
    ///         out_of_memory, device_lost
    static Result<GeometrySubdivision> create(vk::Stream& stream, const Topology& topology,
                                              const SubdivisionOptions& options,
                                              SubdivisionForm form);

    /// Shapes  address of control points vec3[vertices of the topology]
    /// Synchronisation  starts and ends without barrier; reads and writes points().
    void record(vk::Stream& stream, uint64_t control) const;
    /// vec3[3 * triangles] after record().
    const vk::Buffer& points() const { return passes_.back().points; }

private:
    /// One or two levels.
    struct Pass {
        uint32_t triangle_count = 0;  ///< before
        uint32_t children = 4;        ///< of each
        vk::Buffer indices, vertices, fans, starts;
        vk::Buffer points;  ///< that it makes
        vk::GraphicsPipeline pipeline;
    };
    /// `points`: where each vertex's point is; [vertex].
    static Result<Pass> make_pass(vk::Stream& stream, const Topology& mesh,
                                  std::span<const uint32_t> points, uint32_t levels,
                                  SubdivisionForm form);
    void record_pass(vk::Stream& stream, const Pass& pass, uint64_t from) const;

    GeometrySubdivision() = default;
    SubdivisionForm form_ = SubdivisionForm::neighbours_in_memory;
    std::vector<Pass> passes_;
};

/// Which vertex of a subdivision each of the points is that GeometrySubdivision makes.
/// Shapes  [3 * triangles]
std::vector<uint32_t> captured_vertices(const Subdivision& subdivision);

}  // namespace aglow::refine::gpu
