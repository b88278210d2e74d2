// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/random.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "problems/corridor_problem.hpp"
#include "problems/described_problem.hpp"

namespace chicane::bench {

/// Where a solve starts from.
enum class Start {
  kCold,     ///< inputs of zero
  kPathLaw,  ///< inputs of a path-following law
  kWarm,     ///< the optimum of the control cycle before, shifted by one interval
};

/// One problem with its start, and for warm ones the cycle before.
template <class Problem, int Capacity>
struct FamilyInstance {
  Problem problem;
  std::array<double, DescribedProblem::kNx> start{};
  DescribedTrajectory<Capacity> guess;

  Problem before;
  std::array<double, DescribedProblem::kNx> start_before{};
  DescribedTrajectory<Capacity> guess_before;
};

/// The car one interval later: pushed aside by up to 0.1 m, with another speed wanted; measured anew.
template <class Problem>
void drive_on(Random& random, const std::array<double, DescribedProblem::kNu>& input, Problem& problem,
              std::array<double, DescribedProblem::kNx>& x) {
  x = problem.dynamics(0, x, input);
  x[1] += random.uniform(-0.1, 0.1);
  x[3] += random.uniform(-0.1, 0.1);
  problem.speed_reference += random.uniform(-0.5, 0.5);
  const auto& path = problem.path;
  x[4] = path[0] + x[0] * (path[1] + x[0] * (path[2] + x[0] * path[3])) - x[1];
  x[5] = x[2] - atan(path[1] + x[0] * (2.0 * path[2] + x[0] * (3.0 * path[3])));
}

/// The next random instance. `ocp` solves the cycle before a warm one.
template <class Problem, int Capacity>
FamilyInstance<Problem, Capacity> next_instance(Random& random, int horizon, Start start,
                                                solver::OcpSolver<Problem, Capacity>& ocp) {
  FamilyInstance<Problem, Capacity> instance;
  DescribedInstance plain;
  if constexpr (Problem::kNc > 0) {
    const CorridorInstance corridor = random_corridor(random, horizon);
    instance.problem = corridor.problem;
    plain = {.problem = corridor.problem, .start = corridor.start};
  } else {
    plain = random_instance(random, horizon);
    instance.problem = plain.problem;
  }
  instance.start = plain.start;
  instance.guess.horizon = horizon;
  if (start != Start::kCold) guess_by_path_law(plain, instance.guess);
  if (start == Start::kWarm) {
    instance.before = instance.problem;
    instance.start_before = instance.start;
    solver::roll_out(instance.problem, instance.start, instance.guess);
    instance.guess_before = instance.guess;
    ocp.solve(instance.problem, instance.start, instance.guess);
    drive_on(random, instance.guess.u[0], instance.problem, instance.start);
    solver::shift(instance.guess, 1.0);
  }
  solver::roll_out(instance.problem, instance.start, instance.guess);
  return instance;
}

}  // namespace chicane::bench
