// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>

namespace aglow::cli {
namespace {

using Assigned = std::vector<std::pair<const Row*, std::string>>;

bool positional(const Row& row) { return row.name.front() != '-'; }

/// "-o,--output" -> "--output"
std::string long_name(const Row& row) {
    const size_t comma = row.name.find(',');
    return comma == std::string::npos ? row.name : row.name.substr(comma + 1);
}

void declare(CLI::App& app, const Row& row, Assigned& assigned) {
    if (row.value.kind == Value::Kind::flag) {
        app.add_flag_callback(row.name, [&] { assigned.emplace_back(&row, ""); })
            ->disable_flag_override();
        return;
    }
    CLI::Option* option = app.add_option(row.name, [&](const CLI::results_t& texts) {
        for (const std::string& text : texts) assigned.emplace_back(&row, text);
        return true;
    });
    option->type_size(1)->expected(1);
    if (row.value.kind == Value::Kind::repeated)
        option->expected(-1)->allow_extra_args(false)->multi_option_policy(
            CLI::MultiOptionPolicy::TakeAll);
}

/// Texts as CLI11 found them, in the order of the table.
Result<Assigned> split(const Table& table, const std::vector<std::string>& arguments) {
    Assigned assigned;
    CLI::App app;
    app.set_help_flag();
    try {
        for (const Row& row : table) declare(app, row, assigned);
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::ExtrasError&) {
        const std::vector<std::string> extras = app.remaining();
        return fail(Errc::bad_argument,
                    fmt::format("{} {}", fmt::join(extras, " "),
                                extras.front().starts_with("-") ? "is not an option of this command"
                                                                : "is one argument too many"));
    } catch (const CLI::ArgumentMismatch& error) {
        return fail(Errc::bad_argument,
                    std::string(error.what()) + "; give an option once, a flag no value");
    } catch (const CLI::Error& error) {
        return fail(Errc::bad_argument, error.what());
    }
    return assigned;
}

template <class T>
Value checked(T* target, const std::string& bound, const std::function<bool(double)>& holds) {
    return {Value::Kind::single, [=](const std::string& text) -> Status {
                AG_TRY(const double value, parse_number(text));
                if (!holds(value))
                    return fail(Errc::bad_argument, fmt::format("{} is not {}", text, bound));
                *target = value;
                return {};
            }};
}

template <class T>
Value whole_of(T* target, int lowest, int highest) {
    return {Value::Kind::single, [=](const std::string& text) -> Status {
                AG_TRY(const int64_t value, parse_whole(text, lowest, highest));
                *target = static_cast<int>(value);
                return {};
            }};
}

}  // namespace

Table& operator+=(Table& table, Table more) {
    table.insert(table.end(), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
    return table;
}

Result<double> parse_number(const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, value);
    if (problem != std::errc{} || stop != end || !std::isfinite(value))
        return fail(Errc::bad_argument, fmt::format("\"{}\" is not a finite number", text));
    return value;
}

Result<std::vector<double>> parse_numbers(const std::string& text, size_t count) {
    std::vector<double> numbers;
    size_t begin = 0;
    while (begin <= text.size()) {
        const size_t comma = std::min(text.find(',', begin), text.size());
        AG_TRY(const double value, parse_number(text.substr(begin, comma - begin)));
        numbers.push_back(value);
        begin = comma + 1;
    }
    if (numbers.size() != count)
        return fail(Errc::bad_argument,
                    fmt::format("\"{}\" has {} numbers, not {}", text, numbers.size(), count));
    return numbers;
}

Result<int64_t> parse_whole(const std::string& text, int64_t lowest, int64_t highest) {
    int64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, value);
    if (problem != std::errc{} || stop != end || value < lowest || value > highest)
        return fail(Errc::bad_argument, fmt::format("\"{}\" is not a whole number from {} to {}",
                                                    text, lowest, highest));
    return value;
}

Value flag(bool* target) {
    return {Value::Kind::flag, [target](const std::string&) -> Status {
                *target = true;
                return {};
            }};
}

Value text(std::string* target) {
    return parsed(target, [](const std::string& text) -> Result<std::string> { return text; });
}

Value file(std::filesystem::path* target) {
    return parsed(target, [](const std::string& text) -> Result<std::filesystem::path> {
        if (text.empty()) return fail(Errc::bad_argument, "the file name is empty");
        return std::filesystem::path(text);
    });
}

Value whole(int* target, int lowest, int highest) { return whole_of(target, lowest, highest); }
Value whole(std::optional<int>* target, int lowest, int highest) {
    return whole_of(target, lowest, highest);
}

Value seed(uint64_t* target) {
    return parsed(target, [](const std::string& text) -> Result<uint64_t> {
        AG_TRY(const int64_t value, parse_whole(text, 0, std::numeric_limits<int64_t>::max()));
        return static_cast<uint64_t>(value);
    });
}

Value number(std::optional<double>* target, double lowest, double highest) {
    const std::string bound = highest == kNoBound
                                  ? fmt::format("at least {}", lowest)
                                  : fmt::format("between {} and {}", lowest, highest);
    return checked(target, bound, [=](double v) { return v >= lowest && v <= highest; });
}

Value number_above(std::optional<double>* target, double bound) {
    return checked(target, fmt::format("above {}", bound), [=](double v) { return v > bound; });
}

tl::unexpected<Error> no_such_choice(const std::string& text, const std::vector<std::string>& names,
                                     const std::vector<std::string>& planned) {
    const std::string have = fmt::format("{}", fmt::join(names, ", "));
    if (std::find(planned.begin(), planned.end(), text) != planned.end())
        return fail(Errc::unsupported,
                    fmt::format("\"{}\" is not part of this build, which has: {}", text, have));
    return fail(Errc::bad_argument, fmt::format("\"{}\" is none of: {}", text, have));
}

Status parse(const Table& table, const std::vector<std::string>& arguments) {
    AG_TRY(const Assigned assigned, split(table, arguments));
    for (const auto& [row, text] : assigned)
        if (Status status = row->value.assign(text); !status) {
            Error error = std::move(status).error();
            error.context = long_name(*row);
            return tl::unexpected<Error>(std::move(error));
        }
    for (const Row& row : table) {
        const bool given = std::any_of(assigned.begin(), assigned.end(),
                                       [&](const auto& entry) { return entry.first == &row; });
        if (row.need == Need::required && !given)
            return fail(Errc::bad_argument, fmt::format("{} is missing ({})", row.name, row.help));
    }
    return {};
}

std::string describe(const Table& table) {
    const auto head = [](const Row& row) {
        std::string name = row.name;
        if (const size_t comma = name.find(','); comma != std::string::npos)
            name.insert(comma + 1, " ");
        if (!row.placeholder.empty() && !positional(row)) name += " " + row.placeholder;
        return name;
    };
    size_t width = 0;
    for (const Row& row : table) width = std::max(width, head(row).size());
    std::string lines;
    for (const bool arguments : {true, false})
        for (const Row& row : table)
            if (positional(row) == arguments)
                lines += fmt::format("  {:<{}}  {}\n", head(row), width, row.help);
    return lines;
}

}  // namespace aglow::cli
