// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace aglow {
/// Prints the broken promise and aborts. Reached through AG_ASSERT only.
[[noreturn]] void assertion_failed(const char* promise, const char* file, int line);
}  // namespace aglow

/// Checks what the caller promised: aborts in debug builds, costs nothing in release builds.
/// Never for what files, users or drivers do: those return a Result.
#ifdef NDEBUG
#define AG_ASSERT(condition, promise) static_cast<void>(0)
#else
#define AG_ASSERT(condition, promise) \
    ((condition) ? static_cast<void>(0) : ::aglow::assertion_failed(promise, __FILE__, __LINE__))
#endif
