// SPDX-License-Identifier: MIT

#include "chicane/base/pack.hpp"
#include "chicane/solver/problem.hpp"
#include "problems/described_problem.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

TEST(StructuredProblem, ItsTypesSayWhatDependsOnWhat) {
  using P = bench::StructuredDescribedProblem;
  static_assert(solver::StructuredProblem<P>);
  static_assert(!solver::StructuredProblem<bench::DescribedProblem>);
  static_assert(solver::OcpProblem<bench::DescribedProblem>);
  using Next =
      decltype(P{}.dynamics(0, solver::StateJets<P, double, 2>{}, solver::InputJets<P, double, 2>{}));
  using X = std::tuple_element_t<0, Next>;
  EXPECT_EQ(X::kFirst, 0b1101U);  // x, ψ, v
  EXPECT_EQ(X::kUnit, 0b0001U);
  using Epsi = std::tuple_element_t<4, Next>;
  EXPECT_EQ(Epsi::kFirst, Variables{1U | 1U << 2 | 1U << 3 | 1U << 7});
  EXPECT_EQ(Epsi::kSecond.size(), 2);  // (x, x) and (v, δ)
}

TEST(StructuredProblem, ALaneHasTheBitsOfAStageOfItsOwn) {
  using P = bench::StructuredDescribedProblem;
  using V = Pack<arch::Native, 8>;
  Random random{9};
  const auto instance = bench::random_instance(random, 20);
  const P problem{instance.problem, 0.5};
  std::array<V, 7> x;
  std::array<V, 2> u;
  for (auto* values : {x.data(), x.data() + 1, x.data() + 2, x.data() + 3, x.data() + 4, x.data() + 5,
                       x.data() + 6, u.data(), u.data() + 1}) {
    for (std::size_t lane = 0; lane < 8; ++lane) values->set(lane, random.uniform(-1.0, 1.0));
  }
  const auto next = solver::to_array<V>(problem.dynamics(solver::StageLanes<V>{0}, x, u));
  const auto r = solver::to_array<V>(problem.residual(solver::StageLanes<V>{0}, x, u));
  for (int k = 0; k < 8; ++k) {
    const auto lane = static_cast<std::size_t>(k);
    std::array<double, 7> x_k{};
    for (std::size_t i = 0; i < 7; ++i) x_k[i] = x[i][lane];
    const std::array<double, 2> u_k{u[0][lane], u[1][lane]};
    const auto next_k = solver::next_state(problem, k, x_k, u_k);
    const auto r_k = solver::to_array<double>(problem.residual(k, x_k, u_k));
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(next[i][lane], next_k[i]) << i;
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(r[i][lane], r_k[i]) << i;
  }
}

TEST(StructuredDescribedProblem, IsTheDescribedProblemWithoutTheErrorAsAState) {
  Random random{8};
  for (int turn = 0; turn < 100; ++turn) {
    const auto instance = bench::random_instance(random, 20);
    const bench::StructuredDescribedProblem own{instance.problem, instance.start[4]};
    auto x = instance.start;
    auto z = own.without_cte(x);
    double cost = 0.0;
    double expected = 0.0;
    for (int k = 0; k < 20; ++k) {
      const std::array<double, 2> u{random.uniform(-0.4, 0.4), random.uniform(-1.0, 1.0)};
      for (const double r : instance.problem.residual(k, x, u)) expected += 0.5 * r * r;
      for (const double r : solver::to_array<double>(own.residual(k, z, u))) cost += 0.5 * r * r;
      x = instance.problem.dynamics(k, x, u);
      const double cte = own.next_cte(z);
      z = solver::next_state(own, k, z, u);
      ASSERT_EQ(z, own.without_cte(x));
      ASSERT_EQ(cte, x[4]);
    }
    for (const double r : instance.problem.terminal_residual(x)) expected += 0.5 * r * r;
    for (const double r : solver::to_array<double>(own.terminal_residual(z))) cost += 0.5 * r * r;
    ASSERT_NEAR(cost, expected, 1e-12 * expected);  // another order of summation
  }
}

}  // namespace
}  // namespace chicane
