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

/// Adds the CPU time of its life to a sum [s].
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) noexcept : sum_(sum), begin_(cpu_time()) {}
  ~Stopwatch() { sum_ += cpu_time() - begin_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  double begin_;
};

/// Result of another solver on one instance.
struct Outcome {
  bool is_solved = false;
  bool is_impossible = false;  ///< it ended where the misses have a local minimum
  int iterations = 0;
  double cost = 0.0;  ///< by the independent check; where it is impossible: the sum of all misses
  double time = 0.0;  ///< CPU time from the call to the answer [s]
  double time_in_functions = 0.0;  ///< values and derivatives of the problem in it [s]; 0 = not measured
};

}  // namespace chicane::bench
