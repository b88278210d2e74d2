// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

namespace chicane::apps {

/// Options of `chicane limit`.
void add_limit(CLI::App& command, Options& options);

}  // namespace chicane::apps
