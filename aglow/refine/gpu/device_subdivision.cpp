// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/gpu/device_subdivision.h"

#include "aglow/core/assert.h"
#include "aglow/refine/gpu/subdivide.comp.h"
#include "aglow/refine/gpu/subdivide_limit.comp.h"
#include "aglow/refine/gpu/subdivide_loose.comp.h"
#include "aglow/refine/gpu/subdivide_step.comp.h"
#include "aglow/refine/tables/build.h"
#include "aglow/refine/tables/state.h"
#include "aglow/shared/subdivision.h"
#include "aglow/vk/device.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <optional>

namespace aglow::refine::gpu {
namespace {

using shared::SubdivideArgs;
using shared::SubdivideFace;
using shared::SubdivideLimitArgs;
using shared::SubdivideTile;
using vk::Kernel;

constexpr uint32_t kFacesPerLane = 4;       // as subdivide.comp has it
constexpr uint32_t kLimitFacesPerLane = 2;  // as subdivide_limit.comp has it
constexpr uint32_t kColumnLanes = shared::kSubdivideColumnLanes;
constexpr uint32_t kChannels = 3;
constexpr size_t kMostNumbers = size_t{1} << 31;  // that shaders count in a table

/// How a group's invocations are divided.
struct Lanes {
    uint32_t faces = 1;    ///< sets of kColumnLanes invocations
    uint32_t columns = 1;  ///< of an invocation
    uint32_t group_columns() const { return kColumnLanes * columns; }
};

/// Groups are at least as large as the device's subgroups, and their columns few more than there
/// are.
Lanes lanes_for(uint32_t columns, uint32_t subgroup) {
    constexpr uint32_t kMost = 4;  // sums for so many columns fit into registers
    const uint32_t blocks = (columns + kColumnLanes * kMost - 1) / (kColumnLanes * kMost);
    Lanes lanes;
    lanes.columns = (columns + kColumnLanes * blocks - 1) / (kColumnLanes * blocks);
    lanes.faces = std::max(subgroup / kColumnLanes, 1u);
    return lanes;
}

Result<Kernel> make_kernel(const Gpu& gpu, const char* name, std::span<const uint32_t> code,
                           Lanes lanes, uint32_t variant) {
    return Kernel::create(
        gpu, name, code,
        std::array{lanes.faces, kColumnLanes * lanes.faces, lanes.columns, variant});
}

/// The faces, those of a class after each other.
std::vector<uint32_t> faces_by_class(const FaceTables& faces) {
    std::vector<uint32_t> begin(faces.rows.size() + 1, 0);
    for (const uint32_t k : faces.face_class) ++begin[k + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<uint32_t> order(faces.face_count());
    for (uint32_t f = 0; f < faces.face_count(); ++f) order[begin[faces.face_class[f]]++] = f;
    return order;
}

SubdivideFace device_face(const FaceOutput& output) {
    SubdivideFace face{};
    std::copy_n(output.corner, 4, face.first);
    std::copy_n(output.edge, 4, face.first + 4);
    face.first[shared::kSubdivideInside] = output.interior;
    face.owned = output.owned | (1u << shared::kSubdivideInside);
    return face;
}

/// Faces in the order of their classes, cut into what groups work on.
struct Tiling {
    std::vector<uint32_t> order;
    std::vector<uint32_t> ring;
    std::vector<SubdivideFace> faces;

    explicit Tiling(const FaceTables& tables) : order(faces_by_class(tables)) {
        ring.reserve(tables.ring.size());
        for (const uint32_t f : order) {
            const auto begin =
                tables.ring.begin() + static_cast<std::ptrdiff_t>(tables.ring_begin[f]);
            ring.insert(ring.end(), begin, begin + tables.rows[tables.face_class[f]]);
            faces.push_back(device_face(tables.output[f]));
        }
    }

    std::vector<SubdivideTile> tiles(const FaceTables& tables, uint32_t tile_faces) const {
        std::vector<SubdivideTile> tiles;
        uint32_t ring_begin = 0, weights = 0, next = 0;
        for (uint32_t k = 0; k < tables.class_count(); ++k) {
            const uint32_t rows = tables.rows[k];
            while (next < order.size() && tables.face_class[order[next]] == k) {
                uint32_t count = 0;
                while (count < tile_faces && next + count < order.size() &&
                       tables.face_class[order[next + count]] == k)
                    ++count;
                tiles.push_back({weights, rows, ring_begin, next, count});
                ring_begin += count * rows;
                next += count;
            }
            weights += rows * tables.stride;
        }
        return tiles;
    }
};

/// A level of points as sums of those before.
struct Step {
    uint32_t count = 0;
    vk::Buffer begin, index, weight;
    vk::Buffer points;  ///< where they are kept
};

/// Some numbers of every point of an array.
struct Numbers {
    uint64_t address = 0;
    uint32_t width = kChannels, first = 0;  ///< numbers of a point; of these the first
};

struct Limit {
    uint32_t tile_count = 0;
    vk::Buffer tiles, position, u, v;
    Kernel all, normals_only;
};

}  // namespace

struct DeviceSubdivision::State {
    State(Kernel vec3_kernel, Kernel wide_kernel, Kernel step_kernel, Kernel loose_kernel)
        : subdivide(std::move(vec3_kernel)),
          subdivide_wide(std::move(wide_kernel)),
          make_step(std::move(step_kernel)),
          keep_loose(std::move(loose_kernel)) {}

    Kernel subdivide, subdivide_wide, make_step, keep_loose;
    uint32_t control_count = 0, vertex_count = 0, loose_count = 0, kept_count = 0;
    uint32_t tile_count = 0;  ///< 0 at levels 0 and 1
    uint32_t columns = 0, stride = 0, corners = 0, segment_bits = 0;
    Lanes lanes;
    vk::Buffer tiles, faces, ring, weights;
    vk::Buffer loose;  ///< vertices without faces
    vk::Buffer kept;   ///< those that do not move: loose, or at level 0 all
    std::vector<Step> steps;
    std::optional<Step> only;  ///< at level 1: most points are sums of few
    std::optional<Limit> limit;

    uint32_t blocks() const {
        return (columns + lanes.group_columns() - 1) / lanes.group_columns();
    }
    Status upload(vk::Stream& stream, const Subdivision::State& source);
    Status upload_limit(vk::Stream& stream, const Subdivision::State& source);
    void record_step(vk::Stream& stream, const Step& step, Numbers from, Numbers to,
                     uint32_t channels) const;
    /// Result  where the points are that tables start from.
    Numbers record_steps(vk::Stream& stream, Numbers control, uint32_t channels) const;
    void record_tables(vk::Stream& stream, Numbers from, Numbers to, uint32_t channels) const;
    void keep(vk::Stream& stream, const vk::Buffer& vertices, uint32_t count, uint64_t from,
              uint64_t to, uint32_t width, bool zero = false) const;
};

namespace {

template <class T>
Status put(vk::Stream& stream, const std::vector<T>& values, const char* name, vk::Buffer& buffer) {
    AG_TRY(buffer, vk::make_buffer_of(stream, std::span<const T>(values), name));
    return {};
}

/// Tables, and behind them what the last columns of the last row may read.
Status put_tables(vk::Stream& stream, const Weights& weights, Lanes lanes, vk::Buffer& buffer) {
    const std::span<const float> all = floats(weights);
    const uint64_t end = lanes.group_columns() * sizeof(float);
    AG_TRY(buffer, stream.make_buffer(all.size_bytes() + end, "subdivision tables"));
    stream.upload(all, buffer);
    return {};
}

Status check_sizes(const FaceTables& faces) {
    const uint64_t words = uint64_t{faces.face_count()} * shared::kSubdivideFaceWords;
    if (std::max({uint64_t{faces.weights.size()} * kColumnBlock, words,
                  uint64_t{faces.ring.size()}}) < kMostNumbers)
        return {};
    return fail(Errc::unsupported,
                "the tables of a subdivision have 2^31 numbers or more, which is too many for a "
                "GPU: subdivide parts of the mesh, or on the CPU");
}

Status upload_step(vk::Stream& stream, const Stencils& stencils, Step& step) {
    step.count = stencils.count();
    AG_CHECK(put(stream, stencils.begin, "subdivision step", step.begin));
    AG_CHECK(put(stream, stencils.index, "subdivision step", step.index));
    AG_CHECK(put(stream, stencils.weight, "subdivision step", step.weight));
    return {};
}

Status make_points(vk::Stream& stream, Step& step) {
    AG_TRY(step.points,
           stream.make_buffer(uint64_t{step.count} * sizeof(vec3), "points of a subdivision step"));
    return {};
}

}  // namespace

Status DeviceSubdivision::State::upload(vk::Stream& stream, const Subdivision::State& source) {
    control_count = source.control_count;
    vertex_count = source.vertex_count;
    const FaceTables& tables = source.faces;
    corners = tables.corners;
    segment_bits = static_cast<uint32_t>(std::countr_zero(tables.segments));
    columns = tables.corners * tables.segments + tables.interior;
    stride = tables.stride;
    const Tiling tiling(tables);
    AG_CHECK(put(stream, tiling.faces, "subdivision faces", faces));
    AG_CHECK(put(stream, tiling.ring, "subdivision rings", ring));
    AG_CHECK(put(stream, source.loose, "loose vertices", loose));
    loose_count = static_cast<uint32_t>(source.loose.size());
    kept_count = source.options.level == 0 ? control_count : loose_count;
    std::vector<uint32_t> still = source.loose;
    if (source.options.level == 0) {
        still.resize(control_count);
        std::iota(still.begin(), still.end(), 0u);
    } else if (source.options.level == 1) {
        AG_CHECK(upload_step(
            stream,
            source.steps.empty() ? split_stencils(source.mesh, Scheme::loop) : source.steps[0],
            only.emplace()));
    } else {
        const auto all = tiling.tiles(tables, kFacesPerLane * lanes.faces);
        tile_count = static_cast<uint32_t>(all.size());
        AG_CHECK(put(stream, all, "subdivision tiles", tiles));
        AG_CHECK(put_tables(stream, tables.weights, lanes, weights));
    }
    AG_CHECK(put(stream, still, "vertices that stay", kept));
    steps.resize(source.steps.size());
    for (size_t i = 0; i < steps.size(); ++i) {
        AG_CHECK(upload_step(stream, source.steps[i], steps[i]));
        AG_CHECK(make_points(stream, steps[i]));
    }
    return {};
}

Status DeviceSubdivision::State::upload_limit(vk::Stream& stream,
                                              const Subdivision::State& source) {
    AG_TRY(const LimitWeights* const tables, source.limit());
    AG_TRY(Kernel all,
           make_kernel(stream.gpu(), "subdivide limit", shaders::subdivide_limit_comp, lanes, 1));
    AG_TRY(Kernel normals_only,
           make_kernel(stream.gpu(), "subdivide normals", shaders::subdivide_limit_comp, lanes, 0));
    limit.emplace(Limit{0, {}, {}, {}, {}, std::move(all), std::move(normals_only)});
    const FaceTables& f = source.faces;
    const auto cut = Tiling(f).tiles(f, kLimitFacesPerLane * lanes.faces);
    limit->tile_count = static_cast<uint32_t>(cut.size());
    AG_CHECK(put(stream, cut, "limit tiles", limit->tiles));
    AG_CHECK(put_tables(stream, tables->position, lanes, limit->position));
    AG_CHECK(put_tables(stream, tables->tangent_u, lanes, limit->u));
    AG_CHECK(put_tables(stream, tables->tangent_v, lanes, limit->v));
    return {};
}

void DeviceSubdivision::State::record_step(vk::Stream& stream, const Step& step, Numbers from,
                                           Numbers to, uint32_t channels) const {
    shared::SubdivideStepArgs args{};
    args.count = step.count;
    args.from_width = from.width;
    args.from_channel = from.first;
    args.to_width = to.width;
    args.to_channel = to.first;
    args.channels = channels;
    args.begin = step.begin.address();
    args.index = step.index.address();
    args.weight = step.weight.address();
    args.from = from.address;
    args.to = to.address;
    stream.run(make_step, args, vk::group_count(step.count, shared::kSubdividePointGroup));
}

Numbers DeviceSubdivision::State::record_steps(vk::Stream& stream, Numbers control,
                                               uint32_t channels) const {
    Numbers points = control;
    for (const Step& step : steps) {
        const Numbers next{step.points.address()};
        record_step(stream, step, points, next, channels);
        stream.barrier();
        points = next;
    }
    return points;
}

void DeviceSubdivision::State::record_tables(vk::Stream& stream, Numbers from, Numbers to,
                                             uint32_t channels) const {
    SubdivideArgs args{};
    args.blocks = blocks();
    args.corners = corners;
    args.segment_bits = segment_bits;
    args.columns = columns;
    args.stride = stride;
    args.channels = channels;
    args.from_width = from.width;
    args.from_channel = from.first;
    args.to_width = to.width;
    args.to_channel = to.first;
    args.tiles = tiles.address();
    args.faces = faces.address();
    args.ring = ring.address();
    args.weights = weights.address();
    args.from = from.address;
    args.to = to.address;
    stream.run(to.width == kChannels ? subdivide : subdivide_wide, args,
               uint64_t{tile_count} * args.blocks);
}

void DeviceSubdivision::State::keep(vk::Stream& stream, const vk::Buffer& vertices, uint32_t count,
                                    uint64_t from, uint64_t to, uint32_t width, bool zero) const {
    if (count == 0) return;
    const shared::SubdivideLooseArgs args{0,    count, width, zero ? 1u : 0u, vertices.address(),
                                          from, to};
    stream.run(keep_loose, args, vk::group_count(count, shared::kSubdividePointGroup));
}

Result<DeviceSubdivision> DeviceSubdivision::create(vk::Stream& stream,
                                                    const Subdivision& subdivision, Limits limits) {
    const Subdivision::State& source = subdivision.state();
    AG_CHECK(check_sizes(source.faces));
    const Gpu& gpu = stream.gpu();
    const Lanes lanes = lanes_for(
        source.faces.corners * source.faces.segments + source.faces.interior, gpu->subgroup_size());
    AG_TRY(Kernel tight, make_kernel(gpu, "subdivide", shaders::subdivide_comp, lanes, 1));
    AG_TRY(Kernel wide, make_kernel(gpu, "subdivide wide", shaders::subdivide_comp, lanes, 0));
    AG_TRY(Kernel step, Kernel::create(gpu, "subdivide step", shaders::subdivide_step_comp));
    AG_TRY(Kernel loose, Kernel::create(gpu, "keep loose", shaders::subdivide_loose_comp));
    auto state = std::make_unique<State>(std::move(tight), std::move(wide), std::move(step),
                                         std::move(loose));
    state->lanes = lanes;
    AG_CHECK(state->upload(stream, source));
    if (limits == Limits::with) AG_CHECK(state->upload_limit(stream, source));
    AG_CHECK(stream.finish());
    return DeviceSubdivision(std::move(state));
}

DeviceSubdivision::DeviceSubdivision(std::unique_ptr<State> state) : state_(std::move(state)) {}
DeviceSubdivision::DeviceSubdivision(DeviceSubdivision&&) noexcept = default;
DeviceSubdivision& DeviceSubdivision::operator=(DeviceSubdivision&&) noexcept = default;
DeviceSubdivision::~DeviceSubdivision() = default;

uint32_t DeviceSubdivision::control_count() const { return state_->control_count; }
uint32_t DeviceSubdivision::vertex_count() const { return state_->vertex_count; }
bool DeviceSubdivision::has_steps() const { return !state_->steps.empty(); }

void DeviceSubdivision::record(vk::Stream& stream, uint64_t control, uint64_t refined,
                               uint32_t width) const {
    AG_ASSERT(width == kChannels || uint64_t{vertex_count()} * width < kMostNumbers,
              "wide vertices have less than 2^31 numbers");
    const State& s = *state_;
    s.keep(stream, s.kept, s.kept_count, control, refined, width);
    for (uint32_t first = 0; first < width; first += kChannels) {
        const uint32_t channels = std::min(width - first, kChannels);
        const Numbers from{control, width, first}, to{refined, width, first};
        if (s.only) s.record_step(stream, *s.only, from, to, channels);
        if (s.tile_count == 0) continue;
        if (first > 0 && has_steps()) stream.barrier();
        s.record_tables(stream, s.record_steps(stream, from, channels), to, channels);
    }
}

void DeviceSubdivision::record_limit(vk::Stream& stream, uint64_t control, uint64_t positions,
                                     uint64_t normals) const {
    AG_ASSERT(state_->limit.has_value(), "made with limits");
    const State& s = *state_;
    const Limit& limit = *s.limit;
    if (positions != 0) s.keep(stream, s.loose, s.loose_count, control, positions, kChannels);
    s.keep(stream, s.loose, s.loose_count, control, normals, kChannels, true);
    SubdivideLimitArgs args{};
    args.blocks = s.blocks();
    args.corners = s.corners;
    args.segment_bits = s.segment_bits;
    args.columns = s.columns;
    args.stride = s.stride;
    args.tiles = limit.tiles.address();
    args.faces = s.faces.address();
    args.ring = s.ring.address();
    args.position_weights = limit.position.address();
    args.u_weights = limit.u.address();
    args.v_weights = limit.v.address();
    args.from = s.record_steps(stream, {control}, kChannels).address;
    args.positions = positions;
    args.normals = normals;
    stream.run(positions != 0 ? limit.all : limit.normals_only, args,
               uint64_t{limit.tile_count} * args.blocks);
}

}  // namespace aglow::refine::gpu
