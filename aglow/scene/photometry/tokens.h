// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <string_view>
#include <vector>

namespace aglow::photometry {

inline constexpr int kMostAngles = 1 << 14;      ///< per axis; 0.01 degrees apart are fewer
inline constexpr size_t kMostValues = 1u << 24;  ///< intensities of one luminaire

/// The lines of a text, without their ends (LF, CR LF or CR) and outer blanks.
std::vector<std::string_view> split_lines(std::string_view text);

/// Reads numbers parted by blanks, commas or line ends, one after the other.
class Numbers {
public:
    explicit Numbers(std::string_view text) : rest_(text) {}

    /// Errors  malformed: "<what> is missing" or that it is not a finite number.
    Result<float> next(const char* what);
    /// An integer in [least, most].
    Result<int> next_count(const char* what, int least, int most);
    Result<std::vector<float>> next_list(size_t count, const char* what);

private:
    std::string_view rest_;
};

/// Ascending angles within [least, most] degrees.
Status check_angles(const std::vector<float>& angles, float least, float most, const char* what);

}  // namespace aglow::photometry
