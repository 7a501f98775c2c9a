// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/kernel_rate.h"

#include <doctest/doctest.h>

using namespace aglow::vk;

TEST_CASE("an unknown kernel starts small and grows as it is measured") {
    KernelRate rate;
    const double seconds_per_group = 1e-9;
    uint64_t longest = 0, measured = 0;
    for (int run = 0; run < 12; ++run) {
        KernelRate::Piece piece = rate.next_piece(0.05);
        CHECK(piece.groups <= std::max<uint64_t>(16, 16 * measured));
        CHECK(piece.probe == (run < 7));
        longest = std::max(longest, piece.groups);
        if (run > 0) measured = longest;  // the first run does not count
        rate.add(piece.groups, static_cast<double>(piece.groups) * seconds_per_group);
    }
    CHECK(rate.next_piece(0.05).groups == doctest::Approx(0.05 / seconds_per_group));
}

TEST_CASE("the first run of a kernel, in which it may be compiled, says nothing of its speed") {
    KernelRate rate;
    rate.add(16, 10.0);
    rate.add(16, 16e-6);
    CHECK(rate.next_piece(0.05).seconds_per_group == doctest::Approx(1e-6));
}

TEST_CASE("a rate follows its kernel up and down within a few submits") {
    KernelRate rate;
    auto run = [&](double seconds_per_group) {
        KernelRate::Piece piece = rate.next_piece(0.05);
        double seconds = static_cast<double>(piece.groups) * seconds_per_group;
        rate.add(piece.groups, seconds);
        return seconds;
    };
    for (int i = 0; i < 10; ++i) run(1e-6);
    CHECK(run(10e-6) == doctest::Approx(0.5));  // it cannot be known before
    CHECK(run(10e-6) < 0.06);
    for (int i = 0; i < 5; ++i) run(1e-6);
    CHECK(run(1e-6) == doctest::Approx(0.05).epsilon(0.1));
}

TEST_CASE("many short runs do not hide how fast long ones are") {
    KernelRate rate;
    for (int i = 0; i < 10; ++i) rate.add(65535, 1e-3);
    for (int i = 0; i < 100; ++i) rate.add(1, 10e-6);  // mostly the cost of starting
    CHECK(rate.next_piece(0.05).groups > 65535);
}

TEST_CASE("one group is the least") {
    KernelRate rate(3.0);
    CHECK(rate.next_piece(0.05).groups == 1);
}
