// SPDX-License-Identifier: Apache-2.0
// Clusters stretches of leaves from the lowest up: see shared/bvh_build.h. One group has one
// stretch at a time; of two that meet, the last to finish goes on with both, so no group ever
// waits. What is merged with what does not depend on which that is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"
#include "aglow/accel/gpu/bvh/bvh_build.glsl"

layout(local_size_x = kMergeGroupSize) in;

shared Bounds boxes[kMergeGroupSize];
shared Cluster members[kMergeGroupSize];
shared uint best[kMergeGroupSize];  // merge_key() of a cluster with its nearest neighbour
shared uint survivors;              // one bit for each cluster that stays
shared uint sibling;

CoherentNodes nodes = CoherentNodes(args.nodes);
CoherentClusters clusters = CoherentClusters(args.clusters);

// The k-th cluster of a finished stretch; node = kNoNode if it has fewer.
Cluster finished_cluster(uint first, uint last, uint k) {
    uint size = last - first + 1u;
    Cluster cluster;
    cluster.node = k < min(size, args.merge_keep) ? args.triangle_count + first + k : kNoNode;
    cluster.place = first + k;
    if (size > args.merge_keep && k < args.merge_keep) cluster = clusters.at[first + k];
    return cluster;
}

// Moves the clusters that stay to the front, in order, and returns how many there are.
uint gather(bool stays, Cluster cluster, Bounds box) {
    uint i = gl_LocalInvocationID.x;
    if (stays) atomicOr(survivors, 1u << i);
    barrier();
    uint mask = survivors;
    if (stays) {
        uint to = uint(bitCount(mask & ((1u << i) - 1u)));
        members[to] = cluster;
        boxes[to] = box;
    }
    barrier();
    if (i == 0u) survivors = 0u;
    best[i] = kNoNode;
    barrier();
    return uint(bitCount(mask));
}

// Brings the clusters of both parts of a stretch together, those of the first part in front.
uint load(Stretch stretch) {
    uint i = gl_LocalInvocationID.x;
    const uint half_size = kMergeGroupSize / 2u;
    bool in_first = i < half_size;
    Cluster cluster = finished_cluster(in_first ? stretch.first : stretch.split + 1u,
                                       in_first ? stretch.split : stretch.last,
                                       in_first ? i : i - half_size);
    bool exists = cluster.node != kNoNode;
    Bounds box = nodes.at[exists ? cluster.node : args.triangle_count].box;
    return gather(exists, cluster, box);
}

void find_neighbours(uint count) {
    uint i = gl_LocalInvocationID.x;
    if (i < count) {
        Bounds box = boxes[i];
        uint nearest = kNoNode;
        uint end = min(count, i + kMergeRadius + 1u);
        for (uint j = i + 1u; j < end; ++j) {
            uint key = merge_key(box, boxes[j], i, j);
            nearest = min(nearest, key);
            atomicMin(best[j], key);
        }
        atomicMin(best[i], nearest);
    }
    barrier();
}

// Merges all pairs that are each other's nearest, and returns how many clusters remain.
uint merge(uint count) {
    uint i = gl_LocalInvocationID.x;
    bool exists = i < count;
    uint key = best[i];
    uint j = exists ? i ^ (key & (kMergeGroupSize - 1u)) : i;
    bool pairs = exists && best[j] == key;
    Cluster cluster = members[i];
    Bounds box = boxes[i];
    if (pairs && i < j) {
        Cluster partner = members[j];
        box = united(box, boxes[j]);
        uint made = partner.place - 1u;
        BinaryNode node;
        node.box = box;
        node.left = cluster.node;
        node.right = partner.node;
        nodes.at[made] = node;
        args.parents.at[cluster.node] = made;
        args.parents.at[partner.node] = made | kRightChild;
        cluster.node = made;
    }
    barrier();
    return gather(exists && !(pairs && j < i), cluster, box);
}

// Leaves the clusters for the stretch above. The place for them is the stretch's own.
void store(Stretch stretch, uint count) {
    uint i = gl_LocalInvocationID.x;
    if (i < args.merge_keep) {
        Cluster cluster = members[i];
        if (i >= count) cluster.node = kNoNode;
        clusters.at[stretch.first + i] = cluster;
    }
    memoryBarrierBuffer();
    barrier();
}

void main() {
    if (group_index() >= args.counters.at[0].stretch_count) return;
    Stretch stretch = args.stretches.at[group_index()];
    uint leaf_count = args.counters.at[0].usable_count;
    uint i = gl_LocalInvocationID.x;
    if (i == 0u) survivors = 0u;
    barrier();

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
        if (i == 0u) {
            sibling = atomicExchange(args.arrivals.at[split],
                                     is_first ? stretch.first : stretch.last);
        }
        barrier();
        uint other = sibling;
        if (other == kNoNode) return;
        memoryBarrierBuffer();
        stretch.split = split;
        if (is_first) {
            stretch.last = other;
        } else {
            stretch.first = other;
        }
    }
    if (i == 0u) {
        args.counters.at[0].root = members[0].node;
        args.parents.at[members[0].node] = kNoNode;
    }
}
