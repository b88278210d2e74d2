// SPDX-License-Identifier: MIT
#pragma once

#include <ctime>

namespace chicane::bench {

/// CPU time of this thread [s]: what other programs take of a shared machine does not count.
inline double cpu_time() noexcept {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace chicane::bench
