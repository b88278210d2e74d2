// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

/// The options of the commands that drive many runs.
namespace chicane::apps {

void add_jobs(CLI::App& command, int& jobs);
void add_sweep(CLI::App& command, Options& options);
/// What `tune` has beside the options of a run.
void add_search(CLI::App& command, Options& options);
void add_league(CLI::App& command, Options& options);
void add_claims(CLI::App& command, Options& options);
void add_merge(CLI::App& command, Options& options);

}  // namespace chicane::apps
