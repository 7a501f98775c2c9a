// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/cpu/evaluate.h"

#include "aglow/core/parallel.h"
#include "aglow/core/target_clones.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
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

/// A table and what it is multiplied by.
struct Product {
    const float* table;
    size_t stride;
    uint32_t rows;
    const float* ring;
};

/// Blocks of columns, which start at `columns`, of a product.
template <uint32_t kBlocks>
AGLOW_INLINE void sum_blocks(const Product& product, const size_t (&columns)[kBlocks], float* to) {
    Lanes x[kBlocks] = {}, y[kBlocks] = {}, z[kBlocks] = {};
    const float* table = product.table;
    const float* ring = product.ring;
    for (uint32_t r = 0; r < product.rows; ++r, table += product.stride, ring += kChannels)
        for (uint32_t b = 0; b < kBlocks; ++b) {
            Lanes weight;
            load(table + columns[b], weight);
            x[b] += weight * ring[0];
            y[b] += weight * ring[1];
            z[b] += weight * ring[2];
        }
    for (uint32_t b = 0; b < kBlocks; ++b)
        store_interleaved(x[b], y[b], z[b], to + (columns[b] - columns[0]) * kChannels);
}

/// `count` columns from `first` on, at least a block of them. The last block ends with the last
/// column, so that nothing else is written; what two blocks share comes out the same from both.
AGLOW_INLINE void sum_run(const Product& product, size_t first, size_t count, float* to) {
    constexpr size_t n = kColumnBlock;
    for (; count >= 3 * n; count -= 3 * n, first += 3 * n, to += 3 * n * kChannels)
        sum_blocks<3>(product, {first, first + n, first + 2 * n}, to);
    const size_t last = first + count - n;
    if (count > 2 * n)
        sum_blocks<3>(product, {first, first + n, last}, to);
    else if (count > n)
        sum_blocks<2>(product, {first, last}, to);
    else if (count > 0)
        sum_blocks<1>(product, {last}, to - (first - last) * kChannels);
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

/// All columns, then what the face owns of them.
AGLOW_INLINE void sum_all(const FaceTables& faces, const FaceOutput& output, const Product& product,
                          float* sums, OutputChannels to) {
    for (size_t c = 0; c < faces.stride; c += kColumnBlock)
        sum_blocks<1>(product, {c}, sums + c * kChannels);
    write_owned(faces, output, sums, to);
}

/// Corner i and the edge after it, if the face owns them.
AGLOW_INLINE void sum_edge(const FaceTables& faces, const FaceOutput& output, uint32_t i,
                           const Product& product, float* sums, OutputChannels to) {
    const uint32_t n = faces.segments;
    const bool corner = (output.owned & (1u << i)) != 0, edge = (output.owned & (16u << i)) != 0;
    const bool one_block = n <= kColumnBlock;
    if (corner || (edge && one_block)) {
        sum_blocks<1>(product, {size_t{i} * n}, sums);
        if (corner) copy(sums, 1, output.corner[i], to);
        if (edge && one_block) copy(sums + kChannels, n - 1, output.edge[i], to);
    }
    if (edge && !one_block)
        sum_run(product, size_t{i} * n + 1, n - 1, to.values + size_t{output.edge[i]} * kChannels);
}

/// Only what the face owns, straight to where it belongs: three numbers per point, and at least a
/// block of them inside.
AGLOW_INLINE void sum_owned(const FaceTables& faces, const FaceOutput& output,
                            const Product& product, float* sums, OutputChannels to) {
    for (uint32_t i = 0; i < faces.corners; ++i) sum_edge(faces, output, i, product, sums, to);
    sum_run(product, size_t{faces.corners} * faces.segments, faces.interior,
            to.values + size_t{output.interior} * kChannels);
}

AGLOW_TARGET_CLONES
void sum_range(const FaceTables& faces, const Weights& weights, Channels points, OutputChannels to,
               size_t begin, size_t end, Scratch& scratch) {
    float* sums = scratch.points.data()->weight;
    const bool straight = to.width == kChannels && faces.segments >= kColumnBlock;
    Product product = {nullptr, faces.stride, 0, scratch.ring.data()};
    for (size_t i = begin; i < end; ++i) {
        const auto f = static_cast<uint32_t>(i);
        const uint32_t k = faces.face_class[f];
        product.table = weights.data()->weight + faces.weight_begin[k];
        product.rows = faces.rows[k];
        gather(ring_of(faces, f), points, scratch.ring.data());
        if (straight)
            sum_owned(faces, faces.output[f], product, sums, to);
        else
            sum_all(faces, faces.output[f], product, sums, to);
    }
}

/// Points from the first of them on, in parts of their extent: differences of these lose fewer
/// digits, and products of differences do not underflow. Directions stay.
AGLOW_INLINE void make_relative(float* ring, uint32_t rows) {
    const float origin[kChannels] = {ring[0], ring[1], ring[2]};
    float extent = 0;
    for (uint32_t i = 0; i < rows * kChannels; ++i) {
        ring[i] -= origin[i % kChannels];
        extent = std::max(extent, std::abs(ring[i]));
    }
    const float scale = extent > 0 ? 1 / extent : 0.0f;
    for (uint32_t i = 0; i < rows * kChannels; ++i) ring[i] *= scale;
}

AGLOW_INLINE void inverse_root(const Lanes& square, Lanes& result) {
    constexpr float kTiny = std::numeric_limits<float>::min();
    const Lanes safe = square > kTiny ? square : Lanes{} + kTiny;
    float root[kColumnBlock];
    std::memcpy(root, &safe, sizeof(root));
    for (float& r : root) r = std::sqrt(r);
    load(root, result);
    result = 1 / result;
}

/// Unit vectors along u x v, 0 where that is 0. The tangents are the products of two tables and a
/// ring, and stay in registers.
AGLOW_INLINE void sum_normal_block(const float* u, const float* v, size_t stride, uint32_t rows,
                                   const float* ring, float* to) {
    Lanes ux = {}, uy = {}, uz = {}, vx = {}, vy = {}, vz = {};
    for (uint32_t r = 0; r < rows; ++r, u += stride, v += stride, ring += kChannels) {
        Lanes weight_u, weight_v;
        load(u, weight_u);
        load(v, weight_v);
        ux += weight_u * ring[0];
        uy += weight_u * ring[1];
        uz += weight_u * ring[2];
        vx += weight_v * ring[0];
        vy += weight_v * ring[1];
        vz += weight_v * ring[2];
    }
    const Lanes x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    const Lanes square = x * x + y * y + z * z;
    Lanes scale;
    inverse_root(square, scale);
    store_interleaved(x * scale, y * scale, z * scale, to);
}

AGLOW_TARGET_CLONES
void normal_range(const FaceTables& faces, const LimitWeights& limit, Channels points,
                  OutputChannels to, size_t begin, size_t end, Scratch& scratch) {
    float* ring = scratch.ring.data();
    float* sums = scratch.points.data()->weight;
    for (size_t i = begin; i < end; ++i) {
        const auto f = static_cast<uint32_t>(i);
        const uint32_t rows = faces.rows[faces.face_class[f]];
        const size_t table = faces.weight_begin[faces.face_class[f]];
        gather(ring_of(faces, f), points, ring);
        make_relative(ring, rows);
        for (uint32_t c = 0; c < faces.stride; c += kColumnBlock)
            sum_normal_block(limit.tangent_u.data()->weight + table + c,
                             limit.tangent_v.data()->weight + table + c, faces.stride, rows, ring,
                             sums + c * kChannels);
        write_owned(faces, faces.output[f], sums, to);
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
        sum_range(faces, faces.weights, points, to, begin, end, scratch);
    });
}

void sum_limits(const FaceTables& faces, const LimitWeights& limit, Channels points,
                std::span<vec3> positions, std::span<vec3> normals) {
    parallel_for(faces.face_count(), kFaceGrain, [&](size_t begin, size_t end) {
        Scratch scratch(faces);
        sum_range(faces, limit.position, points, {&positions.data()->x}, begin, end, scratch);
        normal_range(faces, limit, points, {&normals.data()->x}, begin, end, scratch);
    });
}

}  // namespace aglow::refine::cpu
