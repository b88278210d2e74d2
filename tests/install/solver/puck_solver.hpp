// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <chicane/solver/solution.hpp>

/// A puck on ice that is to be at 1 m, at rest, after 2 s in 20 steps; pushes of at most 1.5 m/s².
struct Plan {
  chicane::solver::SolveReport report;
  double position = 0.0;
  double speed = 0.0;
};

class PuckSolver {
 public:
  virtual ~PuckSolver() = default;
  virtual Plan solve() = 0;
};

template <class Arch>
std::unique_ptr<PuckSolver> make_puck_solver();
