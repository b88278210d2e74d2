// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

/// The options of the commands that try a car's safety.
namespace chicane::apps {

void add_campaign(CLI::App& command, Options& options);
void add_recover(CLI::App& command, Options& options);
void add_lane_change(CLI::App& command, Options& options);

}  // namespace chicane::apps
