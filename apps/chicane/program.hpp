// SPDX-License-Identifier: MIT
#pragma once

#include "options.hpp"

namespace chicane::apps {

/// What `main` of a program is: reads the command line, does `run`, and says what went wrong. `words`: those
/// of main, the first one the program, the second a command.
[[nodiscard]] int program(int count, const char* const* words, ExitCode (*run)(const Options&)) noexcept;

}  // namespace chicane::apps
