// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <tl/expected.hpp>

#include <string>
#include <utility>

namespace aglow {

/// What kind of "no" an operation met. The command line maps each kind to one exit code.
enum class Errc {
    bad_argument,   ///< an option or parameter makes no sense (exit 1)
    unreadable,     ///< a file could not be read or written (exit 2)
    malformed,      ///< the input breaks its format's rules (exit 3)
    out_of_memory,  ///< memory ran out (exit 4)
    device_lost,    ///< the device failed (exit 4)
    unsupported,    ///< a valid input needs a feature that does not exist here (exit 5)
    cancelled,      ///< the caller asked to stop (exit 130)
};

/// Why an operation did not happen. `message` is a sentence a user can act on and names the
/// element it is about: `node 4 "ear": skin 2 does not exist`; `context` is the file.
struct Error {
    Errc code;
    std::string message;
    std::string context = {};
};

template <class T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

/// return fail(Errc::malformed, "accessor 3: ...");  converts to any Result<T>.
inline tl::unexpected<Error> fail(Errc code, std::string message, std::string context = {}) {
    return tl::unexpected<Error>(Error{code, std::move(message), std::move(context)});
}

/// `room.glb: node 4 "ear": skin 2 does not exist`
std::string to_string(const Error& error);

}  // namespace aglow

/// AG_TRY(auto mesh, load(path));   declares `mesh`, or returns the error to our caller.
/// Expands to several statements, so it stands alone inside braces.
#define AG_TRY(declaration, expression)                                                 \
    auto AG_UNIQUE_(ag_try) = (expression);                                             \
    if (!AG_UNIQUE_(ag_try))                                                            \
        return ::tl::unexpected<::aglow::Error>(std::move(AG_UNIQUE_(ag_try)).error()); \
    declaration = std::move(*AG_UNIQUE_(ag_try))
/// AG_CHECK(write(path));   returns the error of a Status to our caller.
#define AG_CHECK(expression)                       \
    if (auto ag_status = (expression); !ag_status) \
    return ::tl::unexpected<::aglow::Error>(std::move(ag_status).error())
#define AG_UNIQUE_(stem) AG_PASTE_(stem, __LINE__)
#define AG_PASTE_(a, b) AG_PASTE2_(a, b)
#define AG_PASTE2_(a, b) a##_##b
