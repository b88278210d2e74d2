// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>

#include "options.hpp"

/// The options of the commands that drive many runs.
namespace chicane::apps {

void add_jobs(CLI::App& command, int& jobs);
/// `each`: what has a line of its own in the file.
void add_results(CLI::App& command, std::string& results, std::string_view each);
void add_sweep(CLI::App& command, Options& options);
/// What `tune` has beside the options of a run.
void add_search(CLI::App& command, Options& options);
void add_league(CLI::App& command, Options& options);
void add_claims(CLI::App& command, Options& options);
void add_merge(CLI::App& command, Options& options);

}  // namespace chicane::apps
