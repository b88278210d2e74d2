// SPDX-License-Identifier: MIT
// The command line as rows: the parser, the messages about mistakes, the help, the manual page and the
// completion are made of them.
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

namespace chicane::apps {

/// Target of an option that sets a key of `chicane list parameters`.
struct Setting {
  std::string_view key;
};
/// Target of a flag that makes a variable false.
struct Off {
  bool* value;
};
/// Target that is a function of one value. Returns the expectation that the value does not meet; else an
/// empty text.
using Take = std::function<std::string(const std::string& text)>;

/// Target of an option: the variable or function that gets its values.
using Target =
    std::variant<bool*, Off, Setting, int*, std::uint16_t*, std::uint64_t*, double*, std::optional<double>*,
                 std::string*, std::vector<std::string>*, std::vector<int>*, Take>;

/// Closed interval of allowed numbers.
struct Interval {
  double least, most;
};
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Limits of the values of an option, and its relation to other options.
struct OptionRule {
  std::optional<Interval> within{};          ///< limits of numbers
  std::vector<std::string> words{};          ///< allowed words; empty: any
  std::string_view shelf{};                  ///< shelf of `chicane list` with the names; empty: none
  std::string_view needs{};                  ///< option that must be given, too; empty: none
  std::vector<std::string_view> excludes{};  ///< options that must not be given, too
  const char* environment = nullptr;         ///< environment variable with the default; null: none
  bool is_required = false;
  bool is_once = false;        ///< refuses a second use of an option with a Take
  bool shows_default = false;  ///< the help shows the value of the target before parsing
};

/// Union of both rules; a field that both have is taken from b.
[[nodiscard]] OptionRule operator|(OptionRule a, const OptionRule& b);

// Rules with one field.
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
  std::string_view value;  ///< name of its value, "NAME|FILE"; ends with ",..." for a list; empty: a flag
  std::string meaning;     ///< meaning for the help
  Target to;               ///< storage of the value; a std::vector or Take may be repeated, unless is_once
  OptionRule rule{};

  [[nodiscard]] bool is_positional() const { return !names.starts_with('-'); }
  [[nodiscard]] bool is_flag() const { return value.empty(); }
  [[nodiscard]] bool takes_list() const { return value.ends_with(",..."); }
  /// Whether the option may be repeated.
  [[nodiscard]] bool takes_several() const;
  /// All names: "-o" and "--output"; none for a positional argument.
  [[nodiscard]] std::vector<std::string> typed_names() const;
  /// Long name, or name of the positional argument.
  [[nodiscard]] std::string name() const;
  /// Expected value in words: "a number in [0.05, 20]", "one of bash, zsh, fish", "NAME|FILE (chicane list
  /// cars)".
  [[nodiscard]] std::string expectation() const;
  /// Value of the target as text; empty unless rule.shows_default.
  [[nodiscard]] std::string default_text() const;
};

using Rows = std::vector<OptionRow>;

/// Assigns the values of an option to its target. Returns the fault, "got X, expected Y", or an empty text.
/// `settings`: gets the key and text of a Setting.
[[nodiscard]] std::string assign(const OptionRow& row, const std::vector<std::string>& given,
                                 std::vector<std::pair<std::string, std::string>>& settings);

/// Notes after the meaning of a row in the help: " (0.05 to 20; default 1; with --simulate)"; may be empty.
[[nodiscard]] std::string notes(const OptionRow& row);
/// Text broken into lines of 80 columns, which begin at column `indent`, with a line break at the end. The
/// first line begins at column `begun`, after text of the caller; if that is beyond `indent`, a new line
/// begins.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent, std::size_t begun);
/// Prints a sentence: on a terminal wrapped(), otherwise as one line.
void print_sentence(std::FILE* file, std::string_view text, std::size_t indent = 0, std::size_t begun = 0);
/// Help of a command, at most 80 columns wide.
[[nodiscard]] std::string command_help(std::string_view name, std::string_view summary, const Rows& rows,
                                       std::string_view example);
/// Help of the program: its commands in groups, at most 80 columns wide.
[[nodiscard]] std::string program_help();

/// Manual page of the program, as roff for man(7).
[[nodiscard]] std::string manual_page();

}  // namespace chicane::apps
