// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace chicane::apps {

/// From now on Ctrl-C and SIGTERM set `flag`, for a run that ends itself with what it has; the second one
/// ends the process at once. `flag` must outlive the process's last signal: make it static, or one of main's.
void catch_interrupts(std::atomic<bool>& flag);

}  // namespace chicane::apps
