// SPDX-License-Identifier: MIT
// The help as text of 80 columns.
#include <fmt/format.h>

#include <algorithm>

#include "chicane/base/text.hpp"
#include "commands.hpp"
#include "option_row.hpp"

namespace chicane::apps {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kIndent = 27;  ///< column at which meanings begin

/// An example that fits the screen and can be typed as it stands.
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

std::string entry(std::string_view names, std::string_view text, std::size_t indent = kIndent) {
  const std::string begin = fmt::format("  {}", names);
  return begin + wrapped(text, indent, begin.size() + 1 > indent ? indent + 1 : begin.size());
}

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
