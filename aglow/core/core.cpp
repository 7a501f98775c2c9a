// SPDX-License-Identifier: Apache-2.0
#include "aglow/core/assert.h"
#include "aglow/core/result.h"

#include <cstdio>
#include <cstdlib>

namespace aglow {

void assertion_failed(const char* promise, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: broken promise: %s\n", file, line, promise);
    std::abort();
}

std::string to_string(const Error& error) {
    return error.context.empty() ? error.message : error.context + ": " + error.message;
}

}  // namespace aglow
