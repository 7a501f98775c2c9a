// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/scan.h"

#include "aglow/vk/testing/primitives.h"

#include <rapidcheck.h>
#include <numeric>

using namespace aglow;
using namespace aglow::vk;

TEST_SUITE_BEGIN("primitives");

namespace {

struct Sums {
    std::vector<uint32_t> prefix;
    uint32_t total = 0;
    bool operator==(const Sums&) const = default;
};

enum class Place : uint8_t { elsewhere, in_place };

struct Scanner : TestStream {
    using TestStream::TestStream;
    Scan scan = demand(Scan::create(gpu));

    Sums device_sums(const std::vector<uint32_t>& values, Place place) {
        demand(scan.reserve(values.size()));
        const Buffer in = upload(values);
        const Buffer out = make<uint32_t>(values.size());
        const Buffer total = make<uint32_t>(1);
        const Buffer& sums = place == Place::in_place ? in : out;
        stream.barrier();
        scan.record(stream, in.address(), sums.address(), values.size(), total.address());
        return {download<uint32_t>(sums, values.size()), download<uint32_t>(total, 1).front()};
    }
};

Sums host_sums(const std::vector<uint32_t>& values) {
    Sums sums{std::vector<uint32_t>(values.size()), 0};
    std::exclusive_scan(values.begin(), values.end(), sums.prefix.begin(), 0u);
    sums.total = std::reduce(values.begin(), values.end(), 0u);
    return sums;
}

}  // namespace

TEST_CASE("prefix sums equal the standard library's at every size") {
    const TestDevice device;
    if (!device) return;
    Scanner scanner(device);
    std::vector<size_t> sizes = sizes_up_to(16);
    sizes.insert(sizes.end(), {(1u << 22) - 1, 1u << 22, (1u << 22) + 1, 1u << 24});
    for (const size_t size : sizes) {
        CAPTURE(size);
        const std::vector<uint32_t> values = random_uints(size);
        CHECK((scanner.device_sums(values, Place::elsewhere) == host_sums(values)));
    }
}

TEST_CASE("prefix sums may replace what they sum") {
    const TestDevice device;
    if (!device) return;
    Scanner scanner(device);
    for (const size_t size : {1u, 2048u, 2049u, 100'000u, (1u << 22) + 1}) {
        CAPTURE(size);
        const std::vector<uint32_t> values = random_uints(size);
        CHECK((scanner.device_sums(values, Place::in_place) == host_sums(values)));
    }
}

TEST_CASE("a scan reserved for many values scans few, and does without a total") {
    const TestDevice device;
    if (!device) return;
    Scanner scanner(device);
    demand(scanner.scan.reserve(1'000'000));
    const std::vector<uint32_t> values = random_uints(5000);
    const Buffer buffer = scanner.upload(values);
    scanner.stream.barrier();
    scanner.scan.record(scanner.stream, buffer.address(), buffer.address(), values.size());
    CHECK((scanner.download<uint32_t>(buffer, values.size()) == host_sums(values).prefix));
}

TEST_CASE("prefix sums hold for any values and any part of an array") {
    const TestDevice device;
    if (!device) return;
    Scanner scanner(device);
    const bool holds = rc::check([&] {
        const auto count = *rc::gen::inRange<size_t>(0, 10'000);
        const auto first = *rc::gen::inRange<size_t>(0, count + 1);
        const auto mask = *rc::gen::arbitrary<uint32_t>();
        const std::vector<uint32_t> values = random_uints(count, mask);
        demand(scanner.scan.reserve(count - first));
        const Buffer in = scanner.upload(values);
        const Buffer out = scanner.upload(values);
        scanner.stream.barrier();
        scanner.scan.record(scanner.stream, in.address() + 4 * first, out.address() + 4 * first,
                            count - first);
        std::vector<uint32_t> expected = values;
        std::exclusive_scan(values.begin() + static_cast<ptrdiff_t>(first), values.end(),
                            expected.begin() + static_cast<ptrdiff_t>(first), 0u);
        RC_ASSERT(scanner.download<uint32_t>(out, count) == expected);
    });
    CHECK(holds);
}

TEST_SUITE_END();
