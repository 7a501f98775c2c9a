// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace aglow::gltf::edit {

/// Several files that appear together or not at all. Files are written under temporary names beside
/// their targets; commit() renames them, the first one added last, so that the scene never names a
/// file that is not there yet. What is not committed is removed.
class OutputSet {
public:
    OutputSet() = default;
    OutputSet(const OutputSet&) = delete;
    OutputSet& operator=(const OutputSet&) = delete;
    ~OutputSet();

    /// `write` gets the temporary path, which has the ending of `target`.
    /// Errors  those of `write`; unreadable where the folder cannot be made.
    Status add(const std::filesystem::path& target,
               const std::function<Status(const std::filesystem::path&)>& write);
    Status add(const std::filesystem::path& target, std::span<const uint8_t> bytes);

    /// Result  the targets, in the order they were added.   Errors  unreadable.
    Result<std::vector<std::filesystem::path>> commit();

private:
    struct File {
        std::filesystem::path temporary, target;
        bool existed = false;
    };
    std::vector<File> files_;
    std::vector<std::filesystem::path> folders_;  ///< made on the way, innermost last
    bool committed_ = false;
};

}  // namespace aglow::gltf::edit
