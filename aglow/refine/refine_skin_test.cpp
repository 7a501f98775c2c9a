// SPDX-License-Identifier: Apache-2.0
#include "aglow/refine/refine_scene.h"

#include "aglow/core/testing/scenes.h"
#include "aglow/refine/testing/scenes.h"
#include "aglow/scene/load.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <vector>

using namespace aglow;
using namespace aglow::refine::testing;
namespace fs = std::filesystem;

TEST_CASE("of the joints between two vertices the heaviest stay, as many as the file has") {
    // Two triangles side by side; joints of the vertices on the left and on the right differ.
    for (const size_t width : {4u, 8u, 12u}) {
        CAPTURE(width);
        Primitive p = square();
        p.influences = static_cast<int>(width);
        std::map<uint32_t, double> left, right;
        for (const vec3 x : p.positions)
            for (uint32_t i = 0; i < width; ++i) {
                const auto count = static_cast<uint32_t>(width);
                const uint32_t joint = x.x == 0 ? i : count / 2 + i;
                const float rank = x.x == 0 ? float(i) + 1 : float(count - i) + 0.5f;
                const float all = 0.5f * float(count) * (float(count) + (x.x == 0 ? 1.0f : 2.0f));
                p.joints.push_back(joint);
                p.weights.push_back(rank / all);
                (x.x == 0 ? left : right)[joint] = double{p.weights.back()};
            }
        const Primitive fine =
            refined(scene_of(std::move(p)), RefineScheme::phong, 1).meshes[0].primitives[0];
        const size_t kept = width == 4 ? 4 : 8;
        REQUIRE(fine.influences == static_cast<int>(kept));
        for (size_t v = 0; v < fine.positions.size(); ++v) {
            const auto share = double{fine.positions[v].x};  // linear from left to right
            std::map<uint32_t, double> mean;
            for (const auto& [joint, weight] : left) mean[joint] += (1 - share) * weight;
            for (const auto& [joint, weight] : right) mean[joint] += share * weight;
            std::vector<std::pair<double, uint32_t>> heaviest;
            for (const auto& [joint, weight] : mean)
                if (weight > 0) heaviest.emplace_back(weight, joint);
            std::ranges::sort(heaviest, std::greater());
            heaviest.resize(std::min(heaviest.size(), kept));
            double sum = 0;
            for (const auto& [weight, joint] : heaviest) sum += weight;
            for (size_t i = 0; i < heaviest.size(); ++i) {
                CHECK(fine.joints[v * kept + i] == heaviest[i].second);
                CHECK(fine.weights[v * kept + i] ==
                      doctest::Approx(heaviest[i].first / sum).epsilon(1e-5));
            }
        }
    }
}

TEST_CASE("of joints that weigh the same the first ones stay") {
    Scene scene = cube();
    for (Primitive& p : scene.meshes[0].primitives) {
        p.influences = 8;
        for (uint32_t v = 0; v < p.positions.size(); ++v)
            for (uint32_t i = 0; i < 8; ++i) {
                p.joints.push_back(i);
                p.weights.push_back(0.125f);
            }
    }
    const Scene fine = refined(scene, RefineScheme::phong, 1);
    for (const Primitive& p : fine.meshes[0].primitives)
        for (size_t i = 0; i < p.joints.size(); ++i) {
            CHECK(p.joints[i] == i % 8);
            CHECK(p.weights[i] == doctest::Approx(0.125).epsilon(1e-6));
        }
}

TEST_CASE("skinned models: refined then posed is close to posed then refined, and closed") {
    for (const char* name : {"CesiumMan/CesiumMan.glb", "Fox/Fox.glb"}) {
        const fs::path path = scenes_folder() / "khronos" / name;
        if (!is_here(path)) return;
        CAPTURE(name);
        const auto scene = load_scene(path);
        REQUIRE(scene);
        const Scene fine = refined(*scene, RefineScheme::loop, 1);
        for (const Primitive& p : fine.meshes[0].primitives)
            for (size_t v = 0; v < p.positions.size(); ++v) {
                float sum = 0;
                for (size_t i = 0; i < 4; ++i) sum += p.weights[4 * v + i];
                CHECK(sum == doctest::Approx(1).epsilon(1e-6));
            }
        // Boundaries of the model stay; refining puts one vertex on each of their edges.
        const size_t boundary = open_edges(pose(*scene));
        for (const double time : {0.0, 0.4, 1.1}) {
            const Surfaces posed = pose(fine, time);
            CHECK(open_edges(posed) == 2 * boundary);
            // The coarse model, posed and frozen into a scene of its own.
            Scene frozen;
            const Surfaces coarse = pose(*scene, time);
            Mesh mesh;
            mesh.primitives.resize(1);
            mesh.primitives[0].positions = coarse.positions;
            mesh.primitives[0].normals = coarse.normals;
            mesh.primitives[0].texcoords = coarse.texcoords;
            mesh.primitives[0].triangles = coarse.triangles;
            frozen.meshes.push_back(std::move(mesh));
            frozen.nodes.emplace_back().mesh = 0;
            const Surfaces direct = pose(refined(frozen, RefineScheme::loop, 1));
            REQUIRE(direct.triangles.size() == posed.triangles.size());
            Box box;
            for (const vec3 p : direct.positions) box.add(p);
            double sum = 0;
            for (uint32_t t = 0; t < direct.triangles.size(); ++t)
                for (int i = 0; i < 3; ++i)
                    sum += static_cast<double>(length(direct.corner(t, i) - posed.corner(t, i)));
            const double mean = sum / (3.0 * static_cast<double>(direct.triangles.size()));
            CHECK(mean < 0.006 * static_cast<double>(length(box.hi - box.lo)));
        }
    }
}
