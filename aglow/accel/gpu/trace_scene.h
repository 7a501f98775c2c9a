// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/accel/gpu/structure.h"
#include "aglow/core/math.h"
#include "aglow/shared/structure.h"

#include <span>
#include <vector>

namespace aglow::accel::gpu {

/// How the triangles of a group move from frame to frame.
enum class Motion : uint8_t {
    still,      ///< not at all: built once
    rigid,      ///< as one body: built once, rays are moved to its space
    deforming,  ///< freely but little: refitted, and rebuilt when rays get too slow
    free        ///< in any way: rebuilt every frame
};

/// A run of the scene's triangles that move alike and share a structure.
struct Group {
    uint32_t first_triangle = 0;
    uint32_t triangle_count = 0;
    Motion motion = Motion::still;
};

/// Structures over the groups of a scene and a tree over them: what trace.glsl reads.
/// Groups with a rigid motion are built once in the pose of the first update, whose transforms are
/// the reference: the group's placement at a later time is transform * inverse(reference).
class TraceScene {
public:
    static Result<TraceScene> create(const Gpu& gpu, std::span<const Group> groups, Accel accel,
                                     double rays_per_update);
    TraceScene(TraceScene&&) noexcept;
    TraceScene& operator=(TraceScene&&) noexcept;
    ~TraceScene();

    /// Follows the triangles: `triangles` are all of the scene's in world space at this time,
    /// `transforms` [groups] the world transforms of rigid groups (others are not read).
    /// Only what moved is rebuilt. A rigid group whose transform cannot be inverted is rebuilt.
    Status update(vk::Stream& stream, TriangleSpan triangles, std::span<const mat4> transforms);

    uint64_t address() const;  ///< of the shared::TraceScene
    AccelStats stats() const;

private:
    struct State;
    explicit TraceScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace aglow::accel::gpu
