// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/shared/wavefront.h"
#include "aglow/vk/compact.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/stream.h"

#include <cstdint>
#include <span>
#include <utility>

namespace aglow::render::gpu {

/// What kernels are made for.
struct SceneTraits {
    uint32_t kinds = 0;     ///< of its structures, bits as AG_KINDS
    bool alpha = false;     ///< some material is cut out or blended
    bool textured = false;  ///< some material has a texture
};

/// A frame to draw.
struct WavefrontFrame {
    uint64_t scene = 0;              ///< address of a shared::DeviceScene
    uint64_t structure = 0;          ///< address of a shared::TraceScene
    shared::FrameSettings settings;  ///< but for its addresses
    uint32_t light_count = 0;        ///< lights without extent that are asked for shadows
    bool sky = false;                ///< light of the sky is asked for
    bool emitters = false;           ///< light of emissive triangles is asked for
};

/// Draws frames with camera, shadow and mirror rays that go in waves from kernel to kernel: the
/// twin of render/cpu/rays.cpp.
///
/// Lifetime  must outlive the stream's finish().
class Wavefront {
public:
    /// `offsets` are those of filter_offsets().
    /// Errors  out_of_memory, unsupported, device_lost.
    static Result<Wavefront> create(vk::Stream& stream, const SceneTraits& traits,
                                    std::span<const vec2> offsets);

    /// Draws into image(). Finishes the stream between wavefronts.
    /// Errors  out_of_memory (the image), device_lost, cancelled.
    /// Repeat  same bits every run, whatever the size of the wavefronts.
    Status draw(vk::Stream& stream, const WavefrontFrame& frame, const Monitor& monitor);

    const vk::Buffer& image() const { return image_; }    ///< vec3[height][width], cd/m^2
    const vk::Buffer& counts() const { return counts_; }  ///< shared::RayCounts of the last frame

private:
    struct Kernels {
        vk::Kernel camera, trace, shade, lights, sky, emitters, shadow, collect_lights,
            collect_area, finish, resolve, count, count_shadow;
    };
    Wavefront(vk::Compact compact, Kernels kernels)
        : compact_(std::move(compact)), kernels_(std::move(kernels)) {}
    static Result<Kernels> make_kernels(const Gpu& gpu, const SceneTraits& traits);

    Status make_paths(vk::Stream& stream, uint64_t capacity);
    Status prepare(vk::Stream& stream, const WavefrontFrame& frame);
    Status follow(vk::Stream& stream, const WavefrontFrame& frame,
                  shared::WavefrontArgs args) const;
    Result<uint32_t> queue(vk::Stream& stream, const shared::WavefrontArgs& args) const;
    void trace(vk::Stream& stream, const shared::WavefrontArgs& args) const;
    void light(vk::Stream& stream, const WavefrontFrame& frame, shared::WavefrontArgs args) const;
    void shadows(vk::Stream& stream, const vk::Kernel& collect,
                 const shared::WavefrontArgs& args) const;

    vk::Compact compact_;
    Kernels kernels_;
    vk::Buffer paths_;      // all arrays of `wavefront_`
    vk::Buffer addresses_;  // `wavefront_` on the device
    vk::Buffer offsets_, settings_, counts_, image_;
    shared::Wavefront wavefront_{};
    uint64_t capacity_ = 0;
    uint64_t most_paths_ = 1u << 18;  // of about 600 bytes each, with 2^20 shadow rays
};

}  // namespace aglow::render::gpu
