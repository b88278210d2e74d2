// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// What is wrong with a command line, in the words of all our messages.
namespace chicane::apps {

/// "--speed-mph: got 60mph, expected a number", "--laps: got it twice (2, 3), expected once": the option,
/// what was got and what is expected. `command`: whose options were read.
[[nodiscard]] std::string usage_fault(const CLI::App& command, const CLI::ParseError& error);

}  // namespace chicane::apps
