// SPDX-License-Identifier: MIT
// Frame of the programs: main with its error handling, interrupts, the status line, and programs that take
// the place of this process.
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "options.hpp"

namespace chicane::apps {

/// Body of `main`: reads the command line, calls `run`, and prints errors. `words`: arguments of main, the
/// program first and the command second. Returns the exit code.
[[nodiscard]] int program(int count, const char* const* words, ExitCode (*run)(const Options&)) noexcept;

/// Body of `main` of a program that is one command. `words`: arguments of main, the program first and then
/// options.
[[nodiscard]] int program_of(const char* command, int count, const char* const* words,
                             ExitCode (*run)(const Options&)) noexcept;

/// Time after a first signal within which further ones are the same request; chosen: a terminal or a program
/// like `timeout` may signal the process and its group at once, and a second Ctrl-C by hand takes longer.
inline constexpr std::chrono::milliseconds kOneInterrupt{500};

/// Makes Ctrl-C and SIGTERM end the process at once, even if its parent ignores them. For the time before a
/// run, when there are no results to keep.
void let_interrupts_end();

/// Makes Ctrl-C and SIGTERM set `flag`, on which a run ends with its results. Another signal more than
/// kOneInterrupt after the first ends the process at once. Pre: `flag` is static or a variable of main(), so
/// that it outlives the last signal.
void catch_interrupts(std::atomic<bool>& flag);

/// Progress of some work on stderr: on a terminal one line, rewritten ten times a second, otherwise a line
/// every ten seconds.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine() { end(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  [[nodiscard]] bool is_terminal() const noexcept { return is_terminal_; }
  /// Time since the work began [s].
  [[nodiscard]] double seconds() const;
  /// Whether it is time for another show().
  [[nodiscard]] bool is_due() const { return Clock::now() >= next_; }
  /// Shows a line in place of the last one.
  void show(std::string_view line);
  /// Keeps the last line, and moves the cursor to the begin of the next one. Any thread.
  void end();
  /// Erases the last line.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool is_terminal_;
  std::atomic<bool> has_line_{false};  ///< the cursor is at the end of a line that will be rewritten
  Clock::time_point begin_ = Clock::now();
  Clock::time_point next_;  ///< time of the next show()
};

// Programs beside this one that run some of its commands.

/// Path of the program of that name: in the folder of this one, in libexec/chicane or bin of an installation,
/// or with `is_on_path` on PATH. Empty if there is none.
[[nodiscard]] std::string other_program(const std::string& name, bool is_on_path);

/// Folder of this program; empty if the system does not know it.
[[nodiscard]] std::string own_folder();

/// Replaces this process by `program` with the arguments `words`. Returns only on failure, with the reason.
[[nodiscard]] std::string become(const std::string& program, std::vector<std::string> words);

}  // namespace chicane::apps
