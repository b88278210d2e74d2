// SPDX-License-Identifier: MIT
#include "chicane/controller/cubic_problem.hpp"

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/jet.hpp"
#include "chicane/base/random.hpp"
#include "chicane/controller/cubic_solver.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "controller/dense_cubic_problem.hpp"
#include "support/chicane_test.hpp"

namespace chicane::controller {
namespace {

using State = CubicProblem::State;
using Input = CubicProblem::Input;

const State kState{2.0, 0.3, 0.1, 12.0, -0.04, 0.2, -0.5};

CubicProblem sample_problem(LatencyHandling handling = LatencyHandling::kNone) {
  CubicMpcOptions options;
  options.latency_handling = handling;
  options.weight_speed_steer = 0.3;
  CubicProblem problem{options, model::VehicleParams{}};
  problem.line = {{0.4, -0.05, 0.004, -3e-5}};
  return problem;
}

State next(const CubicProblem& problem, const State& x, const Input& u) {
  return solver::next_state(problem, 1, x, u);
}

TEST(CubicProblem, DrivesAStageByTheInputsOfTheStageBeforeInsideTheModel) {
  const State late = next(sample_problem(LatencyHandling::kInsideModel), kState, {0.05, 0.8});
  const State direct = next(sample_problem(), kState, {0.2, -0.5});
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(late[i], direct[i]) << i;
  EXPECT_EQ(late[5], 0.05);
  EXPECT_EQ(late[6], 0.8);
}

double half_square(const auto& residual) {
  double sum = 0.0;
  for (const double r : solver::to_array<double>(residual)) sum += 0.5 * r * r;
  return sum;
}

TEST(CubicProblem, PaysTheDescribedSum) {
  CubicProblem p = sample_problem();
  p.first_lateral_error = 0.7;
  const Input u{0.05, 0.8};
  const auto square = [](double v) { return v * v; };
  const double errors = 200.0 * square(-0.04) + 0.1 * square(12.0 - 17.9);
  const double stage = 200.0 * square(p.next_lateral_error(kState)) + errors + square(0.05) + square(0.8) +
                       0.3 * square(12.0 * 0.05);
  EXPECT_NEAR(half_square(p.residual(1, kState, u)), stage + 10.0 * square(0.05 - 0.2) + square(0.8 + 0.5),
              1e-10);
  EXPECT_NEAR(half_square(p.residual(0, kState, u)), stage, 1e-10);  // no change to pay for in the first
  EXPECT_NEAR(half_square(p.terminal_residual(kState)), 200.0 * square(0.7) + errors, 1e-10);
}

/// Every handling that changes the model, both signs, metres and miles, the errors of `measured-latency` and
/// of the others.
std::vector<CubicProblem> all_variants(Random& random) {
  std::vector<CubicProblem> problems;
  for (const unsigned variant : {0U,  1U,  2U,  3U,  4U,  5U,  6U,  7U,  8U,  9U,  10U, 11U,
                                 12U, 13U, 14U, 15U, 24U, 25U, 26U, 27U, 28U, 29U, 30U, 31U}) {
    CubicMpcOptions options;
    options.latency_handling = (variant & 4U) != 0 ? LatencyHandling::kInsideModel : LatencyHandling::kNone;
    options.steering_right_positive = (variant & 2U) != 0;
    options.speed_in_mph = (variant & 1U) != 0;
    options.lateral_error_to_left = options.heading_error_integrated = (variant & 8U) != 0;
    options.lateral_error_integrated = (variant & 16U) != 0;
    options.speed_reference = random.uniform(5.0, 25.0);
    options.weight_speed_steer = random.uniform(0.0, 1.0);
    options.weight_steer_change = random.uniform(0.0, 100.0);
    options.weight_throttle = random.uniform(0.1, 50.0);
    CubicProblem problem{options, model::VehicleParams{}};
    problem.follow({{random.uniform(-1.5, 1.5), random.uniform(-0.3, 0.3), random.uniform(-4e-3, 4e-3),
                     random.uniform(-3e-5, 3e-5)}});
    problems.push_back(problem);
  }
  return problems;
}

/// By all states and inputs.
std::array<double, 9> slopes(const auto& value) {
  std::array<double, 9> d{};
  jet::repeat<9>([&](auto i) { d[i] = jet::number<double>(jet::slope<i>(value)); });
  return d;
}

TEST(CubicProblem, HasTheDerivativesThatDifferencesShow) {
  Random random{5};
  for (const CubicProblem& p : all_variants(random)) {
    for (int turn = 0; turn < 20; ++turn) {
      std::array<double, 9> z{};
      for (double& value : z) value = random.uniform(-0.4, 0.4);
      z[0] *= 100.0;
      z[3] = random.uniform(0.0, 50.0);
      const auto evaluate = [&](const std::array<double, 9>& at) {
        const State x{at[0], at[1], at[2], at[3], at[4], at[5], at[6]};
        const Input u{at[7], at[8]};
        std::vector<double> values;
        for (const double value : next(p, x, u)) values.push_back(value);
        for (const double value : solver::to_array<double>(p.residual(1, x, u))) values.push_back(value);
        return values;
      };
      // As the solver sees them: every variable of a type of its own.
      const auto x = std::make_tuple(seed<1, 0>(z[0]), seed<1, 1>(z[1]), seed<1, 2>(z[2]), seed<1, 3>(z[3]),
                                     seed<1, 4>(z[4]), seed<1, 5>(z[5]), seed<1, 6>(z[6]));
      const auto u = std::make_tuple(seed<1, 7>(z[7]), seed<1, 8>(z[8]));
      std::vector<std::array<double, 9>> rows;
      const auto collect = [&](const auto&... values) { (rows.push_back(slopes(values)), ...); };
      std::apply(collect, p.dynamics(1, x, u));
      std::apply(collect, p.residual(1, x, u));
      for (std::size_t j = 0; j < 9; ++j) {
        const double h = 1e-6 * std::max(1.0, std::fabs(z[j]));
        auto plus = z;
        auto minus = z;
        plus[j] += h;
        minus[j] -= h;
        const auto a = evaluate(plus);
        const auto b = evaluate(minus);
        ASSERT_EQ(rows.size(), a.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
          // 1e-6 relative: rounding of central differences with h = 1e-6.
          ASSERT_NEAR(rows[i][j], (a[i] - b[i]) / (2.0 * h), 1e-6 * (1.0 + std::fabs(rows[i][j])))
              << i << ' ' << j;
        }
      }
    }
  }
}

solver::SolveReport solve(const CubicProblem& problem, const State& start, CubicTrajectory& answer) {
  return with_instructions(chosen_instruction_set(), [&](auto instructions) {
    return make_cubic_solver<decltype(instructions)>({.max_iterations = 100})
        ->solve(problem, start, answer, Deadline::never());
  });
}

TEST(CubicProblem, HasTheOptimaOfTheDenseForm) {
  using Dense = solver::OcpSolver<DenseCubicProblem, 200>;
  const auto dense_solver = std::make_unique<Dense>(solver::SolverOptions{.max_iterations = 100});
  const auto dense = std::make_unique<Dense::Trajectory>();
  const auto answer = std::make_unique<CubicTrajectory>();
  Random random{11};
  int compared = 0;
  for (int turn = 0; turn < 8; ++turn) {
    for (const CubicProblem& problem : all_variants(random)) {
      const double speed = random.uniform(5.0, 25.0) * problem.speed_unit;
      const State start{0.0, 0.0, 0.0, speed, -std::atan(problem.line.slope(0.0)), random.uniform(-0.1, 0.1),
                        0.3};
      answer->horizon = dense->horizon = 9;
      answer->u.fill({});
      dense->u.fill({});
      const solver::SolveReport report = solve(problem, start, *answer);
      const DenseCubicProblem described{problem};
      const solver::SolveReport expected = dense_solver->solve(
          described, DenseCubicProblem::with_lateral_error(start, problem.first_lateral_error), *dense,
          Deadline::never());
      ASSERT_EQ(report.status, solver::SolveStatus::kOptimal);
      ASSERT_EQ(expected.status, solver::SolveStatus::kOptimal);
      if (std::fabs(report.cost - expected.cost) > 1e-6 * expected.cost) continue;  // another local optimum
      ++compared;
      for (std::size_t k = 0; k < 9; ++k) {
        ASSERT_NEAR(answer->u[k][0], dense->u[k][0], 2e-5) << k;  // both solvers' tolerance
        ASSERT_NEAR(answer->u[k][1], dense->u[k][1], 2e-4) << k;
      }
    }
  }
  EXPECT_GE(compared, 180) << "of 192";
}

TEST(CubicProblem, HasMirroredOptima) {
  const auto left = std::make_unique<CubicTrajectory>();
  const auto right = std::make_unique<CubicTrajectory>();
  Random random{3};
  for (CubicProblem problem : all_variants(random)) {
    State start{0.0, 0.0, 0.0, 15.0, -std::atan(problem.line.slope(0.0)), 0.05, 0.3};
    left->horizon = right->horizon = 9;
    left->u.fill({});
    right->u.fill({});
    (void)solve(problem, start, *left);
    Cubic mirrored = problem.line;
    for (double& c : mirrored.c) c = -c;
    problem.follow(mirrored);
    start[CubicProblem::kEpsi] = -start[CubicProblem::kEpsi];
    start[CubicProblem::kLastSteer] = -start[CubicProblem::kLastSteer];
    (void)solve(problem, start, *right);
    for (std::size_t k = 0; k < 9; ++k) {
      EXPECT_EQ(left->u[k][0], -right->u[k][0]) << k;  // the same arithmetic
      EXPECT_EQ(left->u[k][1], right->u[k][1]) << k;
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

/// Ipopt's optima of the same formulation (tolerance 1e-10, tests/reference_nlp/README.md), every tenth
/// instance.
TEST(CubicProblem, HasTheOptimaThatIpoptFinds) {
  const std::string folder = std::string{CHICANE_SOURCE_DIR} + "/tests/reference_nlp/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "optima are not compared with Ipopt's: no " << folder;
  const auto answer = std::make_unique<CubicTrajectory>();
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
      problem.first_lateral_error = in[4];
      const auto report = solve(problem, {in[0], in[1], in[2], in[3], in[5], 0.0, 0.0}, *answer);
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
