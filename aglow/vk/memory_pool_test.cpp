// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/memory_pool.h"

#include "aglow/vk/testing/test_device.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

using namespace aglow;
using namespace aglow::vk;

namespace {

constexpr uint64_t kMiB = uint64_t{1} << 20;

MemoryPool make_pool(const TestDevice& device) {
    return {device->physical().handle, device->get(), device->physical().max_allocation_bytes};
}

Result<Allocation> allocate(MemoryPool& pool, uint64_t bytes, Memory memory = Memory::device) {
    return pool.allocate({bytes, 256, ~0u}, memory, "test");
}

}  // namespace

TEST_CASE("allocations never share memory, and blocks without use go back") {
    TestDevice device;
    if (!device) return;
    CHECK(rc::check([&] {
        MemoryPool pool = make_pool(device);
        std::vector<Allocation> taken;
        uint64_t bytes_in_use = 0;
        const auto steps =
            *rc::gen::container<std::vector<uint32_t>>(40, rc::gen::arbitrary<uint32_t>());
        for (uint32_t random : steps) {
            if (random % 5 < 3 || taken.empty()) {
                auto made = allocate(pool, 1 + random % (20 * kMiB));
                RC_ASSERT(made.has_value());
                RC_ASSERT(made->offset % 256 == 0u);
                for (const Allocation& other : taken) {
                    bool apart = other.memory != made->memory ||
                                 other.offset + other.bytes <= made->offset ||
                                 made->offset + made->bytes <= other.offset;
                    RC_ASSERT(apart);
                }
                bytes_in_use += made->bytes;
                taken.push_back(*made);
            } else {
                std::swap(taken[random % taken.size()], taken.back());
                bytes_in_use -= taken.back().bytes;
                pool.free(taken.back());
                taken.pop_back();
            }
            RC_ASSERT(pool.bytes_in_use() == bytes_in_use);
        }
        for (const Allocation& allocation : taken) pool.free(allocation);
        RC_ASSERT(pool.bytes_in_use() == 0u);
        RC_ASSERT(pool.block_count() <= 1u);
    }));
}

TEST_CASE("small allocations share a block and large ones have their own") {
    TestDevice device;
    if (!device) return;
    MemoryPool pool = make_pool(device);
    auto a = allocate(pool, 1), b = allocate(pool, kMiB), c = allocate(pool, 40 * kMiB);
    REQUIRE((a && b && c));
    CHECK(a->memory == b->memory);
    CHECK(a->memory != c->memory);
    CHECK(pool.block_count() == 2);
    CHECK(pool.peak_bytes() == 41 * kMiB + 256);
    for (const auto* each : {&a, &b, &c}) pool.free(**each);
    CHECK(pool.block_count() == 1);
    CHECK(pool.peak_bytes() == 41 * kMiB + 256);
}

TEST_CASE("memory for the host is mapped, each allocation where it lies") {
    TestDevice device;
    if (!device) return;
    MemoryPool pool = make_pool(device);
    auto a = allocate(pool, 1000, Memory::upload), b = allocate(pool, 1000, Memory::upload);
    REQUIRE((a && b));
    REQUIRE((a->mapped && b->mapped));
    CHECK(static_cast<std::byte*>(b->mapped) - static_cast<std::byte*>(a->mapped) ==
          static_cast<std::ptrdiff_t>(b->offset) - static_cast<std::ptrdiff_t>(a->offset));
    pool.free(*a);
    pool.free(*b);
}

TEST_CASE("a limit holds for all allocations together, and is told as what there is") {
    TestDevice device;
    if (!device) return;
    MemoryPool pool(device->physical().handle, device->get(),
                    device->physical().max_allocation_bytes, 8 * kMiB);
    auto first = allocate(pool, 5 * kMiB), refused = allocate(pool, 3 * kMiB + 1);
    REQUIRE(first);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == Errc::out_of_memory);
    CHECK_MESSAGE(refused.error().message.find("needs 3145729 bytes of GPU memory; 5242880 of "
                                               "8388608 are in use") != std::string::npos,
                  refused.error().message);
    auto second = allocate(pool, 3 * kMiB);
    REQUIRE(second);
    CHECK(pool.bytes_in_use() == 8 * kMiB);
    pool.free(*first);
    pool.free(*second);
}

TEST_CASE("what does not fit says what was asked for, what is used and what there is") {
    TestDevice device;
    if (!device) return;
    MemoryPool pool = make_pool(device);
    auto kept = allocate(pool, kMiB);
    auto refused = allocate(pool, uint64_t{1} << 50);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == Errc::out_of_memory);
    for (const char* part : {"\"test\"", "1125899906842624 bytes", "1048576 of"})
        CHECK_MESSAGE(refused.error().message.find(part) != std::string::npos,
                      refused.error().message);
    pool.free(*kept);
}
