// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/gpu/part_motion.h"

#include "aglow/scene/builtin.h"

#include <doctest/doctest.h>

#include <string>

using namespace aglow;
using mesh::gpu::PartMotion;

namespace {

std::vector<PartMotion> motions_of(const Scene& scene) {
    return mesh::gpu::classify_parts(scene, pose(scene).parts);
}

/// Counts of the parts of a built-in scene by motion; triangles that deform.
struct Census {
    int still = 0, rigid = 0, deforming = 0;
    size_t deforming_triangles = 0;

    explicit Census(const std::string& name) {
        const Scene scene = *builtin_scene(name);
        const Surfaces surfaces = pose(scene);
        const auto motions = mesh::gpu::classify_parts(scene, surfaces.parts);
        for (size_t i = 0; i < motions.size(); ++i) {
            still += motions[i] == PartMotion::still;
            rigid += motions[i] == PartMotion::rigid;
            deforming += motions[i] == PartMotion::deforming;
            if (motions[i] == PartMotion::deforming)
                deforming_triangles += surfaces.parts[i].triangle_count;
        }
    }
};

/// A root, a child of it with a mesh of one triangle, and a second root; nothing moves.
Scene family() {
    Scene scene;
    Primitive triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.normals.assign(3, {0, 0, 1});
    triangle.triangles = {{0, 1, 2}};
    scene.meshes.push_back({"mesh", {triangle}, {}});
    scene.nodes.resize(3);
    scene.nodes[0].children = {1};
    scene.nodes[1].parent = 0;
    scene.nodes[1].mesh = 0;
    scene.animations.push_back({"motion", {}});
    return scene;
}

void slide(Scene& scene, int node, vec3 to) {
    scene.animations[0].channels.push_back(
        {node, Path::translation, Interpolation::linear, {0, 1}, {0, 0, 0, to.x, to.y, to.z}});
}

void add_skin(Scene& scene, int joint) {
    Primitive& primitive = scene.meshes[0].primitives[0];
    primitive.influences = 4;
    primitive.joints.assign(12, 0);
    primitive.weights.assign(12, 0.25f);
    scene.skins.push_back({{joint}, {mat4{}}});
    scene.nodes[1].skin = 0;
}

}  // namespace

TEST_CASE("parts of the built-in scenes move as those were made to") {
    const Census walker("walker"), marbles("marbles"), toys("toys"), forest("forest");
    CHECK(walker.deforming == 4);
    CHECK(walker.rigid == 0);
    CHECK(walker.still == 3);  // floor, walls, panel
    CHECK(marbles.rigid == 16);
    CHECK(marbles.deforming == 0);
    CHECK(toys.deforming == 4);                  // the sail and the duck's three materials
    CHECK(toys.rigid == 2 + 2 + 3 * 2 + 4 * 2);  // boat, engine, wagons, wheels
    CHECK(forest.rigid == 24 * 5);
    CHECK(forest.deforming == 28);
    CHECK(forest.deforming_triangles == 28 * 2000);
    CHECK(Census("cad:2000").rigid + Census("cad:2000").deforming == 0);
}

TEST_CASE("a part moves with its node and with what stands above it, but not with others") {
    Scene scene = family();
    CHECK(motions_of(scene).at(0) == PartMotion::still);
    slide(scene, 2, {1, 0, 0});
    CHECK(motions_of(scene).at(0) == PartMotion::still);
    slide(scene, 0, {1, 0, 0});
    CHECK(motions_of(scene).at(0) == PartMotion::rigid);
    Scene own = family();
    slide(own, 1, {0, 1, 0});
    CHECK(motions_of(own).at(0) == PartMotion::rigid);
}

TEST_CASE("channels that hold one value move nothing") {
    Scene scene = family();
    slide(scene, 1, {0, 0, 0});
    scene.animations[0].channels.push_back({1, Path::scale, Interpolation::linear, {2}, {3, 3, 3}});
    scene.animations[0].channels.push_back(
        {1,
         Path::translation,
         Interpolation::cubic_spline,
         {0, 1},
         {0, 0, 0, 5, 6, 7, 0, 0, 0, 0, 0, 0, 5, 6, 7, 0, 0, 0}});
    CHECK(motions_of(scene).at(0) == PartMotion::still);
    scene.animations[0].channels.back().values[6] = 1;  // an out-tangent
    CHECK(motions_of(scene).at(0) == PartMotion::rigid);
}

TEST_CASE("nodes with a matrix do not move") {
    Scene scene = family();
    slide(scene, 1, {1, 0, 0});
    scene.nodes[1].has_matrix = true;
    CHECK(motions_of(scene).at(0) == PartMotion::still);
}

TEST_CASE("weights deform only what has targets") {
    Scene scene = family();
    scene.animations[0].channels.push_back(
        {1, Path::weights, Interpolation::linear, {0, 1}, {0, 1}});
    CHECK(motions_of(scene).at(0) == PartMotion::still);
    scene.meshes[0].primitives[0].targets.resize(1);
    CHECK(motions_of(scene).at(0) == PartMotion::deforming);
}

TEST_CASE("a skinned part deforms with its joints and those above them, not with its node") {
    Scene scene = family();
    add_skin(scene, 2);
    slide(scene, 1, {1, 0, 0});
    CHECK(motions_of(scene).at(0) == PartMotion::still);
    slide(scene, 2, {1, 0, 0});
    CHECK(motions_of(scene).at(0) == PartMotion::deforming);

    Scene below = family();
    below.nodes.push_back({});
    below.nodes[2].children = {3};
    below.nodes[3].parent = 2;
    add_skin(below, 3);
    slide(below, 2, {1, 0, 0});
    CHECK(motions_of(below).at(0) == PartMotion::deforming);
}

TEST_CASE("instances of a skinned node follow the node") {
    Scene scene = family();
    add_skin(scene, 2);
    scene.nodes[1].instances = {mat4{}, translation({1, 0, 0})};
    CHECK(motions_of(scene).at(1) == PartMotion::still);
    slide(scene, 1, {1, 0, 0});
    CHECK(motions_of(scene).at(1) == PartMotion::deforming);
}
