// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/motion_groups.h"

#include <algorithm>
#include <map>
#include <utility>

namespace aglow::render::gpu {
namespace {

using accel::gpu::Motion;
using mesh::gpu::PartMotion;

struct Members {
    Motion motion = Motion::still;
    std::vector<uint32_t> parts;
    uint64_t triangles = 0;

    void add(uint32_t index, const SurfacePart& part) {
        parts.push_back(index);
        triangles += part.triangle_count;
    }
};

/// One for what stands still, one for what deforms, and one for each body: parts of one placement
/// of a mesh.
std::vector<Members> members_of(const Surfaces& surfaces, std::span<const PartMotion> motions,
                                size_t most_bodies) {
    std::vector<Members> groups{{Motion::still, {}, 0}, {Motion::deforming, {}, 0}};
    std::map<std::pair<int, int>, Members> bodies;
    for (uint32_t i = 0; i < surfaces.parts.size(); ++i) {
        const SurfacePart& part = surfaces.parts[i];
        if (motions[i] == PartMotion::still) groups[0].add(i, part);
        if (motions[i] == PartMotion::deforming) groups[1].add(i, part);
        if (motions[i] == PartMotion::rigid) bodies[{part.node, part.instance}].add(i, part);
    }
    std::vector<Members> largest_first;
    for (auto& [placement, body] : bodies) largest_first.push_back(std::move(body));
    std::stable_sort(largest_first.begin(), largest_first.end(),
                     [](const Members& a, const Members& b) { return a.triangles > b.triangles; });
    for (size_t i = 0; i < largest_first.size(); ++i) {
        Members& body = largest_first[i];
        body.motion = Motion::rigid;
        if (i < most_bodies)
            groups.push_back(std::move(body));
        else
            for (const uint32_t part : body.parts) groups[1].add(part, surfaces.parts[part]);
    }
    return groups;
}

}  // namespace

std::vector<uint32_t> MotionGroups::place_of() const {
    std::vector<uint32_t> places(source_of.size());
    for (uint32_t i = 0; i < source_of.size(); ++i) places[source_of[i]] = i;
    return places;
}

MotionGroups motion_groups(Surfaces surfaces, std::span<const PartMotion> motions,
                           size_t most_bodies) {
    MotionGroups result;
    const std::vector<Members> all = members_of(surfaces, motions, most_bodies);
    const std::vector<uvec3> triangles = surfaces.triangles;
    for (const Members& members : all) {
        if (members.triangles == 0) continue;
        result.part_of.push_back(members.parts.front());
        result.groups.push_back({static_cast<uint32_t>(result.source_of.size()),
                                 static_cast<uint32_t>(members.triangles), members.motion});
        for (const uint32_t index : members.parts) {
            SurfacePart& part = surfaces.parts[index];
            const uint32_t first = part.first_triangle;
            part.first_triangle = static_cast<uint32_t>(result.source_of.size());
            for (uint32_t t = 0; t < part.triangle_count; ++t) {
                surfaces.triangles[result.source_of.size()] = triangles[first + t];
                surfaces.part_of[result.source_of.size()] = index;
                result.source_of.push_back(first + t);
            }
        }
    }
    result.surfaces = std::move(surfaces);
    return result;
}

}  // namespace aglow::render::gpu
