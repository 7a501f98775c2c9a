// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu_subdivision.h"

#include "aglow/core/assert.h"
#include "aglow/refine/gpu/device_subdivision.h"
#include "aglow/refine/gpu/geometry/geometry_subdivision.h"
#include "aglow/vk/device.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

namespace aglow {

using refine::gpu::DeviceSubdivision;
using refine::gpu::GeometrySubdivision;

const char* name(SubdivisionForm form) {
    constexpr std::array kNames = {"compute", "NITM", "TA", "VS_OUTPUT"};
    return kNames[static_cast<size_t>(form)];
}

struct GpuSubdivision::State {
    explicit State(vk::Stream on) : stream(std::move(on)) {}

    vk::Stream stream;
    uint32_t control_count = 0, vertex_count = 0;
    std::optional<DeviceSubdivision> tables;     ///< of the compute form
    std::optional<GeometrySubdivision> shaders;  ///< of the others
    std::vector<uint32_t> captured;              ///< which vertex each of their points is
    vk::Buffer control, refined;

    void record();
};

void GpuSubdivision::State::record() {
    if (tables)
        tables->record(stream, control.address(), refined.address());
    else
        shaders->record(stream, control.address());
}

Result<GpuSubdivision> GpuSubdivision::create(const Gpu& gpu, const Topology& topology,
                                              const SubdivisionOptions& options,
                                              SubdivisionForm form) {
    AG_TRY(vk::Stream stream, vk::Stream::create(gpu));
    AG_TRY(const Subdivision subdivision, Subdivision::create(topology, options));
    auto state = std::make_unique<State>(std::move(stream));
    state->control_count = subdivision.control_count();
    state->vertex_count = subdivision.vertex_count();
    AG_TRY(state->control, state->stream.make_buffer(uint64_t{state->control_count} * sizeof(vec3),
                                                     "control points"));
    if (form == SubdivisionForm::compute) {
        AG_TRY(state->refined, state->stream.make_buffer(
                                   uint64_t{state->vertex_count} * sizeof(vec3), "refined points"));
        AG_TRY(state->tables, DeviceSubdivision::create(state->stream, subdivision));
    } else {
        AG_TRY(state->shaders, GeometrySubdivision::create(state->stream, topology, options, form));
        state->captured = refine::gpu::captured_vertices(subdivision);
    }
    return GpuSubdivision(std::move(state));
}

GpuSubdivision::GpuSubdivision(std::unique_ptr<State> state) : state_(std::move(state)) {}
GpuSubdivision::GpuSubdivision(GpuSubdivision&&) noexcept = default;
GpuSubdivision& GpuSubdivision::operator=(GpuSubdivision&&) noexcept = default;
GpuSubdivision::~GpuSubdivision() = default;

uint32_t GpuSubdivision::control_count() const { return state_->control_count; }
uint32_t GpuSubdivision::vertex_count() const { return state_->vertex_count; }

Status GpuSubdivision::evaluate(std::span<const vec3> control, std::span<vec3> refined) {
    State& s = *state_;
    AG_ASSERT(control.size() == s.control_count, "a place for every control vertex");
    AG_ASSERT(refined.size() == s.vertex_count, "a place for every refined vertex");
    s.stream.upload(control, s.control);
    s.stream.barrier();
    s.record();
    if (s.tables) return s.stream.download_bytes(s.refined, 0, std::as_writable_bytes(refined));
    AG_TRY(const std::vector<vec3> corners,
           s.stream.download<vec3>(s.shaders->points(), s.captured.size()));
    std::ranges::copy(control, refined.begin());  // those that no triangle touches stay
    for (size_t i = 0; i < corners.size(); ++i) refined[s.captured[i]] = corners[i];
    return {};
}

Result<double> GpuSubdivision::frame_seconds(int frames) {
    vk::Stream& stream = state_->stream;
    AG_CHECK(stream.finish());
    const auto start = std::chrono::steady_clock::now();
    for (int frame = 0; frame < frames; ++frame) {
        stream.barrier();
        state_->record();
    }
    AG_CHECK(stream.finish());
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    return elapsed.count() / frames;
}

}  // namespace aglow
