// SPDX-License-Identifier: MIT
#include "chicane/solver/detail/roll_out.hpp"

#include "chicane/base/pack.hpp"
#include "chicane/base/random.hpp"
#include "problems/described_problem.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using bench::StructuredDescribedProblem;
constexpr std::size_t kCapacity = 40;
using Point = solver::Iterate<7, 2, kCapacity>;

/// Two states that need each other, beside a sum that needs one of them.
struct Pendulum {
  static constexpr int kNx = 3, kNu = 1, kNr = 1, kNe = 1, kNc = 0;
  template <class K, class X, class U>
  auto dynamics(K, const X& x, const U& u) const {
    const auto& [angle, rate, turned] = x;
    const auto& [torque] = u;
    return std::make_tuple(angle + 0.1 * rate, rate + 0.1 * (torque - sin(angle)), turned + 0.1 * rate);
  }
  template <class K, class X, class U>
  auto residual(K, const X&, const U& u) const {
    return std::make_tuple(std::get<0>(u));
  }
  template <class X>
  auto terminal_residual(const X& x) const {
    return std::make_tuple(std::get<0>(x));
  }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-1.0}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {1.0}; }
};

template <class Point>
void fill(Random& random, Point& t) {
  for (auto& row : t.x) {
    for (double& x : row) x = std::numeric_limits<double>::quiet_NaN();  // nothing is read before it is known
    row[0] = random.uniform(-1.0, 1.0);
  }
  for (auto& row : t.u) {
    for (double& u : row) u = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 0; k < t.horizon; ++k) row[k] = random.uniform(-0.4, 0.4);
  }
}

template <class Problem, class Point>
void expect_a_simulation(const Problem& problem, const Point& t) {
  for (std::size_t k = 0; k < t.horizon; ++k) {
    const auto next = solver::next_state(problem, static_cast<int>(k), t.template state<double>(k),
                                         t.template input<double>(k));
    for (std::size_t i = 0; i < next.size(); ++i)
      ASSERT_EQ(t.x[i][k + 1], next[i]) << "horizon " << t.horizon << " stage " << k << " state " << i;
  }
}

TEST(StageOrder, ReadsOffThePatternWhatNeedsWhat) {
  using Order = solver::StageOrder<solver::ProblemPattern<StructuredDescribedProblem>>;
  static_assert(Order::kExists);
  // speed (3) and the kept inputs (5, 6); heading (2); position (0, 1); error of the heading (4)
  EXPECT_EQ(Order::kLevel, (std::array<std::size_t, 7>{2, 2, 1, 0, 3, 0, 0}));
  EXPECT_TRUE(Order::is_sum(0));
  EXPECT_FALSE(Order::is_sum(4));
}

TEST(StageOrder, DoesNotExistWhereStatesNeedEachOther) {
  static_assert(!solver::StageOrder<solver::ProblemPattern<Pendulum>>::kExists);
  static_assert(!solver::StageOrder<solver::FullPattern<1, 1>>::kExists);
  static_assert(!solver::StageOrder<solver::FullPattern<4, 2>>::kExists);
}

TEST(RollOut, HasTheBitsOfASimulationStageAfterStage) {
  static_assert(solver::RollOut<StructuredDescribedProblem, arch::Native>::kInLanes);
  Random random{5};
  const auto t = std::make_unique<Point>();
  for (const std::size_t horizon : {1U, 2U, 7U, 8U, 9U, 16U, 20U, 39U, 40U}) {
    const auto instance = bench::random_instance(random, static_cast<int>(horizon));
    const StructuredDescribedProblem problem{instance.problem, 0.0};
    t->horizon = horizon;
    fill(random, *t);
    ASSERT_TRUE((solver::RollOut<StructuredDescribedProblem, arch::Native>::run(problem, *t)));
    expect_a_simulation(problem, *t);
  }
}

TEST(RollOut, GoesStageAfterStageWhereThereIsNoOrder) {
  static_assert(!solver::RollOut<Pendulum, arch::Native>::kInLanes);
  Random random{6};
  const auto t = std::make_unique<solver::Iterate<3, 1, kCapacity>>();
  for (const std::size_t horizon : {1U, 13U, 40U}) {
    t->horizon = horizon;
    fill(random, *t);
    ASSERT_TRUE((solver::RollOut<Pendulum, arch::Native>::run(Pendulum{}, *t)));
    expect_a_simulation(Pendulum{}, *t);
  }
}

TEST(RollOut, SaysWhenAStateIsNotFinite) {
  Random random{7};
  const auto t = std::make_unique<Point>();
  StructuredDescribedProblem problem;
  const auto run = [&] {
    return solver::RollOut<StructuredDescribedProblem, arch::Native>::run(problem, *t);
  };
  for (const std::size_t horizon : {8U, 13U}) {
    t->horizon = horizon;
    fill(random, *t);
    EXPECT_TRUE(run());
    t->u[1][horizon - 1] = std::numeric_limits<double>::infinity();  // seen by the last stage alone
    EXPECT_FALSE(run());
    t->u[1][horizon - 1] = 0.0;
    t->x[2][0] = 1e300;  // too large for sine and cosine
    EXPECT_FALSE(run());
  }
}

}  // namespace
}  // namespace chicane
