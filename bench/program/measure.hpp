// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

#include "chicane/base/result.hpp"
#include "problems/reference.hpp"
#include "program/report.hpp"
#include "program/request.hpp"

namespace chicane::bench {

/// Everything that `chicane bench` times, beside these solvers; says on stderr what it is at. Ends early,
/// with what there is, when `stop` is set. Fails like run::ClosedLoop::create().
[[nodiscard]] Result<BenchReport> measure(const Request& request, References& references,
                                          const std::atomic<bool>& stop);

}  // namespace chicane::bench
