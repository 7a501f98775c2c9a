// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/radix_sort.h"

#include "aglow/vk/testing/primitives.h"

#include <rapidcheck.h>
#include <numeric>

using namespace aglow;
using namespace aglow::vk;

TEST_SUITE_BEGIN("primitives");

namespace {

struct Pairs {
    std::vector<uint32_t> keys, values;
    bool operator==(const Pairs&) const = default;
};

/// Values are the places of the keys before sorting, so they tell whether equal keys kept their
/// order.
struct Sorter : TestStream {
    explicit Sorter(const TestDevice& device)
        : Sorter(device, demand(RadixSort::create(device.gpu()))) {}
    Sorter(const TestDevice& device, RadixSort sorter)
        : TestStream(device), sort(std::move(sorter)) {}

    RadixSort sort;

    Pairs device_sorted(const std::vector<uint32_t>& keys, uint32_t key_bits) {
        demand(sort.reserve(keys.size()));
        std::vector<uint32_t> places(keys.size());
        std::iota(places.begin(), places.end(), 0u);
        const Buffer key_buffer = upload(keys);
        const Buffer value_buffer = upload(places);
        stream.barrier();
        const Sorted sorted = sort.record(stream, key_buffer.address(), value_buffer.address(),
                                          keys.size(), key_bits);
        return {download(sorted.keys, keys.size()), download(sorted.values, keys.size())};
    }
};

Pairs host_sorted(const std::vector<uint32_t>& keys) {
    Pairs pairs{std::vector<uint32_t>(keys.size()), std::vector<uint32_t>(keys.size())};
    std::iota(pairs.values.begin(), pairs.values.end(), 0u);
    std::ranges::stable_sort(pairs.values, {}, [&](uint32_t i) { return keys[i]; });
    std::ranges::transform(pairs.values, pairs.keys.begin(), [&](uint32_t i) { return keys[i]; });
    return pairs;
}

/// Sorted by keys, then by the places of the keys before; all of these were there.
bool is_stable_sort(const Pairs& sorted, const std::vector<uint32_t>& keys) {
    if (sorted.keys.size() != keys.size()) return false;
    for (size_t i = 0; i < keys.size(); ++i) {
        if (sorted.values[i] >= keys.size() || keys[sorted.values[i]] != sorted.keys[i])
            return false;
        if (i == 0) continue;
        const auto pair = [&](size_t k) { return std::pair{sorted.keys[k], sorted.values[k]}; };
        if (!(pair(i - 1) < pair(i))) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("sorting equals the standard library's stable sort at every size") {
    const TestDevice device;
    if (!device) return;
    Sorter sorter(device);
    std::vector<size_t> sizes = sizes_up_to(16);
    sizes.insert(sizes.end(), {(1u << 20) - 1, 1u << 20, (1u << 20) + 1});
    for (const size_t size : sizes) {
        CAPTURE(size);
        const std::vector<uint32_t> keys = random_uints(size);
        CHECK((sorter.device_sorted(keys, 32) == host_sorted(keys)));
    }
}

TEST_CASE("2^24 pairs are sorted, each once and equal keys in order") {
    const TestDevice device;
    if (!device) return;
    Sorter sorter(device);
    const std::vector<uint32_t> keys = random_uints((1u << 24) + 1, 0xfffffu);
    CHECK(is_stable_sort(sorter.device_sorted(keys, 20), keys));
}

TEST_CASE("keys of any width are sorted, and equal ones keep their order") {
    const TestDevice device;
    if (!device) return;
    Sorter sorter(device);
    for (const uint32_t bits : {1u, 7u, 8u, 9u, 12u, 16u, 17u, 20u, 25u, 31u, 32u})
        for (const size_t size : {1u, 2u, 100u, 4097u, 70'000u}) {
            CAPTURE(bits);
            CAPTURE(size);
            const std::vector<uint32_t> keys = random_uints(size, ~0u >> (32 - bits));
            CHECK((sorter.device_sorted(keys, bits) == host_sorted(keys)));
        }
}

TEST_CASE("keys of no bits stay where they are") {
    const TestDevice device;
    if (!device) return;
    Sorter sorter(device);
    const std::vector<uint32_t> keys(1000, 0);
    CHECK((sorter.device_sorted(keys, 0) == host_sorted(keys)));
}

TEST_CASE("keys in any order and of any frequency are sorted stably") {
    const TestDevice device;
    if (!device) return;
    Sorter sorter(device);
    using Key = uint32_t (*)(uint32_t i);
    for (const Key key :
         {Key([](uint32_t) { return ~0u; }), Key([](uint32_t) { return 0u; }),
          Key([](uint32_t i) { return i; }), Key([](uint32_t i) { return ~i; }),
          Key([](uint32_t i) { return i / 1000; }), Key([](uint32_t i) { return (i % 2) << 31; }),
          Key([](uint32_t i) { return (i % 7 == 0) ? 0x80000000u : 0u; }),
          Key([](uint32_t i) { return (i * 2654435761u) & 0x03000300u; }),
          Key([](uint32_t i) { return i * 2654435761u; })})
        for (const uint32_t size : {5u, 511u, 4096u, 300'001u}) {
            CAPTURE(size);
            std::vector<uint32_t> keys(size);
            for (uint32_t i = 0; i < size; ++i) keys[i] = key(i);
            CAPTURE(keys[1]);
            CHECK((sorter.device_sorted(keys, 32) == host_sorted(keys)));
        }
}

TEST_CASE("a sorter without memory says so, and sorts once it has got it") {
    for (int failing = 0;; ++failing) {
        CAPTURE(failing);
        DeviceOptions options;
        options.faults.fail_allocation = failing;
        const TestDevice device(options);
        if (!device) return;
        auto sort = demand(RadixSort::create(device.gpu()));
        const Status reserved = sort.reserve(10'000);
        if (reserved) {
            CHECK(failing == device->allocation_count());
            CHECK(failing == 4);  // keys, values, counts, sums of the counts
            return;
        }
        CHECK(reserved.error().code == Errc::out_of_memory);
        Sorter sorter(device, std::move(sort));
        const std::vector<uint32_t> keys = random_uints(10'000);
        CHECK((sorter.device_sorted(keys, 32) == host_sorted(keys)));
    }
}

TEST_CASE("any keys are sorted stably") {
    const TestDevice device;
    if (!device) return;
    Sorter sorter(device);
    const bool holds = rc::check([&] {
        const auto bits = *rc::gen::inRange<uint32_t>(1, 33);
        const auto size = *rc::gen::inRange<size_t>(0, 12'000);
        const auto mask = *rc::gen::arbitrary<uint32_t>() & (~0u >> (32 - bits));
        const std::vector<uint32_t> keys = random_uints(size, mask);
        RC_ASSERT((sorter.device_sorted(keys, bits) == host_sorted(keys)));
    });
    CHECK(holds);
}

TEST_SUITE_END();
