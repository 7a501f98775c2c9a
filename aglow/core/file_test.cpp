// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/file.h"

#include "tests/temporary_folder.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <numeric>
#include <string>

using namespace aglow;
namespace fs = std::filesystem;

namespace {

struct Folder : testing::TemporaryFolder {
    size_t entries() const {
        return static_cast<size_t>(
            std::distance(fs::directory_iterator(path), fs::directory_iterator()));
    }
};

std::vector<uint8_t> counting_bytes(size_t count) {
    std::vector<uint8_t> bytes(count);
    std::iota(bytes.begin(), bytes.end(), uint8_t{1});
    return bytes;
}

}  // namespace

TEST_CASE("what is written is read back, and nothing else is left in the folder") {
    const Folder folder;
    for (const size_t size : {size_t{0}, size_t{1}, size_t{4096}, size_t{100'003}}) {
        const fs::path path = folder.path / "x.bin";
        const std::vector<uint8_t> bytes = counting_bytes(size);
        REQUIRE(write_file(path, bytes));
        const auto read = read_file(path);
        REQUIRE(read);
        CHECK(*read == bytes);
        CHECK(folder.entries() == 1);
    }
}

TEST_CASE("a failed write keeps the old file and leaves no temporary one") {
    const Folder folder;
    const fs::path path = folder.path / "taken";
    fs::create_directory(path);
    const auto status = write_file(path, std::string_view("text"));
    REQUIRE_FALSE(status);
    CHECK(status.error().code == Errc::unreadable);
    CHECK(status.error().context == path.string());
    CHECK(fs::is_directory(path));
    CHECK(folder.entries() == 1);
}

TEST_CASE("devices are neither read nor replaced") {
    CHECK_FALSE(write_file("/dev/null", std::string_view("text")));
    CHECK(fs::is_character_file("/dev/null"));
    const auto read = read_file("/dev/zero");
    REQUIRE_FALSE(read);
    CHECK(read.error().code == Errc::unreadable);
}

TEST_CASE("reading a pipe that nobody writes to fails at once") {
    const Folder folder;
    const fs::path path = folder.path / "pipe";
    REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
    CHECK_FALSE(read_file(path));
}

TEST_CASE("missing files and folders are named in the error") {
    const Folder folder;
    const fs::path missing = folder.path / "no" / "such.glb";
    const auto read = read_file(missing);
    REQUIRE_FALSE(read);
    CHECK(read.error().code == Errc::unreadable);
    CHECK(to_string(read.error()).starts_with(missing.string() + ": "));
    const auto of_folder = read_file(folder.path);
    REQUIRE_FALSE(of_folder);
    CHECK(of_folder.error().message == "is a folder");
    CHECK_FALSE(write_file(missing, std::string_view("text")));
    CHECK(folder.entries() == 0);
}

TEST_CASE("a replaced file keeps its permissions, and a link to it stays a link") {
    const Folder folder;
    const fs::path path = folder.path / "real", link = folder.path / "link";
    REQUIRE(write_file(path, std::string_view("old")));
    fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink("real", link);
    REQUIRE(write_file(link, std::string_view("changed")));
    CHECK(fs::is_symlink(link));
    CHECK(fs::status(path).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
    CHECK(read_file(path)->size() == 7);
}

TEST_CASE("other hard links to a replaced file keep the old bytes") {
    const Folder folder;
    const fs::path path = folder.path / "a", other = folder.path / "b";
    REQUIRE(write_file(path, std::string_view("old")));
    fs::create_hard_link(path, other);
    REQUIRE(write_file(path, std::string_view("changed")));
    CHECK(read_file(other)->size() == 3);  // the file was replaced whole, not written into
}
