// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/vk/buffer.h"
#include "aglow/vk/devices.h"
#include "aglow/vk/graphics_pipeline.h"
#include "aglow/vk/kernel.h"
#include "aglow/vk/render_target.h"
#include "aglow/vk/timing_table.h"

#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace aglow::vk {

/// What one draw covers.
struct Draw {
    uint32_t first_vertex = 0, vertex_count = 0;  ///< places in `indices`, if there are any
    uint32_t first_instance = 0, instance_count = 1;
    const Buffer* indices = nullptr;  ///< uint32_t[]
    bool whole = false;  ///< it is not cut, so that gl_PrimitiveID counts from its beginning
};

/// Where captured vertices go.
struct Capture {
    const Buffer& to;
    uint64_t offset = 0;           ///< bytes, a multiple of 4
    uint64_t primitive_bytes = 0;  ///< that each primitive of the draw is made to, all the same
};

/// Work for the device in the order it is given. Members that record cannot fail: the first failure
/// (device lost, no staging memory) is kept and returned by finish(), and what follows it is
/// dropped. Work is submitted in pieces that are expected to take less than 100 ms, judged by the
/// time that each kernel's groups (a pipeline's primitives) took before; what takes longer is
/// split.
///
/// Synchronisation  Work between two barrier() calls may overlap. barrier() makes all writes before
///                  it visible to all that follows. copies and fills count as work like any other,
///                  and so do draws as to the buffers that they read; clear(), draw() and read()
///                  of one target happen in their order without barriers.
/// Thread safety    one thread at a time; several streams may run at once.
class Stream {
public:
    static Result<Stream> create(const Gpu& gpu);
    Stream(Stream&&) noexcept;
    Stream& operator=(Stream&&) noexcept;
    ~Stream();  ///< waits for what was submitted

    /// Runs `groups` groups of the kernel. `args` is copied; its first member is first_group.
    template <class Args>
    void run(const Kernel& kernel, Args args, uint64_t groups) {
        static_assert(std::is_trivially_copyable_v<Args> && sizeof(Args) <= 128);
        static_assert(std::is_same_v<decltype(args.first_group), uint32_t>);
        run_bytes(kernel, {reinterpret_cast<const std::byte*>(&args), sizeof args}, groups);
    }

    /// Draws into the target, whose format is the pipeline's. `args` is copied. Long draws are
    /// cut between primitives, or between instances where there are several; a piece is at least
    /// one instance. gl_VertexIndex and gl_InstanceIndex do not show it, gl_PrimitiveID does.
    template <class Args>
    void draw(const GraphicsPipeline& pipeline, const RenderTarget& target, const Args& args,
              const Draw& draw) {
        static_assert(std::is_trivially_copyable_v<Args> && sizeof(Args) <= 128);
        draw_bytes(pipeline, target, std::as_bytes(std::span(&args, 1)), draw);
    }
    /// Runs the stages before the fragments, and writes the outputs that they mark with xfb_offset
    /// in the order of the primitives (transform feedback). The pipeline has no target.
    template <class Args>
    void capture(const GraphicsPipeline& pipeline, const Args& args, const Draw& draw,
                 const Capture& capture) {
        static_assert(std::is_trivially_copyable_v<Args> && sizeof(Args) <= 128);
        capture_bytes(pipeline, std::as_bytes(std::span(&args, 1)), draw, capture);
    }
    /// The same by `groups` groups of a mesh shader. The first member of `args` is first_group, as
    /// of run().
    template <class Args>
    void draw_groups(const GraphicsPipeline& pipeline, const RenderTarget& target, Args args,
                     uint64_t groups) {
        static_assert(std::is_trivially_copyable_v<Args> && sizeof(Args) <= 128);
        static_assert(std::is_same_v<decltype(args.first_group), uint32_t>);
        draw_groups_bytes(pipeline, target, std::as_bytes(std::span(&args, 1)), groups);
    }
    /// Sets all of the target. A target is cleared before it is first drawn into.
    void clear(const RenderTarget& target, const std::array<float, 4>& color, float depth = 0);
    /// Writes the colours row by row from the top to the buffer, of several samples their mean.
    void read(const RenderTarget& target, const Buffer& to, uint64_t to_offset = 0);

    void barrier();
    /// Offsets and sizes in bytes, multiples of 4.
    void fill(const Buffer& buffer, uint32_t value, uint64_t offset, uint64_t bytes);
    void copy(const Buffer& from, uint64_t from_offset, const Buffer& to, uint64_t to_offset,
              uint64_t bytes);
    /// Copies `data` at once into staging memory, and from there to the buffer when it runs.
    void upload_bytes(std::span<const std::byte> data, const Buffer& to, uint64_t to_offset);
    template <class T>
    void upload(std::span<const T> data, const Buffer& to, uint64_t to_offset = 0) {
        upload_bytes(std::as_bytes(data), to, to_offset);
    }

    /// Hands what is recorded to the device, so that it begins; does not wait.
    void submit();
    /// Submits all and waits for it.
    /// Errors  device_lost, out_of_memory; names the kernel. A stream stays failed.
    Status finish();
    /// finish(), then the buffer's content. Orders itself after all that was recorded.
    Status download_bytes(const Buffer& from, uint64_t from_offset, std::span<std::byte> to);
    template <class T>
    Result<std::vector<T>> download(const Buffer& from, uint64_t count, uint64_t first = 0) {
        std::vector<T> values(count);
        AG_CHECK(
            download_bytes(from, first * sizeof(T), std::as_writable_bytes(std::span(values))));
        return values;
    }

    /// Work recorded while the scope lives is timed under its label. Scopes do not nest.
    class Scope {
    public:
        Scope(Stream& stream, std::string_view label) : stream_(stream) { stream.label(label); }
        ~Scope() { stream_.label({}); }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        Stream& stream_;
    };
    void label(std::string_view label);
    /// What finished since the last call, in order of first appearance; then forgotten.
    std::vector<Timing> take_timings();
    /// GPU time of each submit that finished since the last call, s; then forgotten.
    std::vector<double> take_submit_seconds();

    const Gpu& gpu() const;
    /// gpu()->make_buffer().
    Result<Buffer> make_buffer(uint64_t bytes, std::string_view name,
                               Memory memory = Memory::device);

private:
    struct State;
    explicit Stream(std::unique_ptr<State> state);
    void run_bytes(const Kernel& kernel, std::span<const std::byte> args, uint64_t groups);
    void draw_bytes(const GraphicsPipeline& pipeline, const RenderTarget& target,
                    std::span<const std::byte> args, const Draw& draw);
    void draw_groups_bytes(const GraphicsPipeline& pipeline, const RenderTarget& target,
                           std::span<const std::byte> args, uint64_t groups);
    void capture_bytes(const GraphicsPipeline& pipeline, std::span<const std::byte> args,
                       const Draw& draw, const Capture& capture);

    std::unique_ptr<State> state_;
};

/// A buffer that holds `data` once a barrier() follows. Errors: out_of_memory.
template <class T>
Result<Buffer> make_buffer_of(Stream& stream, std::span<const T> data, std::string_view name) {
    AG_TRY(Buffer buffer, stream.make_buffer(data.size_bytes(), name));
    stream.upload(data, buffer);
    return buffer;
}

}  // namespace aglow::vk
