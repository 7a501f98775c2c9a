// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <doctest/doctest.h>

#include <utility>

namespace aglow::vk {

/// The value that a test cannot do without: an error ends the test with its message.
template <class T>
T demand(Result<T> result) {
    REQUIRE_MESSAGE(result.has_value(), result.error().message);
    return std::move(*result);
}
inline void demand(const Status& status) {
    REQUIRE_MESSAGE(status.has_value(), status.error().message);
}

}  // namespace aglow::vk
