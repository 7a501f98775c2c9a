// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/segmented_bounds.h"

#include "aglow/shared/ray.h"
#include "aglow/vk/testing/primitives.h"

#include <rapidcheck.h>

#include <bit>
#include <cstring>
#include <limits>
#include <numeric>

using namespace aglow;
using namespace aglow::vk;
using shared::Bounds;

TEST_SUITE_BEGIN("primitives");

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr Bounds kNothing{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

struct Bounder : TestStream {
    using TestStream::TestStream;
    SegmentedBounds bounds = demand(SegmentedBounds::create(gpu));

    std::vector<Bounds> device_bounds(const std::vector<Bounds>& boxes,
                                      const std::vector<uint32_t>& starts) {
        const size_t segments = starts.size() - 1;
        const Buffer box_buffer = upload(boxes);
        const Buffer start_buffer = upload(starts);
        const Buffer out = make<Bounds>(segments);
        stream.barrier();
        bounds.record(stream, box_buffer.address(), boxes.size(), start_buffer.address(), segments,
                      out.address());
        return download<Bounds>(out, segments);
    }
};

std::vector<Bounds> host_bounds(const std::vector<Bounds>& boxes,
                                const std::vector<uint32_t>& starts) {
    std::vector<Bounds> bounds(starts.size() - 1, kNothing);
    for (size_t s = 0; s < bounds.size(); ++s)
        for (uint32_t i = starts[s]; i < starts[s + 1]; ++i)
            bounds[s] = {min(bounds[s].lower, boxes[i].lower),
                         max(bounds[s].upper, boxes[i].upper)};
    return bounds;
}

bool same_bits(const std::vector<Bounds>& a, const std::vector<Bounds>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Bounds)) == 0);
}

std::vector<Bounds> random_boxes(size_t count) {
    Pcg32 random(count);
    const auto coordinate = [&] { return 200 * random.uniform() - 100; };
    std::vector<Bounds> boxes(count);
    for (Bounds& box : boxes) {
        box.lower = {coordinate(), coordinate(), coordinate()};
        box.upper = box.lower + shared::vec3{random.uniform(), random.uniform(), random.uniform()};
    }
    return boxes;
}

/// Starts of segments of these lengths.
std::vector<uint32_t> starts_of(const std::vector<uint32_t>& lengths) {
    std::vector<uint32_t> starts(lengths.size() + 1, 0);
    std::partial_sum(lengths.begin(), lengths.end(), starts.begin() + 1);
    return starts;
}

void check_lengths(Bounder& bounder, const std::vector<uint32_t>& lengths) {
    CAPTURE(lengths.size());
    const std::vector<uint32_t> starts = starts_of(lengths);
    const std::vector<Bounds> boxes = random_boxes(starts.back());
    CHECK(same_bits(bounder.device_bounds(boxes, starts), host_bounds(boxes, starts)));
}

}  // namespace

TEST_CASE("one segment that holds all is bounded at every size") {
    const TestDevice device;
    if (!device) return;
    Bounder bounder(device);
    std::vector<size_t> sizes = sizes_up_to(14);
    sizes.insert(sizes.end(), {(1u << 20) - 1, 1u << 20, (1u << 20) + 1});
    for (const size_t size : sizes) check_lengths(bounder, {static_cast<uint32_t>(size)});
}

TEST_CASE("segments of one length are bounded, whether or not it divides the work") {
    const TestDevice device;
    if (!device) return;
    Bounder bounder(device);
    for (const uint32_t length :
         {1u, 2u, 3u, 7u, 8u, 9u, 15u, 16u, 17u, 127u, 128u, 129u, 4095u, 4096u, 4097u})
        check_lengths(bounder, std::vector<uint32_t>(50'000 / length + 1, length));
    check_lengths(bounder, std::vector<uint32_t>(1u << 21, 1));
}

TEST_CASE("an empty segment has the bounds of nothing, wherever it stands") {
    const TestDevice device;
    if (!device) return;
    Bounder bounder(device);
    check_lengths(bounder, {});
    check_lengths(bounder, {0});
    check_lengths(bounder, {0, 0, 5, 0, 3, 0, 0, 2100, 0});
    std::vector<uint32_t> lengths(1u << 20, 0);
    check_lengths(bounder, lengths);
    lengths[1u << 19] = 10'000;
    lengths[(1u << 19) + 7] = 1;
    check_lengths(bounder, lengths);
}

TEST_CASE("boxes that hold nothing, and zeros of either sign, keep their order") {
    const TestDevice device;
    if (!device) return;
    Bounder bounder(device);
    const Bounds zeros{{0.0f, -0.0f, 0.0f}, {0.0f, -0.0f, -0.0f}};
    const Bounds others{{-0.0f, -0.0f, 0.0f}, {-0.0f, -0.0f, 0.0f}};
    const Bounds both{{-0.0f, -0.0f, 0.0f}, {0.0f, -0.0f, 0.0f}};
    const std::vector<Bounds> found = bounder.device_bounds(
        {zeros, others, kNothing, kNothing, zeros, kNothing, others}, {0, 2, 4, 7});
    CHECK(same_bits(found, {both, kNothing, both}));
}

TEST_CASE("segments of any lengths are bounded") {
    const TestDevice device;
    if (!device) return;
    Bounder bounder(device);
    const bool holds = rc::check([&] {
        const auto length = rc::gen::weightedOneOf<uint32_t>({{2, rc::gen::just(0u)},
                                                              {4, rc::gen::inRange(1u, 20u)},
                                                              {1, rc::gen::inRange(1u, 3000u)}});
        const std::vector<uint32_t> starts =
            starts_of(*rc::gen::container<std::vector<uint32_t>>(length));
        const std::vector<Bounds> boxes = random_boxes(starts.back());
        RC_ASSERT(same_bits(bounder.device_bounds(boxes, starts), host_bounds(boxes, starts)));
    });
    CHECK(holds);
}

TEST_SUITE_END();
