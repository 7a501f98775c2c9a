// SPDX-License-Identifier: Apache-2.0
#include "refinement_option.h"

#include "options.h"

#include <fmt/format.h>

#include <map>

namespace aglow::cli {
namespace {

/// What follows "auto:".
Result<float> parse_tolerance(const std::string& text) {
    AG_TRY(const double pixels, parse_number(text));
    if (!(pixels >= kFinestTolerance && pixels <= kCoarsestTolerance))
        return fail(Errc::bad_argument, fmt::format("auto:PIXELS goes from {} to {}, not {}",
                                                    kFinestTolerance, kCoarsestTolerance, pixels));
    return static_cast<float>(pixels);
}

}  // namespace

Result<Refinement> parse_refinement(const std::string& text) {
    using Kind = Refinement::Kind;
    if (text == "none") return Refinement{};
    if (text == "auto") return Refinement{.kind = Kind::automatic};
    const std::map<std::string, Kind> kinds = {{"pn", Kind::pn},
                                               {"st", Kind::tagged},
                                               {"loop", Kind::loop},
                                               {"catmull-clark", Kind::catmull_clark},
                                               {"auto", Kind::automatic}};
    const size_t colon = text.find(':');
    const auto known = kinds.find(text.substr(0, colon));
    if (known == kinds.end() || colon == std::string::npos)
        return fail(Errc::bad_argument,
                    fmt::format("\"{}\" is no refinement; there is none, pn:N, st:N, loop:N, "
                                "catmull-clark:N, auto and auto:PIXELS",
                                text));
    Refinement refinement{.kind = known->second};
    const std::string value = text.substr(colon + 1);
    if (refinement.kind == Kind::automatic) {
        AG_TRY(refinement.tolerance, parse_tolerance(value));
        return refinement;
    }
    const int64_t least = refinement.kind == Kind::catmull_clark ? 1 : 0;
    AG_TRY(const int64_t level, parse_whole(value, least, kMostRefinement));
    refinement.level = static_cast<int>(level);
    return refinement;
}

}  // namespace aglow::cli
