// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace aglow::mesh {

/// Rows of words, of any lengths, to be compared with each other.
class Rows {
public:
    void add(uint32_t word) { words_.push_back(word); }
    void add(float value);  ///< -0 is 0
    void end_row() { begin_.push_back(words_.size()); }

    uint32_t count() const { return static_cast<uint32_t>(begin_.size() - 1); }
    std::span<const uint32_t> operator[](uint32_t i) const {
        return std::span(words_).subspan(begin_[i], begin_[i + 1] - begin_[i]);
    }

private:
    std::vector<size_t> begin_ = {0};
    std::vector<uint32_t> words_;
};

/// Classes of equal rows, numbered in the order in which they first appear.
struct EqualRows {
    std::vector<uint32_t> of;  ///< [row] class
    uint32_t class_count = 0;
};

/// Cost  O(n log n), whatever the rows hold.
EqualRows find_equal(const Rows& rows);

}  // namespace aglow::mesh
