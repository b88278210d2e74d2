// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "options.hpp"

namespace chicane::apps {

/// The body of a program's `main`: reads the command line, does `run`, and prints what went wrong. `words`:
/// main's, the program first and a command second.
[[nodiscard]] int program(int count, const char* const* words, ExitCode (*run)(const Options&)) noexcept;

/// Runs a program that is one command: `words` are main's, the program first and then its options.
[[nodiscard]] int program_of(const char* command, int count, const char* const* words,
                             ExitCode (*run)(const Options&)) noexcept;

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

/// Shows on stderr how far some work is: on a terminal one line that renews itself ten times a second,
/// otherwise a line every ten seconds.
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
  void show(std::string_view line);
  /// Leaves the cursor at the beginning of a line, below the one that was shown. Any thread.
  void end();
  /// Wipes the line that was shown.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool is_terminal_;
  std::atomic<bool> has_line_{false};  ///< the cursor stands behind a line that will be rewritten
  Clock::time_point begin_ = Clock::now();
  Clock::time_point next_;
};

// Programs that are installed apart from this one, and do the work of one of its commands.

/// The program of that name: in the folder of this one, in libexec/chicane or bin of an installation, or on
/// PATH where `is_on_path`. Empty when there is none.
[[nodiscard]] std::string other_program(const std::string& name, bool is_on_path);

/// The folder that this program lies in; empty where the system does not say.
[[nodiscard]] std::string own_folder();

/// Becomes `program`, called with `words`. Comes back only where it cannot be started, with the reason.
[[nodiscard]] std::string become(const std::string& program, std::vector<std::string> words);

}  // namespace chicane::apps
