// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace chicane::apps {

/// From now on Ctrl-C and SIGTERM set the flag that is returned, for a run that ends itself with what it has;
/// the second one ends the process at once.
[[nodiscard]] const std::atomic<bool>& catch_interrupts();

}  // namespace chicane::apps
