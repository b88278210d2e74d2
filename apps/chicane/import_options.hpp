// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

namespace chicane::apps {

/// What `chicane import` takes.
void add_import(CLI::App& command, Options& options);

}  // namespace chicane::apps
