// SPDX-License-Identifier: MIT
#include "problems/structured_solver.hpp"

#include "problems/tagged.hpp"

namespace chicane::bench {

template solver::SolveReport solve_compiled<arch::Native>(const StructuredDescribedProblem&,
                                                          const std::array<double, 7>&,
                                                          StructuredTrajectory&) noexcept;
template solver::SolveReport solve_compiled<arch::Native>(const StructuredCorridorProblem&,
                                                          const std::array<double, 7>&,
                                                          StructuredTrajectory&) noexcept;

}  // namespace chicane::bench
