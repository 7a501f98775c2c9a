// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/image/codecs.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>

#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace aglow::image {
namespace {

/// Highest compression OpenEXR reaches on a flat image, with room to spare, in pixels per byte:
/// a header that promises more was forged or cut off its pixels.
constexpr int64_t kMaxPixelsPerByte = 1 << 14;

class MemoryInput : public Imf::IStream {
public:
    explicit MemoryInput(Bytes bytes) : Imf::IStream("EXR in memory"), bytes_(bytes) {}
    bool read(char out[], int count) override {
        const auto wanted = static_cast<size_t>(count);
        if (count < 0 || position_ > bytes_.size() || wanted > bytes_.size() - position_)
            throw std::runtime_error("unexpected end of file");
        std::memcpy(out, bytes_.data() + position_, wanted);
        position_ += wanted;
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

private:
    Bytes bytes_;
    size_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
public:
    MemoryOutput() : Imf::OStream("EXR in memory") {}
    void write(const char bytes[], int count) override {
        const size_t end = position_ + static_cast<size_t>(count);
        if (end > bytes_.size()) bytes_.resize(end);
        std::memcpy(bytes_.data() + position_, bytes, static_cast<size_t>(count));
        position_ = end;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }
    std::vector<uint8_t> take() { return std::move(bytes_); }

private:
    std::vector<uint8_t> bytes_;
    size_t position_ = 0;
};

struct Window {
    int left = 0, top = 0, width = 0, height = 0;
};

Result<Window> checked_window(const Imf::Header& header, size_t file_bytes) {
    const Imath::Box2i& box = header.dataWindow();
    const int64_t width = int64_t{box.max.x} - box.min.x + 1;
    const int64_t height = int64_t{box.max.y} - box.min.y + 1;
    if (width < 1 || height < 1) return fail(Errc::malformed, "the data window is empty");
    if (width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels)
        return fail(Errc::malformed, fmt::format("{} x {} pixels are too many", width, height));
    if (width * height / kMaxPixelsPerByte > static_cast<int64_t>(file_bytes))
        return fail(Errc::malformed,
                    fmt::format("{} bytes cannot hold {} x {} pixels", file_bytes, width, height));
    return Window{box.min.x, box.min.y, static_cast<int>(width), static_cast<int>(height)};
}

/// Prefix of the layer to show: none where R, G, B or Y stand at the top, else the first layer
/// that has them (`diffuse.` of `diffuse.R`).
Result<std::string> color_layer(const Imf::ChannelList& channels) {
    for (const char* name : {"R", "G", "B", "Y"})
        if (channels.findChannel(name)) return std::string();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const std::string name = channel.name();
        const size_t dot = name.rfind('.');
        if (dot == std::string::npos) continue;
        const std::string last = name.substr(dot + 1);
        if (last == "R" || last == "G" || last == "B" || last == "Y")
            return name.substr(0, dot + 1);
    }
    return fail(Errc::malformed, "has no channel R, G, B or Y");
}

/// Reads `names[i]` into component i of every pixel; channels that do not exist stay 0.
Status read_channels(Imf::InputFile& file, const Window& window,
                     const std::array<std::string, 3>& names, Image& image) {
    char* data = reinterpret_cast<char*>(image.pixels.data());
    Imf::FrameBuffer frame;
    for (size_t i = 0; i < names.size(); ++i) {
        const Imf::Channel* channel = file.header().channels().findChannel(names[i].c_str());
        if (!channel) continue;
        if (channel->xSampling != 1 || channel->ySampling != 1)
            return fail(Errc::unsupported, fmt::format("channel {} is subsampled", names[i]));
        frame.insert(
            names[i].c_str(),
            Imf::Slice::Make(Imf::FLOAT, data + i * sizeof(float), file.header().dataWindow(),
                             sizeof(vec3), sizeof(vec3) * static_cast<size_t>(window.width)));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.top, window.top + window.height - 1);
    return {};
}

/// Luminance with subsampled chroma: OpenEXR's own reader knows how to put them together.
void read_luminance_chroma(Bytes bytes, const Window& window, Image& image) {
    MemoryInput input(bytes);
    Imf::RgbaInputFile file(input);
    Imf::Array2D<Imf::Rgba> pixels(window.height, window.width);
    file.setFrameBuffer(&pixels[0][0] - window.left - std::ptrdiff_t{window.top} * window.width, 1,
                        static_cast<size_t>(window.width));
    file.readPixels(window.top, window.top + window.height - 1);
    for (int y = 0; y < window.height; ++y)
        for (int x = 0; x < window.width; ++x)
            image.at(x, y) = {pixels[y][x].r, pixels[y][x].g, pixels[y][x].b};
}

/// Colours of a file that names other primaries come out as linear Rec. 709 with the same XYZ.
void convert_primaries(const Imf::Header& header, Image& image) {
    if (!Imf::hasChromaticities(header)) return;
    const Imf::Chromaticities from = Imf::chromaticities(header), rec709;
    const auto close = [](const Imath::V2f& a, const Imath::V2f& b) {
        return (a - b).length() < 1e-3f;
    };
    if (close(from.red, rec709.red) && close(from.green, rec709.green) &&
        close(from.blue, rec709.blue) && close(from.white, rec709.white))
        return;
    const Imath::M44f matrix = Imf::RGBtoXYZ(from, 1) * Imf::XYZtoRGB(rec709, 1);
    for (vec3& pixel : image.pixels) {
        const Imath::V3f color = Imath::V3f(pixel.x, pixel.y, pixel.z) * matrix;
        pixel = {color.x, color.y, color.z};
    }
}

Result<Image> read(Bytes bytes) {
    MemoryInput input(bytes);
    Imf::InputFile file(input, 0);  // no threads of OpenEXR's own
    AG_TRY(const Window window, checked_window(file.header(), bytes.size()));
    const Imf::ChannelList& channels = file.header().channels();
    AG_TRY(const std::string layer, color_layer(channels));
    Image image(window.width, window.height);
    const bool grey = channels.findChannel((layer + "Y").c_str());
    if (grey && (channels.findChannel("RY") || channels.findChannel("BY"))) {
        read_luminance_chroma(bytes, window, image);
    } else if (grey) {
        AG_CHECK(read_channels(file, window, {layer + "Y", "", ""}, image));
        for (vec3& pixel : image.pixels) pixel = {pixel.x, pixel.x, pixel.x};
    } else {
        AG_CHECK(read_channels(file, window, {layer + "R", layer + "G", layer + "B"}, image));
    }
    convert_primaries(file.header(), image);
    return image;
}

void write(const Image& image, MemoryOutput& output) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    const char* data = reinterpret_cast<const char*>(image.pixels.data());
    Imf::FrameBuffer frame;
    size_t offset = 0;
    for (const char* name : {"R", "G", "B"}) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        // OpenEXR's slices point to mutable memory even where it only reads from them.
        frame.insert(name, Imf::Slice(Imf::FLOAT, const_cast<char*>(data) + offset, sizeof(vec3),
                                      sizeof(vec3) * static_cast<size_t>(image.width)));
        offset += sizeof(float);
    }
    Imf::addChromaticities(header, Imf::Chromaticities());  // Rec. 709
    Imf::OutputFile file(output, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
}

}  // namespace

Result<Image> decode_exr(Bytes bytes) {
    try {
        return read(bytes);
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the image does not fit into memory");
    } catch (const std::exception& error) {
        return fail(Errc::malformed, fmt::format("cannot be decoded: {}", error.what()));
    }
}

Result<std::vector<uint8_t>> encode_exr(const Image& image) {
    if (image.width < 1 || image.height < 1)
        return fail(Errc::bad_argument, "an image without pixels cannot be an EXR");
    try {
        MemoryOutput output;
        write(image, output);
        return output.take();
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "the image does not fit into memory");
    } catch (const std::exception& error) {
        return fail(Errc::unreadable, fmt::format("cannot be encoded: {}", error.what()));
    }
}

}  // namespace aglow::image
