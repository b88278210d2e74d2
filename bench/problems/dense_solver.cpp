// SPDX-License-Identifier: MIT
// In a file of its own, as a user's model is: beside other problems the compiler would inline less of it.
#include "problems/tagged.hpp"

namespace chicane::bench {

template solver::SolveReport solve_compiled<arch::Native>(const DescribedProblem&,
                                                          const std::array<double, 8>&,
                                                          CompiledTrajectory<DescribedProblem>&) noexcept;

}  // namespace chicane::bench
