// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/solver/ocp_solver.hpp"
#include "problems/described_problem.hpp"
#include "problems/optimality.hpp"
#include "support/chicane_test.hpp"

/// Problems and starts for comparisons with Ipopt.
namespace chicane::test {

constexpr int kIpoptCapacity = 200;

/// Where a solve starts from: inputs of zero, those of a path-following law, or the optimum of a slightly
/// different problem.
enum class Start { kCold, kPathLaw, kWarm };

struct Family {
  Start start;
  int horizon;
  int count;
};

inline std::string name_of(const testing::TestParamInfo<Family>& info) {
  const char* start[] = {"Cold", "PathLaw", "Warm"};
  return std::string(start[static_cast<int>(info.param.start)]) + "N" + std::to_string(info.param.horizon);
}

template <class Problem>
void choose_start(Start start, const bench::Posed<Problem>& posed,
                  solver::OcpSolver<Problem, kIpoptCapacity>& ocp,
                  bench::DescribedTrajectory<kIpoptCapacity>& trajectory) {
  const int horizon = trajectory.horizon;
  trajectory = {};
  trajectory.horizon = horizon;
  if (start != Start::kCold) bench::guess_by_path_law(posed, trajectory);
  if (start == Start::kWarm) {  // the previous cycle: half a step earlier, another speed wanted
    Problem before = posed.problem;
    before.speed_reference -= 0.5;
    auto x0 = posed.start;
    x0[1] -= 0.05;
    x0[4] += 0.05;
    ocp.solve(before, x0, trajectory);
    solver::shift(trajectory, 0.5);
  }
  solver::roll_out(posed.problem, posed.start, trajectory);
}

inline constexpr Family kFamilies[] = {
    {Start::kCold, 1, 20},    {Start::kCold, 2, 30},     {Start::kCold, 7, 40},     {Start::kCold, 10, 40},
    {Start::kCold, 20, 40},   {Start::kCold, 50, 20},    {Start::kPathLaw, 1, 20},  {Start::kPathLaw, 2, 30},
    {Start::kPathLaw, 7, 40}, {Start::kPathLaw, 10, 40}, {Start::kPathLaw, 20, 40}, {Start::kPathLaw, 50, 20},
    {Start::kWarm, 1, 20},    {Start::kWarm, 2, 30},     {Start::kWarm, 7, 40},     {Start::kWarm, 10, 40},
    {Start::kWarm, 20, 40},   {Start::kWarm, 50, 20}};

}  // namespace chicane::test
