// SPDX-License-Identifier: Apache-2.0
// Clusters stretches of leaves from the lowest up: see shared/bvh_build.h. One group has one
// stretch at a time; of two that meet, the last to finish goes on with both, so no group ever
// waits. What is merged with what does not depend on which that is.
//
// A group is one subgroup, whatever its size, and keeps its clusters in registers: cluster i is in
// invocation i mod size. They are looked up by shuffles alone, without shared memory and barriers,
// whose loads lavapipe makes one by one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_build.glsl"

layout(local_size_x_id = 0) in;  // the subgroup's size
const uint kLanes = gl_WorkGroupSize.x;
const uint kRows = (kMergeCount + kLanes - 1u) / kLanes;
const uint kMostRows = 8u;  // subgroups have 4 invocations at least
#define AG_EACH_ROW(r) [[unroll]] for (uint r = 0u; r < kRows; ++r)

struct Member {
    Bounds box;
    Cluster cluster;
};

Member members[kMostRows];
uint nearest[kMostRows];  // merge_key() of a member with its nearest neighbour

CoherentRows nodes = CoherentRows(args.nodes);
CoherentWords clusters = CoherentWords(args.clusters);

uint index_in(uint row) { return row * kLanes + gl_LocalInvocationID.x; }

Member shuffled(Member m, uint lane) {
    m.box.lower = subgroupShuffle(m.box.lower, lane);
    m.box.upper = subgroupShuffle(m.box.upper, lane);
    m.cluster.node = subgroupShuffle(m.cluster.node, lane);
    m.cluster.place = subgroupShuffle(m.cluster.place, lane);
    return m;
}

// Member i, which is in row `first` or one of those up to `last`. Rows are constants once loops are
// unrolled.
Member member_at(uint i, uint first, uint last) {
    uint lane = i % kLanes;
    Member found = shuffled(members[first], lane);
    AG_EACH_ROW(r) {
        if (r > first && r <= last) {
            Member other = shuffled(members[r], lane);
            if (i / kLanes == r) found = other;
        }
    }
    return found;
}

uint nearest_at(uint i, uint first, uint last) {
    uint lane = i % kLanes;
    uint found = subgroupShuffle(nearest[first], lane);
    AG_EACH_ROW(r) {
        if (r > first && r <= last) {
            uint other = subgroupShuffle(nearest[r], lane);
            found = i / kLanes == r ? other : found;
        }
    }
    return found;
}

// Rows in which the neighbours of a row's members are: no subgroup is smaller than kMergeRadius.
uint row_before(uint r) { return r == 0u ? 0u : r - 1u; }
uint row_after(uint r) { return r + 1u == kRows ? r : r + 1u; }

// Where the n-th bit is that is set.
uint place_of_bit(uint bits, uint n) {
    uint place = 0u;
    [[unroll]] for (uint width = 16u; width > 0u; width /= 2u) {
        uint below = uint(bitCount((bits >> place) & ((1u << width) - 1u)));
        bool is_above = n >= below;
        n -= is_above ? below : 0u;
        place += is_above ? width : 0u;
    }
    return place;
}

// Moves those that stay to the front, in order, and returns how many there are.
uint gather(bool stays[kMostRows]) {
    uint bits = 0u;
    AG_EACH_ROW(r) bits |= subgroupBallot(stays[r]).x << (r * kLanes);
    AG_EACH_ROW(r) members[r] = member_at(place_of_bit(bits, index_in(r)), r, kRows - 1u);
    return uint(bitCount(bits));
}

Cluster cluster_of(uint64_t word) {
    uvec2 parts = unpackUint2x32(word);
    return Cluster(parts.x, parts.y);
}

// The k-th cluster of a finished stretch; node = kNoNode if it has fewer.
Cluster finished_cluster(uint first, uint last, uint k) {
    uint size = last - first + 1u;
    Cluster cluster = Cluster(args.triangle_count + first + k, first + k);
    if (k >= min(size, args.merge_keep)) {
        cluster.node = kNoNode;
    } else if (size > args.merge_keep) {
        cluster = cluster_of(clusters.at[first + k]);
    }
    return cluster;
}

// Brings the clusters of both parts of a stretch together, those of the first part in front.
uint load(Stretch stretch) {
    const uint half_count = kMergeCount / 2u;
    bool exists[kMostRows];
    AG_EACH_ROW(r) {
        uint i = index_in(r);
        bool in_first = i < half_count;
        Cluster cluster = finished_cluster(in_first ? stretch.first : stretch.split + 1u,
                                           in_first ? stretch.split : stretch.last,
                                           in_first ? i : i - half_count);
        exists[r] = cluster.node != kNoNode;
        uint row = 2u * (exists[r] ? cluster.node : args.triangle_count);
        members[r].box = box_of_rows(row_words(nodes.at[row]), unpackUint2x32(nodes.at[row + 1u].x));
        members[r].cluster = cluster;
    }
    return gather(exists);
}

// Each pair is looked at by its first member, which tells the second.
void find_neighbours(uint count) {
    AG_EACH_ROW(r) nearest[r] = kNoNode;
    [[unroll]] for (uint d = 1u; d <= kMergeRadius; ++d) {
        uint keys[kMostRows];
        AG_EACH_ROW(r) {
            uint i = index_in(r);
            Bounds other = member_at(i + d, r, row_after(r)).box;
            keys[r] = i + d < count ? merge_key(members[r].box, other, i, i + d) : kNoNode;
        }
        AG_EACH_ROW(r) {
            uint i = index_in(r);
            uint lane = (i - d) % kLanes;
            uint told = subgroupShuffle(keys[r], lane);
            uint told_before = subgroupShuffle(keys[row_before(r)], lane);
            if ((i - d) / kLanes != r) told = i >= d ? told_before : kNoNode;
            nearest[r] = min(nearest[r], min(keys[r], told));
        }
    }
}

// Merges all pairs that are each other's nearest, and returns how many clusters remain.
uint merge(uint count) {
    bool stays[kMostRows];
    Member merged[kMostRows];
    AG_EACH_ROW(r) {
        uint i = index_in(r);
        bool exists = i < count;
        uint j = exists ? i ^ (nearest[r] & (kMergeCount - 1u)) : i;
        bool pairs = nearest_at(j, row_before(r), row_after(r)) == nearest[r] && exists;
        Member partner = member_at(j, r, row_after(r));
        merged[r] = members[r];
        stays[r] = exists && !(pairs && j < i);
        if (pairs && i < j) {
            Bounds box = united(members[r].box, partner.box);
            uint first = members[r].cluster.node;
            uint made = partner.cluster.place - 1u;
            nodes.at[2u * made] = row_of(floatBitsToUint(vec4(box.lower, box.upper.x)));
            nodes.at[2u * made + 1u] =
                row_of(uvec4(floatBitsToUint(box.upper.yz), first, partner.cluster.node));
            args.parents.at[first] = made;
            args.parents.at[partner.cluster.node] = made | kRightChild;
            merged[r].box = box;
            merged[r].cluster.node = made;
        }
    }
    members = merged;
    return gather(stays);
}

// Leaves the clusters for the stretch above. The place for them is the stretch's own.
void store(Stretch stretch, uint count) {
    AG_EACH_ROW(r) {
        uint i = index_in(r);
        Cluster cluster = members[r].cluster;
        if (i >= count) cluster.node = kNoNode;
        if (i < args.merge_keep)
            clusters.at[stretch.first + i] = packUint2x32(uvec2(cluster.node, cluster.place));
    }
    memoryBarrierBuffer();
    barrier();
}

void main() {
    if (group_index() >= args.counters.at[0].stretch_count) return;
    Stretch stretch = args.stretches.at[group_index()];
    uint leaf_count = args.counters.at[0].usable_count;
    bool is_leader = gl_LocalInvocationID.x == 0u;

    while (true) {
        bool is_all = stretch.last - stretch.first + 1u == leaf_count;
        uint count = load(stretch);
        uint keep = is_all ? 1u : args.merge_keep;
        while (count > keep) {
            find_neighbours(count);
            count = merge(count);
        }
        if (is_all) break;

        store(stretch, count);
        uint split = joint(stretch.first, stretch.last, leaf_count);
        bool is_first = split == stretch.last;
        uint other = 0u;
        if (is_leader) {
            other = atomicExchange(args.arrivals.at[split],
                                   is_first ? stretch.first : stretch.last);
        }
        other = subgroupShuffle(other, 0u);
        if (other == kNoNode) return;
        memoryBarrierBuffer();
        stretch.split = split;
        if (is_first) {
            stretch.last = other;
        } else {
            stretch.first = other;
        }
    }
    if (is_leader) {
        uint root = members[0].cluster.node;
        args.counters.at[0].root = root;
        args.parents.at[root] = kNoNode;
    }
}
