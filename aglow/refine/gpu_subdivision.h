// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/math.h"
#include "aglow/core/result.h"
#include "aglow/refine/subdivision.h"
#include "aglow/vk/devices.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace aglow {

/// How a GPU subdivides. The last three work in a geometry shader, which makes two levels of a
/// triangle at a time from it and its neighbours; they differ in how these come to it. Loop without
/// creases. Source  Concheiro et al., "Synthesis of Multiresolution Scenes with Global Illumination
/// on a GPU", GRAPP 2010, section 3.
enum class SubdivisionForm : uint8_t {
    compute,                 ///< tables times rings, any scheme: what draws and bakes
    neighbours_in_memory,    ///< NITM: neighbours are fetched by the number of the triangle
    triangle_adjacency,      ///< TA: three of them come with the triangle, the rest is fetched
    neighbours_in_vertices,  ///< VS_OUTPUT: every vertex brings up to 12 along
};

inline constexpr std::array kSubdivisionForms = {
    SubdivisionForm::compute, SubdivisionForm::neighbours_in_memory,
    SubdivisionForm::triangle_adjacency, SubdivisionForm::neighbours_in_vertices};

const char* name(SubdivisionForm form);  ///< "compute", "NITM", "TA", "VS_OUTPUT"

/// A mesh subdivided on a GPU, as Subdivision does it on the CPU: in the same order of vertices,
/// equal up to rounding.
/// Thread safety  one thread at a time.
class GpuSubdivision {
public:
    /// Errors  bad_argument   as Subdivision::create()
    ///         unsupported    creases or another scheme in a form other than compute; the device
    ///                        has no geometry shaders
    ///         out_of_memory, device_lost
    static Result<GpuSubdivision> create(const Gpu& gpu, const Topology& topology,
                                         const SubdivisionOptions& options,
                                         SubdivisionForm form = SubdivisionForm::compute);
    GpuSubdivision(GpuSubdivision&&) noexcept;
    GpuSubdivision& operator=(GpuSubdivision&&) noexcept;
    ~GpuSubdivision();

    uint32_t control_count() const;
    uint32_t vertex_count() const;

    /// Shapes  control [control_count()], refined [vertex_count()]
    /// Errors  out_of_memory, device_lost
    /// Repeat  same bits every run on one device. All forms but compute work points of edges out
    ///         once for each face; that of one of them is returned.
    Status evaluate(std::span<const vec3> control, std::span<vec3> refined);
    /// Refines again what evaluate() put there, `frames` times in a row, all on the device.
    /// Result  time of one frame, s, from recording the first until the last is done: software
    ///         devices run draws when they like, beside their time stamps.
    /// Errors  as evaluate()
    Result<double> frame_seconds(int frames);

private:
    struct State;
    explicit GpuSubdivision(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace aglow
