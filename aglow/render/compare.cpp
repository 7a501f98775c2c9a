// SPDX-License-Identifier: Apache-2.0
#include "aglow/render/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace aglow {
namespace {

bool finite(vec3 c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

/// value / of, where nothing differs from nothing by 0 and from something without bound.
double ratio(double value, double of) {
    if (of != 0) return value / std::abs(of);
    return value == 0 ? 0 : std::numeric_limits<double>::infinity();
}

double luminance_of(vec3 c) {
    return 0.2126 * double{c.x} + 0.7152 * double{c.y} + 0.0722 * double{c.z};
}

/// The middle value, or the mean of the two middle ones.
double median(std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

/// Sums over the pixels compared.
struct Sums {
    double a = 0, b = 0, b_squared = 0, difference_squared = 0, max = 0;

    void add(double a_value, double b_value) {
        const double d = a_value - b_value;
        a += a_value;
        b += b_value;
        b_squared += b_value * b_value;
        difference_squared += d * d;
        max = std::max(max, std::abs(d));
    }
};

}  // namespace

Result<Difference> difference(const Image& a, const Image& b, std::span<const uint8_t> mask) {
    if (a.width != b.width || a.height != b.height)
        return fail(Errc::bad_argument,
                    fmt::format("the images differ in size: {}x{} and {}x{} pixels", a.width,
                                a.height, b.width, b.height));
    if (!mask.empty() && mask.size() != a.pixels.size())
        return fail(Errc::bad_argument,
                    fmt::format("the mask has {} entries, the images have {} pixels", mask.size(),
                                a.pixels.size()));

    Difference result;
    Sums sums;
    std::vector<double> relative;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        if (!mask.empty() && mask[i] == 0) continue;
        const vec3 from = a.pixels[i], to = b.pixels[i];
        if (!finite(from) || !finite(to)) {
            ++result.non_finite;
            continue;
        }
        ++result.count;
        for (auto [value, reference] :
             {std::array{from.x, to.x}, std::array{from.y, to.y}, std::array{from.z, to.z}})
            sums.add(double{value}, double{reference});
        if (luminance_of(to) > 0)
            relative.push_back(std::abs(luminance_of(from) - luminance_of(to)) / luminance_of(to));
    }
    if (result.count == 0) return result;

    const double values = 3 * static_cast<double>(result.count);
    result.rmse = std::sqrt(sums.difference_squared / values);
    result.relative_rmse = ratio(result.rmse, std::sqrt(sums.b_squared / values));
    result.mean_relative = ratio(std::abs(sums.a - sums.b), sums.b);
    result.max = sums.max;
    result.median_relative = median(relative);
    return result;
}

}  // namespace aglow
