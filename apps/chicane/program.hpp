// SPDX-License-Identifier: MIT
#pragma once

#include "options.hpp"

namespace chicane::apps {

/// The body of a program's `main`: reads the command line, does `run`, and prints what went wrong. `words`:
/// main's, the program first and a command second.
[[nodiscard]] int program(int count, const char* const* words, ExitCode (*run)(const Options&)) noexcept;

}  // namespace chicane::apps
