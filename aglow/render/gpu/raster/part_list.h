// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/mesh/gpu/part_motion.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/render/gpu/raster/projection.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aglow::render::gpu {

/// How a part is drawn.
enum class Layer : uint8_t {
    opaque,
    opaque_both_sides,
    cut,  ///< out by an alpha mask
    cut_both_sides,
    blended
};
inline constexpr size_t kSolidLayers = 4;  ///< all but `blended`

struct FaceRange {
    uint32_t first = 0, count = 0;
    bool operator==(const FaceRange&) const = default;
};

/// What a part's surface is made from, between which it lies.
enum class Reach : uint8_t {
    part,  ///< its own vertices
    mesh   ///< those of its mesh's other parts too: subdivided surfaces
};

/// Faces that are drawn alike.
struct FaceDraw {
    FaceRange places = {};   ///< in RasterArgs::order, if there is one
    uint32_t triangles = 1;  ///< that each is drawn as
    uint32_t segments = 1;   ///< of each edge of their pattern, if they have one
};

inline FaceDraw pattern_draw(FaceRange places, uint32_t segments) {
    return {places, segments * segments, segments};
}

/// The parts of a scene by layer, and where they are.
class PartList {
public:
    PartList(const Scene& scene, const Surfaces& rest, Reach reach = Reach::part);

    /// Runs of faces of each solid layer that may be seen; parts that deform are always taken to
    /// be. `overhang`: see VertexSource.
    std::array<std::vector<FaceRange>, kSolidLayers> visible(std::span<const mat4> transforms,
                                                             const Projection& projection,
                                                             float overhang) const;
    /// Bounds of all parts; of those that deform, in the rest pose.
    Box bounds(std::span<const mat4> transforms) const;

    const std::vector<uint32_t>& blended() const { return blended_; }  ///< faces
    bool has(Layer layer) const { return has_[static_cast<size_t>(layer)]; }

private:
    struct Part {
        FaceRange faces;
        uint32_t index = 0;  ///< in Surfaces::parts
        Layer layer = Layer::opaque;
        bool stiff = true;
        Box box;  ///< of a stiff part in its node's frame, else in the world
    };
    std::vector<Part> parts_;
    std::vector<uint32_t> blended_;
    std::array<bool, kSolidLayers + 1> has_{};
};

}  // namespace aglow::render::gpu
