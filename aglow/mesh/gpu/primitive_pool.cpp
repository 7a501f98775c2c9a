// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/gpu/primitive_pool.h"

#include "aglow/vk/device.h"

namespace aglow::mesh::gpu {
namespace {

constexpr uint32_t kMovesPositions = 1, kMovesNormals = 2;  // bits of PoseTarget::moves

struct Counts {
    uint64_t vertices = 0, triangles = 0, influences = 0, displacements = 0;

    void add(const Primitive& primitive) {
        vertices += primitive.positions.size();
        triangles += primitive.triangles.size();
        influences += primitive.joints.size();
        for (const MorphTarget& target : primitive.targets)
            displacements += target.positions.size() + target.normals.size();
    }
};

/// Gives arrays their places in a buffer, one behind the other.
class Placer {
public:
    explicit Placer(const vk::Buffer& buffer) : next_(buffer.address()) {}

    /// Address of `count` items of `size` bytes; 0 if there are none.
    uint64_t place(size_t count, size_t size) {
        if (count == 0) return 0;
        const uint64_t address = next_;
        next_ += count * size;
        return address;
    }

private:
    uint64_t next_;
};

template <class T>
void write(vk::Stream& stream, const std::vector<T>& items, const vk::Buffer& to,
           uint64_t address) {
    if (!items.empty()) stream.upload(std::span<const T>(items), to, address - to.address());
}

const Primitive& primitive_of(const Scene& scene, std::pair<int, int> key) {
    return scene.meshes[static_cast<size_t>(key.first)].primitives[static_cast<size_t>(key.second)];
}

}  // namespace

Result<PrimitivePool> PrimitivePool::create(const Gpu& gpu, const Scene& scene,
                                            std::span<const SurfacePart> parts) {
    PrimitivePool pool;
    for (const SurfacePart& part : parts) pool.entries_[{part.mesh, part.primitive}];
    Counts counts;
    for (const auto& [key, entry] : pool.entries_) counts.add(primitive_of(scene, key));

    const auto make = [&](vk::Buffer& buffer, uint64_t bytes, const char* name) -> Status {
        AG_TRY(buffer, gpu->make_buffer(bytes, name));
        return {};
    };
    AG_CHECK(make(pool.positions_, counts.vertices * sizeof(vec3), "positions at rest"));
    AG_CHECK(make(pool.normals_, counts.vertices * sizeof(vec3), "normals at rest"));
    AG_CHECK(make(pool.triangles_, counts.triangles * sizeof(uvec3), "triangles of primitives"));
    AG_CHECK(make(pool.joints_, counts.influences * sizeof(uint32_t), "joints of vertices"));
    AG_CHECK(make(pool.weights_, counts.influences * sizeof(float), "weights of vertices"));
    AG_CHECK(make(pool.displacements_, counts.displacements * sizeof(vec3), "morph targets"));
    pool.place_entries(scene);
    return pool;
}

void PrimitivePool::place_entries(const Scene& scene) {
    Placer positions(positions_), normals(normals_), triangles(triangles_);
    Placer joints(joints_), weights(weights_), displacements(displacements_);
    for (auto& [key, entry] : entries_) {
        const Primitive& primitive = primitive_of(scene, key);
        entry.positions = positions.place(primitive.positions.size(), sizeof(vec3));
        entry.normals = normals.place(primitive.positions.size(), sizeof(vec3));
        entry.triangles = triangles.place(primitive.triangles.size(), sizeof(uvec3));
        entry.joints = joints.place(primitive.joints.size(), sizeof(uint32_t));
        entry.weights = weights.place(primitive.weights.size(), sizeof(float));
        entry.influences = static_cast<uint32_t>(primitive.influences);
        for (const MorphTarget& target : primitive.targets) {
            shared::PoseTarget& out = entry.targets.emplace_back();
            out.positions = displacements.place(target.positions.size(), sizeof(vec3));
            out.normals = displacements.place(target.normals.size(), sizeof(vec3));
            out.moves = (target.positions.empty() ? 0 : kMovesPositions) |
                        (target.normals.empty() ? 0 : kMovesNormals);
        }
    }
}

void PrimitivePool::upload(vk::Stream& stream, const Scene& scene) const {
    for (const auto& [key, entry] : entries_) {
        const Primitive& primitive = primitive_of(scene, key);
        write(stream, primitive.positions, positions_, entry.positions);
        std::vector<vec3> normals = primitive.normals;
        normals.resize(primitive.positions.size(), vec3{0, 0, 0});
        write(stream, normals, normals_, entry.normals);
        write(stream, primitive.triangles, triangles_, entry.triangles);
        write(stream, primitive.joints, joints_, entry.joints);
        write(stream, primitive.weights, weights_, entry.weights);
        for (size_t t = 0; t < primitive.targets.size(); ++t) {
            const MorphTarget& target = primitive.targets[t];
            write(stream, target.positions, displacements_, entry.targets[t].positions);
            write(stream, target.normals, displacements_, entry.targets[t].normals);
        }
    }
}

}  // namespace aglow::mesh::gpu
