// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/image_file.h"
#include "aglow/core/testing/scenes.h"

#include "aglow/core/file.h"
#include "tests/temporary_folder.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <rapidcheck.h>
#include <cmath>
#include <string>

using namespace aglow;
namespace fs = std::filesystem;

namespace {

using Folder = testing::TemporaryFolder;

/// Values over many orders of magnitude, with runs of equal pixels and black.
Image test_image(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float v = std::pow(10.0f, static_cast<float>((x * 7 + y * 3) % 9) - 3);
            image.at(x, y) = x % 5 == 4 ? vec3{0, 0, 0} : vec3{v, 0.5f * v, 0.1f * v};
        }
    for (int x = 0; x < width; ++x) image.at(x, height - 1) = {3, 2, 1};
    return image;
}

std::vector<uint8_t> bytes_of(const Image& image, const Folder& folder, const char* name) {
    REQUIRE(write_image(image, folder.path / name));
    return *read_file(folder.path / name);
}

std::vector<uint8_t> to_bytes(const std::string& text) { return {text.begin(), text.end()}; }

}  // namespace

TEST_CASE("EXR keeps every float as it is") {
    const Folder folder;
    const Image image = test_image(37, 19);
    REQUIRE(write_image(image, folder.path / "x.exr"));
    const auto read = read_image(folder.path / "x.exr");
    REQUIRE(read);
    CHECK(read->width == 37);
    CHECK(read->height == 19);
    CHECK(read->pixels == image.pixels);
}

TEST_CASE("Radiance keeps every channel within 1/256 of the pixel's brightest") {
    const Folder folder;
    for (const int width : {5, 8, 37, 300}) {  // flat lines below 8 pixels, coded from there on
        const Image image = test_image(width, 11);
        REQUIRE(write_image(image, folder.path / "x.hdr"));
        const auto read = read_image(folder.path / "x.hdr");
        REQUIRE(read);
        REQUIRE(read->pixels.size() == image.pixels.size());
        for (size_t i = 0; i < image.pixels.size(); ++i) {
            const vec3 a = image.pixels[i], b = read->pixels[i];
            const float bound = std::max({a.x, a.y, a.z}) / 256 + 1e-30f;
            CHECK(std::abs(a.x - b.x) <= bound);
            CHECK(std::abs(a.y - b.y) <= bound);
            CHECK(std::abs(a.z - b.z) <= bound);
        }
    }
}

TEST_CASE("Radiance neither brightens nor darkens a sky on the whole") {
    const Folder folder;
    Image image(64, 64);
    double sum = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const float v = 1000 + 0.7231f * static_cast<float>(i);
        image.pixels[i] = {v, v, v};
        sum += static_cast<double>(v);
    }
    REQUIRE(write_image(image, folder.path / "x.hdr"));
    const auto read = read_image(folder.path / "x.hdr");
    REQUIRE(read);
    double sum_read = 0;
    for (const vec3 p : read->pixels) sum_read += static_cast<double>(p.y);
    CHECK(sum_read == doctest::Approx(sum).epsilon(2e-4));
}

TEST_CASE("a Radiance file is divided by its exposure and turned as its header says") {
    const std::string pixels("\x80\x80\x80\x81\xff\x80\x80\x81", 8);
    const auto upright = decode_image(
        to_bytes("#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + pixels));
    REQUIRE(upright);
    CHECK(upright->at(0, 0).x == doctest::Approx(128.5 / 256 * 2 / 2));
    CHECK(upright->at(1, 0).x == doctest::Approx(255.5 / 256 * 2 / 2));
    const auto mirrored = decode_image(to_bytes("#?RADIANCE\n\n-Y 1 -X 2\n" + pixels));
    REQUIRE(mirrored);
    CHECK(mirrored->at(0, 0).x > mirrored->at(1, 0).x);
    const auto turned = decode_image(to_bytes("#?RADIANCE\n\n+X 1 +Y 2\n" + pixels));
    REQUIRE(turned);
    CHECK(turned->width == 1);
    CHECK(turned->height == 2);
    CHECK(turned->at(0, 0).x > turned->at(0, 1).x);  // the line runs from bottom to top
}

TEST_CASE("PNG codes linear light as sRGB and gives it back") {
    const Folder folder;
    Image image(3, 1);
    image.at(0, 0) = {0.215861f, 0, 1};
    image.at(1, 0) = {7, -1, 0.5f};
    image.at(2, 0) = {NAN, 0.0031308f, 0.2f};
    REQUIRE(write_image(image, folder.path / "x.PNG"));
    const auto read = read_image(folder.path / "x.PNG");
    REQUIRE(read);
    CHECK(read->at(0, 0).x == doctest::Approx(0.215861).epsilon(1e-3));  // byte 128
    CHECK(read->at(0, 0).z == 1);
    CHECK(read->at(1, 0).x == 1);  // clipped
    CHECK(read->at(1, 0).y == 0);
    CHECK(read->at(1, 0).z == doctest::Approx(0.5).epsilon(5e-3));
    CHECK(read->at(2, 0).x == 0);
}

TEST_CASE("what an image is shows in its bytes, not in its name") {
    const Folder folder;
    const std::vector<uint8_t> exr = bytes_of(test_image(4, 4), folder, "x.exr");
    REQUIRE(write_file(folder.path / "y.png", exr));
    CHECK(read_image(folder.path / "y.png"));
}

TEST_CASE("files cut at any length give an error and never a wrong picture") {
    const Folder folder;
    const Image image = test_image(12, 9);
    for (const char* name : {"x.exr", "x.hdr", "x.png"}) {
        const std::vector<uint8_t> whole = bytes_of(image, folder, name);
        REQUIRE(decode_image(whole));
        // The last chunk of a PNG carries nothing: cuts inside it may be forgiven.
        const size_t end = whole.size() - (std::string(name) == "x.png" ? 12 : 0);
        for (size_t length = 0; length < end; ++length) {
            CAPTURE(name);
            CAPTURE(length);
            const auto cut = decode_image(std::span(whole).first(length));
            REQUIRE_FALSE(cut);
            CHECK(cut.error().code != Errc::unreadable);
        }
    }
}

TEST_CASE("files with any byte changed never crash and never give a value that is not finite") {
    const Folder folder;
    const Image image = test_image(12, 9);
    for (const char* name : {"x.exr", "x.hdr", "x.png"}) {
        const std::vector<uint8_t> whole = bytes_of(image, folder, name);
        for (size_t at = 0; at < whole.size(); ++at)
            for (const uint8_t flip : {uint8_t{0x01}, uint8_t{0x80}, uint8_t{0xff}}) {
                std::vector<uint8_t> changed = whole;
                changed[at] ^= flip;
                const auto decoded = decode_image(changed);
                if (!decoded) continue;
                bool finite = true;
                for (const vec3 p : decoded->pixels)
                    finite = finite && std::isfinite(p.x + p.y + p.z);
                REQUIRE(finite);
            }
    }
}

TEST_CASE("headers that promise more pixels than the file can hold are refused") {
    const auto decoded = decode_image(to_bytes("#?RADIANCE\n\n-Y 16000 +X 16000\nabcd"));
    REQUIRE_FALSE(decoded);
    CHECK(decoded.error().code == Errc::malformed);
    CHECK_FALSE(decode_image(to_bytes("#?RADIANCE\n\n-Y 999999999 +X 999999999\nabcd")));
}

TEST_CASE("an image with a value that is not finite is refused and the pixel named") {
    const Folder folder;
    Image image(4, 3);
    image.at(2, 1).y = kInfinity;
    REQUIRE(write_image(image, folder.path / "x.exr"));
    const auto read = read_image(folder.path / "x.exr");
    REQUIRE_FALSE(read);
    CHECK(read.error().code == Errc::malformed);
    CHECK(read.error().message == "pixel (2, 1) is not finite");
    CHECK(read.error().context == (folder.path / "x.exr").string());
}

TEST_CASE("endings that name no format and images without pixels are bad arguments") {
    const Folder folder;
    CHECK(write_image(Image(1, 1), folder.path / "x.bmp").error().code == Errc::bad_argument);
    for (const char* name : {"x.exr", "x.hdr", "x.png"})
        CHECK(write_image(Image(), folder.path / name).error().code == Errc::bad_argument);
    CHECK(fs::is_empty(folder.path));
}

TEST_CASE("any image survives EXR bit for bit") {
    const Folder folder;
    const bool holds = rc::check([&] {
        const int width = *rc::gen::inRange(1, 40), height = *rc::gen::inRange(1, 40);
        Image image(width, height);
        for (vec3& p : image.pixels)
            p = {static_cast<float>(*rc::gen::inRange(-1'000'000, 1'000'000)) / 7, 1e-3f, 2};
        RC_ASSERT(write_image(image, folder.path / "p.exr").has_value());
        RC_ASSERT(read_image(folder.path / "p.exr")->pixels == image.pixels);
    });
    CHECK(holds);
}

TEST_CASE("published skies are read whole") {
    const fs::path sky = scenes_folder() / "hdri" / "kiara_1_dawn_1k.hdr";
    if (!is_here(sky)) return;
    const auto image = read_image(sky);
    REQUIRE(image);
    CHECK(image->width == 1024);
    CHECK(image->height == 512);
}
