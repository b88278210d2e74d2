// SPDX-License-Identifier: MIT
#include "chicane/base/instruction_set.hpp"
#include "chicane/tracking/tracking_solver.hpp"

namespace chicane::tracking {

std::unique_ptr<TrackingSolver> make_tracking_solver(int most_iterations) {
  const solver::SolverOptions options{.tolerance = 1e-2,
                                      .loose_tolerance = 1e3,
                                      .max_iterations = most_iterations,
                                      .may_start_short = false,
                                      .start_from_states = true,
                                      .second_order = false};
  return with_instructions(chosen_instruction_set(), [&](auto instructions) {
    return make_tracking_solver<decltype(instructions)>(options);
  });
}

}  // namespace chicane::tracking
