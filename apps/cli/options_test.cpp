// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cstdio>
#include <cstring>

using namespace aglow;
using namespace aglow::cli;

namespace {

struct Options {
    std::string input;
    bool loud = false;
    std::optional<double> length;
    std::optional<int> count;
    std::vector<double> weights;
    std::string method;
};

Table table(Options& o) {
    return {
        {"IN", text(&o.input), "", "input", Need::required},
        {"-l,--loud", flag(&o.loud), "", "noise"},
        {"--length", number_above(&o.length, 0), "M", "a length"},
        {"--count", whole(&o.count, -5, 5), "N", "a count"},
        {"--weight", parsed_each(&o.weights, parse_number), "W", "repeatable"},
        {"--method",
         choice<std::string>(&o.method, {{"fast", "fast"}, {"slow", "slow"}}, {"magic"}), "NAME",
         "a choice"},
    };
}

/// The code of the error that parsing ends with, or none.
std::optional<Errc> outcome(const std::vector<std::string>& words, Options& options) {
    const Status status = parse(table(options), words);
    return status ? std::nullopt : std::optional(status.error().code);
}

std::optional<Errc> outcome(const std::vector<std::string>& words) {
    Options options;
    return outcome(words, options);
}

}  // namespace

TEST_CASE("every row of a table takes its own text, in any order") {
    Options o;
    REQUIRE_FALSE(outcome({"--weight", "-1.5", "--count=-3", "room", "-l", "--length", "2e-3",
                           "--weight", "7", "--method", "slow"},
                          o));
    CHECK(o.input == "room");
    CHECK(o.loud);
    CHECK(*o.length == 2e-3);
    CHECK(*o.count == -3);
    CHECK(o.weights == std::vector<double>{-1.5, 7});
    CHECK(o.method == "slow");
}

TEST_CASE("what is unknown, missing, repeated or out of range is wrong usage") {
    const std::vector<std::vector<std::string>> wrong = {
        {},
        {"room", "hall"},
        {"room", "--shiny"},
        {"room", "--length"},
        {"room", "--length", "0"},
        {"room", "--length", "1", "--length", "2"},
        {"room", "--length", "1m"},
        {"room", "--length", "inf"},
        {"room", "--length", ""},
        {"room", "--count", "6"},
        {"room", "--count", "1.0"},
        {"room", "--method", "wrong"},
        {"room", "--loud=5x"},
    };
    for (const std::vector<std::string>& words : wrong) {
        CAPTURE(words.size());
        CAPTURE(words.empty() ? "" : words.back());
        CHECK(outcome(words) == Errc::bad_argument);
    }
}

TEST_CASE("a value that the interface defines but the build lacks is unsupported") {
    CHECK(outcome({"room", "--method", "magic"}) == Errc::unsupported);
}

TEST_CASE("an error names the option it is about") {
    Options options;
    const Status status = parse(table(options), {"room", "--length", "-2"});
    REQUIRE_FALSE(status);
    CHECK(to_string(status.error()).find("--length") != std::string::npos);
    CHECK(to_string(status.error()).find("-2") != std::string::npos);
}

TEST_CASE("finite numbers survive being printed and parsed") {
    rc::check([](double value) {
        RC_PRE(std::abs(value) < 1e300);
        char text[64];
        std::snprintf(text, sizeof(text), "%.17g", value);
        const Result<double> back = parse_number(text);
        RC_ASSERT(back.has_value());
        RC_ASSERT(*back == value);
    });
}

TEST_CASE("a list of numbers has exactly as many as asked for") {
    CHECK(*parse_numbers("1,-2,3.5", 3) == std::vector<double>{1, -2, 3.5});
    for (const char* text : {"1,2", "1,2,3,4", "1,,3", ",1,2", "1,2,", "1 ,2,3", ""})
        CHECK_FALSE(parse_numbers(text, 3).has_value());
}

TEST_CASE("help names every row and its placeholder") {
    Options options;
    const std::string text = describe(table(options));
    for (const char* part : {"IN", "-l, --loud", "--length M", "--method NAME", "a choice"})
        CHECK(text.find(part) != std::string::npos);
}
