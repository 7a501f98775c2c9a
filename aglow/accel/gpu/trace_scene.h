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
///
/// Rigid groups are built in the pose of the first update, whose transforms are the reference: the
/// group's placement later is transform * inverse(reference). Where that cannot be worked out (a
/// transform that is not finite or not invertible), or would enlarge the body, and with it the
/// rounding of its corners, more than four times, the group is rebuilt where it is, and its
/// transform becomes the reference.
///
/// A deforming group is refitted. After every update 1024 fixed rays through its box count the
/// nodes and triangles they meet; the update after that rebuilds where they met 1.5 times as many
/// as just after the last build. A grid, which has nothing to refit, is rebuilt each time.
class TraceScene {
public:
    /// `accel` for every group; automatic: choose_accel() by the group's triangles and the rays
    /// until it is rebuilt, `rays_per_update` for free groups and unlimited for others.
    /// Errors  out_of_memory, unsupported.
    static Result<TraceScene> create(const Gpu& gpu, std::span<const Group> groups, Accel accel,
                                     double rays_per_update);
    TraceScene(TraceScene&&) noexcept;
    TraceScene& operator=(TraceScene&&) noexcept;
    ~TraceScene();

    /// Follows the triangles: `triangles` are all of the scene's in world space at this time,
    /// `transforms` [groups] the world transforms of rigid groups (others are not read).
    /// Only what moved is rebuilt. Starts and ends without barrier; finishes the stream where
    /// something is built, refitted or measured.
    /// Errors  out_of_memory, device_lost. After an error nothing may be traced until an update
    ///         succeeds, which builds all anew.
    Status update(vk::Stream& stream, TriangleSpan triangles, std::span<const mat4> transforms);

    uint64_t address() const;  ///< of the shared::TraceScene, always the same
    uint32_t kinds() const;    ///< AG_KINDS of shaders that trace it, always the same
    /// Sums over the groups; no rays are counted.
    AccelStats stats() const;
    /// How many groups the last update built and refitted.
    struct Work {
        uint32_t built = 0, refitted = 0;
    };
    Work work() const;

private:
    struct State;
    explicit TraceScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace aglow::accel::gpu
