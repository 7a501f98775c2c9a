// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>
#include <string>
#include <system_error>

namespace aglow {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxFileBytes = size_t{1} << 34;  // 16 GiB
constexpr mode_t kNewFileMode = 0666;              // the process's umask takes its part away
constexpr mode_t kPermissionBits = 07777;

/// Sole owner of a file descriptor.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return number_; }
    bool close() { return ::close(std::exchange(number_, -1)) == 0; }

private:
    int number_;
};

/// Removes a temporary file unless it was renamed to its final place.
struct Temporary {
    fs::path path;
    bool kept = false;
    ~Temporary() {
        if (!kept) ::unlink(path.c_str());
    }
};

tl::unexpected<Error> system_failure(const char* what, const fs::path& path) {
    const std::string reason = std::generic_category().message(errno);
    return fail(Errc::unreadable, fmt::format("{}: {}", what, reason), path.string());
}

bool retryable(ssize_t count) { return count < 0 && errno == EINTR; }

/// Reads to the end, which need not be where it was when the file was opened.
Status read_to_end(int descriptor, std::vector<uint8_t>& bytes, const fs::path& path) {
    size_t filled = 0;
    for (;;) {
        if (filled == bytes.size()) bytes.resize(bytes.size() + bytes.size() / 2 + 4096);
        const ssize_t count = ::read(descriptor, bytes.data() + filled, bytes.size() - filled);
        if (retryable(count)) continue;
        if (count < 0) return system_failure("cannot be read", path);
        if (count == 0) break;
        filled += static_cast<size_t>(count);
        if (filled > kMaxFileBytes)
            return fail(Errc::unreadable, "is larger than 16 GiB", path.string());
    }
    bytes.resize(filled);
    return {};
}

Status write_all(int descriptor, std::span<const uint8_t> bytes, const fs::path& path) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
        if (retryable(count)) continue;
        if (count < 0) return system_failure("cannot be written", path);
        bytes = bytes.subspan(static_cast<size_t>(count));
    }
    return {};
}

/// Where the bytes must land so that a symbolic link stays one; only files may be replaced.
Result<fs::path> final_place(const fs::path& path) {
    std::error_code ignored;
    fs::path place = path;
    if (fs::is_symlink(fs::symlink_status(path, ignored))) {
        const fs::path target = fs::weakly_canonical(path, ignored);
        if (!ignored) place = target;
    }
    const fs::file_status status = fs::status(place, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status))
        return fail(Errc::unreadable, "cannot be written: it exists and is not a file",
                    path.string());
    if (!place.has_filename())
        return fail(Errc::unreadable, "cannot be written: it names no file", path.string());
    return place;
}

/// Opens a file that did not exist before, beside `place` so that a rename stays atomic.
int open_temporary(const fs::path& place, fs::path& temporary) {
    for (int attempt = 0; attempt < 1000; ++attempt) {
        temporary = place.parent_path() / fmt::format(".aglow-{}-{}.tmp", ::getpid(), attempt);
        const int descriptor =
            ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
        if (descriptor >= 0 || errno != EEXIST) return descriptor;
    }
    return -1;
}

/// A file that is replaced keeps its permissions. Best effort: it may belong to someone else.
void copy_permissions(const fs::path& from, int to) {
    struct stat old = {};
    if (::stat(from.c_str(), &old) == 0 && ::fchmod(to, old.st_mode & kPermissionBits) != 0)
        errno = 0;
}

/// Makes a rename survive a power cut. File systems that cannot are no reason to fail.
void flush_folder(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (descriptor.get() >= 0 && ::fsync(descriptor.get()) != 0) errno = 0;
}

}  // namespace

Result<std::vector<uint8_t>> read_file(const fs::path& path) {
    try {
        // Without O_NONBLOCK, opening a pipe that nobody writes to would never return.
        const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
        if (file.get() < 0) return system_failure("cannot be opened", path);
        struct stat status = {};
        if (::fstat(file.get(), &status) != 0) return system_failure("cannot be read", path);
        if (S_ISDIR(status.st_mode)) return fail(Errc::unreadable, "is a folder", path.string());
        if (!S_ISREG(status.st_mode))
            return fail(Errc::unreadable, "is not a file but a device or pipe", path.string());
        if (static_cast<size_t>(status.st_size) > kMaxFileBytes)
            return fail(Errc::unreadable, "is larger than 16 GiB", path.string());
        std::vector<uint8_t> bytes(static_cast<size_t>(status.st_size) + 1);
        AG_CHECK(read_to_end(file.get(), bytes, path));
        return bytes;
    } catch (const std::bad_alloc&) {
        return fail(Errc::out_of_memory, "does not fit into memory", path.string());
    }
}

Status write_file(const fs::path& path, std::span<const uint8_t> bytes) {
    AG_TRY(const fs::path place, final_place(path));
    Temporary temporary;
    Descriptor file(open_temporary(place, temporary.path));
    if (file.get() < 0) {
        temporary.kept = true;  // it was never made
        return system_failure("cannot be written", path);
    }
    copy_permissions(place, file.get());
    AG_CHECK(write_all(file.get(), bytes, path));
    if (::fsync(file.get()) != 0 || !file.close()) return system_failure("cannot be written", path);
    if (::rename(temporary.path.c_str(), place.c_str()) != 0)
        return system_failure("cannot be replaced", path);
    temporary.kept = true;
    flush_folder(place);
    return {};
}

Status write_file(const fs::path& path, std::string_view text) {
    return write_file(path, std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

}  // namespace aglow
