// SPDX-License-Identifier: MIT
#include "traced/solver_of_size.hpp"

namespace chicane::python {

template std::unique_ptr<TracedSolver> make_sized_solver<arch::Native, kOf24States>(const TracedProblem&,
                                                                                    const Workspace&);

}  // namespace chicane::python
