// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

#include "options.hpp"

namespace chicane::apps {

/// The body of a program's `main`: reads the command line, does `run`, and prints what went wrong. `words`:
/// main's, the program first and a command second.
[[nodiscard]] int program(int count, const char* const* words, ExitCode (*run)(const Options&)) noexcept;

/// Signals closer to the first than this are the same request: a terminal or a program like `timeout` may
/// send one to the process and one to its group, and a second Ctrl-C by hand takes longer.
inline constexpr std::chrono::milliseconds kOneInterrupt{500};

/// Makes Ctrl-C and SIGTERM end the process at once, even if its parent ignores them: a racing line is
/// planned for up to half a minute, and there is nothing to keep yet.
void let_interrupts_end();

/// Makes Ctrl-C and SIGTERM set `flag`, for a run that ends itself with its results. Another signal more than
/// `kOneInterrupt` after the first ends the process at once. `flag` must outlive the process's last signal:
/// make it static, or a variable of main().
void catch_interrupts(std::atomic<bool>& flag);

// Programs that are installed apart from this one, and do the work of one of its commands.

/// The program of that name: in the folder of this one, in libexec/chicane or bin of an installation, or on
/// PATH where `is_on_path`. Empty when there is none.
[[nodiscard]] std::string other_program(const std::string& name, bool is_on_path);

/// The folder that this program lies in; empty where the system does not say.
[[nodiscard]] std::string own_folder();

/// Becomes `program`, called with `words`. Comes back only where it cannot be started, with the reason.
[[nodiscard]] std::string become(const std::string& program, std::vector<std::string> words);

}  // namespace chicane::apps
