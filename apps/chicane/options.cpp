// SPDX-License-Identifier: MIT
#include "options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <utility>

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/version.hpp"
#include "command_text.hpp"
#include "commands.hpp"
#include "setting_options.hpp"
#include "usage.hpp"

namespace chicane::apps {
namespace {

void add_commands(CLI::App& app, Options& options) {
  for (const Command& command : commands()) {
    CLI::App* const sub = app.add_subcommand(std::string(command.name), std::string(command.summary));
    sub->group(std::string(command.group));
    sub->footer("Example: chicane " + std::string(command.name));  // of a command without options
    command.add_options(*sub, options);
    if (command.is_planning)
      add_negation(*sub, "--no-cache", options.uses_cache,
                   "Compute plans and limits anew, and keep none in the cache folder");
  }
}

/// "NAME|FILE:{a,b}", as the parser shows it: the value's name, and the words it takes.
void read_type(const CLI::Option& option, OptionText& text) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  text.value = type.substr(0, type.find(':'));
  for (std::size_t at = open; at != std::string::npos && at + 1 < type.size();) {
    const std::size_t end = type.find_first_of(",}", at + 1);
    text.choices.push_back(type.substr(at + 1, end - at - 1));
    at = end == std::string::npos || type[end] == '}' ? std::string::npos : end;
  }
}

OptionText text_of(const CLI::Option& option) {
  OptionText text;
  text.help = option.get_description();
  text.is_required = option.get_required();
  text.takes_several = option.get_items_expected_max() > 1;
  for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  text.default_value = option.get_default_str();
  if (option.get_items_expected_max() > 0) read_type(option, text);
  return text;
}

Done explain(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const CLI::App& at = chosen.empty() ? app : *chosen.front();
  if (error.get_exit_code() == 0) {  // help or version
    fmt::print("{}", error.get_name() == "CallForVersion" ? std::string(error.what()) + "\n" : app.help());
    return {kSuccess};
  }
  const std::string name = chosen.empty() ? "chicane" : fmt::format("chicane {}", at.get_name());
  fmt::print(stderr, "{}: {}\nSee `{} --help`.\n", name, usage_fault(at, error), name);
  return {kUsage};
}

/// Six lines for a newcomer, in place of all commands.
constexpr std::string_view kFirstSteps =
    "chicane drive                        drives a lap; open the link that it prints\n"
    "chicane drive --preset race --fast   races at once and prints the lap times\n"
    "chicane list                         presets, tracks, cars and scenarios to choose from\n"
    "chicane serve                        drives the car of another simulator, as Udacity's\n"
    "chicane COMMAND --help               options of a command, with an example\n"
    "chicane --help                       all commands\n";

/// The first word must be a command; empty when it is, or an option.
std::string command_fault(const char* const* words) {
  const std::string_view word = words[1];
  std::vector<std::string_view> names;
  for (const Command& command : commands()) names.push_back(command.name);
  if (word.starts_with("-") || std::find(names.begin(), names.end(), word) != names.end()) return "";
  const std::string_view best = protocol::nearest(word, names);
  return fmt::format("chicane: got the unknown command {}, expected one of {}{}", printable(word),
                     fmt::join(names, ", "), best.empty() ? "" : fmt::format(" (did you mean {}?)", best));
}

/// Its second line is there when this program cannot do what a package can.
std::string version_text() {
  const std::string left_out = instruction_sets_left_out();
  if (left_out.empty()) return "chicane " CHICANE_VERSION;
  return fmt::format("chicane {}\ninstruction sets: {} (not built in: {})", CHICANE_VERSION,
                     built_instruction_sets(), left_out);
}

}  // namespace

std::variant<Options, Done> parse_command_line(int count, const char* const* words) {
  Options options;
  CLI::App app("Drives a car round a track by model predictive control.", "chicane");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer("Example: chicane drive");
  add_commands(app, options);
  if (count < 2) {
    fmt::print(stderr, "{}", kFirstSteps);
    return Done{kUsage};
  }
  if (const std::string fault = command_fault(words); !fault.empty()) {
    fmt::print(stderr, "{}\nSee `chicane --help`.\n", fault);
    return Done{kUsage};
  }
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    return explain(app, error);
  }
  options.command = app.get_subcommands().front()->get_name();
  options.words.assign(words + 2, words + count);
  return options;
}

std::vector<CommandText> command_texts() {
  Options options;
  CLI::App app;
  add_commands(app, options);
  std::vector<CommandText> texts;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    CommandText text{command->get_name(), command->get_description(), {}, command->get_footer()};
    const std::string_view example = "Example: ";
    if (text.example.starts_with(example)) text.example.erase(0, example.size());
    for (const CLI::Option* option : command->get_options()) {
      if (option != command->get_help_ptr()) text.options.push_back(text_of(*option));
    }
    std::stable_partition(text.options.begin(), text.options.end(),
                          [](const OptionText& option) { return option.is_positional(); });
    texts.push_back(std::move(text));
  }
  return texts;
}

std::string shelf_of(const OptionText& option) {
  const std::string_view words = "chicane list ";
  const std::size_t at = option.help.find(words);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + words.size();
  return option.help.substr(begin,
                            option.help.find_first_not_of("abcdefghijklmnopqrstuvwxyz", begin) - begin);
}

}  // namespace chicane::apps
