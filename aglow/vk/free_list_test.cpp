// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/free_list.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <map>

using namespace aglow::vk;

TEST_CASE("ranges never overlap, are aligned, and all comes back") {
    CHECK(rc::check([] {
        const uint64_t total = 1 << 16;
        FreeList list(total);
        std::map<uint64_t, uint64_t> taken;  // offset, bytes
        uint64_t taken_bytes = 0;
        const auto steps =
            *rc::gen::container<std::vector<uint32_t>>(200, rc::gen::arbitrary<uint32_t>());
        for (uint32_t random : steps) {
            if (random % 5 < 3 || taken.empty()) {
                uint64_t bytes = 1 + random / 8 % 4000, alignment = uint64_t{1} << random / 7 % 10;
                auto offset = list.allocate(bytes, alignment);
                if (!offset) continue;
                RC_ASSERT(*offset % alignment == 0u);
                auto next = taken.lower_bound(*offset);
                RC_ASSERT(*offset + bytes <= (next == taken.end() ? total : next->first));
                if (next != taken.begin()) {
                    --next;
                    RC_ASSERT(next->first + next->second <= *offset);
                }
                taken[*offset] = bytes;
                taken_bytes += bytes;
            } else {
                auto range = std::next(taken.begin(), random % taken.size());
                list.free(range->first, range->second);
                taken_bytes -= range->second;
                taken.erase(range);
            }
            RC_ASSERT(list.free_bytes() == total - taken_bytes);
        }
        for (auto [offset, bytes] : taken) list.free(offset, bytes);
        RC_ASSERT(list.unused());
        // What was free in pieces has joined: the whole can be had at once.
        RC_ASSERT(list.allocate(total, 1) == 0u);
    }));
}

TEST_CASE("the smallest range that fits is taken") {
    FreeList list(1000);
    for (uint64_t bytes : {100u, 10u, 50u, 10u, 830u}) REQUIRE(list.allocate(bytes, 1));
    list.free(0, 100);
    list.free(110, 50);
    CHECK(list.allocate(40, 1) == 110u);
    CHECK(list.allocate(60, 1) == 0u);
    CHECK_FALSE(list.allocate(50, 1));
}
