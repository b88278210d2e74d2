// SPDX-License-Identifier: MIT

#include "chicane/solver/ocp_solver.hpp"
#include "problems/described_problem.hpp"
#include "problems/optimality.hpp"
#include "support/chicane_test.hpp"
#include "support/slow_tests.hpp"

namespace chicane {
namespace {

using bench::DescribedProblem;

constexpr int kCapacity = 200;
const std::string kFolder = std::string(CHICANE_SOURCE_DIR) + "/tests/reference_nlp/";

/// Rows of numbers of a comma-separated file without its heading; empty when there is no such file.
std::vector<std::vector<double>> read_table(const std::string& file) {
  std::vector<std::vector<double>> table;
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    std::string cell;
    auto& row = table.emplace_back();
    while (std::getline(cells, cell, ',')) row.push_back(std::stod(cell));
  }
  return table;
}

struct GoldenSet {
  const char* lap;
  int nodes;  ///< states of the reference problem: one more than intervals
};

struct Golden : testing::TestWithParam<GoldenSet> {};

/// Calls visit(i, instance, optimum's row) for the problems of a set that Ipopt solved, in the normal run for
/// each third; false without any.
template <class Visit>
bool each_problem(const GoldenSet& set, const Visit& visit) {
  const std::string lap = set.lap;
  const auto cycles = read_table(kFolder + "lap_" + lap + ".csv");
  const auto optima = read_table(kFolder + "golden_" + lap + "_N" + std::to_string(set.nodes) + ".csv");
  constexpr std::size_t kStride = kDrivesAll ? 1 : 3;
  for (std::size_t i = 0; i < optima.size() && !cycles.empty(); i += kStride) {
    if (optima[i][1] != 1.0) continue;
    const auto& row = cycles[static_cast<std::size_t>(optima[i][0])];
    bench::DescribedInstance instance;
    instance.start = {row[0], row[1], row[2], row[3], row[4], row[5], 0.0, 0.0};
    instance.problem.path = {row[6], row[7], row[8], row[9]};
    instance.problem.speed_reference = row[10];
    visit(i, instance, optima[i]);
  }
  return !cycles.empty() && !optima.empty();
}
using Solver = solver::OcpSolver<DescribedProblem, kCapacity>;

/// Control cycles of closed loops on the original's lake with optima by Ipopt (tolerance 1e-10, exact
/// derivatives, bounds relaxed).
TEST_P(Golden, OptimaAndFirstInputsAgree) {
  const auto ocp = std::make_unique<Solver>(solver::SolverOptions{.max_iterations = 100});
  int better = 0;
  const auto trajectory = std::make_unique<bench::DescribedTrajectory<kCapacity>>();
  const auto compare = [&](std::size_t i, const bench::DescribedInstance& instance,
                           const std::vector<double>& optimum) {
    *trajectory = {};
    trajectory->horizon = GetParam().nodes - 1;
    bench::guess_by_path_law(instance, *trajectory);
    const auto report = ocp->solve(instance.problem, instance.start, *trajectory);
    ASSERT_EQ(report.status, solver::SolveStatus::kOptimal) << "cycle " << i;
    if (report.cost < (1.0 - 1e-6) * optimum[2]) {
      ++better;
      return;
    }
    const double relaxed =
        report.cost - bench::gain_of_relaxed_bounds(instance.problem, instance.start, *trajectory);
    ASSERT_NEAR(relaxed, optimum[2], 1e-8 * std::max(1.0, optimum[2])) << "cycle " << i;
    ASSERT_NEAR(trajectory->u[0][0], optimum[3], 1e-6) << "cycle " << i;
    ASSERT_NEAR(trajectory->u[0][1], optimum[4], 1e-6) << "cycle " << i;
  };
  if (!each_problem(GetParam(), compare)) GTEST_SKIP() << "no reference problems in " << kFolder;
  EXPECT_LE(better, 2) << "a few cycles far off the road have several local optima, most have one";
}

/// From inputs of zero: none ends higher than Ipopt.
TEST_P(Golden, ColdStartsEndNoHigher) {
  const auto ocp = std::make_unique<Solver>(solver::SolverOptions{.max_iterations = 100});
  const auto trajectory = std::make_unique<bench::DescribedTrajectory<kCapacity>>();
  const auto compare = [&](std::size_t i, const bench::DescribedInstance& instance,
                           const std::vector<double>& optimum) {
    *trajectory = {};
    trajectory->horizon = GetParam().nodes - 1;
    const auto report = ocp->solve(instance.problem, instance.start, *trajectory);
    EXPECT_EQ(report.status, solver::SolveStatus::kOptimal) << "cycle " << i;
    EXPECT_LE(report.cost, (1.0 + 1e-6) * optimum[2] + 1e-6) << "cycle " << i;
  };
  if (!each_problem(GetParam(), compare)) GTEST_SKIP() << "no reference problems in " << kFolder;
}

std::string name_of_set(const testing::TestParamInfo<GoldenSet>& info) {
  return "Lap" + std::string(info.param.lap) + "N" + std::to_string(info.param.nodes);
}
constexpr GoldenSet kSets[] = {{"30mps", 7},  {"30mps", 10}, {"30mps", 20}, {"30mps", 25},
                               {"30mps", 50}, {"16mps", 50}, {"8mps", 100}, {"4mps", 200}};
INSTANTIATE_TEST_SUITE_P(OcpSolver, Golden, testing::ValuesIn(kSets), name_of_set);

}  // namespace
}  // namespace chicane
