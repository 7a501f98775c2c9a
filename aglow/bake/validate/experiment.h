// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/bake/bake.h"
#include "aglow/bake/validate/build_scene.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace aglow::validation {

/// What the measuring of one experiment at one scale has found.
struct Evidence {
    std::vector<Irradiance> sensors;  ///< [experiment.sensors.size()]
    const Baked* baked = nullptr;     ///< of an experiment that bakes
    double scale = 1;
};

/// One number read off the evidence, and what it should be.
struct Check {
    std::string quantity;
    std::string source;
    double expected = 0;
    std::function<double(const Evidence&)> read;
    std::string unit = "lx";
    double reference = 0;  ///< for darkness: what would arrive without the obstacle
};

/// One scene at its natural size, in metres, with the points and checks that belong to it.
struct Experiment {
    std::string group;
    std::string name;
    Scene scene;
    std::vector<Receiver> sensors = {};  ///< measured through measure() if there are any
    bool bakes = false;                  ///< baked through bake() too
    int resolution = 32;                 ///< of the atlas, texels
    std::vector<Check> checks = {};
};

std::vector<Experiment> punctual_lights();
std::vector<Experiment> area_sources();
std::vector<Experiment> rooms();
std::vector<Experiment> flux_balances();
std::vector<Experiment> skies();
std::vector<Experiment> darkness();

/// All of them, in the order of the table.
std::vector<Experiment> all_experiments();

/// Check of the luminance-weighted total, direct or indirect illuminance at sensor `i`.
Check total_at(size_t i, std::string quantity, double expected, std::string source);
Check indirect_at(size_t i, std::string quantity, double expected, std::string source);

enum class Share : uint8_t { total, direct, indirect };

/// Mean over the surface of one node (-1: all) of the baked illuminance, weighted by area.
double mean_over_node(const Baked& baked, int node, Share share);
/// Largest illuminance of any texel of one node (-1: all).
double max_over_node(const Baked& baked, int node);
/// Flux that the texels of all nodes absorb, sum of E (1 - rho) A per colour channel, lm.
std::array<double, 3> absorbed_flux(const Baked& baked);

}  // namespace aglow::validation
