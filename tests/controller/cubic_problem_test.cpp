// SPDX-License-Identifier: MIT
#include "chicane/controller/cubic_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "chicane/base/dual.hpp"
#include "chicane/base/random.hpp"
#include "chicane/solver/ocp_solver.hpp"

namespace chicane::controller {
namespace {

using States = CubicProblem::States<double>;
using Inputs = CubicProblem::Inputs<double>;
using Solver = solver::OcpSolver<CubicProblem, 200>;

CubicProblem sample_problem(LatencyHandling handling = LatencyHandling::kNone, bool right_positive = false) {
  CubicMpcOptions options;
  options.latency_handling = handling;
  options.steering_right_positive = right_positive;
  options.weight_speed_steer = 0.3;
  CubicProblem problem{options, model::VehicleParams{}};
  problem.line = {{0.4, -0.05, 0.004, -3e-5}};
  return problem;
}

TEST(CubicProblem, MovesAsDescribed) {
  const CubicProblem p = sample_problem();
  const States x{2.0, 0.3, 0.1, 12.0, 0.7, -0.04, 0.2, -0.5};
  const Inputs u{0.05, 0.8};
  const States next = p.dynamics(0, x, u);
  const double f = 0.4 - 0.05 * 2.0 + 0.004 * 4.0 - 3e-5 * 8.0;
  const double slope = -0.05 + 2.0 * 0.004 * 2.0 - 3.0 * 3e-5 * 4.0;
  const double turn = 12.0 / 2.67 * 0.05 * 0.1;
  EXPECT_NEAR(next[0], 2.0 + 12.0 * std::cos(0.1) * 0.1, 1e-14);
  EXPECT_NEAR(next[1], 0.3 + 12.0 * std::sin(0.1) * 0.1, 1e-14);
  EXPECT_NEAR(next[2], 0.1 + turn, 1e-14);
  EXPECT_NEAR(next[3], 12.0 + 0.8 * 0.1, 1e-14);
  EXPECT_NEAR(next[4], f - 0.3 + 12.0 * std::sin(-0.04) * 0.1, 1e-14);
  EXPECT_NEAR(next[5], 0.1 - std::atan(slope) + turn, 1e-14);
  EXPECT_EQ(next[6], 0.05);
  EXPECT_EQ(next[7], 0.8);
}

TEST(CubicProblem, TurnsTheOtherWayWithTheSimulatorsSign) {
  const States x{2.0, 0.3, 0.1, 12.0, 0.7, -0.04, 0.2, -0.5};
  const States left = sample_problem().dynamics(0, x, Inputs{0.05, 0.8});
  const States right = sample_problem(LatencyHandling::kNone, true).dynamics(0, x, Inputs{-0.05, 0.8});
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(left[i], right[i]) << i;
}

TEST(CubicProblem, DrivesAStageByTheInputsOfTheStageBeforeInsideTheModel) {
  const States x{2.0, 0.3, 0.1, 12.0, 0.7, -0.04, 0.2, -0.5};
  const States late = sample_problem(LatencyHandling::kInsideModel).dynamics(0, x, Inputs{0.05, 0.8});
  const States direct = sample_problem().dynamics(0, x, Inputs{0.2, -0.5});
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(late[i], direct[i]) << i;
  EXPECT_EQ(late[6], 0.05);
  EXPECT_EQ(late[7], 0.8);
}

TEST(CubicProblem, PaysTheDescribedSum) {
  const CubicProblem p = sample_problem();
  const States x{2.0, 0.3, 0.1, 12.0, 0.7, -0.04, 0.2, -0.5};
  const Inputs u{0.05, 0.8};
  double cost = 0.0;
  for (const double r : p.residual(1, x, u)) cost += 0.5 * r * r;
  const auto square = [](double v) { return v * v; };
  const double stage = 200.0 * square(0.7) + 200.0 * square(-0.04) + 0.1 * square(12.0 - 17.9) +
                       square(0.05) + square(0.8) + 0.3 * square(12.0 * 0.05);
  EXPECT_NEAR(cost, stage + 10.0 * square(0.05 - 0.2) + square(0.8 + 0.5), 1e-10);
  double first = 0.0;
  for (const double r : p.residual(0, x, u)) first += 0.5 * r * r;
  EXPECT_NEAR(first, stage, 1e-10);  // no change to pay for in the first stage
}

TEST(CubicProblem, HasTheDerivativesThatDifferencesShow) {
  using D = Dual<10>;
  Random random{5};
  for (const auto handling : {LatencyHandling::kNone, LatencyHandling::kInsideModel}) {
    const CubicProblem p = sample_problem(handling);
    for (int turn = 0; turn < 50; ++turn) {
      std::array<double, 10> z{};
      for (double& value : z) value = random.uniform(-0.4, 0.4);
      z[0] *= 100.0;
      z[3] = random.uniform(0.0, 50.0);
      const auto evaluate = [&](const std::array<double, 10>& at) {
        States x{};
        std::copy(at.begin(), at.begin() + 8, x.begin());
        const Inputs u{at[8], at[9]};
        std::vector<double> values;
        for (const double value : p.dynamics(1, x, u)) values.push_back(value);
        for (const double value : p.residual(1, x, u)) values.push_back(value);
        return values;
      };
      std::array<D, 8> x;
      for (int i = 0; i < 8; ++i)
        x[static_cast<std::size_t>(i)] = D::variable(z[static_cast<std::size_t>(i)], i);
      const std::array<D, 2> u{D::variable(z[8], 8), D::variable(z[9], 9)};
      std::vector<D> duals;
      for (const D& value : p.dynamics(1, x, u)) duals.push_back(value);
      for (const D& value : p.residual(1, x, u)) duals.push_back(value);
      for (std::size_t j = 0; j < 10; ++j) {
        const double h = 1e-6 * std::max(1.0, std::fabs(z[j]));
        auto plus = z;
        auto minus = z;
        plus[j] += h;
        minus[j] -= h;
        const auto a = evaluate(plus);
        const auto b = evaluate(minus);
        for (std::size_t i = 0; i < duals.size(); ++i) {
          // 1e-6 relative: rounding of central differences with h = 1e-6.
          ASSERT_NEAR(duals[i].d[j], (a[i] - b[i]) / (2.0 * h), 1e-6 * (1.0 + std::fabs(duals[i].d[j])))
              << i << ' ' << j;
        }
      }
    }
  }
}

std::vector<std::vector<double>> read_csv(const std::string& path) {
  std::vector<std::vector<double>> rows;
  std::ifstream file{path};
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells{line};
    std::string cell;
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

/// Ipopt's optima of the same formulation (tolerance 1e-10, ../shared/reference_nlp/README.md), every tenth
/// instance.
TEST(CubicProblem, HasTheOptimaThatIpoptFinds) {
  const std::string folder = std::string{CHICANE_SOURCE_DIR} + "/../shared/reference_nlp/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const auto solver = std::make_unique<Solver>();
  const auto answer = std::make_unique<Solver::Trajectory>();
  int compared = 0;
  int unequal = 0;
  int unsolved = 0;
  for (const auto& [set, n] :
       {std::pair{"30mps", 7}, {"30mps", 10}, {"30mps", 20}, {"30mps", 50}, {"16mps", 50}}) {
    const auto instances = read_csv(folder + "lap_" + set + ".csv");
    const auto golden = read_csv(folder + "golden_" + set + "_N" + std::to_string(n) + ".csv");
    for (std::size_t i = 0; i < golden.size(); i += 10) {
      const auto& g = golden[i];
      const auto& in = instances[static_cast<std::size_t>(g[0])];
      if (g[1] != 1.0) continue;
      CubicMpcOptions options;
      options.speed_reference = in[10];
      CubicProblem problem{options, model::VehicleParams{}};
      problem.line = {{in[6], in[7], in[8], in[9]}};
      answer->horizon = n - 1;
      answer->u.fill({});
      const auto report = solver->solve(problem, {in[0], in[1], in[2], in[3], in[4], in[5], 0.0, 0.0},
                                        *answer, Deadline::never());
      ++compared;
      if (report.status != solver::SolveStatus::kOptimal) {
        ++unsolved;
        continue;
      }
      // A non-convex problem may have a better minimum than the golden one; it must never be a worse one.
      EXPECT_LE(report.cost, g[2] * (1.0 + 1e-6)) << set << ' ' << n << ' ' << g[0];
      if (report.cost < g[2] * (1.0 - 1e-6)) ++unequal;
      if (std::fabs(report.cost - g[2]) <= 1e-9 * g[2]) {
        EXPECT_NEAR(answer->u[0][0], g[3], 1e-5);  // both solvers' tolerance, by the smallest weight
      }
    }
  }
  EXPECT_GT(compared, 100);
  EXPECT_LE(unequal, compared / 100);
  EXPECT_LE(unsolved, compared / 100)
      << "cold starts at 30 m/s are harder than any step of a running controller";
}

}  // namespace
}  // namespace chicane::controller
