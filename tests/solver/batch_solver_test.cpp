// SPDX-License-Identifier: MIT
#include "chicane/solver/batch_solver.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "chicane/solver/ocp_solver.hpp"
#include "problems/described_problem.hpp"
#include "problems/optimality.hpp"
#include "solver/batch_cases.hpp"
#include "support/alloc_guard.hpp"

namespace chicane {
namespace {

using bench::DescribedProblem;
using test::BatchProblem;
using test::BatchTrajectory;

struct Batch {
  std::vector<bench::DescribedInstance> instances;
  std::vector<BatchProblem> problems;
  std::vector<std::array<double, 7>> starts;
  std::vector<BatchTrajectory> trajectories;
  std::vector<solver::SolveReport> reports;

  Batch(std::uint64_t seed, std::size_t count, int horizon)
      : instances(count), problems(count), starts(count), trajectories(count), reports(count) {
    Random random{seed};
    for (std::size_t i = 0; i < count; ++i) {
      instances[i] = bench::random_instance(random, horizon);
      problems[i] = bench::for_batch(instances[i].problem, instances[i].start[4]);
      starts[i] = bench::StructuredDescribedProblem::without_cte(instances[i].start);
      bench::DescribedTrajectory<test::kBatchCapacity> guess;
      guess.horizon = horizon;
      bench::guess_by_path_law(instances[i], guess);
      trajectories[i].horizon = horizon;
      for (std::size_t k = 0; k < static_cast<std::size_t>(horizon); ++k) trajectories[i].u[k] = guess.u[k];
    }
  }
  void solve(InstructionSet set) {
    with_instructions(
        set, [&](auto arch) { test::solve_batch<decltype(arch)>(problems, starts, trajectories, reports); });
  }
};

std::vector<InstructionSet> available_sets() {
  std::vector<InstructionSet> sets;
  for (const auto set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512, InstructionSet::kNeon}) {
    if (is_available(set)) sets.push_back(set);
  }
  return sets;
}

TEST(BatchSolver, FindsTheOptimaOfSingleSolves) {
  const auto ocp = std::make_unique<solver::OcpSolver<DescribedProblem, test::kBatchCapacity>>();
  for (const InstructionSet set : available_sets()) {
    for (const int horizon : {1, 2, 10, 20, 30}) {
      Batch batch(61, 45, horizon);
      batch.solve(set);
      int given_up = 0;
      for (std::size_t i = 0; i < batch.problems.size(); ++i) {
        if (batch.reports[i].status != solver::SolveStatus::kOptimal) {
          ++given_up;
          continue;
        }
        bench::DescribedTrajectory<test::kBatchCapacity> single;
        single.horizon = horizon;
        bench::guess_by_path_law(batch.instances[i], single);
        const auto report = ocp->solve(batch.instances[i].problem, batch.instances[i].start, single);
        ASSERT_EQ(report.status, solver::SolveStatus::kOptimal);
        EXPECT_NEAR(batch.reports[i].cost, report.cost, 1e-9 * (1.0 + report.cost));
        EXPECT_LE(batch.reports[i].stationarity, 1e-6);
        for (std::size_t k = 0; k < static_cast<std::size_t>(horizon); ++k) {
          // Both stop at slopes of 1e-6; curvatures are at least 2.
          EXPECT_NEAR(batch.trajectories[i].u[k][0], single.u[k][0], 1e-6);
          EXPECT_NEAR(batch.trajectories[i].u[k][1], single.u[k][1], 1e-6);
          single.u[k] = batch.trajectories[i].u[k];
        }
        EXPECT_LE(bench::projected_gradient(batch.instances[i].problem, batch.instances[i].start, single),
                  1e-5);
      }
      EXPECT_LE(given_up, 4) << to_string(set) << ", horizon " << horizon;
    }
  }
}

TEST(BatchSolver, TheLaneAndTheNeighboursOfAProblemDoNotChangeItsBits) {
  for (const InstructionSet set : available_sets()) {
    Batch together(62, 21, 20);
    together.solve(set);
    for (std::size_t i = 0; i < together.problems.size(); i += 5) {
      Batch all(62, 21, 20);
      Batch alone(62, 1, 20);
      alone.problems = {all.problems[i]};
      alone.starts = {all.starts[i]};
      alone.trajectories = {all.trajectories[i]};
      alone.solve(set);
      EXPECT_EQ(
          std::memcmp(&alone.trajectories[0].u, &together.trajectories[i].u, sizeof alone.trajectories[0].u),
          0)
          << to_string(set) << ", problem " << i;
    }
  }
}

TEST(BatchSolver, GivesTheSameBitsForEveryWidthOfRegisters) {
  if (!is_available(InstructionSet::kAvx512)) GTEST_SKIP() << "needs a processor with AVX-512";
  Batch narrow(63, 24, 20);
  Batch wide(63, 24, 20);
  narrow.solve(InstructionSet::kAvx2);
  wide.solve(InstructionSet::kAvx512);
  for (std::size_t i = 0; i < narrow.problems.size(); ++i)
    EXPECT_EQ(
        std::memcmp(&narrow.trajectories[i].u, &wide.trajectories[i].u, sizeof narrow.trajectories[i].u), 0);
}

TEST(BatchSolver, AllocatesNothingButItself) {
  for (const InstructionSet set : available_sets()) {
    Batch batch(65, 20, 20);
    const test::AllocationGuard guard;
    batch.solve(set);
    EXPECT_EQ(guard.count(), 1) << to_string(set);
  }
}

TEST(BatchSolver, HandsOverWhatIsNotANumberAndLeavesTheRestAlone) {
  for (const InstructionSet set : available_sets()) {
    Batch whole(64, 9, 20);
    whole.solve(set);
    Batch batch(64, 9, 20);
    batch.problems[3].path[1] = std::numeric_limits<double>::quiet_NaN();
    batch.starts[5][3] = std::numeric_limits<double>::infinity();
    batch.solve(set);
    for (std::size_t i = 0; i < batch.problems.size(); ++i) {
      if (i == 3 || i == 5) {
        EXPECT_EQ(batch.reports[i].status, solver::SolveStatus::kStalled) << to_string(set);
      } else {
        EXPECT_EQ(batch.reports[i].status, whole.reports[i].status);
        EXPECT_EQ(batch.reports[i].cost, whole.reports[i].cost);
      }
    }
  }
}

}  // namespace
}  // namespace chicane
