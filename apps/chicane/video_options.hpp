// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

namespace chicane::apps {

/// The options of `chicane video`.
void add_video(CLI::App& command, Options& options);

}  // namespace chicane::apps
