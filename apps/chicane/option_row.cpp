// SPDX-License-Identifier: MIT
// Rows of options: assigns values to their targets, and makes the help of them.
#include "option_row.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "chicane/base/text.hpp"
#include "chicane/protocol/schema.hpp"
#include "commands.hpp"

namespace chicane::apps {
namespace {

/// Whether a target is of one of these kinds.
template <class... Kinds>
bool holds_any(const Target& to) {
  return (std::holds_alternative<Kinds>(to) || ...);
}

/// Whether a target takes whole numbers.
bool is_whole(const Target& to) {
  return holds_any<int*, std::uint16_t*, std::uint64_t*, std::vector<int>*>(to);
}

/// Whether a target takes numbers.
bool is_number(const Target& to) { return is_whole(to) || holds_any<double*, std::optional<double>*>(to); }

/// Whether a number is inside the limits of an option.
bool is_within(const OptionRow& row, double number) {
  return !row.rule.within || (number >= row.rule.within->least && number <= row.rule.within->most);
}

/// Interval in words: " in [0, 1]", " > 0".
std::string limits(const Interval& within) {
  if (within.most < kUnbounded)
    return fmt::format(" in [{}, {}]", number_text(within.least), number_text(within.most));
  return within.least > 0.0 ? " > 0" : " >= 0";
}

/// Visitor that assigns a text to the target of a row. Returns the expectation that the text does not meet;
/// else an empty text.
struct Assign {
  const OptionRow& row;
  const std::string& text;
  std::vector<std::pair<std::string, std::string>>& settings;

  std::string operator()(bool* to) const { return *to = true, ""; }
  std::string operator()(Off to) const { return *to.value = false, ""; }
  /// The schema checks the value; the message has the name of the option.
  std::string operator()(Setting to) const {
    const protocol::Parameter& parameter = *protocol::find(to.key);
    if (!protocol::parse(parameter, text)) return chicane::expectation(parameter.option);
    return settings.emplace_back(to.key, text), "";
  }
  std::string operator()(std::string* to) const { return *to = text, ""; }
  std::string operator()(std::vector<std::string>* to) const { return to->push_back(text), ""; }
  std::string operator()(const Take& take) const { return take(text); }
  std::string operator()(double* to) const { return number(number_in(text), *to); }
  std::string operator()(std::optional<double>* to) const { return number(number_in(text), *to); }
  std::string operator()(std::vector<int>* to) const { return number(count_in(text), to->emplace_back()); }
  template <class Whole>
  std::string operator()(Whole* to) const {
    return number(count_in(text), *to);
  }

 private:
  /// Assigns a number that fits the rule and the type of the target.
  template <class Number, class To>
  std::string number(const std::optional<Number>& read, To& to) const {
    using Kind = std::conditional_t<std::is_integral_v<To>, To, double>;
    const bool fits = read && is_within(row, static_cast<double>(*read)) &&
                      static_cast<double>(*read) <= static_cast<double>(std::numeric_limits<Kind>::max());
    if (!fits) return row.expectation();
    to = static_cast<Kind>(*read);
    return "";
  }
};

/// Visitor that gives the present value of a target as text; empty for targets that have none.
struct DefaultText {
  template <class Value>
  std::string operator()(Value* value) const {
    if constexpr (std::is_same_v<Value, std::string>)
      return *value;
    else if constexpr (std::is_same_v<Value, std::vector<std::string>> ||
                       std::is_same_v<Value, std::vector<int>>)
      return fmt::format("{}", fmt::join(*value, ","));
    else if constexpr (std::is_same_v<Value, std::optional<double>>)
      return *value ? number_text(**value) : "";
    else
      return number_text(static_cast<double>(*value));
  }
  template <class Other>
  std::string operator()(const Other&) const {
    return "";
  }
};

/// Parts of a text between separators.
std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char each : text) {
    if (each == at)
      parts.emplace_back();
    else
      parts.back() += each;
  }
  return parts;
}

/// Values for a message.
std::string joined_values(const std::vector<std::string>& values) {
  std::vector<std::string> words;
  for (const std::string& value : values) words.push_back(printable(value));
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

OptionRule operator|(OptionRule a, const OptionRule& b) {
  if (b.within) a.within = b.within;
  if (!b.words.empty()) a.words = b.words;
  if (!b.shelf.empty()) a.shelf = b.shelf;
  if (!b.needs.empty()) a.needs = b.needs;
  if (!b.excludes.empty()) a.excludes = b.excludes;
  if (b.environment != nullptr) a.environment = b.environment;
  a.is_required = a.is_required || b.is_required;
  a.is_once = a.is_once || b.is_once;
  a.shows_default = a.shows_default || b.shows_default;
  return a;
}

bool OptionRow::takes_several() const {
  return holds_any<std::vector<std::string>*, std::vector<int>*>(to) ||
         (std::holds_alternative<Take>(to) && !rule.is_once);
}

std::vector<std::string> OptionRow::typed_names() const {
  return is_positional() ? std::vector<std::string>{} : split(names, ',');
}

std::string OptionRow::name() const { return names.substr(names.find(',') + 1); }

std::string OptionRow::expectation() const {
  if (!rule.words.empty()) return fmt::format("one of {}", fmt::join(rule.words, ", "));
  if (is_number(to))
    return std::string(is_whole(to) ? "a whole number" : "a number") +
           (rule.within ? limits(*rule.within) : "");
  if (value == "X") return "a number";
  return std::string(value) + (rule.shelf.empty() ? "" : fmt::format(" (chicane list {})", rule.shelf));
}

std::string OptionRow::default_text() const {
  return rule.shows_default ? std::visit(DefaultText{}, to) : "";
}

std::string assign(const OptionRow& row, const std::vector<std::string>& given,
                   std::vector<std::pair<std::string, std::string>>& settings) {
  if (row.is_flag()) {
    for (const std::string& text : given)
      if (text != "true") return fmt::format("got {}, expected no value", printable(text));
    return std::visit(Assign{row, given.front(), settings}, row.to);
  }
  if (given.size() > 1 && !row.takes_several())
    return fmt::format("got it {} times ({}), expected once", given.size(), joined_values(given));
  if (auto* const* const list = std::get_if<std::vector<std::string>*>(&row.to)) (*list)->clear();
  if (auto* const* const list = std::get_if<std::vector<int>*>(&row.to)) (*list)->clear();
  for (const std::string& whole : given) {
    for (const std::string& text : row.takes_list() ? split(whole, ',') : std::vector{whole}) {
      const bool is_word = row.rule.words.empty() || std::find(row.rule.words.begin(), row.rule.words.end(),
                                                               text) != row.rule.words.end();
      const std::string expected =
          text.empty() || !is_word ? row.expectation() : std::visit(Assign{row, text, settings}, row.to);
      if (!expected.empty())
        return fmt::format("got {}, expected {}", text.empty() ? "nothing" : printable(text), expected);
    }
  }
  return "";
}

namespace {

constexpr std::size_t kWidth = 80;   // columns of a terminal
constexpr std::size_t kIndent = 27;  // column at which meanings begin: fits most names; chosen

/// Example in lines of 80 columns that can be typed as they are.
std::string example_lines(std::string_view example) {
  std::string lines;
  std::size_t room = kWidth - std::string_view{"Example: "}.size();
  while (example.size() > room) {
    const std::size_t space = example.rfind(' ', room - 2);  // room for " \\"
    if (space == std::string_view::npos) break;
    lines += fmt::format("{} \\\n    ", example.substr(0, space));
    example.remove_prefix(space + 1);
    room = kWidth - 4;
  }
  return lines + std::string(example);
}

/// Entry of the help: names, and a text beside or below them.
std::string entry(std::string_view names, std::string_view text, std::size_t indent = kIndent) {
  const std::string begin = fmt::format("  {}", names);
  return begin + wrapped(text, indent, begin.size() + 1 > indent ? indent + 1 : begin.size());
}

/// Entry of an option in the help.
std::string entry(const OptionRow& row) {
  const std::string names = row.is_positional()
                                ? std::string(row.value) + (row.takes_several() ? "..." : "")
                                : row.names + (row.is_flag() ? "" : " " + std::string(row.value));
  return entry(names, row.meaning + notes(row));
}

const char* const kHelpRow = "Print this help and end";

}  // namespace

std::string wrapped(std::string_view text, std::size_t indent, std::size_t begun) {
  std::string lines;
  std::size_t column = begun;
  if (column > indent) {  // the names are too long for this column
    lines += '\n';
    column = 0;
  }
  lines.append(indent - column, ' ');
  column = indent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    const std::size_t space = column > indent ? 1 : 0;
    if (space > 0 && column + space + word.size() > kWidth) {
      lines += '\n' + std::string(indent, ' ');
      column = indent;
    } else {
      lines.append(space, ' ');
      column += space;
    }
    lines += word;
    column += word.size();
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return lines + '\n';
}

void print_sentence(std::FILE* file, std::string_view text, std::size_t indent, std::size_t begun) {
  fmt::print(file, "{}", isatty(fileno(file)) == 1 ? wrapped(text, indent, begun) : std::string(text) + '\n');
}

std::string notes(const OptionRow& row) {
  std::vector<std::string> notes;
  if (!row.rule.shelf.empty()) notes.push_back(fmt::format("chicane list {}", row.rule.shelf));
  if (!row.rule.words.empty()) notes.push_back(fmt::format("one of {}", fmt::join(row.rule.words, ", ")));
  if (row.rule.within && row.rule.within->most < kUnbounded)
    notes.push_back(
        fmt::format("{} to {}", number_text(row.rule.within->least), number_text(row.rule.within->most)));
  if (const std::string text = row.default_text(); !text.empty()) notes.push_back("default " + text);
  if (row.rule.environment != nullptr) notes.push_back(fmt::format("default ${}", row.rule.environment));
  if (!row.rule.needs.empty()) notes.push_back(fmt::format("with {}", row.rule.needs));
  if (!row.rule.excludes.empty())
    notes.push_back(fmt::format("not with {}", fmt::join(row.rule.excludes, ", ")));
  if (row.takes_several() && !row.takes_list() && !row.is_positional()) notes.push_back("may be repeated");
  return notes.empty() ? "" : fmt::format(" ({})", fmt::join(notes, "; "));
}

std::string command_help(std::string_view name, std::string_view summary, const Rows& rows,
                         std::string_view example) {
  std::string usage = fmt::format("Usage: chicane {} [OPTION]...", name);
  std::string positionals, options;
  for (const OptionRow& row : rows) {
    if (row.is_positional()) {
      const std::string value = std::string(row.value) + (row.takes_several() ? "..." : "");
      usage += row.rule.is_required ? " " + value : " [" + value + "]";
    }
    (row.is_positional() ? positionals : options) += entry(row);
  }
  return fmt::format("{}\n{}\n\n{}Options:\n{}{}\nExample: {}\n", summary, usage,
                     positionals.empty() ? "" : positionals + "\n", entry("-h,--help", kHelpRow), options,
                     example_lines(example));
}

std::string program_help() {
  std::string help = fmt::format(
      "Drives a car round a track by model predictive control.\nUsage: chicane COMMAND [OPTION]...\n\n"
      "Options:\n{}{}",
      entry("-h,--help", kHelpRow), entry("--version", "Print the version and end"));
  std::string_view group;
  for (const Command& command : commands()) {
    if (command.group != group) help += fmt::format("\n{}:\n", group = command.group);
    help += entry(command.name, command.summary, 15);
  }
  return help + "\nExample: chicane drive\n";
}

}  // namespace chicane::apps
