// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/refine/subdivision.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <memory>

namespace aglow::refine::gpu {

/// A subdivision on the device: its tables are there once, and every frame makes all refined
/// points from the control points in one pass, which writes the last level only. What is written is
/// what Subdivision::evaluate() writes, up to rounding; every point is written once, so that faces
/// meet exactly.
///
/// A group takes faces of one class, reads their rings into shared memory, and every invocation
/// makes a few columns for a few faces: a weight that is read serves all of these faces.
///
/// Lifetime       keeps nothing of the subdivision; must not die between record() and the submit.
/// Thread safety  one thread at a time.
class DeviceSubdivision {
public:
    enum class Limits : uint8_t { without, with };  ///< whether record_limit() will be called

    /// Waits until all is on the device.
    /// Errors  out_of_memory (names the buffer), unsupported (2^31 numbers or more in a table),
    ///         device_lost.
    static Result<DeviceSubdivision> create(vk::Stream& stream, const Subdivision& subdivision,
                                            Limits limits = Limits::without);
    DeviceSubdivision(DeviceSubdivision&&) noexcept;
    DeviceSubdivision& operator=(DeviceSubdivision&&) noexcept;
    ~DeviceSubdivision();

    uint32_t control_count() const;
    uint32_t vertex_count() const;

    /// Shapes  addresses of control float[control_count()][width], refined
    ///         float[vertex_count()][width]; other widths than 3 up to 2^31 numbers.
    /// Synchronisation  starts and ends without barrier. Calls of one object for other arrays need
    ///                  a barrier between them where there are steps: has_steps().
    /// Cost    a pass over the output for every three numbers; bound by memory where it is fast.
    /// Repeat  same bits every run on one device.
    void record(vk::Stream& stream, uint64_t control, uint64_t refined, uint32_t width = 3) const;
    /// Where the vertices go in the limit, and unit normals there: vec3[vertex_count()] each.
    /// Without `positions` (0) only normals. Synchronisation as record().
    void record_limit(vk::Stream& stream, uint64_t control, uint64_t positions,
                      uint64_t normals) const;
    /// Whether points are kept between control and refined ones: Catmull-Clark, and deep levels.
    bool has_steps() const;

private:
    struct State;
    explicit DeviceSubdivision(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace aglow::refine::gpu
