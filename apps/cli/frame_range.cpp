// SPDX-License-Identifier: Apache-2.0
#include "frame_range.h"

#include "options.h"

#include <fmt/format.h>

namespace aglow::cli {

Result<FrameRange> parse_frames(const std::string& text) {
    constexpr int kLast = 999999;
    const size_t colon = text.find(':');
    if (colon == std::string::npos)
        return fail(Errc::bad_argument, fmt::format("\"{}\" is not FIRST:LAST", text));
    AG_TRY(const int64_t first, parse_whole(text.substr(0, colon), 0, kLast));
    AG_TRY(const int64_t last, parse_whole(text.substr(colon + 1), 0, kLast));
    if (first > last)
        return fail(Errc::bad_argument,
                    fmt::format("\"{}\" ends before it begins; give {}:{}", text, last, first));
    return FrameRange{static_cast<int>(first), static_cast<int>(last)};
}

std::filesystem::path numbered(const std::filesystem::path& path, int frame) {
    std::filesystem::path name = path.stem();
    name += fmt::format("-{:04}", frame);
    name += path.extension();
    return path.parent_path() / name;
}

}  // namespace aglow::cli
