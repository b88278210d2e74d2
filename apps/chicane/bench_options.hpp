// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

namespace chicane::apps {

/// Options of `chicane bench`.
void add_bench(CLI::App& command, Options& options);

}  // namespace chicane::apps
