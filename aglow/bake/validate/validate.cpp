// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/validate.h"

#include "aglow/bake/validate/experiment.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

namespace aglow {

namespace validation {

std::vector<Experiment> all_experiments() {
    std::vector<Experiment> all;
    for (auto make : {punctual_lights, area_sources, rooms, flux_balances, skies, darkness})
        for (Experiment& e : make()) all.push_back(std::move(e));
    return all;
}

namespace {

std::string full_name(const Experiment& e) { return e.group + ": " + e.name; }

BakeOptions bake_options(const Experiment& e, const ValidationOptions& options) {
    BakeOptions result;
    result.solve.method = options.method;
    result.solve.quality = options.quality;
    result.solve.seed = options.seed;
    result.unwrap.resolution = e.resolution;
    return result;
}

std::vector<Receiver> scaled(std::vector<Receiver> sensors, double scale) {
    for (Receiver& s : sensors) s.position *= static_cast<float>(scale);
    return sensors;
}

ValidationCase judge(const Experiment& e, const Check& check, const Evidence& evidence,
                     Quality quality) {
    ValidationCase result{.group = e.group,
                          .name = e.name,
                          .quantity = check.quantity,
                          .unit = check.unit,
                          .source = check.source,
                          .scale = evidence.scale,
                          .expected = check.expected,
                          .measured = check.read(evidence)};
    const bool dark = check.expected == 0;
    result.error = (result.measured - check.expected) / (dark ? check.reference : check.expected);
    result.tolerance = dark ? 0 : validation_tolerance(quality);
    return result;
}

/// Measures one experiment at one scale the way a user would.
Result<std::vector<ValidationCase>> run(const Experiment& e, double scale,
                                        const ValidationOptions& options, const Monitor& quiet) {
    const auto start = std::chrono::steady_clock::now();
    const BakeOptions how = bake_options(e, options);
    Scene scene = e.scene;
    scene.name = e.name;
    scale_scene(scene, scale);

    Evidence evidence;
    evidence.scale = scale;
    if (!e.sensors.empty()) {
        AG_TRY(IrradianceField field, measure(scene, scaled(e.sensors, scale), how, quiet));
        evidence.sensors = std::move(field.values);
    }
    Baked baked;
    if (e.bakes) {
        AG_TRY(baked, bake(std::move(scene), how, quiet));
        evidence.baked = &baked;
    }

    std::vector<ValidationCase> cases;
    for (const Check& check : e.checks) cases.push_back(judge(e, check, evidence, options.quality));
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    for (ValidationCase& c : cases) c.seconds = passed.count();
    return cases;
}

Result<std::vector<Experiment>> chosen(const ValidationOptions& options) {
    for (double scale : options.scales)
        if (!(scale > 0) || !std::isfinite(scale))
            return fail(Errc::bad_argument, fmt::format("scale {}: must be positive", scale));
    std::vector<Experiment> all = all_experiments();
    std::erase_if(all, [&](const Experiment& e) {
        return full_name(e).find(options.filter) == std::string::npos;
    });
    if (all.empty() || options.scales.empty())
        return fail(Errc::bad_argument,
                    fmt::format("no analytic case has \"{}\" in its name", options.filter));
    return all;
}

}  // namespace
}  // namespace validation

double validation_tolerance(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return 0.05;
        case Quality::medium:
            return 0.01;
        case Quality::high:
            break;
    }
    return 0.005;
}

int validation_case_count() {
    size_t count = 0;
    for (const validation::Experiment& e : validation::all_experiments()) count += e.checks.size();
    return static_cast<int>(count);
}

Result<std::vector<ValidationCase>> validate(const ValidationOptions& options,
                                             const Monitor& monitor) {
    AG_TRY(const std::vector<validation::Experiment> experiments, validation::chosen(options));
    const Monitor quiet{.report = {}, .cancel = monitor.cancel};
    const auto steps = static_cast<double>(experiments.size() * options.scales.size());
    std::vector<ValidationCase> all;
    double done = 0;
    for (const validation::Experiment& e : experiments) {
        std::vector<std::vector<ValidationCase>> by_scale;
        for (double scale : options.scales) {
            monitor("validate", done++ / steps);
            AG_TRY(auto cases, validation::run(e, scale, options, quiet));
            by_scale.push_back(std::move(cases));
        }
        for (size_t check = 0; check < e.checks.size(); ++check)
            for (const auto& cases : by_scale) all.push_back(cases[check]);
    }
    monitor("validate", 1);
    return all;
}

}  // namespace aglow
