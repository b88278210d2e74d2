// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The command line as text, read off its parser: what the manual page and the shells' completion are made
/// of.
namespace chicane::apps {

/// One option or one positional argument of a command.
struct OptionText {
  std::vector<std::string> names;  ///< as typed: "-o", "--output"; none of a positional argument
  std::string value;               ///< name of its value, "NAME|FILE"; empty for a flag
  std::string help;
  std::string default_value;         ///< the value without it; empty where there is none, or the help says it
  std::vector<std::string> choices;  ///< the words it takes, where these are few
  bool is_required = false;
  bool takes_several = false;

  [[nodiscard]] bool is_positional() const { return names.empty(); }
};

struct CommandText {
  std::string name;
  std::string summary;
  std::vector<OptionText> options;  ///< positional ones first
  std::string example;
};

/// All commands in the order of the help.
[[nodiscard]] std::vector<CommandText> command_texts();

/// What of `chicane list` completes the value of an option, by its help: "presets" for "... (chicane list
/// presets)"; empty where it says nothing.
[[nodiscard]] std::string shelf_of(const OptionText& option);

/// The manual page, for man(7).
[[nodiscard]] std::string manual_page();

/// A script that completes command lines; shell is bash, zsh or fish.
[[nodiscard]] std::string completion_script(std::string_view shell);

}  // namespace chicane::apps
