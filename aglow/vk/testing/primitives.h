// SPDX-License-Identifier: Apache-2.0
// What the tests of the primitives share: sizes to try, values to fill them with, a stream.
#pragma once
#include "aglow/core/random.h"
#include "aglow/core/testing/demand.h"
#include "aglow/vk/testing/copy.comp.h"
#include "aglow/vk/testing/test_device.h"

#include <algorithm>
#include <span>
#include <vector>

namespace aglow::vk {

/// 0, 1, 2, 3 and all powers of two up to 2^`most` with their neighbours.
inline std::vector<size_t> sizes_up_to(int most) {
    std::vector<size_t> sizes = {0, 1, 2, 3};
    for (int power = 2; power <= most; ++power)
        for (const size_t step : {0, 1, 2}) sizes.push_back((size_t{1} << power) + step - 1);
    return sizes;
}

/// Uniform over all integers that have no bit outside of `mask`.
inline std::vector<uint32_t> random_uints(size_t count, uint32_t mask = ~0u) {
    Pcg32 random(count);
    std::vector<uint32_t> values(count);
    std::ranges::generate(values, [&] { return random.next() & mask; });
    return values;
}

/// A stream whose failures end the test.
struct TestStream {
    explicit TestStream(const TestDevice& device)
        : gpu(device.gpu()),
          stream(device.stream()),
          copy_kernel(demand(Kernel::create(gpu, "copy", shaders::copy_comp))) {}

    template <class T>
    Buffer upload(const std::vector<T>& values) {
        return demand(make_buffer_of(stream, std::span<const T>(values), "input"));
    }
    template <class T>
    Buffer make(size_t count) {
        return demand(stream.make_buffer(count * sizeof(T), "output"));
    }
    template <class T>
    std::vector<T> download(const Buffer& from, size_t count) {
        return demand(stream.download<T>(from, count));
    }
    /// What lies at an address.
    std::vector<uint32_t> download(uint64_t from, size_t count) {
        struct CopyArgs {
            uint32_t first_group, count;
            uint64_t from, to;
        };
        const Buffer to = make<uint32_t>(count);
        stream.barrier();
        stream.run(copy_kernel, CopyArgs{0, static_cast<uint32_t>(count), from, to.address()},
                   group_count(count, 256));
        return download<uint32_t>(to, count);
    }

    Gpu gpu;
    Stream stream;
    Kernel copy_kernel;
};

}  // namespace aglow::vk
