// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <doctest/doctest.h>

#include <utility>

namespace aglow {

/// The value that a test cannot do without: an error ends the test with its message.
template <class T>
T demand(Result<T> result) {
    if (!result) FAIL(to_string(result.error()));
    return std::move(*result);
}
inline void demand(const Status& status) {
    if (!status) FAIL(to_string(status.error()));
}

}  // namespace aglow
