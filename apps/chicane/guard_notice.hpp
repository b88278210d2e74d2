// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "chicane/safety/guard_options.hpp"
#include "chicane/scenario/scenario.hpp"
#include "options.hpp"

namespace chicane::apps {

/// One sentence on what these options of the guard leave open; empty where it guards with its defaults' aims.
[[nodiscard]] std::string guard_notice(const safety::GuardOptions& guard);

/// Prints guard_notice() to stderr, once, at the start of a run; nothing with --json.
void print_guard_notice(const Options& options, const safety::GuardOptions& guard);

/// Prints the scenario's notices to stderr, a line each, at the start of a run: also with --json.
void print_notices(const scenario::Scenario& scenario);

}  // namespace chicane::apps
