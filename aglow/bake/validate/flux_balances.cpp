// SPDX-License-Identifier: Apache-2.0
// A closed room absorbs exactly what its lights emit: sum of E (1 - rho) A = flux. Every surface
// is closed and shows only its front, so that texels see all the light there is.
#include "aglow/bake/validate/closed_forms.h"
#include "aglow/bake/validate/experiment.h"

namespace aglow::validation {
namespace {

constexpr const char* kSource = "absorbed = emitted";

/// Absorbed flux of one channel (0..2), brought back to the scene's natural size.
Check absorbed(std::string quantity, size_t channel, double expected, const char* source) {
    return {.quantity = std::move(quantity),
            .source = source,
            .expected = expected,
            .read =
                [channel](const Evidence& e) {
                    return absorbed_flux(*e.baked)[channel] / (e.scale * e.scale);
                },
            .unit = "lm"};
}

/// A room of 5 x 3 x 4 m with a free block in it.
Experiment furnished(std::string name, vec3 walls, float block) {
    Experiment e{.group = "flux balance",
                 .name = std::move(name),
                 .scene = {},
                 .bakes = true,
                 .resolution = 64};
    add_box(e.scene, add_material(e.scene, walls), {-2.5f, 0, -2}, {2.5f, 3, 2}, Facing::inwards);
    add_box(e.scene, add_grey(e.scene, block), {0.3f, 0.4f, -0.5f}, {1.4f, 1.2f, 0.9f},
            Facing::outwards);
    return e;
}

Experiment lit_by_panel() {
    Experiment e = furnished("emissive slab", {0.7f, 0.7f, 0.7f}, 0.3f);
    const float luminance_of_slab = 1000;
    add_box(e.scene, add_grey(e.scene, 0.5f, luminance_of_slab), {-1.2f, 2.7f, -0.5f},
            {-0.2f, 2.8f, 0.5f}, Facing::outwards);
    const double slab_area = 2 * 1 * 1 + 4 * 1 * 0.1;
    e.checks = {absorbed("absorbed flux", 0, kPi * 1000 * slab_area, kSource)};
    return e;
}

Experiment lit_by_point() {
    Experiment e = furnished("point light, coloured walls", {0.8f, 0.5f, 0.1f}, 0.6f);
    add_point_light(e.scene, {-0.7f, 1.9f, 0.3f}, 5000);
    e.checks = {absorbed("absorbed flux, red", 0, 5000, kSource),
                absorbed("absorbed flux, green", 1, 5000, kSource),
                absorbed("absorbed flux, blue", 2, 5000, kSource)};
    return e;
}

Experiment lit_by_spot() {
    Experiment e = furnished("spot", {0.6f, 0.6f, 0.6f}, 0.2f);
    const float inner = 0.4f, outer = 0.8f;
    add_light(e.scene,
              {.name = "lamp",
               .kind = LightKind::spot,
               .intensity = {2000, 2000, 2000},
               .inner_cone = inner,
               .outer_cone = outer},
              {-0.5f, 2.5f, 0.2f}, {0.28f, -0.96f, 0});
    const double flux = 2000 * spot_flux(static_cast<double>(inner), static_cast<double>(outer));
    e.checks = {absorbed("absorbed flux", 0, flux, "absorbed = integral of the cone")};
    return e;
}

}  // namespace

std::vector<Experiment> flux_balances() { return {lit_by_panel(), lit_by_point(), lit_by_spot()}; }

}  // namespace aglow::validation
