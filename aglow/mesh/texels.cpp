// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/texels.h"

#include "aglow/core/assert.h"
#include "aglow/core/parallel.h"
#include "aglow/mesh/raster/coverage.h"
#include "aglow/mesh/raster/spread.h"

#include <algorithm>
#include <cmath>

namespace aglow {
namespace {

using mesh::Point2;
using mesh::TexelPiece;
using mesh::Triangle2;

/// That a triangle overlaps a texel.
struct Fragment {
    uint32_t pixel = 0;
    uint32_t triangle = 0;
};

/// Corners in texels, counter-clockwise; mirrored UVs are turned round.
Triangle2 atlas_corners(const Surfaces& surfaces, uint32_t triangle) {
    const uvec3 t = surfaces.triangles[triangle];
    const auto corner = [&](uint32_t v) {
        return Point2{double(surfaces.lightmap_uvs[v].x), double(surfaces.lightmap_uvs[v].y)};
    };
    Triangle2 corners{corner(t.x), corner(t.y), corner(t.z)};
    if (mesh::doubled_area(corners) < 0) std::swap(corners[1], corners[2]);
    return corners;
}

std::vector<Fragment> find_fragments(const Surfaces& surfaces, int width, int height) {
    constexpr size_t kGrain = 1024;
    const size_t count = surfaces.triangles.size();
    std::vector<std::vector<Fragment>> chunks((count + kGrain - 1) / kGrain);
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        std::vector<Fragment>& chunk = chunks[begin / kGrain];
        for (auto t = static_cast<uint32_t>(begin); t < end; ++t) {
            const Triangle2 corners = atlas_corners(surfaces, t);
            if (!(mesh::doubled_area(corners) > 0) || !(area(surfaces, t) > 0)) continue;
            mesh::for_each_covered_square(
                corners, width, height, [&](int x, int y, const mesh::ClipPolygon&) {
                    const auto pixel = static_cast<uint32_t>(y) * static_cast<uint32_t>(width) +
                                       static_cast<uint32_t>(x);
                    chunk.push_back({pixel, t});
                });
        }
    });
    std::vector<Fragment> all;
    for (std::vector<Fragment>& chunk : chunks) {
        all.insert(all.end(), chunk.begin(), chunk.end());
        chunk = {};
    }
    return all;
}

/// Triangles of each element: those of element e are triangles[first[e] .. first[e + 1]), in order.
struct Elements {
    std::vector<uint32_t> first, triangles;
};

/// Numbers the covered texels by pixel and sorts the fragments by them (a counting sort).
Elements number_elements(const std::vector<Fragment>& fragments, Texels& texels) {
    texels.element_at.assign(static_cast<size_t>(texels.width) * static_cast<size_t>(texels.height),
                             0);
    for (const Fragment& f : fragments) ++texels.element_at[f.pixel];
    Elements elements;
    uint32_t offset = 0;
    for (uint32_t pixel = 0; pixel < texels.element_at.size(); ++pixel) {
        const uint32_t count = texels.element_at[pixel];
        texels.element_at[pixel] = kNoElement;
        if (count == 0) continue;
        texels.element_at[pixel] = static_cast<uint32_t>(texels.pixel_of.size());
        texels.pixel_of.push_back(pixel);
        elements.first.push_back(offset);
        offset += count;
    }
    elements.first.push_back(offset);
    elements.triangles.resize(offset);
    std::vector<uint32_t> next(elements.first.begin(), elements.first.end() - 1);
    for (const Fragment& f : fragments)
        elements.triangles[next[texels.element_at[f.pixel]]++] = f.triangle;
    return elements;
}

std::vector<TexelPiece> pieces_of(const Surfaces& surfaces, const Elements& elements,
                                  uint32_t element, int x, int y) {
    std::vector<TexelPiece> pieces;
    for (uint32_t i = elements.first[element]; i < elements.first[element + 1]; ++i) {
        TexelPiece piece;
        piece.triangle = elements.triangles[i];
        const Triangle2 corners = atlas_corners(surfaces, piece.triangle);
        piece.polygon =
            mesh::clip_column(mesh::clip_row(mesh::to_polygon(corners), y, y + 1), x, x + 1);
        piece.weight = double(area(surfaces, piece.triangle)) * piece.polygon.signed_area() /
                       (mesh::doubled_area(corners) / 2);
        pieces.push_back(piece);
    }
    return pieces;
}

SurfacePoint surface_point(const Surfaces& surfaces, uint32_t triangle, Point2 p) {
    const uvec3 t = surfaces.triangles[triangle];
    const auto corner = [&](uint32_t v) {
        return Point2{double(surfaces.lightmap_uvs[v].x), double(surfaces.lightmap_uvs[v].y)};
    };
    const Point2 a = corner(t.x), ab = corner(t.y) - a, ac = corner(t.z) - a, ap = p - a;
    const double whole = cross(ab, ac);
    // Slivers lose their inside to rounding: the bound keeps all three barycentrics positive.
    constexpr double kLeast = 1e-6;
    double b1 = std::max(kLeast, cross(ap, ac) / whole);
    double b2 = std::max(kLeast, cross(ab, ap) / whole);
    const double sum = b1 + b2;
    if (sum > 1 - kLeast) {
        b1 *= (1 - kLeast) / sum;
        b2 *= (1 - kLeast) / sum;
    }
    return {triangle, {static_cast<float>(b1), static_cast<float>(b2)}};
}

/// A texel of which less than this share is covered needs no more than one point.
constexpr double kSliver = 1e-3;

struct ElementResult {
    float area = 0;
    std::vector<SurfacePoint> samples;
};

ElementResult sample_element(const Surfaces& surfaces, const Texels& texels,
                             const Elements& elements, uint32_t element,
                             const std::vector<Point2>& pattern) {
    const uint32_t pixel = texels.pixel_of[element];
    const int x = static_cast<int>(pixel) % texels.width;
    const int y = static_cast<int>(pixel / static_cast<uint32_t>(texels.width));
    const std::vector<TexelPiece> pieces = pieces_of(surfaces, elements, element, x, y);
    double covered = 0, area_sum = 0;
    for (const TexelPiece& piece : pieces) {
        covered += piece.polygon.signed_area();
        area_sum += piece.weight;
    }
    static const std::vector<Point2> single = {{0.5, 0.5}};
    ElementResult result{static_cast<float>(area_sum), {}};
    for (const mesh::PiecePoint& p :
         mesh::spread_points(pieces, {double(x), double(y)}, covered < kSliver ? single : pattern))
        result.samples.push_back(surface_point(surfaces, pieces[p.piece].triangle, p.point));
    return result;
}

}  // namespace

Texels rasterize(const Surfaces& surfaces, const Atlas& atlas, int samples_per_texel) {
    AG_ASSERT(samples_per_texel > 0, "at least one sample point per texel");
    AG_ASSERT(surfaces.lightmap_uvs.size() == surfaces.positions.size(), "posed with an atlas");
    Texels texels;
    texels.width = atlas.width;
    texels.height = atlas.height;
    const Elements elements =
        number_elements(find_fragments(surfaces, atlas.width, atlas.height), texels);
    const size_t count = texels.element_count();
    texels.area.resize(count);

    constexpr size_t kGrain = 2048;
    const std::vector<Point2> pattern = mesh::latin_points(samples_per_texel);
    std::vector<std::vector<SurfacePoint>> chunks((count + kGrain - 1) / kGrain);
    texels.first_sample.assign(count + 1, 0);
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        std::vector<SurfacePoint>& chunk = chunks[begin / kGrain];
        for (size_t e = begin; e < end; ++e) {
            const ElementResult result =
                sample_element(surfaces, texels, elements, static_cast<uint32_t>(e), pattern);
            texels.area[e] = result.area;
            texels.first_sample[e + 1] = static_cast<uint32_t>(result.samples.size());
            chunk.insert(chunk.end(), result.samples.begin(), result.samples.end());
        }
    });
    for (size_t e = 0; e < count; ++e) texels.first_sample[e + 1] += texels.first_sample[e];
    texels.samples.reserve(texels.first_sample.back());
    for (const auto& chunk : chunks)
        texels.samples.insert(texels.samples.end(), chunk.begin(), chunk.end());
    return texels;
}

}  // namespace aglow
