// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace aglow::vk {

/// What the validation layers said. Shared by a device and by who asked for validation, so that
/// what is said while the device dies (of objects that leak) is heard too.
/// Thread safety  all members may be called from any thread.
class Messages {
public:
    void add(std::string text) {
        std::lock_guard lock(mutex_);
        texts_.push_back(std::move(text));
    }
    std::vector<std::string> list() const {
        std::lock_guard lock(mutex_);
        return texts_;
    }

private:
    mutable std::mutex mutex_;
    std::vector<std::string> texts_;
};

}  // namespace aglow::vk
