// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/fair/coarse_surface.h"

#include "aglow/core/assert.h"
#include "aglow/mesh/simplify.h"
#include "aglow/mesh/unwrap.h"
#include "aglow/refine/tessellation.h"

#include <cmath>
#include <numeric>

namespace aglow::bake::fair {
namespace {

constexpr int kGutter = 4;  // texels between charts: two for each

/// The mesh alone, with nothing that unwrapping could take for coordinates of its own.
Scene lone_mesh(const Mesh& mesh) {
    Scene scene;
    Mesh bare = mesh;
    for (Primitive& primitive : bare.primitives) {
        primitive.material = -1;
        primitive.texcoords.clear();
        primitive.source_vertex.clear();
    }
    scene.meshes.push_back(std::move(bare));
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

/// Splits vertices along the borders of charts, and adds a set of coordinates.
Result<Atlas> add_uvs(Mesh& mesh, int map_size) {
    Scene scene = lone_mesh(mesh);
    UnwrapOptions options;
    options.resolution = map_size;
    options.gutter = kGutter;
    AG_TRY(Atlas atlas, unwrap(scene, options));
    const Placement& place = atlas.placements.front();
    const vec2 texel = {1 / static_cast<float>(atlas.width), 1 / static_cast<float>(atlas.height)};
    for (size_t p = 0; p < mesh.primitives.size(); ++p) {
        const Primitive& split = scene.meshes[0].primitives[p];
        std::vector<uint32_t> sources = split.source_vertex;
        if (sources.empty()) {
            sources.resize(split.positions.size());
            std::iota(sources.begin(), sources.end(), 0u);
        }
        Primitive primitive = copied_vertices(mesh.primitives[p], sources);
        primitive.triangles = split.triangles;
        std::vector<vec2> uvs;
        for (const vec2 uv : split.lightmap_uvs)
            uvs.push_back((place.offset + place.scale * uv) * texel);
        primitive.texcoords.push_back(std::move(uvs));
        mesh.primitives[p] = std::move(primitive);
    }
    return atlas;
}

/// Along u on the surface of a triangle, weighted by its area; and likewise against v, which runs
/// down in an image where a normal map's second axis runs up.
struct Axes {
    vec3 u = {0, 0, 0}, up = {0, 0, 0};
};

Axes axes_of(const Primitive& primitive, const std::vector<vec2>& uvs, uvec3 t) {
    const vec3 ab = primitive.positions[t.y] - primitive.positions[t.x];
    const vec3 ac = primitive.positions[t.z] - primitive.positions[t.x];
    const vec2 b = uvs[t.y] - uvs[t.x], c = uvs[t.z] - uvs[t.x];
    const float sign = b.x * c.y - b.y * c.x < 0 ? -1.0f : 1.0f;
    return {(ab * c.y - ac * b.y) * sign, (ab * c.x - ac * b.x) * sign};
}

/// Some unit vector across n.
vec3 across(vec3 n) { return Frame(n).tangent; }

void set_tangents(Primitive& primitive) {
    const std::vector<vec2>& uvs = primitive.texcoords.back();
    std::vector<Axes> sums(primitive.positions.size());
    for (const uvec3 t : primitive.triangles) {
        const Axes axes = axes_of(primitive, uvs, t);
        for (const uint32_t v : {t.x, t.y, t.z}) {
            sums[v].u += axes.u;
            sums[v].up += axes.up;
        }
    }
    primitive.tangents.clear();
    for (size_t v = 0; v < sums.size(); ++v) {
        const vec3 n = primitive.normals[v];
        const vec3 along = sums[v].u - n * dot(n, sums[v].u);
        const float size = length(along);
        const vec3 t = size > 0 ? along / size : across(n);
        const float hand = dot(cross(n, t), sums[v].up) < 0 ? -1.0f : 1.0f;
        primitive.tangents.push_back({t.x, t.y, t.z, hand});
    }
}

}  // namespace

Result<CoarseSurface> make_coarse_surface(Mesh& mesh, int map_size, int& width, int& height) {
    AG_TRY(const Atlas atlas, add_uvs(mesh, map_size));
    width = atlas.width;
    height = atlas.height;
    CoarseSurface surface;
    AG_TRY(surface.control, make_control_mesh(mesh));
    const Topology& topology = surface.control.topology;
    surface.normals = corner_normals(topology, surface.control.positions);
    surface.directions.assign(topology.vertex_count(), {0, 0, 0});
    for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
        const VertexOf at = surface.control.corners[h];
        Primitive& primitive = mesh.primitives[at.primitive];
        if (length(surface.normals[h]) > 0.5f) primitive.normals[at.vertex] = surface.normals[h];
        surface.directions[topology.vertex[h]] += surface.normals[h];
    }
    for (vec3& d : surface.directions) d = shared::unit_or(d, d);
    for (Primitive& primitive : mesh.primitives) set_tangents(primitive);
    for (const VertexOf at : surface.control.corners) {
        surface.uvs.push_back(mesh.primitives[at.primitive].texcoords.back()[at.vertex]);
        surface.tangents.push_back(mesh.primitives[at.primitive].tangents[at.vertex]);
    }
    return surface;
}

Result<RefinedSurface> displaced(const CoarseSurface& surface, const HeightMap& heights,
                                 int level) {
    const Topology& topology = surface.control.topology;
    AG_TRY(const Patches patches, Patches::create(topology, kSurface));
    AG_TRY(Tessellation tessellation, Tessellation::uniform(topology, 1 << level));
    PatchControl control;
    patches.update({surface.control.positions, surface.normals}, control);
    DisplacementMap map;
    map.settings.kind = shared::kHeightMapDisplacement;
    map.settings.amplitude = 1;
    map.map = heights;
    map.uvs = surface.uvs;
    RefinedSurface refined;
    refined.positions.resize(tessellation.vertex_count());
    patches.evaluate(control, tessellation, map, refined.positions, {});
    refined.triangles = std::move(tessellation.triangles);
    return refined;
}

}  // namespace aglow::bake::fair
