// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/file.h"
#include "aglow/scene/gltf/test_files.h"
#include "aglow/scene/gltf/uri.h"

#include <doctest/doctest.h>
#include <unistd.h>

using namespace aglow;
using namespace aglow::gltf_test;
namespace fs = std::filesystem;

namespace {

/// A folder of its own, removed at the end.
class TemporaryFolder {
public:
    TemporaryFolder()
        : path_(fs::temp_directory_path() / ("aglow_uri_test_" + std::to_string(getpid()))) {
        fs::create_directories(path_ / "scene" / "data");
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    fs::path scene() const { return path_ / "scene"; }

private:
    fs::path path_;
};

std::string with_uri(const std::string& uri) {
    return document(R"("buffers": [{"byteLength": 3, "uri": ")" + uri + "\"}]");
}

}  // namespace

TEST_CASE("files in the folder and below are read, with percent escapes resolved") {
    const TemporaryFolder folder;
    const Bytes bytes{1, 2, 3};
    for (const char* name : {"plain.bin", "data/deep.bin", "with space.bin", "\xc3\xbc.bin"})
        REQUIRE(write_file(folder.scene() / name, bytes).has_value());
    for (const char* uri : {"plain.bin", "./plain.bin", "data/deep.bin", "data/../plain.bin",
                            "with%20space.bin", "with space.bin", "%C3%BC.bin", "%70lain.bin"}) {
        CAPTURE(uri);
        const auto read = gltf::read_uri(uri, folder.scene());
        REQUIRE(read.has_value());
        CHECK(*read == bytes);
        CHECK(load_json(with_uri(uri), folder.scene()).has_value());
    }
}

TEST_CASE("URIs that leave the folder or name anything but a file in it are unreadable") {
    const TemporaryFolder folder;
    REQUIRE(write_file(folder.scene().parent_path() / "secret.bin", Bytes{1, 2, 3}).has_value());
    for (const char* uri : {"../secret.bin",
                            "data/../../secret.bin",
                            "%2e%2e/secret.bin",
                            "..%2fsecret.bin",
                            "/etc/passwd",
                            "%2Fetc%2Fpasswd",
                            "/dev/zero",
                            "file:///etc/passwd",
                            "FILE:/etc/passwd",
                            "http://127.0.0.1/x.bin",
                            "C:/x.bin",
                            "..\\\\secret.bin",
                            "secret.bin%00.bin",
                            "a%0Ab.bin",
                            "",
                            ".",
                            "data/",
                            "data",
                            "missing.bin",
                            "%zz.bin",
                            "%4",
                            "//host/share.bin"}) {
        CAPTURE(uri);
        const auto scene = load_json(with_uri(uri), folder.scene());
        REQUIRE_FALSE(scene.has_value());
        CHECK(scene.error().code == Errc::unreadable);
        CHECK(scene.error().message.starts_with("buffer 0: "));
    }
    CHECK(load_json(with_uri("../secret.bin"), folder.scene()).error().message ==
          "buffer 0: URI \"../secret.bin\" leaves the scene's folder");
}

TEST_CASE("a scene in memory has no folder to read from") {
    const auto scene = load_json(with_uri("plain.bin"));
    REQUIRE_FALSE(scene.has_value());
    CHECK(scene.error().code == Errc::unreadable);
    CHECK(scene.error().message ==
          "buffer 0: URI \"plain.bin\" cannot be read: the scene has no folder");
}

TEST_CASE("data: URIs decode as RFC 2397 and 4648 say") {
    struct Case {
        const char* uri;
        const char* text;
    };
    // The examples of RFC 4648, section 10.
    for (const Case c : {Case{"data:;base64,", ""}, Case{"data:;base64,Zg==", "f"},
                         Case{"data:;base64,Zm8=", "fo"}, Case{"data:;base64,Zm9v", "foo"},
                         Case{"data:application/octet-stream;base64,Zm9vYmFy", "foobar"},
                         Case{"DATA:;base64,Zm8", "fo"}, Case{"data:;base64,Zm8%3D", "fo"},
                         Case{"data:text/plain,a%20b,c", "a b,c"}}) {
        CAPTURE(c.uri);
        const auto bytes = gltf::decode_data_uri(c.uri);
        REQUIRE(bytes.has_value());
        CHECK(std::string(bytes->begin(), bytes->end()) == c.text);
    }
    for (const char* uri : {"data:;base64,Zm9vY", "data:;base64,Z*==", "data:;base64", "data:,%4",
                            "data:;base64,Zm9v YmFy"}) {
        CAPTURE(uri);
        REQUIRE_FALSE(gltf::decode_data_uri(uri).has_value());
        CHECK(gltf::decode_data_uri(uri).error().code == Errc::malformed);
    }
}

TEST_CASE(
    "a material's image file that is missing is unreadable, one that does not decode malformed") {
    const TemporaryFolder folder;
    const std::string rest =
        R"("textures": [{"source": 0}],
           "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])";
    const auto missing = load_json(
        document(R"("images": [{"name": "wood", "uri": "wood.png"}], )" + rest), folder.scene());
    REQUIRE_FALSE(missing.has_value());
    CHECK(missing.error().code == Errc::unreadable);
    CHECK(missing.error().message.starts_with("image 0 \"wood\": "));

    const Bytes broken{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 1, 2, 3};
    const auto damaged =
        load_json(document(R"("images": [{"name": "wood", "uri": "data:image/png;base64,)" +
                           base64(broken) + "\"}], " + rest));
    REQUIRE_FALSE(damaged.has_value());
    CHECK(damaged.error().code == Errc::malformed);
    CHECK(damaged.error().message == "image 0 \"wood\": the image does not decode");

    const auto foreign =
        load_json(document(R"("images": [{"uri": "data:image/gif;base64,)" +
                           base64(Bytes{'G', 'I', 'F', '8', '9', 'a', 0, 0}) + "\"}], " + rest));
    REQUIRE_FALSE(foreign.has_value());
    CHECK(foreign.error().code == Errc::unsupported);
}
