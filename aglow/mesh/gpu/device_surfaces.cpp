// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/gpu/device_surfaces.h"

#include "aglow/core/assert.h"
#include "aglow/mesh/gpu/pose_normals.comp.h"
#include "aglow/mesh/gpu/pose_triangles.comp.h"
#include "aglow/mesh/gpu/pose_vertices.comp.h"
#include "aglow/mesh/gpu/primitive_pool.h"
#include "aglow/mesh/pose/placement_pose.h"
#include "aglow/shared/pose.h"
#include "aglow/vk/device.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>

namespace aglow::mesh::gpu {
namespace {

using shared::PoseChunk;
using shared::PosePart;
using shared::PoseState;
using shared::PoseTarget;

shared::Affine affine(const mat4& t) {
    const auto column = [&](int i) { return vec3{t.at(0, i), t.at(1, i), t.at(2, i)}; };
    return {column(0), column(1), column(2), column(3)};
}

PlacedMesh placed(const SurfacePart& part) { return {part.node, part.instance, part.mesh}; }

/// What node_poses() and joint_transforms() read, without vertices and images.
Scene skeleton_of(const Scene& scene) {
    Scene skeleton;
    skeleton.nodes = scene.nodes;
    skeleton.skins = scene.skins;
    skeleton.animations = scene.animations;
    for (const Mesh& mesh : scene.meshes) skeleton.meshes.push_back({{}, {}, mesh.weights});
    return skeleton;
}

/// Indices of the parts: those that move first, and of these those without a skin first.
std::vector<uint32_t> posing_order(std::span<const PartMotion> motions,
                                   const std::vector<char>& skinned) {
    std::vector<uint32_t> order(motions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const auto rank = [&](uint32_t part) {
            return 2 * (motions[part] == PartMotion::still) + (skinned[part] ? 1 : 0);
        };
        return rank(a) < rank(b);
    });
    return order;
}

/// How much of a list a call works on: what moves comes first.
struct Extent {
    size_t all = 0, moving = 0;
    size_t of(bool everything) const { return everything ? all : moving; }
};

template <class Count>
std::vector<PoseChunk> cut(std::span<const uint32_t> order, size_t moving, Count count,
                           Extent& extent) {
    std::vector<PoseChunk> chunks;
    for (size_t i = 0; i < order.size(); ++i) {
        for (uint32_t first = 0; first < count(order[i]); first += shared::kPoseGroup)
            chunks.push_back({static_cast<uint32_t>(i), first});
        if (i < moving) extent.moving = chunks.size();
    }
    extent.all = chunks.size();
    return chunks;
}

struct Kernels {
    vk::Kernel vertices, skinned_vertices, triangles, normals;

    static Result<Kernels> create(const Gpu& gpu) {
        AG_TRY(auto vertices,
               vk::Kernel::create(gpu, "pose vertices", shaders::pose_vertices_comp));
        const std::array skin = {1u};
        AG_TRY(auto skinned_vertices,
               vk::Kernel::create(gpu, "pose skinned vertices", shaders::pose_vertices_comp, skin));
        AG_TRY(auto triangles,
               vk::Kernel::create(gpu, "pose triangles", shaders::pose_triangles_comp));
        AG_TRY(auto normals, vk::Kernel::create(gpu, "pose normals", shaders::pose_normals_comp));
        return Kernels{std::move(vertices), std::move(skinned_vertices), std::move(triangles),
                       std::move(normals)};
    }
};

}  // namespace

/// Parts are numbered as in Surfaces; `order` says how the device numbers them.
struct DeviceSurfaces::State {
    explicit State(Kernels made, PrimitivePool primitives)
        : kernels(std::move(made)), pool(std::move(primitives)) {}

    Kernels kernels;
    PrimitivePool pool;
    Scene skeleton;
    std::vector<SurfacePart> parts;
    std::vector<PartMotion> motions;
    std::vector<mat4> transforms;
    std::vector<uint32_t> order;
    Extent part_extent, vertex_chunk_extent, triangle_chunk_extent, skin_extent;

    /// A placement whose joints lie in a run of the joint buffer.
    struct PlacedSkin {
        PlacedMesh placed;
        uint32_t first_joint = 0;
    };
    std::vector<PlacedSkin> skins;

    /// Chunks of vertices that one kernel poses, one behind the other.
    struct Run {
        size_t first = 0, count = 0;
        bool skinned = false, moving = false;
    };
    std::vector<Run> runs;
    std::vector<uint32_t> first_joints;  ///< [part]
    uint32_t vertex_count = 0, triangle_count = 0;
    std::optional<bool> posed_at_rest;  ///< of the last pose()

    vk::Buffer part_buffer, state_buffer, joint_buffer, target_buffer;
    vk::Buffer vertex_chunks, triangle_chunks;
    vk::Buffer positions, normals, indices, corners;
    vk::Buffer mirrored, first_triangle, without_normal;

    bool is_skinned(uint32_t part) const { return skinned[part] != 0; }
    std::vector<char> skinned;                          ///< [part]
    std::vector<PoseChunk> vertex_list, triangle_list;  ///< until they are uploaded

    void place_skins();
    void cut_chunks();
    Status make_buffers(const Gpu& gpu);
    void upload_layout(vk::Stream& stream) const;
    uint64_t skinned_vertices() const;
    std::vector<PosePart> device_parts() const;
    void upload_pose(vk::Stream& stream, const NodePoses& poses, bool everything);
    shared::PoseArgs args(const vk::Buffer& chunks) const;
};

/// Gives the joints of every skinned placement a run; those of moving parts come first.
void DeviceSurfaces::State::place_skins() {
    first_joints.assign(parts.size(), 0);
    std::map<std::pair<int, int>, uint32_t> known;
    uint32_t next = 0;
    for (size_t i = 0; i < order.size(); ++i) {
        const SurfacePart& part = parts[order[i]];
        if (is_skinned(order[i])) {
            const auto [at, is_new] = known.try_emplace({part.node, part.instance}, next);
            first_joints[order[i]] = at->second;
            if (is_new) {
                skins.push_back({placed(part), next});
                const int skin = skeleton.nodes[static_cast<size_t>(part.node)].skin;
                next +=
                    static_cast<uint32_t>(skeleton.skins[static_cast<size_t>(skin)].joints.size());
            }
        }
        if (i < part_extent.moving) skin_extent.moving = skins.size();
    }
    skin_extent.all = skins.size();
}

uint64_t DeviceSurfaces::State::skinned_vertices() const {
    uint64_t count = 0;
    for (uint32_t part = 0; part < parts.size(); ++part)
        if (is_skinned(part)) count += parts[part].vertex_count;
    return count;
}

std::vector<PosePart> DeviceSurfaces::State::device_parts() const {
    std::vector<PosePart> out;
    out.reserve(parts.size());
    uint32_t first_mirrored = 0;
    for (const uint32_t index : order) {
        const SurfacePart& part = parts[index];
        const PrimitivePool::Entry& entry = pool.entry(part);
        const bool skin = is_skinned(index);
        out.push_back({.positions = entry.positions,
                       .normals = entry.normals,
                       .triangles = entry.triangles,
                       .joints = entry.joints,
                       .weights = entry.weights,
                       .first_vertex = part.first_vertex,
                       .vertex_count = part.vertex_count,
                       .first_triangle = part.first_triangle,
                       .triangle_count = part.triangle_count,
                       .influences = skin ? entry.influences : 0,
                       .first_mirrored = first_mirrored});
        if (skin) first_mirrored += part.vertex_count;
    }
    return out;
}

void DeviceSurfaces::State::cut_chunks() {
    const auto vertices = [&](uint32_t part) { return parts[part].vertex_count; };
    const auto triangles = [&](uint32_t part) { return parts[part].triangle_count; };
    vertex_list = cut(order, part_extent.moving, vertices, vertex_chunk_extent);
    for (size_t i = 0; i < vertex_list.size(); ++i) {
        const uint32_t place = vertex_list[i].part;
        const bool skin = is_skinned(order[place]), moving = place < part_extent.moving;
        if (runs.empty() || runs.back().skinned != skin || runs.back().moving != moving)
            runs.push_back({i, 0, skin, moving});
        ++runs.back().count;
    }
    triangle_list = cut(order, part_extent.moving, triangles, triangle_chunk_extent);
}

void DeviceSurfaces::State::upload_layout(vk::Stream& stream) const {
    const std::vector<PosePart> device = device_parts();
    stream.upload(std::span<const PosePart>(device), part_buffer);
    stream.upload(std::span<const PoseChunk>(vertex_list), vertex_chunks);
    stream.upload(std::span<const PoseChunk>(triangle_list), triangle_chunks);
}

Status DeviceSurfaces::State::make_buffers(const Gpu& gpu) {
    const auto make = [&](vk::Buffer& buffer, uint64_t bytes, const char* name) -> Status {
        AG_TRY(buffer, gpu->make_buffer(bytes, name));
        return {};
    };
    const uint64_t v = vertex_count, t = triangle_count;
    uint64_t targets = 0, joints = 0;
    for (const SurfacePart& part : parts) targets += pool.entry(part).targets.size();
    for (const PlacedSkin& skin : skins) {
        const Node& node = skeleton.nodes[static_cast<size_t>(skin.placed.node)];
        joints += skeleton.skins[static_cast<size_t>(node.skin)].joints.size();
    }
    AG_CHECK(make(part_buffer, parts.size() * sizeof(PosePart), "parts to pose"));
    AG_CHECK(make(vertex_chunks, vertex_list.size() * sizeof(PoseChunk), "chunks of vertices"));
    AG_CHECK(
        make(triangle_chunks, triangle_list.size() * sizeof(PoseChunk), "chunks of triangles"));
    AG_CHECK(make(state_buffer, parts.size() * sizeof(PoseState), "poses of parts"));
    AG_CHECK(make(joint_buffer, joints * sizeof(shared::Affine), "joints"));
    AG_CHECK(make(target_buffer, targets * sizeof(PoseTarget), "morph targets in use"));
    AG_CHECK(make(positions, v * sizeof(vec3), "positions of vertices"));
    AG_CHECK(make(normals, v * sizeof(vec3), "normals of vertices"));
    AG_CHECK(make(indices, t * sizeof(uvec3), "vertices of triangles"));
    AG_CHECK(make(corners, t * sizeof(shared::Triangle), "corners of triangles"));
    AG_CHECK(make(mirrored, skinned_vertices() * sizeof(uint32_t), "mirrored vertices"));
    AG_CHECK(make(first_triangle, v * sizeof(uint32_t), "vertices without normals"));
    AG_CHECK(make(without_normal, sizeof(uint32_t), "flag of vertices without normals"));
    return {};
}

/// Sends where everything is to the device.
void DeviceSurfaces::State::upload_pose(vk::Stream& stream, const NodePoses& poses,
                                        bool everything) {
    std::vector<PoseState> states;
    std::vector<PoseTarget> targets;
    for (size_t i = 0; i < part_extent.of(everything); ++i) {
        const uint32_t index = order[i];
        const SurfacePart& part = parts[index];
        transforms[index] = placement_transform(skeleton, poses, placed(part));
        const std::vector<float>& weights = poses.weights[static_cast<size_t>(part.node)];
        const std::vector<PoseTarget>& all = pool.entry(part).targets;
        const auto first = static_cast<uint32_t>(targets.size());
        for (size_t t = 0; t < std::min(weights.size(), all.size()); ++t) {
            if (weights[t] == 0 || all[t].moves == 0) continue;
            targets.push_back(all[t]);
            targets.back().weight = weights[t];
        }
        states.push_back({.transform = affine(transforms[index]),
                          .mirrored = determinant3(transforms[index]) < 0 ? 1u : 0u,
                          .first_joint = first_joints[index],
                          .first_target = first,
                          .target_count = static_cast<uint32_t>(targets.size()) - first});
    }
    std::vector<shared::Affine> joints;
    for (size_t i = 0; i < skin_extent.of(everything); ++i)
        for (const mat4& joint : joint_transforms(skeleton, poses, skins[i].placed))
            joints.push_back(affine(joint));
    stream.upload(std::span<const PoseState>(states), state_buffer);
    stream.upload(std::span<const PoseTarget>(targets), target_buffer);
    stream.upload(std::span<const shared::Affine>(joints), joint_buffer);
}

shared::PoseArgs DeviceSurfaces::State::args(const vk::Buffer& chunks) const {
    return {.first_group = 0,
            .chunk_count = 0,
            .chunks = chunks.address(),
            .parts = part_buffer.address(),
            .states = state_buffer.address(),
            .joints = joint_buffer.address(),
            .targets = target_buffer.address(),
            .positions = positions.address(),
            .normals = normals.address(),
            .mirrored = mirrored.address(),
            .indices = indices.address(),
            .corners = corners.address(),
            .without_normal = without_normal.address(),
            .first_triangle = first_triangle.address()};
}

DeviceSurfaces::DeviceSurfaces(std::unique_ptr<State> state) : state_(std::move(state)) {}
DeviceSurfaces::DeviceSurfaces(DeviceSurfaces&&) noexcept = default;
DeviceSurfaces& DeviceSurfaces::operator=(DeviceSurfaces&&) noexcept = default;
DeviceSurfaces::~DeviceSurfaces() = default;

Result<DeviceSurfaces> DeviceSurfaces::create(vk::Stream& stream, const Scene& scene,
                                              const Surfaces& rest) {
    AG_TRY(auto kernels, Kernels::create(stream.gpu()));
    AG_TRY(auto pool, PrimitivePool::create(stream.gpu(), scene, rest.parts));
    auto state = std::make_unique<State>(std::move(kernels), std::move(pool));
    state->skeleton = skeleton_of(scene);
    state->parts = rest.parts;
    state->motions = classify_parts(scene, rest.parts);
    state->transforms.resize(rest.parts.size());
    for (const SurfacePart& part : rest.parts)
        state->skinned.push_back(is_skinned(scene, part) ? 1 : 0);
    state->order = posing_order(state->motions, state->skinned);
    state->part_extent.all = rest.parts.size();
    state->part_extent.moving =
        rest.parts.size() - static_cast<size_t>(std::count(
                                state->motions.begin(), state->motions.end(), PartMotion::still));
    state->vertex_count = static_cast<uint32_t>(rest.positions.size());
    state->triangle_count = static_cast<uint32_t>(rest.triangles.size());
    state->place_skins();
    state->cut_chunks();
    AG_CHECK(state->make_buffers(stream.gpu()));
    state->pool.upload(stream, scene);
    state->upload_layout(stream);
    AG_CHECK(stream.finish());
    state->vertex_list = {};
    state->triangle_list = {};
    return DeviceSurfaces(std::move(state));
}

Status DeviceSurfaces::pose(vk::Stream& stream, double time) {
    State& s = *state_;
    const bool at_rest = time < 0;
    const bool everything = s.posed_at_rest != at_rest;
    s.posed_at_rest = at_rest;
    const size_t vertex_groups = s.vertex_chunk_extent.of(everything);
    const size_t triangle_groups = s.triangle_chunk_extent.of(everything);
    if (vertex_groups == 0) return {};

    s.upload_pose(stream, node_poses(s.skeleton, time), everything);
    stream.fill(s.without_normal, 0, 0, sizeof(uint32_t));
    stream.barrier();
    for (const State::Run& run : s.runs) {
        if (!everything && !run.moving) continue;
        shared::PoseArgs args = s.args(s.vertex_chunks);
        args.chunks += run.first * sizeof(PoseChunk);
        stream.run(run.skinned ? s.kernels.skinned_vertices : s.kernels.vertices, args, run.count);
    }
    stream.barrier();
    if (triangle_groups > 0)
        stream.run(s.kernels.triangles, s.args(s.triangle_chunks), triangle_groups);
    stream.barrier();
    shared::PoseArgs args = s.args(s.vertex_chunks);
    args.chunk_count = static_cast<uint32_t>(vertex_groups);
    stream.run(s.kernels.normals, args,
               vk::group_count(vertex_groups, shared::kChunksPerRepairGroup));
    return {};
}

uint64_t DeviceSurfaces::positions() const { return state_->positions.address(); }
uint64_t DeviceSurfaces::normals() const { return state_->normals.address(); }
uint64_t DeviceSurfaces::indices() const { return state_->indices.address(); }
uint64_t DeviceSurfaces::corners() const { return state_->corners.address(); }
uint32_t DeviceSurfaces::vertex_count() const { return state_->vertex_count; }
uint32_t DeviceSurfaces::triangle_count() const { return state_->triangle_count; }
std::span<const PartMotion> DeviceSurfaces::part_motions() const { return state_->motions; }
std::span<const mat4> DeviceSurfaces::part_transforms() const { return state_->transforms; }

}  // namespace aglow::mesh::gpu
