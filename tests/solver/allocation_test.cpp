// SPDX-License-Identifier: MIT

#include "chicane/solver/ocp_solver.hpp"
#include "problems/described_problem.hpp"
#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"

namespace {

using namespace chicane;

TEST(AllocationGuard, CountsEveryWayToTheHeap) {
  const test::AllocationGuard guard;
  auto number = std::make_unique<double>(1.0);
  EXPECT_EQ(guard.count(), 1);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  void* volatile raw = std::malloc(3);  // volatile: the compiler may not drop the pair
  EXPECT_EQ(guard.count(), 2);
  std::free(raw);
#endif
}

TEST(OcpSolver, AllocatesNothingInAHundredSolves) {
  constexpr int kLongest = 20;
  const auto solver = std::make_unique<solver::OcpSolver<bench::DescribedProblem, 50>>();
  const auto trajectory = std::make_unique<bench::DescribedTrajectory<50>>();
  Random random{1};
  const test::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    const bench::DescribedInstance instance = bench::random_instance(random, kLongest);
    trajectory->horizon = 1 + i % kLongest;
    const auto report = solver->solve(instance.problem, instance.start, *trajectory);
    ASSERT_EQ(report.status, solver::SolveStatus::kOptimal);
    solver::shift(*trajectory, 1.0);
  }
  EXPECT_EQ(guard.count(), 0);
}

}  // namespace
