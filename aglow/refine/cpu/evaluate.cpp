// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/cpu/evaluate.h"

#include "aglow/core/parallel.h"
#include "aglow/core/target_clones.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace aglow::refine::cpu {
namespace {

constexpr uint32_t kChannels = 3;

/// A block of columns of one channel. Where registers are narrower it takes several.
using Lanes = float __attribute__((vector_size(kColumnBlock * sizeof(float))));

// What runs inside sum_range must be inlined there, to be compiled for the same processors.
#define AGLOW_INLINE __attribute__((always_inline)) inline

/// Memory that a face is worked out in.
struct Scratch {
    explicit Scratch(const FaceTables& faces)
        : ring(size_t{*std::ranges::max_element(faces.rows)} * kChannels),
          points(faces.stride / kColumnBlock * kChannels) {}
    std::vector<float> ring;  ///< [row][channel]
    Weights points;           ///< [column][channel]
};

AGLOW_INLINE void load(const float* from, Lanes& to) { std::memcpy(&to, from, sizeof(to)); }

/// x0 x1 .., y0 y1 .., z0 z1 .. to x0 y0 z0 x1 y1 ..: shuffles that stay within halves of
/// registers, then halves are exchanged.
AGLOW_INLINE void store_interleaved(const Lanes& x, const Lanes& y, const Lanes& z, float* to) {
    const Lanes xy = __builtin_shufflevector(x, y, 0, 2, 8, 10, 4, 6, 12, 14);
    const Lanes yz = __builtin_shufflevector(y, z, 1, 3, 9, 11, 5, 7, 13, 15);
    const Lanes zx = __builtin_shufflevector(z, x, 0, 2, 9, 11, 4, 6, 13, 15);
    const Lanes a = __builtin_shufflevector(xy, zx, 0, 2, 8, 10, 4, 6, 12, 14);
    const Lanes b = __builtin_shufflevector(yz, xy, 0, 2, 9, 11, 4, 6, 13, 15);
    const Lanes c = __builtin_shufflevector(zx, yz, 1, 3, 9, 11, 5, 7, 13, 15);
    const Lanes first = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
    const Lanes second = __builtin_shufflevector(c, a, 0, 1, 2, 3, 12, 13, 14, 15);
    const Lanes third = __builtin_shufflevector(b, c, 4, 5, 6, 7, 12, 13, 14, 15);
    std::memcpy(to, &first, sizeof(first));
    std::memcpy(to + kColumnBlock, &second, sizeof(second));
    std::memcpy(to + 2 * kColumnBlock, &third, sizeof(third));
}

/// kBlocks blocks of columns of a table times a ring.
template <uint32_t kBlocks>
AGLOW_INLINE void sum_blocks(const float* table, size_t stride, uint32_t rows, const float* ring,
                             float* to) {
    Lanes x[kBlocks] = {}, y[kBlocks] = {}, z[kBlocks] = {};
    for (uint32_t r = 0; r < rows; ++r, table += stride, ring += kChannels)
        for (uint32_t b = 0; b < kBlocks; ++b) {
            Lanes weight;
            load(table + b * kColumnBlock, weight);
            x[b] += weight * ring[0];
            y[b] += weight * ring[1];
            z[b] += weight * ring[2];
        }
    for (uint32_t b = 0; b < kBlocks; ++b)
        store_interleaved(x[b], y[b], z[b], to + b * kColumnBlock * kChannels);
}

AGLOW_INLINE void sum_columns(const float* table, size_t stride, uint32_t rows, const float* ring,
                              uint32_t begin, uint32_t end, float* points) {
    uint32_t c = begin;
    for (; c + 2 * kColumnBlock <= end; c += 2 * kColumnBlock)
        sum_blocks<2>(table + c, stride, rows, ring, points + c * kChannels);
    for (; c < end; c += kColumnBlock)
        sum_blocks<1>(table + c, stride, rows, ring, points + c * kChannels);
}

AGLOW_INLINE void copy(const float* points, uint32_t count, uint32_t first, OutputChannels to) {
    float* out = to.values + first * to.width;
    if (to.width == kChannels) {
        std::memcpy(out, points, count * kChannels * sizeof(float));
        return;
    }
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t c = 0; c < to.count; ++c) out[i * to.width + c] = points[i * kChannels + c];
}

AGLOW_INLINE std::span<const uint32_t> ring_of(const FaceTables& faces, uint32_t f) {
    return {faces.ring.data() + faces.ring_begin[f], faces.rows[faces.face_class[f]]};
}

AGLOW_INLINE void gather(std::span<const uint32_t> ring, Channels points, float* to) {
    for (const uint32_t v : ring) {
        const float* from = points.values + v * points.width;
        to[0] = from[0];
        to[1] = points.count > 1 ? from[1] : 0.0f;
        to[2] = points.count > 2 ? from[2] : 0.0f;
        to += kChannels;
    }
}

/// Writes the corners and edges that the face owns, and its inside.
AGLOW_INLINE void write_owned(const FaceTables& faces, const FaceOutput& output,
                              const float* points, OutputChannels to) {
    const uint32_t n = faces.segments;
    for (uint32_t i = 0; i < faces.corners; ++i) {
        const float* corner = points + i * n * kChannels;
        if ((output.owned & (1u << i)) != 0) copy(corner, 1, output.corner[i], to);
        if ((output.owned & (16u << i)) != 0) copy(corner + kChannels, n - 1, output.edge[i], to);
    }
    copy(points + faces.corners * n * kChannels, faces.interior, output.interior, to);
}

/// The columns that the face owns of a table times its ring. Corners with their edges that others
/// own are left out where they fill whole blocks.
AGLOW_INLINE void sum_owned(const FaceTables& faces, const float* weights, uint32_t f,
                            const float* ring, float* points) {
    const uint32_t k = faces.face_class[f], rows = faces.rows[k], n = faces.segments;
    const float* table = weights + faces.weight_begin[k];
    uint32_t begin = 0;
    if (n % kColumnBlock == 0) {
        begin = faces.corners * n;
        for (uint32_t i = 0; i < faces.corners; ++i)
            if ((faces.output[f].owned & (17u << i)) != 0)
                sum_columns(table, faces.stride, rows, ring, i * n, (i + 1) * n, points);
    }
    sum_columns(table, faces.stride, rows, ring, begin, faces.stride, points);
}

AGLOW_TARGET_CLONES
void sum_range(const FaceTables& faces, Channels points, OutputChannels to, size_t begin,
               size_t end, Scratch& scratch) {
    float* ring = scratch.ring.data();
    float* sums = scratch.points.data()->weight;
    for (size_t i = begin; i < end; ++i) {
        const auto f = static_cast<uint32_t>(i);
        gather(ring_of(faces, f), points, ring);
        sum_owned(faces, faces.weights.data()->weight, f, ring, sums);
        write_owned(faces, faces.output[f], sums, to);
    }
}

/// Points from the first of them on: differences of these lose fewer digits.
AGLOW_INLINE void move_to_origin(float* ring, uint32_t rows) {
    const float origin[kChannels] = {ring[0], ring[1], ring[2]};
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c < kChannels; ++c) ring[r * kChannels + c] -= origin[c];
}

struct LimitScratch {
    explicit LimitScratch(const FaceTables& faces) : position(faces), u(faces), v(faces) {}
    Scratch position, u, v;
};

/// u becomes the normals.
AGLOW_INLINE void make_normals(float* u, const float* v, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i, u += kChannels, v += kChannels) {
        const vec3 n = cross(vec3{u[0], u[1], u[2]}, vec3{v[0], v[1], v[2]});
        const float length = std::sqrt(dot(n, n));
        const float scale = length > 0 ? 1 / length : 0.0f;
        u[0] = n.x * scale;
        u[1] = n.y * scale;
        u[2] = n.z * scale;
    }
}

AGLOW_TARGET_CLONES
void limit_range(const FaceTables& faces, const LimitWeights& limit, Channels points,
                 OutputChannels positions, OutputChannels normals, size_t begin, size_t end,
                 LimitScratch& scratch) {
    float* ring = scratch.position.ring.data();
    float* u = scratch.u.points.data()->weight;
    float* v = scratch.v.points.data()->weight;
    float* position = scratch.position.points.data()->weight;
    for (size_t i = begin; i < end; ++i) {
        const auto f = static_cast<uint32_t>(i);
        gather(ring_of(faces, f), points, ring);
        sum_owned(faces, limit.position.data()->weight, f, ring, position);
        move_to_origin(ring, faces.rows[faces.face_class[f]]);
        sum_owned(faces, limit.tangent_u.data()->weight, f, ring, u);
        sum_owned(faces, limit.tangent_v.data()->weight, f, ring, v);
        make_normals(u, v, faces.stride);
        write_owned(faces, faces.output[f], position, positions);
        write_owned(faces, faces.output[f], u, normals);
    }
}

constexpr size_t kFaceGrain = 128;

}  // namespace

void sum_stencils(const Stencils& stencils, Channels from, OutputChannels to) {
    constexpr size_t kGrain = 4096;
    parallel_for(stencils.count(), kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            float sums[kChannels] = {};
            for (uint32_t t = stencils.begin[i]; t < stencils.begin[i + 1]; ++t)
                for (uint32_t c = 0; c < from.count; ++c)
                    sums[c] += stencils.weight[t] * from.values[stencils.index[t] * from.width + c];
            for (uint32_t c = 0; c < to.count; ++c) to.values[i * to.width + c] = sums[c];
        }
    });
}

void sum_faces(const FaceTables& faces, Channels points, OutputChannels to) {
    parallel_for(faces.face_count(), kFaceGrain, [&](size_t begin, size_t end) {
        Scratch scratch(faces);
        sum_range(faces, points, to, begin, end, scratch);
    });
}

void sum_limits(const FaceTables& faces, const LimitWeights& limit, Channels points,
                std::span<vec3> positions, std::span<vec3> normals) {
    parallel_for(faces.face_count(), kFaceGrain, [&](size_t begin, size_t end) {
        LimitScratch scratch(faces);
        limit_range(faces, limit, points, {&positions.data()->x}, {&normals.data()->x}, begin, end,
                    scratch);
    });
}

}  // namespace aglow::refine::cpu
