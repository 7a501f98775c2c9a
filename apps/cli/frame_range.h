// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <filesystem>
#include <string>

namespace aglow::cli {

/// Frames first to last, both included.
struct FrameRange {
    int first = 0, last = 0;
};

/// "A:B" with 0 <= A <= B. Errors: bad_argument.
Result<FrameRange> parse_frames(const std::string& text);

/// out.png and 7: out-0007.png
std::filesystem::path numbered(const std::filesystem::path& path, int frame);

}  // namespace aglow::cli
