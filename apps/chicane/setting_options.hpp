// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "options.hpp"

/// Options that set a key of the schema.
namespace chicane::apps {

/// One option that is another name for a setting of the schema.
void add_setting(CLI::App& command, Options& options, const std::string& name, const std::string& key,
                 const std::string& type, const std::string& help);
/// --set comes after all named options: the last one wins.
void add_set(CLI::App& command, Options& options);

/// A flag that makes `value` false. CLI11's own "!--name" shows as --name{false} in the help.
void add_negation(CLI::App& command, const std::string& name, bool& value, const std::string& help);

}  // namespace chicane::apps
