// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/output_set.h"

#include "aglow/core/file.h"

#include <fmt/format.h>
#include <unistd.h>

namespace aglow::gltf::edit {

namespace fs = std::filesystem;

OutputSet::~OutputSet() {
    if (committed_) return;
    std::error_code ignored;
    for (const File& file : files_) fs::remove(file.temporary, ignored);
    // Only empty folders go; others have come to hold something else.
    for (size_t i = folders_.size(); i-- > 0;) fs::remove(folders_[i], ignored);
}

Status OutputSet::add(const fs::path& target, const std::function<Status(const fs::path&)>& write) {
    std::vector<fs::path> missing;
    std::error_code error;
    const fs::path folder = target.parent_path();
    for (fs::path f = folder; !f.empty() && !fs::exists(f, error); f = f.parent_path())
        missing.push_back(f);
    // The folder of the first file is the caller's choice and must exist.
    if (!missing.empty() && files_.empty())
        return fail(Errc::unreadable, fmt::format("folder {} does not exist", folder.string()));
    for (size_t i = missing.size(); i-- > 0;) {
        if (fs::create_directory(missing[i], error)) folders_.push_back(missing[i]);
    }
    File file{folder / fmt::format(".{}.{}.part{}", target.stem().string(), ::getpid(),
                                   target.extension().string()),
              target, fs::exists(target, error)};
    if (fs::is_directory(target, error))
        return fail(Errc::unreadable, fmt::format("{} is a folder", target.string()));
    files_.push_back(file);
    return write(file.temporary).map_error([&](Error e) {
        e.context = target.string();
        return e;
    });
}

Status OutputSet::add(const fs::path& target, std::span<const uint8_t> bytes) {
    return add(target, [&](const fs::path& temporary) { return write_file(temporary, bytes); });
}

Result<std::vector<fs::path>> OutputSet::commit() {
    for (size_t i = files_.size(); i-- > 0;) {
        std::error_code error;
        fs::rename(files_[i].temporary, files_[i].target, error);
        if (!error) continue;
        for (size_t done = i + 1; done < files_.size(); ++done) {
            std::error_code ignored;
            if (!files_[done].existed) fs::remove(files_[done].target, ignored);
        }
        return fail(Errc::unreadable, fmt::format("cannot write it: {}", error.message()),
                    files_[i].target.string());
    }
    committed_ = true;
    std::vector<fs::path> targets;
    for (const File& file : files_) targets.push_back(file.target);
    return targets;
}

}  // namespace aglow::gltf::edit
