// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/subdivision.h"

#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"
#include "aglow/refine/cpu/evaluate.h"
#include "aglow/refine/tables/build.h"
#include "aglow/refine/tables/face_points.h"
#include "aglow/refine/tables/layout.h"
#include "aglow/refine/tables/split.h"
#include "aglow/refine/tables/state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace aglow {
namespace {

using refine::cpu::Channels;

constexpr uint64_t kMostVertices = uint64_t{1} << 31;

/// Whether numbers of refined faces, and of half-edges of the split that Catmull-Clark always
/// makes, fit into 32 bits.
bool faces_fit(const Topology& mesh, const SubdivisionOptions& options) {
    const uint64_t corners = mesh.half_edge_count();
    if (options.scheme == Scheme::loop)
        return uint64_t{mesh.face_count()} << (2 * options.level) <= UINT32_MAX;
    return corners << (2 * std::max(options.level, 2) - 2) <= UINT32_MAX;
}

Status check(const Topology& mesh, const SubdivisionOptions& options) {
    if (options.level < 0 || options.level > kDeepestLevel)
        return fail(Errc::bad_argument,
                    fmt::format("the level of subdivision is {}; it can be 0 to {}", options.level,
                                kDeepestLevel));
    for (uint32_t f = 0; options.scheme == Scheme::loop && f < mesh.face_count(); ++f)
        if (mesh.face_size(f) != 3)
            return fail(Errc::bad_argument,
                        fmt::format("face {} has {} corners; Loop subdivision is for triangles, "
                                    "use Catmull-Clark",
                                    f, mesh.face_size(f)));
    const uint64_t count =
        refine::refined_count(mesh, options.scheme, uint64_t{1} << options.level);
    if (count > kMostVertices || !faces_fit(mesh, options))
        return fail(Errc::bad_argument,
                    fmt::format("{} vertices at level {} are too many: use a lower level", count,
                                options.level));
    return {};
}

/// The mesh without what subdivision does not read, and with corners as sharp as they are to be.
Topology control_mesh(const Topology& mesh, Corners corners) {
    Topology copy = mesh;
    copy.source_face = {};
    copy.source_vertex = {};
    if (corners == Corners::smooth) return copy;
    for (uint32_t v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.on_boundary(v) && mesh.twin[mesh.previous(mesh.vertex_half[v])] == kNone)
            copy.vertex_sharpness[v] = kSharp;
    return copy;
}

/// At level 0 of Catmull-Clark only the vertices that there were are wanted of the first split.
refine::Layout still_layout(const Topology& fine, uint32_t control_count) {
    refine::Layout layout;
    layout.vertex.assign(fine.vertex_count(), kNone);
    for (uint32_t v = 0; v < control_count; ++v) layout.vertex[v] = v;
    layout.edge.assign(fine.edge_count(), 0);
    layout.face.assign(fine.face_count(), 0);
    return layout;
}

std::unique_ptr<Subdivision::State> build(const Topology& topology,
                                          const SubdivisionOptions& options) {
    const Scheme scheme = options.scheme;
    auto state = std::make_unique<Subdivision::State>();
    Topology mesh = control_mesh(topology, options.corners);
    refine::Layout layout = refine::control_layout(mesh, scheme, 1u << options.level);
    const uint32_t control_count = mesh.vertex_count();
    state->options = options;
    state->control_count = control_count;
    state->vertex_count =
        static_cast<uint32_t>(refine::refined_count(mesh, scheme, layout.segments));
    for (uint32_t v = 0; v < control_count; ++v)
        if (mesh.vertex_half[v] == kNone) state->loose.push_back(v);
    const int steps = scheme == Scheme::loop
                          ? std::max(options.level - refine::kLoopLevels, 0)
                          : std::max(options.level - refine::kCatmullClarkLevels, 1);
    for (int step = 0; step < steps; ++step) {
        state->steps.push_back(refine::split_stencils(mesh, scheme));
        Topology fine = refine::split(mesh, scheme);
        layout = layout.segments > 1 ? refine::split_layout(mesh, scheme, layout)
                                     : still_layout(fine, control_count);
        mesh = std::move(fine);
    }
    state->faces =
        refine::face_tables(mesh, scheme, std::max(options.level - steps, 0), state->class_face);
    state->faces.output = refine::face_outputs(mesh, layout);
    state->mesh = std::move(mesh);
    return state;
}

/// The points that tables start from, where steps come before them.
class SteppedPoints {
public:
    /// Errors  out_of_memory
    static Result<SteppedPoints> create(const std::vector<refine::Stencils>& steps,
                                        Channels control) {
        SteppedPoints points;
        points.result_ = control;
        for (const refine::Stencils& step : steps) {
            const size_t floats = size_t{step.count()} * control.count;
            std::unique_ptr<float[]> next(new (std::nothrow) float[floats]);
            if (!next)
                return fail(Errc::out_of_memory, "a subdivided mesh does not fit into memory");
            refine::cpu::sum_stencils(step, points.result_,
                                      {next.get(), control.count, control.count});
            points.memory_ = std::move(next);
            points.result_ = {points.memory_.get(), control.count, control.count};
        }
        return points;
    }
    Channels channels() const { return result_; }

private:
    std::unique_ptr<float[]> memory_;
    Channels result_;
};

/// The numbers of a face's refined vertices.
void number_points(const refine::FaceTables& faces, const refine::FaceOutput& output,
                   std::vector<uint32_t>& numbers) {
    numbers.clear();
    const uint32_t n = faces.segments;
    for (uint32_t i = 0; i < faces.corners; ++i) {
        numbers.push_back(output.corner[i]);
        const bool owned = (output.owned & (16u << i)) != 0;
        for (uint32_t k = 0; k + 1 < n; ++k)
            numbers.push_back(output.edge[i] + (owned ? k : n - 2 - k));
    }
    for (uint32_t k = 0; k < faces.interior; ++k) numbers.push_back(output.interior + k);
}

/// Calls write(number of the refined face, its vertices by columns, numbers of columns).
template <class Write>
void for_each_refined_face(const refine::FaceTables& faces, const Write& write) {
    constexpr size_t kGrain = 256;
    const refine::FacePoints points = refine::face_points(faces.corners, faces.segments);
    parallel_for(faces.face_count(), kGrain, [&](size_t begin, size_t end) {
        std::vector<uint32_t> numbers;
        for (size_t f = begin; f < end; ++f) {
            number_points(faces, faces.output[f], numbers);
            for (size_t i = 0; i < points.faces.size(); ++i)
                write(f * points.faces.size() + i, points.faces[i], numbers);
        }
    });
}

}  // namespace

Result<const refine::LimitWeights*> Subdivision::State::limit() const {
    std::call_once(limit_once, [&] {
        try {
            limit_weights = refine::limit_weights(mesh, options.scheme, faces, class_face);
        } catch (const std::bad_alloc&) {
            limit_weights =
                fail(Errc::out_of_memory, "the limit of a subdivision does not fit into memory");
        }
    });
    if (!limit_weights) return tl::unexpected(limit_weights.error());
    return &*limit_weights;
}

Result<Subdivision> Subdivision::create(const Topology& topology,
                                        const SubdivisionOptions& options) {
    AG_CHECK(check(topology, options));
    try {
        return Subdivision(build(topology, options));
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the tables of a subdivision do not fit into memory");
    }
}

Subdivision::Subdivision(std::unique_ptr<State> state) : state_(std::move(state)) {}
Subdivision::Subdivision(Subdivision&&) noexcept = default;
Subdivision& Subdivision::operator=(Subdivision&&) noexcept = default;
Subdivision::~Subdivision() = default;

uint32_t Subdivision::control_count() const { return state_->control_count; }
uint32_t Subdivision::vertex_count() const { return state_->vertex_count; }

uint32_t Subdivision::face_count() const {
    const State& s = *state_;
    if (s.options.scheme == Scheme::catmull_clark && s.options.level == 0) return 0;
    const uint32_t n = s.faces.segments;
    return s.faces.face_count() * n * n;
}

std::vector<uvec3> Subdivision::triangles() const {
    if (state_->options.scheme != Scheme::loop) return {};
    std::vector<uvec3> triangles(face_count());
    for_each_refined_face(state_->faces, [&](size_t i, const auto& face, const auto& numbers) {
        triangles[i] = {numbers[face[0]], numbers[face[1]], numbers[face[2]]};
    });
    return triangles;
}

std::vector<std::array<uint32_t, 4>> Subdivision::quads() const {
    if (state_->options.scheme != Scheme::catmull_clark) return {};
    std::vector<std::array<uint32_t, 4>> quads(face_count());
    if (quads.empty()) return quads;
    for_each_refined_face(state_->faces, [&](size_t i, const auto& face, const auto& numbers) {
        for (size_t c = 0; c < 4; ++c) quads[i][c] = numbers[face[c]];
    });
    return quads;
}

Status Subdivision::evaluate(std::span<const float> control, int width,
                             std::span<float> refined) const {
    const State& s = *state_;
    const auto floats = static_cast<size_t>(width);
    AG_ASSERT(control.size() == s.control_count * floats, "a row for every control vertex");
    AG_ASSERT(refined.size() == s.vertex_count * floats, "a row for every refined vertex");
    if (s.options.level == 0) {
        std::ranges::copy(control, refined.begin());
        return {};
    }
    for (size_t first = 0; first < floats; first += 3) {
        const auto count = static_cast<uint32_t>(std::min(floats - first, size_t{3}));
        AG_TRY(const SteppedPoints points,
               SteppedPoints::create(s.steps, {control.data() + first, floats, count}));
        refine::cpu::sum_faces(s.faces, points.channels(), {refined.data() + first, floats, count});
    }
    for (const uint32_t v : s.loose)
        std::copy_n(control.begin() + static_cast<std::ptrdiff_t>(v * floats), floats,
                    refined.begin() + static_cast<std::ptrdiff_t>(v * floats));
    return {};
}

Status Subdivision::evaluate(std::span<const vec3> control, std::span<vec3> refined) const {
    return evaluate({&control.data()->x, control.size() * 3}, 3,
                    {&refined.data()->x, refined.size() * 3});
}

Status Subdivision::evaluate_limit(std::span<const vec3> control, std::span<vec3> positions,
                                   std::span<vec3> normals) const {
    const State& s = *state_;
    AG_ASSERT(control.size() == s.control_count, "a place for every control vertex");
    AG_ASSERT(positions.size() == s.vertex_count && normals.size() == s.vertex_count,
              "a place and a normal for every refined vertex");
    AG_TRY(const refine::LimitWeights* weights, s.limit());
    AG_TRY(const SteppedPoints points, SteppedPoints::create(s.steps, {&control.data()->x, 3, 3}));
    refine::cpu::sum_limits(s.faces, *weights, points.channels(), positions, normals);
    for (const uint32_t v : s.loose) {
        positions[v] = control[v];
        normals[v] = {0, 0, 0};
    }
    return {};
}

}  // namespace aglow
