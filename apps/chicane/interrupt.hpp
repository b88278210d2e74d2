// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>

namespace chicane::apps {

/// Signals closer to the first than this are the same request: a terminal or a program like `timeout` may
/// send one to the process and one to its group, and a second Ctrl-C by hand takes longer.
inline constexpr std::chrono::milliseconds kOneInterrupt{500};

/// Makes Ctrl-C and SIGTERM end the process at once, also where whoever started it ignored them: a
/// racing line is planned for up to half a minute, and there is nothing to keep yet.
void let_interrupts_end();

/// From now on Ctrl-C and SIGTERM set `flag`, for a run that ends itself with what it has; another one, more
/// than `kOneInterrupt` after the first, ends the process at once. `flag` must outlive the process's last
/// signal: make it static, or one of main's.
void catch_interrupts(std::atomic<bool>& flag);

}  // namespace chicane::apps
