// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

namespace chicane::apps {

/// Adds the command `chicane import` with its options.
void add_import(CLI::App& command, Options& options);

}  // namespace chicane::apps
