// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/staging_ring.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <vector>

using namespace aglow::vk;

TEST_CASE("ranges in use never overlap and fit the ring") {
    CHECK(rc::check([] {
        const uint64_t bytes = 1024;
        StagingRing ring(bytes);
        struct Range {
            uint64_t batch, start, size;
        };
        std::vector<Range> used;
        uint64_t batch = 1;
        const auto steps =
            *rc::gen::container<std::vector<uint32_t>>(100, rc::gen::arbitrary<uint32_t>());
        for (uint32_t random : steps) {
            uint64_t size = 1 + random % 256;
            auto start = ring.allocate(size);
            while (!start) {
                uint64_t oldest = ring.oldest_batch().value();
                ring.release_until(oldest);
                std::erase_if(used, [&](const Range& range) { return range.batch <= oldest; });
                start = ring.allocate(size);
            }
            RC_ASSERT(*start + size <= bytes);
            for (const Range& range : used)
                RC_ASSERT((*start + size <= range.start || range.start + range.size <= *start));
            used.push_back({batch, *start, size});
            ring.used_by(batch);
            if (random % 3 == 0) ++batch;
        }
    }));
}
