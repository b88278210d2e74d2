// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <vector>

#include "chicane/base/result.hpp"
#include "problems/reference.hpp"
#include "program/report.hpp"

namespace chicane::bench {

/// What `chicane bench` asks for.
struct Request {
  int instances = 100;                    ///< of each family
  std::vector<int> horizons{10, 20, 50};  ///< intervals, each 2 to kLongestHorizon
};

/// Everything that `chicane bench` times, beside these solvers; says on stderr what it is at. Ends early,
/// with what there is, when `stop` is set. Fails like run::ClosedLoop::create().
[[nodiscard]] Result<BenchReport> measure(const Request& request, References& references,
                                          const std::atomic<bool>& stop);

}  // namespace chicane::bench
