// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/compact.h"

#include "aglow/vk/testing/primitives.h"

#include <rapidcheck.h>

using namespace aglow;
using namespace aglow::vk;

TEST_SUITE_BEGIN("primitives");

namespace {

struct Compactor : TestStream {
    using TestStream::TestStream;
    Compact compact = demand(Compact::create(gpu));

    /// The indices kept, or all that there is room for if their number comes out wrong.
    std::vector<uint32_t> kept(const std::vector<uint32_t>& flags) {
        demand(compact.reserve(flags.size()));
        const Buffer in = upload(flags);
        const Buffer indices = make<uint32_t>(flags.size());
        const Buffer count = make<uint32_t>(1);
        stream.barrier();
        compact.record(stream, in.address(), flags.size(), indices.address(), count.address());
        const size_t number = download<uint32_t>(count, 1).front();
        return download<uint32_t>(indices, std::min(number, flags.size()));
    }
};

std::vector<uint32_t> set_flags(const std::vector<uint32_t>& flags) {
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < flags.size(); ++i)
        if (flags[i] != 0) indices.push_back(i);
    return indices;
}

}  // namespace

TEST_CASE("what is kept stands in order at every size, whatever bit of a flag is set") {
    const TestDevice device;
    if (!device) return;
    Compactor compactor(device);
    std::vector<size_t> sizes = sizes_up_to(14);
    sizes.insert(sizes.end(), {(1u << 20) - 1, 1u << 20, (1u << 20) + 1});
    for (const size_t size : sizes)
        for (const uint32_t mask : {0u, ~0u, 1u, 0x80000000u, 0x11000000u}) {
            CAPTURE(size);
            CAPTURE(mask);
            const std::vector<uint32_t> flags = random_uints(size, mask);
            CHECK((compactor.kept(flags) == set_flags(flags)));
        }
}

TEST_CASE("compaction keeps runs of any length") {
    const TestDevice device;
    if (!device) return;
    Compactor compactor(device);
    const bool holds = rc::check([&] {
        std::vector<uint32_t> flags;
        for (const auto length :
             *rc::gen::container<std::vector<size_t>>(rc::gen::weightedOneOf<size_t>(
                 {{3, rc::gen::inRange<size_t>(0, 20)}, {1, rc::gen::inRange<size_t>(0, 3000)}})))
            flags.resize(flags.size() + length, flags.empty() ? 0 : 1 - flags.back());
        RC_ASSERT(compactor.kept(flags) == set_flags(flags));
    });
    CHECK(holds);
}

TEST_SUITE_END();
