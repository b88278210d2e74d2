// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/controller/cubic_solver.hpp"

namespace chicane::bench {

/// CppAD and Ipopt as the write-ups' programs use them: derivatives by a tape that each solve records, every
/// solve from zeros, the options of the course's template but for max_cpu_time, 10 s where it has 0.5 s, so
/// that no answer depends on the clock. Allocates.
[[nodiscard]] std::unique_ptr<controller::CubicSolver> make_cppad_solver();

}  // namespace chicane::bench
