// SPDX-License-Identifier: Apache-2.0
// A machine of as many parts as it takes: cells of an octree, each filled by one part, are split or
// given a finer part in turn until the wanted number of triangles is reached.
#include "aglow/scene/builtin/machine_parts.h"
#include "aglow/scene/builtin/scenes.h"
#include "aglow/scene/builtin/studio.h"

#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <string>

namespace aglow::builtin {
namespace {

constexpr float kCell = 0.4f;                        // m, edge of the coarsest cells
constexpr int kMaxDepth = 9;                         // of the octree; cells below 1 mm
constexpr int64_t kBox = 12;                         // triangles of the smallest part
constexpr int kColumns = 6, kRows = 3, kLayers = 4;  // cells along x, y, z

struct Cell {
    vec3 center;
    float edge;
    int depth;
    MachinePart part;
    int level;
    int finish;  ///< which of its part's materials
    vec4 rotation;
};

/// Meshes of parts, made when they are first asked for.
class PartMeshes {
public:
    explicit PartMeshes(SceneBuilder& scene) : scene_(scene) {
        const int steel = scene.metal("steel", {0.56f, 0.57f, 0.58f}, 0.3f);
        const int chrome = scene.metal("chrome", {0.7f, 0.7f, 0.72f}, 0.08f);
        const int brass = scene.metal("brass", {0.78f, 0.57f, 0.25f}, 0.25f);
        const int copper = scene.metal("copper", {0.8f, 0.45f, 0.32f}, 0.2f);
        const int iron = scene.glossy("cast iron", {0.09f, 0.1f, 0.11f}, 0.5f);
        const int red = scene.glossy("red paint", {0.55f, 0.06f, 0.04f}, 0.25f);
        const int rubber = scene.diffuse("rubber", {0.04f, 0.04f, 0.04f});
        materials_ = {{{iron, red},
                       {steel, brass},
                       {brass, steel},
                       {copper, chrome},
                       {rubber, chrome},
                       {steel, red},
                       {iron, steel}}};
    }

    const Shape& shape(MachinePart part, int level) {
        const auto [at, is_new] = shapes_.try_emplace({part, level});
        if (is_new) at->second = machine_part(part, level);
        return at->second;
    }
    int64_t triangles(MachinePart part, int level) {
        return static_cast<int64_t>(shape(part, level).triangles.size());
    }
    int mesh(MachinePart part, int level, int finish) {
        const auto [at, is_new] = meshes_.try_emplace({part, level, finish}, 0);
        if (is_new) {
            const auto kind = static_cast<size_t>(part);
            at->second = scene_.add_mesh(
                std::string(kNames[kind]) + " " + std::to_string(level),
                {{shape(part, level), materials_[kind][static_cast<size_t>(finish)]}});
        }
        return at->second;
    }

private:
    static constexpr std::array<const char*, kMachinePartCount> kNames = {
        "plate", "bolt", "gear", "pipe", "ring", "spring", "cylinder"};

    SceneBuilder& scene_;
    std::array<std::array<int, 2>, kMachinePartCount> materials_{};
    std::map<std::pair<MachinePart, int>, Shape> shapes_;
    std::map<std::tuple<MachinePart, int, int>, int> meshes_;
};

/// Turns the main axis, +Y, to one of the six axes.
vec4 axis_turn(int which) {
    switch (which) {
        case 0:
            return turn({1, 0, 0}, 90);
        case 1:
            return turn({1, 0, 0}, -90);
        case 2:
            return turn({0, 0, 1}, 90);
        case 3:
            return turn({0, 0, 1}, -90);
        case 4:
            return turn({1, 0, 0}, 180);
        default:
            return {0, 0, 0, 1};
    }
}

Cell make_cell(vec3 center, float edge, int depth, Dice& dice) {
    const auto pick = [&](int count) {
        return std::min(count - 1, static_cast<int>(dice.next() * static_cast<float>(count)));
    };
    const auto part = static_cast<MachinePart>(pick(kMachinePartCount));
    const int finish = pick(2);
    return {center, edge, depth, part, 0, finish, axis_turn(pick(6))};
}

/// The machine's rough outline: a block with a V on top of it.
bool is_in_outline(int i, int j, int k) {
    if (j < kRows - 1) return true;
    return (k == 0 || k == kLayers - 1) && i > 0 && i < kColumns - 1;
}

std::deque<Cell> coarse_cells(Dice& dice) {
    std::deque<Cell> cells;
    for (int j = 0; j < kRows; ++j)
        for (int k = 0; k < kLayers; ++k)
            for (int i = 0; i < kColumns; ++i) {
                if (!is_in_outline(i, j, k)) continue;
                const vec3 at{static_cast<float>(i) - 0.5f * (kColumns - 1),
                              static_cast<float>(j) + 0.6f,
                              static_cast<float>(k) - 0.5f * (kLayers - 1)};
                cells.push_back(make_cell(at * kCell, kCell, 0, dice));
                cells.back().part =
                    (i + j + k) % 3 == 0 ? MachinePart::finned_cylinder : cells.back().part;
            }
    return cells;
}

std::array<Cell, 8> split(const Cell& cell, Dice& dice) {
    std::array<Cell, 8> children;
    for (size_t c = 0; c < 8; ++c) {
        const auto side = [&](size_t bit) { return (c >> bit & 1) ? 0.25f : -0.25f; };
        children[c] = make_cell(cell.center + vec3{side(0), side(1), side(2)} * cell.edge,
                                cell.edge / 2, cell.depth + 1, dice);
    }
    return children;
}

/// Cells whose parts together have at most `budget` triangles, and what is left of it.
std::deque<Cell> fill(PartMeshes& meshes, int64_t& budget) {
    Dice dice(11);
    std::deque<Cell> open, done;
    for (Cell& cell : coarse_cells(dice)) {
        const int64_t cost = meshes.triangles(cell.part, 0);
        if (cost > budget) continue;
        budget -= cost;
        open.push_back(cell);
    }
    while (!open.empty()) {
        Cell cell = open.front();
        open.pop_front();
        const int64_t cost = meshes.triangles(cell.part, cell.level);
        // Two in five cells are split, so that parts of all sizes stay side by side.
        const bool splits =
            cell.depth < kMaxDepth && (cell.level == kMaxPartLevel || dice.next() < 0.4f);
        if (splits) {
            const std::array<Cell, 8> children = split(cell, dice);
            int64_t more = -cost;
            for (const Cell& child : children) more += meshes.triangles(child.part, 0);
            if (more <= budget) {
                budget -= more;
                open.insert(open.end(), children.begin(), children.end());
                continue;
            }
        } else if (cell.level < kMaxPartLevel) {
            const int64_t more = meshes.triangles(cell.part, cell.level + 1) - cost;
            if (more <= budget) {
                budget -= more;
                ++cell.level;
                open.push_back(cell);
                continue;
            }
        }
        done.push_back(cell);
    }
    return done;
}

void place(SceneBuilder& scene, PartMeshes& meshes, const Cell& cell, int number) {
    constexpr float kOverlap = 1.06f;  // neighbours reach into each other, so nothing hangs in air
    const int node = scene.add_node("part " + std::to_string(number),
                                    meshes.mesh(cell.part, cell.level, cell.finish));
    scene.node(node).translation = cell.center;
    scene.node(node).rotation = cell.rotation;
    const float scale = kOverlap * cell.edge;
    scene.node(node).scale = {scale, scale, scale};
}

void place_plate(SceneBuilder& scene, PartMeshes& meshes, const std::string& name, vec3 center,
                 vec3 size, int finish) {
    const int node = scene.add_node(name, meshes.mesh(MachinePart::plate, 0, finish));
    scene.node(node).translation = center;
    scene.node(node).scale = {size.x, 5 * size.y, size.z};  // plates are a fifth as thick as wide
}

/// The bed and the rails that run along the whole machine: its largest triangles.
void place_frame(SceneBuilder& scene, PartMeshes& meshes, int64_t& budget) {
    constexpr float kLong = kColumns * kCell + 0.3f, kDeep = kLayers * kCell + 0.2f;
    constexpr float kRail = 0.05f;
    struct Plate {
        vec3 center, size;
    };
    constexpr std::array<Plate, 5> kPlates = {{
        {{0, kRail / 2, 0}, {kLong, kRail, kDeep}},
        {{0, 2 * kCell, kDeep / 2}, {kLong, kRail, kRail}},
        {{0, 2 * kCell, -kDeep / 2}, {kLong, kRail, kRail}},
        {{0, kCell, kDeep / 2}, {kLong, kRail, kRail}},
        {{0, kCell, -kDeep / 2}, {kLong, kRail, kRail}},
    }};
    for (const Plate& plate : kPlates) {
        if (budget < kBox) return;
        place_plate(scene, meshes, "part of the frame", plate.center, plate.size, 0);
        budget -= kBox;
    }
}

/// Small tiles on the floor before the machine use up what no part is small enough for.
void place_tiles(SceneBuilder& scene, PartMeshes& meshes, int64_t budget) {
    for (int i = 0; budget >= kBox; budget -= kBox, ++i)
        place_plate(scene, meshes, "tile " + std::to_string(i),
                    {-1.1f + 0.05f * static_cast<float>(i % 45), 0.004f,
                     1.0f + 0.05f * static_cast<float>(i / 45)},
                    {0.036f, 0.007f, 0.036f}, 1);
}

}  // namespace

Scene cad(int64_t triangle_count) {
    SceneBuilder scene("cad:" + std::to_string(triangle_count));
    const int floor = scene.glossy("floor", {0.32f, 0.33f, 0.35f}, 0.35f);
    add_studio(scene,
               {.half = 3,
                .height = 3.5f,
                .spot = vec3{14000, 13400, 12400},
                .spot_position = {2.6f, 3.2f, 2.2f},
                .spot_target = {0, 0.5f, 0}},
               floor);
    scene.look({2.0f, 1.65f, 2.5f}, {-0.05f, 0.5f, 0}, 42);
    PartMeshes meshes(scene);
    int64_t budget = triangle_count - kStudioTriangles;
    place_frame(scene, meshes, budget);
    int number = 0;
    for (const Cell& cell : fill(meshes, budget)) place(scene, meshes, cell, number++);
    place_tiles(scene, meshes, budget);
    return scene.take();
}

}  // namespace aglow::builtin
