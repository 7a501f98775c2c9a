// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/gpu/raster/corner_normals.h"

#include "aglow/refine/creases.h"
#include "aglow/render/gpu/raster/corner_normals.comp.h"

#include <algorithm>
#include <span>
#include <utility>

namespace aglow::render::gpu {
namespace {

/// Push constants of corner_normals.comp.
struct CornerNormalArgs {
    uint32_t first_group = 0;
    uint32_t count = 0;
    uint64_t positions = 0, normals = 0, source = 0, begin = 0, wedges = 0, to = 0;
};

/// The arrays of corner_normals.comp.
struct NormalTable {
    std::vector<uint32_t> number;  // [half-edge]
    std::vector<uint32_t> source, begin = {0};
    std::vector<uvec3> wedges;
};

/// [half-edge] Corners with one number share a smooth normal.
Result<std::vector<uint32_t>> smooth_groups(const Topology& topology) {
    AG_TRY(CreaseSides sides, crease_sides(topology));
    if (sides.empty()) return topology.vertex;
    return std::move(sides.mesh.vertex);
}

/// [group + 1] where its members begin, and these.
std::pair<std::vector<uint32_t>, std::vector<uint32_t>> members_of(
    const std::vector<uint32_t>& group) {
    std::vector<uint32_t> begin = {0};
    for (const uint32_t g : group) {
        if (g + 2 > begin.size()) begin.resize(g + 2, 0);
        ++begin[g + 1];
    }
    for (size_t g = 1; g < begin.size(); ++g) begin[g] += begin[g - 1];
    std::vector<uint32_t> next = begin, members(group.size());
    for (uint32_t h = 0; h < group.size(); ++h) members[next[group[h]]++] = h;
    return {std::move(begin), std::move(members)};
}

Result<NormalTable> normal_table(const ControlScene& control) {
    const Topology& topology = control.topology;
    AG_TRY(const auto groups, smooth_groups(topology));
    const auto [begin, members] = members_of(groups);
    NormalTable table;
    table.number.resize(topology.half_edge_count());
    const auto add = [&](uint32_t source) {
        table.source.push_back(source);
        table.begin.push_back(static_cast<uint32_t>(table.wedges.size()));
        return static_cast<uint32_t>(table.source.size() - 1);
    };
    for (uint32_t h = 0; h < topology.half_edge_count(); ++h)
        if (!control.lacks_normals[topology.face[h]])
            table.number[h] = add(control.corner_source[h]);
    const auto& corner = control.corner_source;
    for (size_t g = 0; g + 1 < begin.size(); ++g) {
        const std::span group(members.data() + begin[g], begin[g + 1] - begin[g]);
        if (group.empty() || !control.lacks_normals[topology.face[group[0]]]) continue;
        for (const uint32_t h : group)
            table.wedges.push_back(
                {corner[h], corner[topology.next(h)], corner[topology.previous(h)]});
        const uint32_t number = add(corner[group[0]]);
        for (const uint32_t h : group) table.number[h] = number;
    }
    return table;
}

}  // namespace

Result<CornerNormals> CornerNormals::create(vk::Stream& stream, const ControlScene& control) {
    CornerNormals made;
    if (std::ranges::find(control.lacks_normals, true) == control.lacks_normals.end()) {
        made.number_ = control.corner_source;
        return made;
    }
    AG_TRY(NormalTable table, normal_table(control));
    AG_TRY(made.kernel_,
           vk::Kernel::create(stream.gpu(), "corner normals", shaders::corner_normals_comp));
    made.count_ = static_cast<uint32_t>(table.source.size());
    made.number_ = std::move(table.number);
    const auto put = [&](const auto& values, const char* name) {
        return vk::make_buffer_of(stream, std::span(values.data(), values.size()), name);
    };
    AG_TRY(made.source_, put(table.source, "normals of corners"));
    AG_TRY(made.begin_, put(table.begin, "normals of corners"));
    AG_TRY(made.wedges_, put(table.wedges, "faces round vertices"));
    AG_TRY(made.normals_, stream.make_buffer(made.count_ * sizeof(vec3), "normals of corners"));
    return made;
}

uint64_t CornerNormals::update(vk::Stream& stream, uint64_t positions, uint64_t normals) const {
    if (!kernel_) return normals;
    stream.run(*kernel_,
               CornerNormalArgs{0, count_, positions, normals, source_.address(), begin_.address(),
                                wedges_.address(), normals_.address()},
               vk::group_count(count_, 64));
    stream.barrier();
    return normals_.address();
}

}  // namespace aglow::render::gpu
