// SPDX-License-Identifier: MIT
#include "chicane/solver/batch_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "chicane/solver/ocp_solver.hpp"
#include "problems/optimality.hpp"
#include "solver/batch_cases.hpp"
#include "support/alloc_guard.hpp"

namespace chicane {
namespace {

using bench::CorridorProblem;
using bench::DescribedOver;
using bench::DescribedProblem;
using solver::SolveReport;
using solver::SolveStatus;
using test::BatchState;
using test::BatchTrajectory;
using test::CappedCorridor;
using test::kBatchCapacity;

/// What makes a problem unpleasant.
enum class Kind { kRandom, kCold, kStandstill, kStraight, kHairpin, kTightBounds, kNoWidth, kHeavy, kCount };

template <class Plain>
void spoil(Kind kind, Random& random, Plain& p, double& speed) {
  if (kind == Kind::kStandstill) speed = 0.0;
  if (kind == Kind::kStraight) {
    p.path = {};
    p.speed_reference = speed;
  }
  if (kind == Kind::kHairpin) {
    p.path[2] = random.uniform(0.03, 0.06) * (random.uniform() < 0.5 ? -1.0 : 1.0);
    speed = random.uniform(3.0, 9.0);
    p.speed_reference = random.uniform(3.0, 9.0);
  }
  if (kind == Kind::kTightBounds) {
    p.steer_limit = random.uniform(1e-4, 5e-3);
    p.acceleration_limit = random.uniform(1e-4, 5e-3);
    p.path[0] = random.uniform(2.0, 4.0);
  }
  if (kind == Kind::kNoWidth) p.steer_limit = 0.0;
  if (kind == Kind::kHeavy) p.path[0] = random.uniform(4.0, 12.0) * (random.uniform() < 0.5 ? -1.0 : 1.0);
}

template <template <class> class Over>
constexpr bool kHasCorridor = Over<double>::kNc > 0;

int given_up = 0;
template <class Problem>
SolveReport solve_alone(const Problem& problem, const BatchState& start, BatchTrajectory& trajectory) {
  static solver::OcpSolver<Problem, kBatchCapacity> ocp{{.max_iterations = 100}};
  return ocp.solve(problem, start, trajectory);
}
template <class Problem>
SolveReport give_up(const Problem& problem, const BatchState& start, BatchTrajectory& trajectory) {
  ++given_up;
  return solve_alone(problem, start, trajectory);
}

template <template <class> class Over>
struct Batch {
  using Plain = std::conditional_t<kHasCorridor<Over>, CorridorProblem, DescribedProblem>;
  std::vector<Plain> plain;
  std::vector<std::array<double, 8>> plain_starts;
  std::vector<Over<double>> problems;
  std::vector<BatchState> starts;
  std::vector<BatchTrajectory> trajectories;
  std::vector<SolveReport> reports;

  Batch(std::uint64_t seed, std::size_t count, int horizon, Kind kind = Kind::kRandom)
      : plain(count),
        plain_starts(count),
        problems(count),
        starts(count),
        trajectories(count),
        reports(count) {
    Random random{seed};
    for (std::size_t i = 0; i < count; ++i) {
      if constexpr (kHasCorridor<Over>) {
        plain[i] = bench::random_corridor(random, horizon).problem;
      } else {
        plain[i] = bench::random_instance(random, horizon).problem;
      }
      double speed = random.uniform(5.0, 25.0);
      spoil(kind, random, plain[i], speed);
      bench::DescribedInstance instance{.problem = plain[i]};
      instance.place(speed);
      plain_starts[i] = instance.start;
      static_cast<decltype(bench::for_batch(plain[i], 0.0, 0))&>(problems[i]) =
          bench::for_batch(plain[i], instance.start[4], horizon);
      starts[i] = bench::StructuredDescribedProblem::without_cte(instance.start);
      bench::DescribedTrajectory<kBatchCapacity> guess;
      guess.horizon = trajectories[i].horizon = horizon;
      if (kind == Kind::kCold) continue;
      bench::guess_by_path_law(instance, guess);
      trajectories[i].u = guess.u;
    }
  }
  void solve(InstructionSet set) {
    given_up = 0;
    with_instructions(set, [&](auto arch) {
      test::solve_batch<decltype(arch), Over>(problems, starts, trajectories, reports, give_up<Over<double>>);
    });
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

/// Statuses and optima of single solves, or, from a cold start, of another local optimum as good as theirs.
template <template <class> class Over>
void expect_the_same(const Batch<Over>& guesses, const Batch<Over>& batch, int horizon, int& elsewhere) {
  for (std::size_t i = 0; i < batch.problems.size(); ++i) {
    BatchTrajectory single = guesses.trajectories[i];
    const SolveReport report = solve_alone(batch.problems[i], batch.starts[i], single);
    const SolveReport& ours = batch.reports[i];
    bench::DescribedTrajectory<kBatchCapacity> answer;
    answer.horizon = horizon;
    answer.u = batch.trajectories[i].u;
    ASSERT_TRUE(bench::inputs_are_inside(batch.plain[i], answer)) << i;
    if constexpr (!kHasCorridor<Over>) {
      ASSERT_LE(bench::projected_gradient(batch.plain[i], batch.plain_starts[i], answer),
                1e-5 + 1e-11 * ours.cost)
          << i;
    }
    ASSERT_LE(ours.stationarity, 1e-6);
    ASSERT_LE(ours.complementarity, 1e-6);
    if (std::fabs(ours.cost - report.cost) > 1e-7 * (1.0 + report.cost)) {
      ++elsewhere;
      continue;
    }
    ASSERT_EQ(ours.status, report.status) << i;
    ASSERT_NEAR(ours.violation, report.violation, 1e-6) << i;
    if (ours.violation > 1e-3) {
      ASSERT_EQ(ours.worst_stage, report.worst_stage) << i;
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(horizon); ++k) {
      // Both stop at slopes of 1e-6; curvatures are at least 2.
      ASSERT_NEAR(batch.trajectories[i].u[k][0], single.u[k][0], 2e-6) << i;
      ASSERT_NEAR(batch.trajectories[i].u[k][1], single.u[k][1], 2e-6) << i;
      for (std::size_t j = 0; j < 7; ++j)
        ASSERT_NEAR(batch.trajectories[i].x[k + 1][j], single.x[k + 1][j], 1e-4) << i;
    }
  }
}

template <template <class> class Over>
void expect_the_optima_of_single_solves() {
  for (const InstructionSet set : available_sets()) {
    for (int kind = 0; kind < static_cast<int>(Kind::kCount); ++kind) {
      int elsewhere = 0;
      int handed_over = 0;
      int count = 0;
      for (const int horizon : {1, 2, 10, 20, 30}) {
        const Batch<Over> guesses(61 + static_cast<std::uint64_t>(kind), 19, horizon,
                                  static_cast<Kind>(kind));
        Batch<Over> batch = guesses;
        batch.solve(set);
        handed_over += given_up;
        count += 19;
        SCOPED_TRACE(std::string(to_string(set)) + ", kind " + std::to_string(kind) + ", horizon " +
                     std::to_string(horizon));
        expect_the_same(guesses, batch, horizon, elsewhere);
        if (testing::Test::HasFatalFailure()) return;
      }
      EXPECT_LE(elsewhere, count / 20) << to_string(set) << ", kind " << kind;
      const bool is_hard = kHasCorridor<Over> || static_cast<Kind>(kind) == Kind::kHeavy;
      EXPECT_LE(handed_over, is_hard ? count / 4 : count / 20) << to_string(set) << ", kind " << kind;
    }
  }
}

TEST(BatchSolver, FindsTheOptimaOfSingleSolves) { expect_the_optima_of_single_solves<DescribedOver>(); }

TEST(BatchSolver, FindsTheOptimaOfSingleSolvesWithSoftConstraints) {
  expect_the_optima_of_single_solves<CappedCorridor>();
}

TEST(BatchSolver, SaysWhatIsInfeasible) {
  for (const InstructionSet set : available_sets()) {
    Batch<CappedCorridor> batch(67, 16, 20, Kind::kHeavy);
    batch.solve(set);
    int infeasible = 0;
    for (const SolveReport& report : batch.reports) {
      EXPECT_EQ(report.status, report.violation > 0.5 ? SolveStatus::kInfeasible : SolveStatus::kOptimal);
      infeasible += report.status == SolveStatus::kInfeasible ? 1 : 0;
    }
    EXPECT_GT(infeasible, 0) << to_string(set);
    EXPECT_LT(given_up, 16) << to_string(set);
  }
}

template <template <class> class Over>
void expect_the_same_bits_alone() {
  for (const InstructionSet set : available_sets()) {
    const Batch<Over> all(62, 21, 20);
    Batch<Over> together = all;
    together.solve(set);
    for (std::size_t i = 0; i < together.problems.size(); i += 5) {
      Batch<Over> alone(62, 1, 20);
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

TEST(BatchSolver, TheLaneAndTheNeighboursOfAProblemDoNotChangeItsBits) {
  expect_the_same_bits_alone<DescribedOver>();
  expect_the_same_bits_alone<CappedCorridor>();
}

TEST(BatchSolver, GivesTheSameBitsForEveryWidthOfRegisters) {
  if (!is_available(InstructionSet::kAvx512)) GTEST_SKIP() << "needs a processor with AVX-512";
  Batch<CappedCorridor> narrow(63, 24, 20);
  Batch<CappedCorridor> wide(63, 24, 20);
  narrow.solve(InstructionSet::kAvx2);
  wide.solve(InstructionSet::kAvx512);
  for (std::size_t i = 0; i < narrow.problems.size(); ++i)
    EXPECT_EQ(
        std::memcmp(&narrow.trajectories[i].u, &wide.trajectories[i].u, sizeof narrow.trajectories[i].u), 0);
}

TEST(BatchSolver, AllocatesNothing) {
  for (const InstructionSet set : available_sets()) {
    Batch<DescribedOver> batch(65, 20, 20);
    const test::AllocationGuard guard;
    batch.solve(set);
    EXPECT_EQ(guard.count(), 0) << to_string(set);
  }
}

/// What is not a number, or has bounds that cross, goes to the fallback, disturbs no neighbour, and leaves
/// nothing behind.
TEST(BatchSolver, HandsOverWhatIsNotANumberAndLeavesTheRestAlone) {
  for (const InstructionSet set : available_sets()) {
    const Batch<DescribedOver> guesses(64, 29, 20);
    Batch<DescribedOver> whole = guesses;
    whole.solve(set);
    Batch<DescribedOver> batch = guesses;
    batch.problems[3].line.c[1] = std::numeric_limits<double>::quiet_NaN();
    batch.starts[5][3] = std::numeric_limits<double>::infinity();
    batch.problems[7].steer_limit = -1.0;
    batch.problems[8].steer_limit = std::numeric_limits<double>::quiet_NaN();
    batch.trajectories[9].u[4][1] = std::numeric_limits<double>::quiet_NaN();
    batch.solve(set);
    EXPECT_EQ(given_up, 4) << to_string(set);
    Batch<DescribedOver> after = guesses;
    after.solve(set);
    for (std::size_t i = 0; i < batch.problems.size(); ++i) {
      const auto same = [&](const Batch<DescribedOver>& other) {
        return std::memcmp(&other.trajectories[i].u, &whole.trajectories[i].u,
                           sizeof whole.trajectories[i].u) == 0;
      };
      EXPECT_TRUE(same(after)) << to_string(set) << ", problem " << i;
      if (i == 3 || i == 5 || i == 7 || i == 8) {
        EXPECT_EQ(batch.reports[i].status, SolveStatus::kNotFinite) << to_string(set);
      } else if (i == 9) {  // only a guess: a zero takes its place
        EXPECT_EQ(batch.reports[i].status, SolveStatus::kOptimal) << to_string(set);
      } else {
        EXPECT_TRUE(same(batch)) << to_string(set) << ", problem " << i;
      }
    }
  }
}

}  // namespace
}  // namespace chicane
