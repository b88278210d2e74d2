// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "options.hpp"

/// Building blocks of the options of commands.
namespace chicane::apps {

/// An option. `type`: the word for its value in the help.
template <class T>
CLI::Option* add(CLI::App& command, const char* name, T& value, const char* type, const std::string& help) {
  return command.add_option(name, value, help)->type_name(type);
}
/// The same, with its default in the help.
template <class T>
CLI::Option* add_shown(CLI::App& command, const char* name, T& value, const char* type,
                       const std::string& help) {
  return add(command, name, value, type, help)->capture_default_str();
}
/// --json of commands whose results are one object.
void add_json(CLI::App& command, Options& options);

/// One option that is another name for a setting of the schema.
void add_setting(CLI::App& command, Options& options, const std::string& name, const std::string& key,
                 const std::string& type, const std::string& help);
/// --set comes after all named options: the last one wins.
void add_set(CLI::App& command, Options& options);

/// Who drives: preset, controller, car and speed.
void add_controller(CLI::App& command, Options& options);
/// Where and how long: track, laps and seed.
void add_world(CLI::App& command, Options& options);

/// A flag that makes `value` false. CLI11's own "!--name" shows as --name{false} in the help.
void add_negation(CLI::App& command, const std::string& name, bool& value, const std::string& help);

}  // namespace chicane::apps
