// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/unwrap.h"

#include "aglow/core/parallel.h"
#include "aglow/mesh/charts/apply.h"
#include "aglow/mesh/charts/file_uvs.h"
#include "aglow/mesh/charts/layout.h"
#include "aglow/mesh/charts/make_charts.h"
#include "aglow/mesh/charts/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>

namespace aglow {
namespace {

using mesh::Point2;

/// What the layout needs to know of one mesh that is placed in the scene.
struct PlacedMeshCharts {
    int mesh = 0;
    std::vector<size_t> placements;  ///< numbers among all placements
    size_t triangle_count = 0;
    std::optional<mesh::FileUvs> file_uvs;
    std::vector<mesh::Chart> charts;  ///< where there are no usable UVs in the file
    std::vector<double> scales;
    bool cancelled = false;
};

std::vector<PlacedMeshCharts> group_by_mesh(const Scene& scene,
                                            const std::vector<mesh::PlacedMesh>& placed) {
    std::vector<int> group_of(scene.meshes.size(), -1);
    std::vector<PlacedMeshCharts> groups;
    for (size_t p = 0; p < placed.size(); ++p) {
        int& group = group_of[static_cast<size_t>(placed[p].mesh)];
        if (group < 0) {
            group = static_cast<int>(groups.size());
            groups.emplace_back();
            groups.back().mesh = placed[p].mesh;
        }
        groups[static_cast<size_t>(group)].placements.push_back(p);
    }
    return groups;
}

void make_mesh_charts(const Scene& scene, const mesh::NodePoses& poses,
                      const std::vector<mesh::PlacedMesh>& placed, const Monitor& monitor,
                      PlacedMeshCharts& group) {
    std::vector<mesh::PlacedMesh> own;
    for (size_t p : group.placements) own.push_back(placed[p]);
    const mesh::MeshShape shape = mesh::mesh_shape(scene, poses, own);
    const mesh::Soup soup = mesh::make_soup(shape.positions, shape.triangles);
    group.scales = shape.scales;
    group.triangle_count = shape.triangles.size();
    group.file_uvs =
        mesh::valid_file_uvs(scene.meshes[static_cast<size_t>(group.mesh)], shape, soup);
    if (group.file_uvs) return;
    auto charts = mesh::make_charts(soup, monitor);
    group.cancelled = !charts;
    if (charts) group.charts = std::move(*charts);
}

mesh::LayoutGroup layout_group(const PlacedMeshCharts& group) {
    mesh::LayoutGroup layout;
    layout.scales = group.scales;
    if (group.file_uvs) {
        const mesh::FileUvs& uvs = *group.file_uvs;
        layout.may_turn = false;
        layout.boxes = {{(uvs.high.x - uvs.low.x) * uvs.meters_per_unit.x,
                         (uvs.high.y - uvs.low.y) * uvs.meters_per_unit.y}};
    }
    for (const mesh::Chart& chart : group.charts)
        layout.boxes.push_back({chart.width, chart.height});
    return layout;
}

vec2 to_vec2(Point2 p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

/// The affine map of file UVs that lays their box into `box` (texels).
void place_file_uvs(const mesh::FileUvs& uvs, const mesh::PlacedBox& box, Placement& placement) {
    const Point2 extent = uvs.high - uvs.low;
    const Point2 scale{extent.x > 0 ? box.size.x / extent.x : 0,
                       extent.y > 0 ? box.size.y / extent.y : 0};
    placement.scale = to_vec2(scale);
    placement.offset =
        to_vec2({box.corner.x - scale.x * uvs.low.x, box.corner.y - scale.y * uvs.low.y});
}

/// A block's chart (of file UVs) as placement `shown` shows it.
mesh::PlacedBox box_in_block(const mesh::PlacedBox& chart, Point2 block,
                             const mesh::PlacedBox& shown) {
    const Point2 ratio{shown.size.x / block.x, shown.size.y / block.y};
    return {{shown.corner.x + chart.corner.x * ratio.x, shown.corner.y + chart.corner.y * ratio.y},
            {chart.size.x * ratio.x, chart.size.y * ratio.y}};
}

/// Writes UVs of one mesh and its placements.
void apply(const PlacedMeshCharts& group, const mesh::Layout& layout,
           const mesh::GroupLayout& placed, Scene& scene, Atlas& atlas) {
    Mesh& mesh = scene.meshes[static_cast<size_t>(group.mesh)];
    const Point2 whole{double(layout.width), double(layout.height)};
    // The border's gutter is empty, and half a texel from the corner no look-up reaches a chart.
    const Point2 outside = placed.is_block ? Point2{0, 0} : Point2{0.25, 0.25};
    if (group.file_uvs) {
        atlas.origins[static_cast<size_t>(group.mesh)] = UvOrigin::file;
        for (Primitive& primitive : mesh.primitives)
            if (!primitive.triangles.empty()) primitive.lightmap_uvs = primitive.texcoords[1];
    } else {
        atlas.origins[static_cast<size_t>(group.mesh)] = UvOrigin::charts;
        mesh::apply_corner_uvs(mesh::corner_uvs(group.triangle_count, group.charts, placed.charts,
                                                placed.is_block ? placed.block : whole, outside),
                               mesh);
    }
    for (size_t i = 0; i < group.placements.size(); ++i) {
        Placement& placement = atlas.placements[group.placements[i]];
        if (placed.is_block && group.file_uvs) {
            place_file_uvs(*group.file_uvs,
                           box_in_block(placed.charts[0], placed.block, placed.placements[i]),
                           placement);
        } else if (group.file_uvs) {
            place_file_uvs(*group.file_uvs, placed.charts[0], placement);
        } else if (placed.is_block) {
            placement.scale = to_vec2(placed.placements[i].size);
            placement.offset = to_vec2(placed.placements[i].corner);
        } else {
            placement.scale = to_vec2(whole);
            placement.offset = {0, 0};
        }
    }
}

Result<mesh::Layout> layout_for_texel_size(const std::vector<mesh::LayoutGroup>& groups,
                                           const UnwrapOptions& options) {
    const int most = options.max_resolution;
    auto layout = mesh::smallest_layout(groups, double(options.texel_size), most, options.gutter);
    if (layout) return std::move(*layout);
    const auto finest = mesh::finest_layout(groups, {most, most, options.gutter});
    if (finest)
        return fail(Errc::bad_argument,
                    fmt::format("texels of {} m need an atlas larger than {} x {}; {:.3g} m would "
                                "fit",
                                options.texel_size, most, most, finest->texel.x));
    return fail(
        Errc::bad_argument,
        fmt::format("an atlas of {0} x {0} texels cannot hold one texel for every chart", most));
}

Result<mesh::Layout> layout_for_resolution(const std::vector<mesh::LayoutGroup>& groups,
                                           const UnwrapOptions& options) {
    // Every chart takes a texel and its gutter, however coarse the texels: many charts may need
    // more rows than the atlas is wide.
    for (int height = options.resolution;; height *= 2) {
        height = std::min(height, options.max_resolution);
        auto layout = mesh::finest_layout(groups, {options.resolution, height, options.gutter});
        if (layout) return std::move(*layout);
        if (height == options.max_resolution) break;
    }
    for (int larger = 2 * options.resolution; larger <= options.max_resolution; larger *= 2)
        if (mesh::finest_layout(groups, {larger, options.max_resolution, options.gutter}))
            return fail(Errc::bad_argument,
                        fmt::format("an atlas {} texels wide cannot hold one texel for every "
                                    "chart; a resolution of {} would do",
                                    options.resolution, larger));
    return fail(Errc::bad_argument,
                fmt::format("an atlas of {0} x {0} texels cannot hold one texel for every chart",
                            options.max_resolution));
}

Result<mesh::Layout> choose_layout(const std::vector<mesh::LayoutGroup>& groups,
                                   const UnwrapOptions& options) {
    return options.texel_size > 0 ? layout_for_texel_size(groups, options)
                                  : layout_for_resolution(groups, options);
}

Status check_options(const UnwrapOptions& options) {
    if (!(options.texel_size >= 0) || !std::isfinite(options.texel_size))
        return fail(Errc::bad_argument, "texel size must be a positive length");
    if (options.gutter < 0) return fail(Errc::bad_argument, "gutter must not be negative");
    const int least = 2 * options.gutter + 1;
    if (options.max_resolution < least || options.max_resolution > 32768)
        return fail(Errc::bad_argument,
                    fmt::format("largest atlas size must be {} to 32768 texels", least));
    if (options.texel_size == 0 &&
        (options.resolution < least || options.resolution > options.max_resolution))
        return fail(Errc::bad_argument, fmt::format("resolution must be {} to {} texels", least,
                                                    options.max_resolution));
    return {};
}

Result<Atlas> unwrap_checked(Scene& scene, const UnwrapOptions& options, const Monitor& monitor) {
    const mesh::NodePoses poses = mesh::node_poses(scene, -1);
    const std::vector<mesh::PlacedMesh> placed = mesh::placed_meshes(scene);
    std::vector<PlacedMeshCharts> groups = group_by_mesh(scene, placed);
    std::atomic<size_t> done = 0;
    parallel_for(groups.size(), 1, [&](size_t begin, size_t end) {
        for (size_t g = begin; g < end; ++g) {
            make_mesh_charts(scene, poses, placed, monitor, groups[g]);
            monitor("unwrap", 0.8 * double(++done) / double(groups.size()));
        }
    });
    std::vector<mesh::LayoutGroup> layout_groups;
    for (const PlacedMeshCharts& group : groups) {
        if (group.cancelled) return fail(Errc::cancelled, "stopped while making charts");
        layout_groups.push_back(layout_group(group));
    }
    AG_TRY(const mesh::Layout layout, choose_layout(layout_groups, options));

    Atlas atlas;
    atlas.width = layout.width;
    atlas.height = layout.height;
    atlas.texel_size = static_cast<float>(std::max(layout.texel.x, layout.texel.y));
    atlas.origins.assign(scene.meshes.size(), UvOrigin::file);
    for (const mesh::PlacedMesh& p : placed)
        atlas.placements.push_back({p.node, p.instance, p.mesh, {0, 0}, {0, 0}});
    for (size_t g = 0; g < groups.size(); ++g) {
        apply(groups[g], layout, layout.groups[g], scene, atlas);
        atlas.chart_count += groups[g].file_uvs ? groups[g].file_uvs->chart_count
                                                : static_cast<int>(groups[g].charts.size());
    }
    monitor("unwrap", 1);
    return atlas;
}

}  // namespace

Result<Atlas> unwrap(Scene& scene, const UnwrapOptions& options, const Monitor& monitor) {
    AG_CHECK(check_options(options));
    try {
        return unwrap_checked(scene, options, monitor);
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "memory ran out while making charts");
    }
}

}  // namespace aglow
