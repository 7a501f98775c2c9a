// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aglow::cli {

/// How the text of an option becomes a value of the program.
struct Value {
    enum class Kind : uint8_t { flag, single, repeated };
    Kind kind = Kind::single;
    std::function<Status(const std::string& text)> assign;
};

enum class Need : uint8_t { optional, required };

/// One row of a command's table. Parsing, --help and docs/cli.md read the same rows.
struct Row {
    std::string name;         ///< "-o,--output", or "IN" for a positional argument
    Value value;              ///< where the text goes
    std::string placeholder;  ///< what --help shows for the text; empty for flags
    std::string help;         ///< one line: meaning, unit, default
    Need need = Need::optional;
};
using Table = std::vector<Row>;

/// Appends `more` to `table`.
Table& operator+=(Table& table, Table more);

/// A finite number, wholly consumed. Errors: bad_argument; says what was found.
Result<double> parse_number(const std::string& text);
/// `count` numbers with commas between them. Errors as above.
Result<std::vector<double>> parse_numbers(const std::string& text, size_t count);
/// A whole number of the range. Errors as above.
Result<int64_t> parse_whole(const std::string& text, int64_t lowest, int64_t highest);

Value flag(bool* target);
Value text(std::string* target);
Value file(std::filesystem::path* target);
Value whole(int* target, int lowest, int highest);
Value whole(std::optional<int>* target, int lowest, int highest);
Value seed(uint64_t* target);

/// A number with lowest <= value <= highest.
inline constexpr double kNoBound = std::numeric_limits<double>::infinity();
Value number(std::optional<double>* target, double lowest, double highest = kNoBound);
/// A number above `bound`.
Value number_above(std::optional<double>* target, double bound);

/// Anything else: `parse` turns the text into a value or says what is wrong with it.
template <class T, class Parse>
Value parsed(T* target, Parse parse) {
    return {Value::Kind::single, [target, parse](const std::string& text) -> Status {
                AG_TRY(*target, parse(text));
                return {};
            }};
}
template <class T, class Parse>
Value parsed_each(std::vector<T>* target, Parse parse) {
    return {Value::Kind::repeated, [target, parse](const std::string& text) -> Status {
                AG_TRY(T value, parse(text));
                target->push_back(std::move(value));
                return {};
            }};
}

/// Why `text` is none of `names`; unsupported where it is one of `planned`, values that the
/// interface defines and this build does not have.
tl::unexpected<Error> no_such_choice(const std::string& text, const std::vector<std::string>& names,
                                     const std::vector<std::string>& planned);

/// One of a few names: choice<Method>(&method, {{"gather", Method::gather}}, {"progressive"}).
template <class Choice, class T>
Value choice(T* target, std::initializer_list<std::pair<std::string, Choice>> choices,
             const std::vector<std::string>& planned = {}) {
    std::vector<std::pair<std::string, Choice>> known(choices);
    return {Value::Kind::single, [=](const std::string& text) -> Status {
                std::vector<std::string> names;
                for (const auto& [name, value] : known) {
                    if (name == text) {
                        *target = value;
                        return {};
                    }
                    names.push_back(name);
                }
                return no_such_choice(text, names, planned);
            }};
}

/// Assigns `arguments` to the rows of `table`.
/// Errors  bad_argument  unknown, missing, repeated or senseless options
///         unsupported   a value this build does not have
Status parse(const Table& table, const std::vector<std::string>& arguments);

/// The rows as aligned lines, arguments first.
std::string describe(const Table& table);

}  // namespace aglow::cli
