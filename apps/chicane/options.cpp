// SPDX-License-Identifier: MIT
// Parser of the command line, with a fault and a suggestion for each mistake.
#include "options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/version.hpp"
#include "commands.hpp"
#include "option_row.hpp"

namespace chicane::apps {
namespace {

/// Help for a command line without a command.
constexpr std::string_view kFirstSteps =
    "chicane drive                        drives a lap; open the link that it prints\n"
    "chicane drive --preset race --fast   races at once and prints the lap times\n"
    "chicane list                         presets, tracks, cars and scenarios to choose from\n"
    "chicane serve                        drives the car of another simulator, as Udacity's\n"
    "chicane COMMAND --help               options of a command, with an example\n"
    "chicane --help                       all commands\n";

/// Suggestion of the name that is nearest to a mistake; empty if none is near.
std::string did_you_mean(std::string_view got, const std::vector<std::string_view>& names) {
  const std::string_view best = protocol::nearest(got, names);
  return best.empty() ? "" : fmt::format(" (did you mean {}?)", best);
}

/// Message about a first word that is no command.
std::string command_fault(std::string_view word) {
  std::vector<std::string_view> names;
  for (const Command& command : commands()) names.push_back(command.name);
  return fmt::format("got the unknown command {}, expected one of {}{}", printable(word),
                     fmt::join(names, ", "), did_you_mean(word, names));
}

/// Text of --version. A second line names the instruction sets that this build lacks.
std::string version_text() {
  const std::string left_out = instruction_sets_left_out();
  if (left_out.empty()) return "chicane " CHICANE_VERSION "\n";
  return fmt::format("chicane {}\ninstruction sets: {} (not built in: {})\n", CHICANE_VERSION,
                     built_instruction_sets(), left_out);
}

/// Words of a command line, divided among the options of the rows by CLI11.
class Words {
 public:
  explicit Words(const Rows& rows) : rows_(rows) {
    for (const OptionRow& row : rows) {
      CLI::Option* const option = row.is_flag() ? app_.add_flag(row.names) : app_.add_option(row.names);
      option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
      if (row.is_positional() && row.takes_several()) option->expected(-1);
      options_.push_back(option);
    }
  }

  /// Divides the words. Returns the fault, or an empty text. `wants_help`: set by --help.
  std::string read(int count, const char* const* words, bool& wants_help) {
    try {
      app_.parse(count, words);
    } catch (const CLI::CallForHelp&) {
      wants_help = true;
    } catch (const CLI::ExtrasError&) {
      return unexpected();
    } catch (const CLI::ArgumentMismatch&) {  // the last word is an option without its value
      lacks_value_ = true;
      const std::string_view last = words[count - 1];
      return without_value(last.substr(0, last.find('=')));
    }
    return "";
  }

  /// Whether the last word is an option without its value.
  bool lacks_value() const { return lacks_value_; }

  /// Values of an option, by the index of its row; without any, that of its environment variable.
  std::vector<std::string> values(std::size_t row) const {
    std::vector<std::string> given = options_[row]->results();
    const char* const variable = rows_[row].rule.environment;
    const char* const text = given.empty() && variable != nullptr ? std::getenv(variable) : nullptr;
    if (text != nullptr) given.emplace_back(text);
    return given;
  }

  /// Whether an option is given.
  bool has(std::string_view name) const {
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (rows_[i].name() == name) return options_[i]->count() > 0;
    return false;
  }

 private:
  /// Message about the first word that no option takes.
  std::string unexpected() const {
    const std::vector<std::string> unknown = app_.remaining();
    const auto flag = std::find_if(unknown.begin(), unknown.end(),
                                   [](const std::string& word) { return word.starts_with('-'); });
    const std::string got = flag != unknown.end() ? *flag : unknown.front();
    std::vector<std::string> names;
    for (const OptionRow& row : rows_) names.push_back(row.name());
    return fmt::format("got {}, expected {}{}", printable(got),
                       got.starts_with('-') ? "one of its options" : "nothing more",
                       did_you_mean(got.substr(0, got.find('=')), {names.begin(), names.end()}));
  }

  /// Message about an option without its value.
  std::string without_value(std::string_view typed) const {
    for (const OptionRow& row : rows_)
      for (const std::string& name : row.typed_names())
        if (name == typed) return fmt::format("{}: got nothing, expected {}", row.name(), row.expectation());
    return fmt::format("got {}, expected a value after it", printable(typed));
  }

  const Rows& rows_;
  CLI::App app_;
  std::vector<CLI::Option*> options_;
  bool lacks_value_ = false;
};

/// Fault of an option together with the others: one that it needs is missing, or one that it excludes is
/// given; or an empty text.
std::string company_fault(const OptionRow& row, bool is_given, const Words& words) {
  if (!is_given)
    return row.rule.is_required ? fmt::format("got nothing, expected {}", row.expectation()) : "";
  if (!row.rule.needs.empty() && !words.has(row.rule.needs))
    return fmt::format("got it alone, expected {} with it", row.rule.needs);
  for (const std::string_view other : row.rule.excludes)
    if (words.has(other)) return fmt::format("got it with {}, expected one of the two", other);
  return "";
}

/// Assigns the words to the targets of the rows. Returns the first fault, or an empty text.
std::string take_words(const Rows& rows, const Words& words, Options& options) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<std::string> given = words.values(i);
    std::string fault = given.empty() ? "" : assign(rows[i], given, options.settings);
    if (fault.empty()) fault = company_fault(rows[i], !given.empty(), words);
    if (!fault.empty()) return fmt::format("{}: {}", rows[i].name(), fault);
  }
  return "";
}

/// Prints a fault on stderr.
Done refuse(std::string_view name, std::string_view fault) {
  print_sentence(stderr, fmt::format("{}: {}", name, fault));
  fmt::print(stderr, "See `{} --help`.\n", name);
  return {kUsage};
}

}  // namespace

Rows options_of(const Command& command, Options& options) {
  Rows rows = command.rows == nullptr ? Rows{} : command.rows(options);
  if (command.is_planning)
    rows.push_back({"--no-cache", "", "Compute plans and limits again, and keep none in the cache folder",
                    Off{&options.uses_cache}});
  return rows;
}

std::variant<Options, Done> parse_command_line(int count, const char* const* words) {
  if (count < 2) return fmt::print(stderr, "{}", kFirstSteps), Done{kUsage};
  const std::string_view first = words[1];
  if (first == "-h" || first == "--help") return fmt::print("{}", program_help()), Done{};
  if (first == "--version") return fmt::print("{}", version_text()), Done{};
  const auto command = std::find_if(commands().begin(), commands().end(),
                                    [&](const Command& each) { return each.name == first; });
  if (command == commands().end()) return refuse("chicane", command_fault(first));
  Options options;
  options.command = first;
  options.words.assign(words + 2, words + count);
  const Rows rows = options_of(*command, options);
  Words given(rows);
  bool wants_help = false;
  std::string fault = given.read(count - 1, words + 1, wants_help);
  if (wants_help)
    return fmt::print("{}", command_help(command->name, command->summary, rows, command->example)), Done{};
  // The fault of a value comes first: an unexpected word is often the rest of a value with blanks.
  if (const std::string value_fault = take_words(rows, given, options);
      !value_fault.empty() && !given.lacks_value())
    fault = value_fault;
  if (!fault.empty()) return refuse(fmt::format("chicane {}", first), fault);
  return options;
}

}  // namespace chicane::apps
