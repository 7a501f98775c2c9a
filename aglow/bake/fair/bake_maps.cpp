// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/fair/bake_maps.h"

#include "aglow/accel/ray_scene.h"
#include "aglow/bake/fair/chart_texels.h"
#include "aglow/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace aglow::bake::fair {
namespace {

constexpr float kGutter = 3;       // texels that a bilinear look-up past a chart's border can meet
constexpr int kMostLayers = 16;    // of backs that a line passes before it gives up
constexpr size_t kRowsAtOnce = 4;  // some ms of rays
constexpr int kFillRings = 32;     // texels without a height are filled so far in

constexpr float kMissed = std::numeric_limits<float>::quiet_NaN();

/// The dense mesh as it stands, opaque.
Scene dense_scene(const Mesh& mesh) {
    Scene scene;
    scene.meshes.push_back(mesh);
    for (Primitive& primitive : scene.meshes[0].primitives) primitive.material = -1;
    Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    return scene;
}

/// A place of the coarse surface, with the axes of its normal map.
struct Place {
    vec3 position, normal, tangent;
    float hand = 1;
};

struct Found {
    float height = kMissed;
    vec3 normal = {0, 0, 0};
};

class Baker {
public:
    Baker(const CoarseSurface& coarse, const Surfaces& surfaces, const RayScene& rays, float reach)
        : coarse_(coarse), surfaces_(surfaces), rays_(rays), reach_(reach) {}

    Found find(const Place& place) const {
        const Found above = along(place, 1), below = along(place, -1);
        if (std::isnan(below.height)) return above;
        if (std::isnan(above.height)) return below;
        return std::abs(above.height) <= std::abs(below.height) ? above : below;
    }

    Place place(const ChartTexel& texel) const {
        const Topology& t = coarse_.control.topology;
        const uint32_t h = t.face_begin[texel.triangle];
        const float x = texel.barycentrics.x, y = texel.barycentrics.y;
        const auto blend = [&](auto at) {
            return at(h) * (1 - x - y) + at(h + 1) * x + at(h + 2) * y;
        };
        Place p;
        p.position = blend([&](uint32_t c) { return coarse_.control.positions[t.vertex[c]]; });
        p.normal = blend([&](uint32_t c) { return coarse_.directions[t.vertex[c]]; });
        p.normal = shared::unit_or(p.normal, coarse_.directions[t.vertex[h]]);
        const vec4 tangent = blend([&](uint32_t c) { return coarse_.tangents[c]; });
        p.tangent = shared::unit_or(vec3{tangent.x, tangent.y, tangent.z}, {1, 0, 0});
        p.hand = coarse_.tangents[h].w;
        return p;
    }

private:
    /// The first front met on the normal's side (`side` 1) or on the other (-1).
    Found along(const Place& place, float side) const {
        const vec3 p = place.position;
        const float gap =
            2 * clearance(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), reach_}));
        const vec3 direction = place.normal * side;
        float walked = -gap;  // begins behind the place, which may lie on the dense surface
        for (int layer = 0; layer < kMostLayers; ++layer) {
            const auto hit = rays_.intersect({p + direction * walked, direction, reach_ - walked});
            if (!hit) return {};
            walked += hit->distance;
            // A front faces the normal's way: a line along the normal leaves through it.
            if (hit->front == (side < 0))
                return {side * walked, shading_normal(surfaces_, hit->at)};
            walked += gap;
        }
        return {};
    }

    const CoarseSurface& coarse_;
    const Surfaces& surfaces_;
    const RayScene& rays_;
    float reach_;
};

/// Coordinates of n by the axes that a renderer makes of the place: tangent, bitangent and normal,
/// the first and the last not quite at right angles.
vec3 in_tangent_space(const Place& place, vec3 n) {
    const vec3 up = cross(place.normal, place.tangent) * place.hand;
    const float c = dot(place.tangent, place.normal), square = std::max(1 - c * c, 1e-6f);
    const float a = dot(n, place.tangent), b = dot(n, place.normal);
    const vec3 local = {(a - c * b) / square, dot(n, up) / square, (b - c * a) / square};
    return shared::unit_or(local, {0, 0, 1});
}

void store_normal(vec3 n, uint8_t* rgb) {
    size_t i = 0;
    for (const float x : {n.x, n.y, n.z})
        rgb[i++] = static_cast<uint8_t>(std::lround(127.5f + 127.5f * std::clamp(x, -1.0f, 1.0f)));
}

/// Gives texels without a height the mean of neighbours that have one, ring by ring; what is left
/// after `rings` gets 0.
void fill(std::vector<float>& heights, int width, int height, int rings) {
    const auto columns = static_cast<size_t>(width);
    for (int ring = 0; ring < rings; ++ring) {
        const std::vector<float> before = heights;
        bool any = false;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                float& h = heights[static_cast<size_t>(y) * columns + static_cast<size_t>(x)];
                if (!std::isnan(h)) continue;
                float sum = 0, count = 0;
                for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
                    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) {
                        const float other =
                            before[static_cast<size_t>(j) * columns + static_cast<size_t>(i)];
                        if (std::isnan(other)) continue;
                        sum += other;
                        count += 1;
                    }
                if (count == 0) continue;
                h = sum / count;
                any = true;
            }
        if (!any) break;
    }
    for (float& h : heights)
        if (std::isnan(h)) h = 0;
}

std::vector<ChartTriangle> chart_triangles(const CoarseSurface& coarse, int width, int height) {
    const vec2 size = {static_cast<float>(width), static_cast<float>(height)};
    std::vector<ChartTriangle> triangles;
    for (uint32_t f = 0; f < coarse.control.topology.face_count(); ++f) {
        const uint32_t h = coarse.control.topology.face_begin[f];
        triangles.push_back(
            {coarse.uvs[h] * size, coarse.uvs[h + 1] * size, coarse.uvs[h + 2] * size});
    }
    return triangles;
}

}  // namespace

Result<Maps> bake_maps(const CoarseSurface& coarse, const Mesh& dense, int width, int height,
                       float reach, const Monitor& monitor) {
    const Scene scene = dense_scene(dense);
    const Surfaces surfaces = pose(scene);
    AG_TRY(const RayScene rays, RayScene::create(scene, surfaces));
    const Baker baker(coarse, surfaces, rays, reach);
    const std::vector<ChartTexel> texels =
        chart_texels(chart_triangles(coarse, width, height), width, height, kGutter);
    Maps maps;
    maps.heights.assign(texels.size(), kMissed);
    maps.normals.assign(3 * texels.size(), 0);
    const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
    std::atomic<size_t> missed = 0, inside = 0, done = 0;
    parallel_for(rows, kRowsAtOnce, [&](size_t begin, size_t end) {
        if (monitor.cancelled()) return;
        for (size_t i = begin * columns; i < end * columns; ++i) {
            Found found;
            Place place;
            if (texels[i].triangle != UINT32_MAX) {
                place = baker.place(texels[i]);
                found = baker.find(place);
            }
            maps.heights[i] = found.height;
            if (texels[i].inside) {
                ++inside;
                if (std::isnan(found.height)) ++missed;
            }
            store_normal(
                std::isnan(found.height) ? vec3{0, 0, 1} : in_tangent_space(place, found.normal),
                &maps.normals[3 * i]);
        }
        done += end - begin;
        monitor("bake", static_cast<double>(done) / static_cast<double>(rows));
    });
    if (monitor.cancelled()) return fail(Errc::cancelled, "stopped while baking maps");
    maps.missed = inside > 0 ? static_cast<double>(missed) / static_cast<double>(inside) : 0;
    fill(maps.heights, width, height, kFillRings);
    return maps;
}

}  // namespace aglow::bake::fair
