// SPDX-License-Identifier: MIT
// Makes the tracking solver for the chosen instruction set, with the options of real time.
#include "chicane/base/instruction_set.hpp"
#include "chicane/tracking/tracking_solver.hpp"

namespace chicane::tracking {

std::unique_ptr<TrackingSolver> make_tracking_solver(int most_iterations) {
  // A step has time for a few iterations from the last plan: the largest tolerances that SolverOptions
  // permits make any iterate within the bounds an answer.
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
