// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/reduce.h"

#include "aglow/vk/testing/primitives.h"

#include <bit>
#include <limits>
#include <numeric>

using namespace aglow;
using namespace aglow::vk;

TEST_SUITE_BEGIN("primitives");

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Reducer : TestStream {
    Reducer(const TestDevice& device, Reduction reduction)
        : TestStream(device), reduce(demand(Reduce::create(gpu, reduction))) {}
    Reduce reduce;

    template <class T>
    T operator()(const std::vector<T>& values) {
        demand(reduce.reserve(values.size()));
        const Buffer in = upload(values);
        const Buffer result = make<T>(1);
        stream.barrier();
        reduce.record(stream, in.address(), values.size(), result.address());
        return download<T>(result, 1).front();
    }
};

std::vector<size_t> sizes() {
    std::vector<size_t> sizes = sizes_up_to(14);
    sizes.insert(sizes.end(), {100'000, (1u << 20) - 1, 1u << 20, (1u << 20) + 1});
    return sizes;
}

std::vector<float> random_floats(size_t count, float low, float high) {
    Pcg32 random(count);
    std::vector<float> values(count);
    std::ranges::generate(values, [&] { return low + (high - low) * random.uniform(); });
    return values;
}

}  // namespace

TEST_CASE("sums of unsigned integers equal the standard library's") {
    const TestDevice device;
    if (!device) return;
    Reducer sum(device, Reduction::sum_uint);
    for (const size_t size : sizes()) {
        CAPTURE(size);
        const std::vector<uint32_t> values = random_uints(size);
        CHECK(sum(values) == std::reduce(values.begin(), values.end(), 0u));
    }
    const std::vector<uint32_t> values = random_uints(1 << 24);
    CHECK(sum(values) == std::reduce(values.begin(), values.end(), 0u));
}

TEST_CASE("the largest unsigned integer is found wherever it stands, and is 0 of none") {
    const TestDevice device;
    if (!device) return;
    Reducer maximum(device, Reduction::max_uint);
    for (const size_t size : sizes()) {
        CAPTURE(size);
        std::vector<uint32_t> values = random_uints(size, 0x7fffffffu);
        if (size != 0) values[values[0] % size] = 0xfffffff0u;
        CHECK(maximum(values) == (size != 0 ? 0xfffffff0u : 0u));
    }
}

TEST_CASE("extremes of floats of either sign equal the standard library's, infinite of none") {
    const TestDevice device;
    if (!device) return;
    Reducer smallest(device, Reduction::min_float);
    Reducer largest(device, Reduction::max_float);
    for (const auto& [low, high] : {std::pair{-1.0f, 1.0f}, {-2e30f, -1e-30f}, {1e-30f, 2e30f}})
        for (const size_t size : sizes()) {
            CAPTURE(size);
            const std::vector<float> values = random_floats(size, low, high);
            const float least = size != 0 ? std::ranges::min(values) : kInfinity;
            const float most = size != 0 ? std::ranges::max(values) : -kInfinity;
            CHECK(smallest(values) == least);
            CHECK(largest(values) == most);
        }
}

TEST_CASE("denormal and infinite floats and the sign of zero count") {
    const TestDevice device;
    if (!device) return;
    Reducer smallest(device, Reduction::min_float);
    Reducer largest(device, Reduction::max_float);
    const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
    const auto extremes = [&](const std::vector<float>& values) {
        return std::pair{bits(smallest(values)), bits(largest(values))};
    };
    CHECK(extremes({0.0f, -0.0f, 0.0f}) == std::pair{bits(-0.0f), bits(0.0f)});
    CHECK(extremes({1e-45f, -1e-45f, 0.0f}) == std::pair{bits(-1e-45f), bits(1e-45f)});
    CHECK(extremes({3.0f, -kInfinity, kInfinity}) == std::pair{bits(-kInfinity), bits(kInfinity)});
    CHECK(extremes({kInfinity, kInfinity}) == std::pair{bits(kInfinity), bits(kInfinity)});
}

TEST_SUITE_END();
