// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/image/codecs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

namespace aglow::image {
namespace {

constexpr int kExponentBias = 128 + 8;  // mantissas are 8-bit integers
constexpr int kMinRunLengthWidth = 8;   // shorter and longer lines are never run-length coded
constexpr int kMaxRunLengthWidth = 0x7fff;

using Rgbe = std::array<uint8_t, 4>;

/// Mantissas are truncated when written, so the middle of their interval is read: without the
/// half, a whole sky would come out darker by a quarter of a per cent.
vec3 decode_pixel(Rgbe p) {
    if (p[3] == 0) return {0, 0, 0};
    const float scale = std::ldexp(1.0f, p[3] - kExponentBias);
    const auto channel = [&](uint8_t m) { return (static_cast<float>(m) + 0.5f) * scale; };
    return {channel(p[0]), channel(p[1]), channel(p[2])};
}

Rgbe encode_pixel(vec3 c) {
    const float largest = std::max({c.x, c.y, c.z});
    int exponent = 0;
    if (!(largest > 1e-32f)) return {0, 0, 0, 0};
    std::frexp(std::min(largest, 1e38f), &exponent);
    const float scale = std::ldexp(1.0f, 8 - exponent);
    const auto mantissa = [&](float v) {
        return static_cast<uint8_t>(std::clamp(v * scale, 0.0f, 255.0f));
    };
    return {mantissa(c.x), mantissa(c.y), mantissa(c.z), static_cast<uint8_t>(exponent + 128)};
}

class Reader {
public:
    explicit Reader(Bytes bytes) : rest_(bytes) {}

    /// One line of the header without its end; false at the end of the file.
    bool line(std::string& text) {
        const auto end = std::find(rest_.begin(), rest_.end(), static_cast<uint8_t>('\n'));
        if (end == rest_.end()) return false;
        text.assign(rest_.begin(), end);
        if (!text.empty() && text.back() == '\r') text.pop_back();
        rest_ = rest_.subspan(static_cast<size_t>(end - rest_.begin()) + 1);
        return true;
    }
    bool bytes(std::span<uint8_t> out) {
        if (rest_.size() < out.size()) return false;
        std::copy_n(rest_.begin(), out.size(), out.begin());
        rest_ = rest_.subspan(out.size());
        return true;
    }
    bool pixel(Rgbe& out) { return bytes(out); }
    size_t left() const { return rest_.size(); }

private:
    Bytes rest_;
};

/// The lines of pixels in file order: which way they run is said by the resolution line.
struct Layout {
    int line_count = 0, line_length = 0;
    bool lines_are_rows = true;
    bool flip_x = false, flip_y = false;

    int width() const { return lines_are_rows ? line_length : line_count; }
    int height() const { return lines_are_rows ? line_count : line_length; }
    size_t index(int line, int i) const {
        const int x = lines_are_rows ? i : line, y = lines_are_rows ? line : i;
        const int column = flip_x ? width() - 1 - x : x, row = flip_y ? height() - 1 - y : y;
        return static_cast<size_t>(row) * static_cast<size_t>(width()) +
               static_cast<size_t>(column);
    }
};

/// `-Y 512 +X 1024`: rows from top to bottom, each from left to right; and the seven others.
Result<Layout> parse_layout(const std::string& text) {
    char signs[2], axes[2];
    int counts[2];
    const auto bad = [&] {
        return fail(Errc::malformed,
                    fmt::format("resolution line \"{}\" makes no sense", text.substr(0, 40)));
    };
    if (std::sscanf(text.c_str(), "%c%c %9d %c%c %9d", &signs[0], &axes[0], &counts[0], &signs[1],
                    &axes[1], &counts[1]) != 6)
        return bad();
    Layout layout;
    layout.line_count = counts[0];
    layout.line_length = counts[1];
    layout.lines_are_rows = axes[0] == 'Y';
    for (int i = 0; i < 2; ++i) {
        if (signs[i] != '+' && signs[i] != '-') return bad();
        if (axes[i] == 'Y')
            layout.flip_y = signs[i] == '+';
        else if (axes[i] == 'X')
            layout.flip_x = signs[i] == '-';
        else
            return bad();
    }
    if (axes[0] == axes[1] || counts[0] < 1 || counts[1] < 1) return bad();
    if (int64_t{counts[0]} * counts[1] > kMaxPixels)
        return fail(Errc::malformed,
                    fmt::format("{} x {} pixels are too many", counts[0], counts[1]));
    return layout;
}

struct Header {
    Layout layout;
    float exposure = 1;
};

Result<Header> read_header(Reader& reader) {
    Header header;
    std::string line;
    while (reader.line(line) && !line.empty()) {
        constexpr std::string_view kFormat = "FORMAT=", kExposure = "EXPOSURE=";
        if (line.starts_with(kFormat) && line.substr(kFormat.size()) != "32-bit_rle_rgbe")
            return fail(Errc::unsupported, fmt::format("pixel format \"{}\" is not 32-bit_rle_rgbe",
                                                       line.substr(kFormat.size(), 40)));
        if (line.starts_with(kExposure))
            header.exposure *= std::strtof(line.c_str() + kExposure.size(), nullptr);
    }
    if (!(header.exposure > 0) || !std::isfinite(header.exposure))
        return fail(Errc::malformed, "EXPOSURE is not a positive number");
    if (!reader.line(line)) return fail(Errc::malformed, "ends inside the header");
    AG_TRY(header.layout, parse_layout(line));
    return header;
}

/// One component of a line: counts above 128 repeat a byte, others copy that many.
bool read_component(Reader& reader, std::span<Rgbe> line, size_t component) {
    size_t filled = 0;
    while (filled < line.size()) {
        uint8_t head[2];
        if (!reader.bytes(std::span(head, 1))) return false;
        const bool repeats = head[0] > 128;
        const size_t count = repeats ? head[0] - 128u : head[0];
        if (count == 0 || count > line.size() - filled) return false;
        if (repeats && !reader.bytes(std::span(&head[1], 1))) return false;
        for (size_t i = 0; i < count; ++i) {
            if (!repeats && !reader.bytes(std::span(&head[1], 1))) return false;
            line[filled++][component] = head[1];
        }
    }
    return true;
}

/// Flat pixels, where (1, 1, 1, n) repeats the pixel before it: the oldest coding.
bool read_flat(Reader& reader, std::span<Rgbe> line, Rgbe first) {
    size_t filled = 0;
    int shift = 0;
    for (Rgbe pixel = first;;) {
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
            const size_t count = shift < 32 ? size_t{pixel[3]} << shift : SIZE_MAX;
            if (filled == 0 || count > line.size() - filled) return false;
            std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(filled), count,
                        line[filled - 1]);
            filled += count;
            shift += 8;
        } else {
            line[filled++] = pixel;
            shift = 0;
        }
        if (filled == line.size()) return true;
        if (!reader.pixel(pixel)) return false;
    }
}

bool read_line(Reader& reader, std::span<Rgbe> line) {
    Rgbe first;
    if (!reader.pixel(first)) return false;
    const bool may_be_coded =
        line.size() >= kMinRunLengthWidth && line.size() <= kMaxRunLengthWidth;
    if (!may_be_coded || first[0] != 2 || first[1] != 2 || (first[2] & 0x80) != 0)
        return read_flat(reader, line, first);
    if (static_cast<size_t>(first[2] << 8 | first[3]) != line.size()) return false;
    for (size_t component = 0; component < 4; ++component)
        if (!read_component(reader, line, component)) return false;
    return true;
}

size_t run_length(std::span<const Rgbe> line, size_t begin, size_t component) {
    size_t end = begin + 1;
    while (end < line.size() && end - begin < 127 && line[end][component] == line[begin][component])
        ++end;
    return end - begin;
}

void append_component(std::span<const Rgbe> line, size_t component, std::vector<uint8_t>& out) {
    constexpr size_t kShortestRun = 3;  // a run costs two bytes
    size_t i = 0;
    while (i < line.size()) {
        const size_t run = run_length(line, i, component);
        if (run >= kShortestRun) {
            out.insert(out.end(), {static_cast<uint8_t>(128 + run), line[i][component]});
            i += run;
            continue;
        }
        const size_t begin = i;
        while (i < line.size() && i - begin < 128 && run_length(line, i, component) < kShortestRun)
            ++i;
        out.push_back(static_cast<uint8_t>(i - begin));
        for (size_t k = begin; k < i; ++k) out.push_back(line[k][component]);
    }
}

}  // namespace

Result<Image> decode_radiance(Bytes bytes) {
    Reader reader(bytes);
    AG_TRY(const Header header, read_header(reader));
    const Layout& layout = header.layout;
    // A run of 127 equal pixels costs at least 8 bytes, the oldest coding's longest run far less
    // per pixel; either way a file far smaller than its image was cut.
    if (static_cast<size_t>(layout.line_count) > reader.left())
        return fail(Errc::malformed, fmt::format("ends before its {} lines", layout.line_count));
    Image image(layout.width(), layout.height());
    std::vector<Rgbe> line(static_cast<size_t>(layout.line_length));
    for (int y = 0; y < layout.line_count; ++y) {
        if (!read_line(reader, line))
            return fail(Errc::malformed,
                        fmt::format("line {} of {} is cut or broken", y, layout.line_count));
        for (int x = 0; x < layout.line_length; ++x)
            image.pixels[layout.index(y, x)] =
                decode_pixel(line[static_cast<size_t>(x)]) / header.exposure;
    }
    return image;
}

Result<std::vector<uint8_t>> encode_radiance(const Image& image) {
    if (image.width < 1 || image.height < 1)
        return fail(Errc::bad_argument, "an image without pixels cannot be a Radiance file");
    const std::string header = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n",
                                           image.height, image.width);
    std::vector<uint8_t> out(header.begin(), header.end());
    std::vector<Rgbe> line(static_cast<size_t>(image.width));
    const bool coded = image.width >= kMinRunLengthWidth && image.width <= kMaxRunLengthWidth;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            line[static_cast<size_t>(x)] = encode_pixel(image.at(x, y));
        if (!coded) {
            for (const Rgbe& pixel : line) out.insert(out.end(), pixel.begin(), pixel.end());
            continue;
        }
        out.insert(out.end(), {2, 2, static_cast<uint8_t>(image.width >> 8),
                               static_cast<uint8_t>(image.width & 0xff)});
        for (size_t component = 0; component < 4; ++component)
            append_component(line, component, out);
    }
    return out;
}

}  // namespace aglow::image
