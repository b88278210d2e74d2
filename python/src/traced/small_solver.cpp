// SPDX-License-Identifier: MIT
#include "traced/solver_of_size.hpp"

namespace chicane::python {

template <class Arch>
std::unique_ptr<TracedSolver> make_small_solver(const TracedProblem& problem, const Workspace& workspace) {
  return std::make_unique<SolverOfSize<Arch, kSmall>>(problem, workspace);
}
template std::unique_ptr<TracedSolver> make_small_solver<arch::Native>(const TracedProblem&,
                                                                       const Workspace&);

}  // namespace chicane::python
