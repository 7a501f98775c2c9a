// SPDX-License-Identifier: Apache-2.0
// Pictures of engine `raster`, for its tests.
#pragma once
#include "aglow/core/testing/demand.h"
#include "aglow/render/compare.h"
#include "aglow/render/raster.h"
#include "aglow/render/testing/stage.h"

#include <memory>

namespace aglow::render::testing {

inline Image rastered(const Gpu& gpu, const Footage& footage, const View& view, double time = -1,
                      RasterOptions options = {}) {
    const auto renderer = demand(make_raster_frame_renderer(gpu, footage, options));
    return demand(renderer->draw(time, view, {})).luminance;
}

inline View auto_view(const Scene& scene, double time, int width, int height) {
    const Surfaces surfaces = pose(scene, time);
    const RayScene rays = demand(RayScene::create(scene, surfaces));
    return demand(choose_view(scene, surfaces, rays, "auto", width, height, time));
}

/// An octahedron with the normals of a sphere; its corners are split as files have them.
inline Scene octahedron(bool mirrored) {
    Scene scene;
    Primitive p;
    p.material = 0;
    scene.materials.push_back(unlit({1, 1, 1}));
    const vec3 tips[] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (uint32_t i = 0; i < 8; ++i) {
        const uint32_t a = i % 4, b = (i + 1) % 4;
        for (const uint32_t corner : {a, i < 4 ? b : 5, i < 4 ? 4 : b}) {
            p.positions.push_back(tips[corner]);
            p.normals.push_back(tips[corner]);
        }
        p.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    Node node;
    node.mesh = 0;
    if (mirrored) node.scale = {-1, 1, 1};
    scene.meshes.push_back({"", {p}, {}});
    scene.nodes.push_back(node);
    return scene;
}

/// The mean of a picture of unlit white.
inline double covered(const Image& image) {
    double sum = 0;
    for (const vec3 pixel : image.pixels) sum += static_cast<double>(pixel.x / kUnlitWhite);
    return sum / static_cast<double>(image.pixels.size());
}

}  // namespace aglow::render::testing
