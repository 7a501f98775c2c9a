// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/topology/equal_rows.h"

#include <algorithm>
#include <bit>

namespace aglow::mesh {
namespace {

struct Hashed {
    uint64_t hash;
    uint32_t row;
};

/// Multiplies and mixes word by word; the multiplier is 2^64 over the golden ratio.
uint64_t hash_of(std::span<const uint32_t> words) {
    uint64_t hash = words.size();
    for (const uint32_t word : words) {
        hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return hash;
}

/// Equal rows one after the other, the first of the list in front. Rows of one hash are nearly
/// always equal; where they are not they are sorted.
std::vector<Hashed> sort_rows(const Rows& rows) {
    std::vector<Hashed> sorted(rows.count());
    for (uint32_t i = 0; i < rows.count(); ++i) sorted[i] = {hash_of(rows[i]), i};
    std::ranges::sort(sorted, [](const Hashed& a, const Hashed& b) {
        return a.hash != b.hash ? a.hash < b.hash : a.row < b.row;
    });
    const auto less = [&](const Hashed& a, const Hashed& b) {
        const auto x = rows[a.row], y = rows[b.row];
        return std::ranges::lexicographical_compare(x, y);
    };
    for (auto first = sorted.begin(), last = first; first != sorted.end(); first = last) {
        bool equal = true;
        for (; last != sorted.end() && last->hash == first->hash; ++last)
            equal = equal && std::ranges::equal(rows[first->row], rows[last->row]);
        if (!equal) std::stable_sort(first, last, less);
    }
    return sorted;
}

}  // namespace

void Rows::add(float value) { words_.push_back(std::bit_cast<uint32_t>(value == 0 ? 0 : value)); }

EqualRows find_equal(const Rows& rows) {
    const std::vector<Hashed> sorted = sort_rows(rows);
    std::vector<uint32_t> first(rows.count());  // row that is the first of its class
    for (size_t i = 0; i < sorted.size(); ++i) {
        const uint32_t row = sorted[i].row;
        const bool same = i > 0 && std::ranges::equal(rows[sorted[i - 1].row], rows[row]);
        first[row] = same ? first[sorted[i - 1].row] : row;
    }
    EqualRows classes;
    classes.of.resize(rows.count());
    for (uint32_t i = 0; i < rows.count(); ++i)
        classes.of[i] = first[i] == i ? classes.class_count++ : classes.of[first[i]];
    return classes;
}

}  // namespace aglow::mesh
