// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/validate/experiment.h"

#include <algorithm>

namespace aglow::validation {

Check total_at(size_t i, std::string quantity, double expected, std::string source) {
    return {.quantity = std::move(quantity),
            .source = std::move(source),
            .expected = expected,
            .read = [i](const Evidence& e) { return luminance(e.sensors[i].total()); }};
}

Check indirect_at(size_t i, std::string quantity, double expected, std::string source) {
    return {.quantity = std::move(quantity),
            .source = std::move(source),
            .expected = expected,
            .read = [i](const Evidence& e) { return luminance(e.sensors[i].indirect); }};
}

namespace {

double pick(const Irradiance& value, Share share) {
    switch (share) {
        case Share::direct:
            return luminance(value.direct);
        case Share::indirect:
            return luminance(value.indirect);
        case Share::total:
            break;
    }
    return luminance(value.total());
}

SurfacePoint first_sample(const Texels& texels, size_t element) {
    return texels.samples[texels.first_sample[element]];
}

bool lies_on(const Baked& baked, size_t element, int node) {
    const uint32_t triangle = first_sample(baked.texels, element).triangle;
    return node < 0 || baked.surfaces.part(triangle).node == node;
}

}  // namespace

double mean_over_node(const Baked& baked, int node, Share share) {
    double sum = 0, total_area = 0;
    for (size_t e = 0; e < baked.texels.element_count(); ++e) {
        if (!lies_on(baked, e, node)) continue;
        const double texel_area = static_cast<double>(baked.texels.area[e]);
        sum += texel_area * pick(baked.field.values[e], share);
        total_area += texel_area;
    }
    return sum / total_area;
}

double max_over_node(const Baked& baked, int node) {
    double most = 0;
    for (size_t e = 0; e < baked.texels.element_count(); ++e)
        if (lies_on(baked, e, node))
            most = std::max(most, pick(baked.field.values[e], Share::total));
    return most;
}

std::array<double, 3> absorbed_flux(const Baked& baked) {
    std::array<double, 3> flux = {0, 0, 0};
    for (size_t e = 0; e < baked.texels.element_count(); ++e) {
        const vec3 rho =
            diffuse_reflectance(baked.scene, baked.surfaces, first_sample(baked.texels, e));
        const vec3 arriving = baked.field.values[e].total();
        const auto texel_area = static_cast<double>(baked.texels.area[e]);
        flux[0] += texel_area * static_cast<double>(arriving.x * (1 - rho.x));
        flux[1] += texel_area * static_cast<double>(arriving.y * (1 - rho.y));
        flux[2] += texel_area * static_cast<double>(arriving.z * (1 - rho.z));
    }
    return flux;
}

}  // namespace aglow::validation
