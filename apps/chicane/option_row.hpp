// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "options.hpp"

/// The command line as rows: the parser, the words for mistakes, the help, the manual page and the shells'
/// completion are made of them.
namespace chicane::apps {

/// Target of an option that is another name for a setting of `chicane list parameters`.
struct Setting {
  std::string_view key;
};
/// Variable that a flag clears.
struct Off {
  bool* value;
};
/// Function that takes one value. Returns the expectation that the value misses, or an empty text.
using Take = std::function<std::string(const std::string& text)>;

/// Variable or function that receives the values of an option.
using Target =
    std::variant<bool*, Off, Setting, int*, std::uint16_t*, std::uint64_t*, double*, std::optional<double>*,
                 std::string*, std::vector<std::string>*, std::vector<int>*, Take>;

/// Closed interval of the numbers that an option takes.
struct Interval {
  double least, most;
};
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Limits of the values of an option, and the options that it needs or excludes.
struct OptionRule {
  std::optional<Interval> within{};          ///< limits of numbers
  std::vector<std::string> words{};          ///< the only words that it takes; empty: any
  std::string_view shelf{};                  ///< shelf of `chicane list` that has its names
  std::string_view needs{};                  ///< option without which it is refused
  std::vector<std::string_view> excludes{};  ///< options with which it is refused
  const char* environment = nullptr;         ///< variable that gives the value if the option does not
  bool is_required = false;
  bool is_once = false;        ///< refuses a second use, for a Take
  bool shows_default = false;  ///< help shows the target's value before parsing
};

/// Union of both rules; a field that both have is taken from b.
[[nodiscard]] OptionRule operator|(OptionRule a, const OptionRule& b);

[[nodiscard]] inline OptionRule between(double least, double most) {
  return {.within = Interval{least, most}};
}
[[nodiscard]] inline OptionRule one_of(std::vector<std::string> words) { return {.words = std::move(words)}; }
[[nodiscard]] inline OptionRule from_shelf(std::string_view shelf) { return {.shelf = shelf}; }
[[nodiscard]] inline OptionRule from_variable(const char* name) { return {.environment = name}; }
[[nodiscard]] inline OptionRule with(std::string_view other) { return {.needs = other}; }
[[nodiscard]] inline OptionRule without(std::vector<std::string_view> others) {
  return {.excludes = std::move(others)};
}
inline const OptionRule kPositive = between(std::numeric_limits<double>::denorm_min(), kUnbounded);
inline const OptionRule kNonNegative = between(0.0, kUnbounded);
inline const OptionRule kRequired{.is_required = true}, kOnce{.is_once = true}, kShown{.shows_default = true};

/// One option, flag or positional argument of a command.
struct OptionRow {
  std::string names;       ///< names as typed: "-o,--output"; without dashes: a positional argument
  std::string_view value;  ///< name of its value, "NAME|FILE"; empty: a flag; with ",...": a list with commas
  std::string meaning;     ///< meaning of the option; starts with a noun or a verb
  Target to;               ///< std::vector and Take: may be repeated, unless is_once
  OptionRule rule{};

  [[nodiscard]] bool is_positional() const { return !names.starts_with('-'); }
  [[nodiscard]] bool is_flag() const { return value.empty(); }
  [[nodiscard]] bool takes_list() const { return value.ends_with(",..."); }
  [[nodiscard]] bool takes_several() const;
  /// All names: "-o" and "--output"; none for a positional argument.
  [[nodiscard]] std::vector<std::string> typed_names() const;
  /// The long name, or the positional argument's.
  [[nodiscard]] std::string name() const;
  /// Expected value in words: "a number in [0.05, 20]", "one of bash, zsh, fish", "NAME|FILE (chicane list
  /// cars)".
  [[nodiscard]] std::string expectation() const;
  /// The target's value as text; empty unless rule.shows_default.
  [[nodiscard]] std::string default_text() const;
};

using Rows = std::vector<OptionRow>;

/// Gives the values of an option to its target. Returns the fault, "got X, expected Y", or an
/// empty text. `settings`: receives key and text of a Setting.
[[nodiscard]] std::string assign(const OptionRow& row, const std::vector<std::string>& given,
                                 std::vector<std::pair<std::string, std::string>>& settings);

/// Notes after the meaning of a row: " (0.05 to 20; default 1; with --simulate)"; may be empty.
[[nodiscard]] std::string notes(const OptionRow& row);
/// Words in lines of 80 columns that begin at column `indent`. The first line continues at column `begun`; if
/// that is beyond `indent`, on a new line. Ends with a line break.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent, std::size_t begun);
/// The help of a command, at most 80 columns wide.
[[nodiscard]] std::string command_help(std::string_view name, std::string_view summary, const Rows& rows,
                                       std::string_view example);
/// The help of the program: its commands in groups, at most 80 columns wide.
[[nodiscard]] std::string program_help();

/// The manual page, for man(7).
[[nodiscard]] std::string manual_page();

}  // namespace chicane::apps
