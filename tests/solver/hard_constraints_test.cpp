// SPDX-License-Identifier: MIT
#include "chicane/solver/hard_constraints.hpp"

#include "chicane/solver/describe.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "families/hard.hpp"
#include "families/measure_family.hpp"
#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"

namespace chicane::bench {
namespace {

using solver::HardReport;
using solver::SolveStatus;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A mass is pushed from rest at 0 so that it is at `goal` with speed `end_speed` after N stages, for the
/// least sum of squares of the push.
struct Push {
  static constexpr int kNx = 2, kNu = 1, kNr = 1, kNe = 0, kNc = 1, kNeh = 1, kNec = 1;
  static constexpr double kStep = 0.1;
  double goal = 1.0, end_speed = 0.0, most = kInfinity, fastest = kInfinity, first_penalty = 1.0;

  template <class K, class X, class U>
  auto dynamics(K, const X& x, const U& u) const {
    const auto& [position, speed] = x;
    return std::make_tuple(position + kStep * speed, speed + kStep * std::get<0>(u));
  }
  template <class K, class X, class U>
  auto residual(K, const X&, const U& u) const {
    return std::make_tuple(1.0 * std::get<0>(u));
  }
  template <class X>
  auto terminal_residual(const X&) const {
    return std::make_tuple();
  }
  template <class X>
  auto terminal_equality(const X& x) const {
    return std::make_tuple(std::get<0>(x) - goal);
  }
  template <class X>
  auto terminal_constraint(const X& x) const {
    return std::make_tuple(std::get<1>(x) - end_speed);
  }
  template <class K, class X, class U>
  auto constraint(K, const X& x, const U&) const {
    return std::make_tuple(std::get<1>(x) - std::min(fastest, 1e6));
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const {
    return {.linear = first_penalty, .quadratic = 0.0};
  }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-most}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {most}; }
  [[nodiscard]] std::string_view terminal_equality_name(int) const { return "the goal"; }
};
constexpr int kStages = 20;
using PushSolver = solver::OcpSolver<Push, kStages>;
using PushPlan = PushSolver::Trajectory;

class HardConstraints : public testing::Test {
 protected:
  HardReport solve(const Push& problem) {
    plan_ = {.horizon = kStages};
    return ocp_->solve(problem, {0.0, 0.0}, plan_);
  }
  std::unique_ptr<PushSolver> ocp_ = std::make_unique<PushSolver>();
  PushPlan plan_;
};

TEST_F(HardConstraints, ReachAGoalForTheLeastPush) {
  const HardReport report = solve({});
  ASSERT_EQ(report.status, SolveStatus::kOptimal);
  // Least squares: u = Cᵀ (C Cᵀ)⁻¹ (1, 0), where C has what each push does to position and speed at the end.
  double pp = 0.0, ps = 0.0, ss = 0.0;
  const auto position = [](int k) { return Push::kStep * Push::kStep * (kStages - 1 - k); };
  for (int k = 0; k < kStages; ++k) {
    pp += position(k) * position(k);
    ps += position(k) * Push::kStep;
    ss += Push::kStep * Push::kStep;
  }
  const double det = pp * ss - ps * ps;
  for (int k = 0; k < kStages; ++k) {
    const double u = position(k) * ss / det - Push::kStep * ps / det;
    EXPECT_NEAR(plan_.u[static_cast<std::size_t>(k)][0], u, 1e-5) << k;
  }
  EXPECT_NEAR(plan_.x[kStages][0], 1.0, 1e-6);
  EXPECT_LE(plan_.x[kStages][1], 1e-6);
  EXPECT_NEAR(report.cost, 0.5 * ss / det, 1e-6 * report.cost + 1e-5);
}

TEST_F(HardConstraints, HaveMultipliersThatSayWhatARightHandSideCosts) {
  const double cost = solve({}).cost;
  const double by_goal = ocp_->terminal_equality_multiplier(0);
  const double by_speed = ocp_->terminal_constraint_multiplier(0);
  EXPECT_GT(by_speed, 0.0);
  constexpr double kChange = 1e-3;
  const double further = solve({.goal = 1.0 + kChange}).cost;
  const double faster = solve({.end_speed = kChange}).cost;
  EXPECT_NEAR((further - cost) / kChange, -by_goal, 0.01 * std::fabs(by_goal));  // h = p − goal
  EXPECT_NEAR((faster - cost) / kChange, -by_speed, 0.01 * by_speed);
  solve({.end_speed = 10.0});  // out of reach: as if it were not there
  EXPECT_EQ(ocp_->terminal_constraint_multiplier(0), 0.0);
}

TEST_F(HardConstraints, KeepAHardLimitWhoseFirstPenaltyIsTooLow) {
  for (const double penalty : {1e-4, 1.0, 1e4}) {
    const HardReport report = solve({.fastest = 0.6, .first_penalty = penalty});
    ASSERT_EQ(report.status, SolveStatus::kOptimal) << penalty;
    double fastest = 0.0;
    for (int k = 0; k < kStages; ++k) fastest = std::max(fastest, plan_.x[static_cast<std::size_t>(k)][1]);
    EXPECT_NEAR(fastest, 0.6, 1e-4) << penalty;
    EXPECT_LE(fastest, 0.6 + 1e-6) << penalty;
  }
}

TEST_F(HardConstraints, SayWhatCannotHoldAndWhere) {
  for (const double most : {0.01, 0.1, 0.5}) {  // pushing all the time brings it not even half the way
    const Push problem{.most = most};
    const HardReport report = solve(problem);
    EXPECT_EQ(report.status, SolveStatus::kInfeasible) << most;
    EXPECT_GT(report.miss, 0.05) << most;
    EXPECT_EQ(report.miss_stage, kStages) << most;
    EXPECT_LE(report.iterations, 300) << most;
    const std::string text = describe(problem, report);
    EXPECT_EQ(text.rfind("infeasible: ", 0), 0U) << text;
    if (report.kind == HardReport::Kind::kTerminalEquality) {
      EXPECT_NE(text.find("the goal missed by"), std::string::npos) << text;
    }
  }
}

TEST_F(HardConstraints, AreUsableOnlyWhereTheyHold) {
  constexpr double kReach = 1.9;  // of pushing with 1 m/s² for all stages [m]
  for (const double beyond : {1e-4, 3e-4, 5e-4, 1e-3, 3e-3, 1e-2, 0.1, 1.0}) {
    const HardReport report = solve({.goal = kReach + beyond, .end_speed = 10.0, .most = 1.0});
    EXPECT_FALSE(solver::usable(report.status)) << beyond;
    EXPECT_GE(report.miss, 0.9 * beyond) << beyond;
  }
  const HardReport report = solve({.goal = kReach - 1e-4, .end_speed = 10.0, .most = 1.0});
  EXPECT_EQ(report.status, SolveStatus::kOptimal);
}

TEST_F(HardConstraints, GoOnFromMultipliersOfTheLastSolve) {
  ocp_ = std::make_unique<PushSolver>(solver::SolverOptions{.start_from_states = true});
  plan_ = {.horizon = kStages};
  PushSolver::Multipliers multipliers;
  const HardReport first = ocp_->solve({}, {0.0, 0.0}, plan_, multipliers);
  ASSERT_EQ(first.status, SolveStatus::kOptimal);
  const HardReport second = ocp_->solve({}, {0.0, 0.0}, plan_, multipliers);
  EXPECT_EQ(second.status, SolveStatus::kOptimal);
  EXPECT_EQ(second.rounds, 1);
  EXPECT_LT(second.iterations, first.iterations);
  EXPECT_NEAR(second.cost, first.cost, 5e-5);  // misses of 1e-6 at multipliers of 15
}

TEST_F(HardConstraints, NeedNoMemoryAndStopInTime) {
  plan_ = {.horizon = kStages};
  const test::AllocationGuard guard;
  ocp_->solve({.fastest = 0.6}, {0.0, 0.0}, plan_);
  EXPECT_EQ(guard.count(), 0);
  ocp_->allow_iterations(2);
  const HardReport report = ocp_->solve({.fastest = 0.6}, {0.0, 0.0}, plan_);
  EXPECT_FALSE(report.status == SolveStatus::kOptimal);
  EXPECT_LE(report.iterations, 3);
}

/// A slow state behind one that follows its valve within 1 / rate, by the implicit method of Euler: the next
/// states are inputs, tied by equalities.
struct Valve {
  static constexpr int kNx = 2, kNu = 3, kNr = 2, kNe = 0, kNc = 0, kNh = 2;
  double rate = 1.0, step = 0.1;

  template <class K, class X, class U>
  auto dynamics(K, const X&, const U& u) const {
    return std::make_tuple(1.0 * std::get<1>(u), 1.0 * std::get<2>(u));
  }
  template <class K, class X, class U>
  auto residual(K, const X& x, const U& u) const {
    return std::make_tuple(4.5 * (std::get<0>(x) - 0.5), 0.45 * std::get<0>(u));
  }
  template <class X>
  auto terminal_residual(const X&) const {
    return std::make_tuple();
  }
  template <class K, class X, class U>
  auto equality(K, const X& x, const U& u) const {
    const auto& [valve, slow, fast] = u;
    return std::make_tuple(slow - std::get<0>(x) - step * (fast - slow),
                           fast - std::get<1>(x) - step * rate * (valve - fast));
  }
  [[nodiscard]] std::array<double, 3> input_lower(int) const { return {0.0, -kInfinity, -kInfinity}; }
  [[nodiscard]] std::array<double, 3> input_upper(int) const { return {1.0, kInfinity, kInfinity}; }
};

// Rows weighed alike, whatever their slopes, left nothing but rounding of other curvature.
TEST_F(HardConstraints, MayHaveSlopesOfAnySize) {
  const auto ocp = std::make_unique<solver::OcpSolver<Valve, kStages>>();
  for (const double step : {0.01, 0.1, 1.0}) {
    for (double rate = 1e2; rate < 1e9; rate *= 10.0) {
      solver::Trajectory<2, 3, kStages> plan{.horizon = kStages};
      const HardReport report = ocp->solve({.rate = rate, .step = step}, {0.0, 0.0}, plan);
      EXPECT_EQ(report.status, SolveStatus::kOptimal) << step << " " << rate;
      EXPECT_LE(report.iterations, 40) << step << " " << rate;
    }
  }
}

/// Solves instances of a family and checks each answer by dual numbers, with the multipliers that come with
/// it.
template <class P>
void expect_optimal(std::initializer_list<int> seeds, NaiveStart start, solver::SolverOptions options = {}) {
  using Measurement = FamilyMeasurement<P>;
  options.start_from_states = start == NaiveStart::kLine;
  const auto ocp = std::make_unique<solver::OcpSolver<P, P::kHorizon>>(options);
  for (const int seed : seeds) {
    const auto instance = Measurement::instance(seed);
    const auto t = std::make_unique<typename Measurement::Trajectory>(Measurement::guess(instance, start));
    const HardReport report = ocp->solve(instance, instance.start, *t);
    ASSERT_EQ(report.status, SolveStatus::kOptimal) << seed;
    const KktResidual kkt = check_kkt(instance, *t, *ocp);
    EXPECT_LE(kkt.miss, 1e-6) << seed;
    EXPECT_LE(kkt.stationarity, 1.5e-6 + kkt.rounding) << seed;
    EXPECT_LE(kkt.defect, 1e-12) << seed;
    EXPECT_LE(kkt.subgradient, 2e-3) << seed;  // the root of the last barrier
    EXPECT_NEAR(kkt.cost, report.cost, 1e-9 * kkt.cost) << seed;
  }
}

TEST_F(HardConstraints, SwingUpAPoleExactly) {
  expect_optimal<HardCartPole>({0, 1, 2, 3, 4, 5}, NaiveStart::kIdle);
  expect_optimal<HardCartPole>({0, 1, 2, 3, 4, 5}, NaiveStart::kLine);
}
// Multipliers of rounds as loose as the tolerance led a third of these astray.
TEST_F(HardConstraints, AreMetToALooseTolerance) {
  const auto ocp = std::make_unique<solver::OcpSolver<CraneInLeastTime, CraneInLeastTime::kHorizon>>(
      solver::SolverOptions{.tolerance = 1e-4});
  for (int seed = 0; seed < 12; ++seed) {
    const auto instance = FamilyMeasurement<CraneInLeastTime>::instance(seed);
    auto t = FamilyMeasurement<CraneInLeastTime>::guess(instance, NaiveStart::kIdle);
    const HardReport report = ocp->solve(instance, instance.start, t);
    EXPECT_EQ(report.status, SolveStatus::kOptimal) << seed;
    EXPECT_LE(report.miss, 1e-4) << seed;
  }
}
// An inequality at the end that was active in early rounds only kept its multiplier: no optimum.
TEST_F(HardConstraints, LetGoOfInequalitiesThatHoldWithRoomToSpare) {
  expect_optimal<GoddardRocket>({4, 10, 12}, NaiveStart::kIdle);
}
TEST_F(HardConstraints, SetTheDurationAndTheFirstStateOfAMotion) {
  expect_optimal<CraneInLeastTime>({0, 1, 2}, NaiveStart::kIdle);
}

#ifdef CHICANE_SLOW_TESTS
TEST_F(HardConstraints, LeadAHandAlongALine) { expect_optimal<ArmOnALine>({0, 1, 3}, NaiveStart::kIdle); }
#endif

}  // namespace
}  // namespace chicane::bench
