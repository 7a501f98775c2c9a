// SPDX-License-Identifier: Apache-2.0
#include "aglow/accel/gpu/trace_scene.h"

#include "aglow/accel/gpu/group_bounds.h"
#include "aglow/accel/gpu/placement.h"
#include "aglow/accel/gpu/top_tree.h"
#include "aglow/accel/gpu/trace_rays.h"
#include "aglow/core/assert.h"
#include "aglow/core/random.h"
#include "aglow/vk/device.h"

#include <algorithm>
#include <array>
#include <optional>

namespace aglow::accel::gpu {
namespace {

using shared::Bounds;
using shared::Instance;
using shared::TraceCounts;

constexpr float kMostStretch = 4;      // of a rigid body from its reference
constexpr double kWornOut = 1.5;       // cost of rays since the build that makes a refit a build
constexpr uint32_t kProbeRays = 1024;  // that measure it
constexpr uint32_t kProbeKinds = 1u << shared::kStructureBvh;

enum class Action : uint8_t { keep, refit, build };

/// One group and its structure.
struct Member {
    Group group;
    size_t index = 0;  // of the group
    Accel accel = Accel::grid;
    std::unique_ptr<Structure> structure;
    Action action = Action::keep;
    Box box;  // of the triangles in the structure's space; empty: nothing can be hit
    std::optional<mat4> reference;  // of a rigid group; nothing: it cannot be moved
    Placement placement;
    double cost_when_built = 0;  // of the probe rays; 0: not measured
    uint32_t probe = 0;          // index among those that are measured

    bool wears() const { return group.motion == Motion::deforming && accel == Accel::bvh; }
    uvec2 run() const { return {group.first_triangle, group.triangle_count}; }
};

Result<std::unique_ptr<Structure>> make_structure(const Gpu& gpu, Accel accel) {
    if (accel == Accel::grid) return make_grid(gpu);
    if (accel == Accel::grid2) return make_grid2(gpu);
    return make_bvh(gpu);
}

/// Chords of the unit cube, between random points on opposite or adjoining faces; t from 0 to 1.
std::vector<shared::RayQuery> probe_rays() {
    Pcg32 random(1);
    const auto point = [&](uint32_t face) {
        const float a = random.uniform(), b = random.uniform();
        const float side = face % 2 == 0 ? 0.0f : 1.0f;
        return face / 2 == 0   ? vec3{side, a, b}
               : face / 2 == 1 ? vec3{a, side, b}
                               : vec3{a, b, side};
    };
    std::vector<shared::RayQuery> rays;
    for (uint32_t i = 0; i < kProbeRays; ++i) {
        const vec3 from = point(i % 6);
        const vec3 to = point((i % 6 + 1 + random.next() % 5) % 6);
        rays.push_back({from, 0, to - from, 1});
    }
    return rays;
}

/// Moves the unit cube onto the box. A flat box is thickened, so that no ray loses its direction.
shared::Affine unit_cube_onto(const Box& box) {
    const vec3 size = box.size();
    const float least = std::max(1e-3f * std::max({size.x, size.y, size.z}), 1e-30f);
    return {{std::max(size.x, least), 0, 0},
            {0, std::max(size.y, least), 0},
            {0, 0, std::max(size.z, least)},
            box.lo};
}

uvec2 words(uint64_t address) {
    return {static_cast<uint32_t>(address), static_cast<uint32_t>(address >> 32)};
}

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

/// What shaders read, in one buffer: the scene, its instances and its tree; then, for each group
/// that is measured, a scene and an instance of its own.
struct Layout {
    explicit Layout(uint64_t groups, uint64_t probes)
        : instances(64),
          nodes(instances + groups * sizeof(Instance)),
          probe_scenes(nodes + 2 * groups * sizeof(shared::TopNode)),
          probe_instances(probe_scenes + probes * kSceneStride),
          bytes(probe_instances + probes * sizeof(Instance)) {}
    static constexpr uint64_t kSceneStride = 64;  // keeps addresses aligned
    uint64_t instances, nodes, probe_scenes, probe_instances, bytes;
};

}  // namespace

struct TraceScene::State {
    State(Gpu device, GroupBounds group_bounds)
        : gpu(std::move(device)), bounds(std::move(group_bounds)), rays(gpu) {}

    Gpu gpu;
    GroupBounds bounds;
    TraceRays rays;
    std::vector<Member> members;  // groups that are not empty
    uint32_t kinds = 0;
    uint32_t probe_count = 0;
    bool fresh = true;  // the next update builds all
    Work work;
    Layout layout{0, 0};
    vk::Buffer scene;   // see Layout
    vk::Buffer probes;  // RayQuery [kProbeRays], the same for all measured groups
    vk::Buffer hits;    // RayHit [probe_count][kProbeRays], which nobody reads
    vk::Buffer counts;  // TraceCounts [probe_count]

    Status make_members(std::span<const Group> groups, Accel accel, double rays_per_update);
    Status make_buffers();
    void plan(std::span<const mat4> transforms);
    void plan_rigid(Member& member, const mat4& transform);
    Status judge_wear(vk::Stream& stream);
    Status measure_boxes(vk::Stream& stream, TriangleSpan triangles);
    Status build(vk::Stream& stream, TriangleSpan triangles);
    void place(vk::Stream& stream);
    void place_probes(vk::Stream& stream);
    void probe(vk::Stream& stream);
    Status update(vk::Stream& stream, TriangleSpan triangles, std::span<const mat4> transforms);
    bool fits(TriangleSpan triangles, std::span<const mat4> transforms) const;
    bool needs_boxes() const { return members.size() > 1 || probe_count > 0; }
    Instance instance(const Member& member) const;
};

Status TraceScene::State::make_members(std::span<const Group> groups, Accel accel,
                                       double rays_per_update) {
    std::array<Structure*, 4> first_of{};  // by Accel
    for (size_t i = 0; i < groups.size(); ++i) {
        const Group& group = groups[i];
        if (group.triangle_count == 0) continue;
        Member member;
        member.group = group;
        member.index = i;
        member.accel = accel;
        AccelDemand demand{.triangles = group.triangle_count};
        if (group.motion == Motion::free) demand.rays_per_build = rays_per_update;
        if (accel == Accel::automatic) member.accel = choose_accel(demand);
        Structure*& first = first_of[static_cast<size_t>(member.accel)];
        if (first) {
            member.structure = first->sibling();
        } else {
            AG_TRY(member.structure, make_structure(gpu, member.accel));
            first = member.structure.get();
        }
        if (member.wears()) member.probe = probe_count++;
        kinds |= 1u << member.structure->kind();
        members.push_back(std::move(member));
    }
    return {};
}

Status TraceScene::State::make_buffers() {
    layout = Layout(members.size(), probe_count);
    AG_TRY(scene, gpu->make_buffer(layout.bytes, "trace scene"));
    if (probe_count == 0) return {};
    AG_TRY(probes, gpu->make_buffer(kProbeRays * sizeof(shared::RayQuery), "probe rays"));
    AG_TRY(counts, gpu->make_buffer(probe_count * sizeof(TraceCounts), "probe counts"));
    AG_TRY(hits, gpu->make_buffer(probe_count * kProbeRays * sizeof(shared::RayHit), "probe hits"));
    return rays.prepare(kProbeKinds, Query::nearest, Counting::on);
}

bool TraceScene::State::fits(TriangleSpan triangles, std::span<const mat4> transforms) const {
    return std::all_of(members.begin(), members.end(), [&](const Member& member) {
        const Group& group = member.group;
        return uint64_t{group.first_triangle} + group.triangle_count <= triangles.count &&
               (group.motion != Motion::rigid || member.index < transforms.size());
    });
}

/// What each group needs; judge_wear() may turn refits into builds.
void TraceScene::State::plan(std::span<const mat4> transforms) {
    for (Member& member : members) {
        const Motion motion = member.group.motion;
        member.action = Action::keep;
        if (motion == Motion::rigid) plan_rigid(member, transforms[member.index]);
        if (motion == Motion::deforming)
            member.action = member.wears() ? Action::refit : Action::build;
        if (fresh || motion == Motion::free) member.action = Action::build;
    }
}

void TraceScene::State::plan_rigid(Member& member, const mat4& transform) {
    if (member.reference && !fresh) {
        if (transform == *member.reference) {
            member.placement = {};
            return;
        }
        const auto moved = placement(*member.reference, transform);
        if (moved && moved->stretch <= kMostStretch) {
            member.placement = *moved;
            return;
        }
    }
    member.action = Action::build;
    member.placement = {};
    member.reference.reset();
    if (placement(transform, transform)) member.reference = transform;
}

Status TraceScene::State::judge_wear(vk::Stream& stream) {
    if (fresh || probe_count == 0) return {};
    AG_TRY(const auto counted, stream.download<TraceCounts>(counts, probe_count));
    for (Member& member : members) {
        if (!member.wears()) continue;
        const TraceCounts& work_of_rays = counted[member.probe];
        const double cost = static_cast<double>(work_of_rays.steps) + work_of_rays.triangles;
        if (member.cost_when_built == 0) member.cost_when_built = cost;
        if (cost > kWornOut * member.cost_when_built) member.action = Action::build;
    }
    return {};
}

Status TraceScene::State::measure_boxes(vk::Stream& stream, TriangleSpan triangles) {
    if (!needs_boxes()) return {};
    std::vector<uvec2> runs;
    for (const Member& member : members)
        if (member.action != Action::keep) runs.push_back(member.run());
    AG_TRY(const std::vector<Box> boxes, bounds.measure(stream, triangles, runs));
    size_t next = 0;
    for (Member& member : members)
        if (member.action != Action::keep) member.box = boxes[next++];
    return {};
}

Status TraceScene::State::build(vk::Stream& stream, TriangleSpan triangles) {
    work = {};
    for (Member& member : members) {
        if (member.action == Action::keep) continue;
        const TriangleSpan span{
            triangles.address + member.group.first_triangle * sizeof(shared::Triangle),
            member.group.triangle_count};
        if (work.built + work.refitted > 0) stream.barrier();  // structures share scratch memory
        if (member.action == Action::refit) {
            AG_CHECK(member.structure->refit(stream, span));
            ++work.refitted;
        } else {
            AG_CHECK(member.structure->build(stream, span));
            member.cost_when_built = 0;
            ++work.built;
        }
    }
    return {};
}

Instance TraceScene::State::instance(const Member& member) const {
    return {.to_local = member.placement.to_local,
            .kind = member.structure->kind(),
            .first_triangle = member.group.first_triangle,
            .header = words(member.structure->header())};
}

void TraceScene::State::place(vk::Stream& stream) {
    std::vector<Instance> instances;
    std::vector<Bounds> boxes;
    for (const Member& member : members) {
        if (needs_boxes() && member.box.empty()) continue;
        instances.push_back(instance(member));
        boxes.push_back(moved_box({member.box.lo, member.box.hi}, member.placement.to_world));
    }
    const std::vector<shared::TopNode> nodes =
        instances.size() > 1 ? top_tree(boxes) : std::vector<shared::TopNode>();
    const shared::TraceScene header{.instances = scene.address() + layout.instances,
                                    .nodes = scene.address() + layout.nodes,
                                    .instance_count = static_cast<uint32_t>(instances.size()),
                                    .kinds = kinds};
    stream.upload(std::span(&header, 1), scene);
    if (!instances.empty()) stream.upload_bytes(bytes_of(instances), scene, layout.instances);
    if (!nodes.empty()) stream.upload_bytes(bytes_of(nodes), scene, layout.nodes);
}

/// A scene of one instance for each group that is measured, in which it fills the unit cube.
void TraceScene::State::place_probes(vk::Stream& stream) {
    struct alignas(Layout::kSceneStride) PaddedScene : shared::TraceScene {};
    std::vector<PaddedScene> scenes(probe_count);
    std::vector<Instance> instances(probe_count);
    for (const Member& member : members) {
        if (!member.wears()) continue;
        Instance probed = instance(member);
        probed.to_local = unit_cube_onto(member.box);
        instances[member.probe] = probed;
        scenes[member.probe].instances =
            scene.address() + layout.probe_instances + member.probe * sizeof(Instance);
        scenes[member.probe].instance_count = member.box.empty() ? 0 : 1;
        scenes[member.probe].kinds = kProbeKinds;
    }
    stream.upload_bytes(bytes_of(scenes), scene, layout.probe_scenes);
    stream.upload_bytes(bytes_of(instances), scene, layout.probe_instances);
    if (fresh) stream.upload_bytes(bytes_of(probe_rays()), probes, 0);
    stream.fill(counts, 0, 0, counts.size());
}

void TraceScene::State::probe(vk::Stream& stream) {
    if (probe_count == 0) return;
    place_probes(stream);
    stream.barrier();
    for (uint64_t i = 0; i < probe_count; ++i)
        rays.record(stream, kProbeKinds, Query::nearest, Counting::on,
                    {.first_group = 0,
                     .ray_count = kProbeRays,
                     .scene = scene.address() + layout.probe_scenes + i * Layout::kSceneStride,
                     .rays = probes.address(),
                     .hits = hits.address() + i * kProbeRays * sizeof(shared::RayHit),
                     .blocked = 0,
                     .counts = counts.address() + i * sizeof(TraceCounts)});
}

Status TraceScene::State::update(vk::Stream& stream, TriangleSpan triangles,
                                 std::span<const mat4> transforms) {
    plan(transforms);
    AG_CHECK(judge_wear(stream));
    AG_CHECK(measure_boxes(stream, triangles));
    AG_CHECK(build(stream, triangles));
    place(stream);
    probe(stream);
    // What is recorded fails only here; a later update must not build upon it.
    return work.built + work.refitted > 0 ? stream.finish() : Status();
}

TraceScene::TraceScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
TraceScene::TraceScene(TraceScene&&) noexcept = default;
TraceScene& TraceScene::operator=(TraceScene&&) noexcept = default;
TraceScene::~TraceScene() = default;

Result<TraceScene> TraceScene::create(const Gpu& gpu, std::span<const Group> groups, Accel accel,
                                      double rays_per_update) {
    AG_TRY(GroupBounds bounds, GroupBounds::create(gpu));
    auto state = std::make_unique<State>(gpu, std::move(bounds));
    AG_CHECK(state->make_members(groups, accel, rays_per_update));
    AG_CHECK(state->make_buffers());
    return TraceScene(std::move(state));
}

Status TraceScene::update(vk::Stream& stream, TriangleSpan triangles,
                          std::span<const mat4> transforms) {
    AG_ASSERT(state_->fits(triangles, transforms),
              "groups are runs of the triangles, and rigid ones have a transform");
    Status done = state_->update(stream, triangles, transforms);
    state_->fresh = !done;
    return done;
}

uint64_t TraceScene::address() const { return state_->scene.address(); }
uint32_t TraceScene::kinds() const { return state_->kinds; }
TraceScene::Work TraceScene::work() const { return state_->work; }

AccelStats TraceScene::stats() const {
    AccelStats sum;
    for (const Member& member : state_->members) {
        const StructureStats stats = member.structure->stats();
        sum.bytes += stats.bytes;
        sum.references += stats.references;
        sum.cells += stats.cells;
    }
    return sum;
}

}  // namespace aglow::accel::gpu
