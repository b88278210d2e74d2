// SPDX-License-Identifier: MIT

#include "chicane/base/jet.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/describe.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "chicane/solver/problem.hpp"
#include "families/flights.hpp"
#include "problems/described_problem.hpp"
#include "problems/optimality.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using bench::CorridorProblem;
using bench::DescribedProblem;
using bench::StructuredCorridorProblem;
using bench::StructuredDescribedProblem;
using solver::SolveStatus;

constexpr int kCapacity = 60;

/// In the real-time form: full steps and growing horizons.
struct Flight : bench::Quadrotor {
  static constexpr bool kRealTime = true;
  double price = 100.0;  ///< of being inside a ball
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = price, .quadratic = price}; }
  [[nodiscard]] static std::string_view constraint_name(int c) { return c == 0 ? "near ball" : "far ball"; }
};

/// First and second derivatives of one row, those that its type knows to be zero among them.
template <std::size_t Nz>
struct Derivatives {
  std::array<double, Nz> first{};
  std::array<std::array<double, Nz>, Nz> second{};
};

template <std::size_t Nz, class J>
Derivatives<Nz> derivatives_of(const J& row) {
  Derivatives<Nz> all;
  jet::repeat<Nz>([&](auto i) { all.first[i] = jet::number<double>(jet::slope<i>(row)); });
  jet::repeat<J::kSecond.size()>([&](auto n) {
    constexpr Pair p = members<J::kSecond>()[n];
    all.second[p.i][p.j] = all.second[p.j][p.i] = jet::number<double>(row.curvatures[n]);
  });
  return all;
}

/// Derivatives of each row of a structured problem, jets of their own types against those of one type that
/// store everything.
template <class Row, class FullRow, int Nz>
void expect_same_derivatives(const Row& jets, const FullRow& full) {
  constexpr auto count = static_cast<std::size_t>(Nz);
  std::size_t n = 0;
  const auto compare = [&n](const Derivatives<count>& x, const FullJet<Nz, 2>& y) {
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_NEAR(x.first[i], y.slopes[i], 1e-12 * (1.0 + std::fabs(x.first[i]))) << n << ' ' << i;
      for (std::size_t j = 0; j < count; ++j) {
        const double h = x.second[i][j];
        EXPECT_NEAR(
            h,
            y.curvatures[static_cast<std::size_t>(Pairs::index_of(static_cast<int>(i), static_cast<int>(j)))],
            1e-10 * (1.0 + std::fabs(h)))
            << n << ' ' << i << ' ' << j;
      }
    }
    ++n;
  };
  jet::repeat<solver::kRowSize<Row>>([&](auto i) {
    compare(derivatives_of<count>(solver::as_jet<double, 2>(std::get<i>(jets))),
            FullJet<Nz, 2>(std::get<i>(full)));
  });
}

template <class P>
void check_derivatives(const P& problem, const std::array<double, P::kNx>& x0,
                       const std::array<double, P::kNu>& u0) {
  constexpr int nz = P::kNx + P::kNu;
  using D = FullJet<nz, 2>;
  solver::StateJets<P, double, 2> x;
  solver::InputJets<P, double, 2> u;
  std::array<D, P::kNx> xd;
  std::array<D, P::kNu> ud;
  jet::repeat<P::kNx>([&](auto i) {
    std::get<i>(x).v = x0[i];
    xd[i] = D::variable(x0[i], i);
  });
  jet::repeat<P::kNu>([&](auto m) {
    std::get<m>(u).v = u0[m];
    ud[m] = D::variable(u0[m], P::kNx + m);
  });
  const auto check = [](const auto& jets, const auto& full) {
    expect_same_derivatives<std::remove_cvref_t<decltype(jets)>, std::remove_cvref_t<decltype(full)>, nz>(
        jets, full);
  };
  check(problem.dynamics(1, x, u), problem.dynamics(1, xd, ud));
  check(problem.residual(1, x, u), problem.residual(1, xd, ud));
  if constexpr (P::kNc > 0) check(problem.constraint(1, x, u), problem.constraint(1, xd, ud));
}

TEST(StructuredProblem, HasTheFirstAndSecondDerivativesOfFullJets) {
  Random random{4};
  for (int turn = 0; turn < 20; ++turn) {
    const auto instance = bench::random_instance(random, 20);
    const auto at = [&] { return random.uniform(-0.5, 0.5); };
    const StructuredDescribedProblem described{instance.problem, 0.3};
    check_derivatives(described, {20.0 * at(), at(), at(), 12.0 + at(), at(), at(), at()}, {at(), at()});
    check_derivatives(Flight{}, {at(), at(), at(), at(), at(), at(), at(), at(), at()},
                      {9.81 + at(), at(), at(), at()});
  }
}

TEST(StructuredSolve, FindsTheOptimumOfTheDescribedProblem) {
  using Own = solver::OcpSolver<StructuredDescribedProblem, kCapacity>;
  const auto own = std::make_unique<Own>();
  Random random{77};
  for (const int horizon : {1, 2, 7, 8, 9, 16, 20, 50, 60}) {
    for (int turn = 0; turn < 12; ++turn) {
      const auto instance = bench::random_instance(random, horizon);
      bench::DescribedTrajectory<kCapacity> plain;
      plain.horizon = horizon;
      if (turn % 2 == 0) bench::guess_by_path_law(instance, plain);
      const StructuredDescribedProblem problem{instance.problem, instance.start[4]};
      Own::Trajectory answer;
      answer.horizon = horizon;
      answer.u = plain.u;
      const auto report = own->solve(problem, problem.without_cte(instance.start), answer);
      ASSERT_EQ(report.status, SolveStatus::kOptimal) << horizon << ' ' << turn;
      plain.u = answer.u;
      ASSERT_TRUE(bench::inputs_are_inside(instance.problem, plain));
      // Judged on the problem as it is written down, by derivatives that share no code with the solver; at 50
      // stages the accepted defects times Hessians near 1e5 may add to the solver's own 1e-6.
      ASSERT_LE(bench::projected_gradient(instance.problem, instance.start, plain),
                horizon < 50 ? 1.2e-6 : 1e-5)
          << horizon << ' ' << turn;
      ASSERT_NEAR(report.cost, bench::simulated_cost(instance.problem, instance.start, plain),
                  1e-8 * (1.0 + report.cost));
      for (int k = 0; k < horizon; ++k) {
        for (int m = 0; m < 2; ++m) {
          const double u = answer.u[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
          const double limit = m == 0 ? instance.problem.steer_limit : 1.0;
          if (std::fabs(u) < limit - 1e-9) {  // a step may miss its bound by a rounding
            ASSERT_LE(std::fabs(own->bound_multiplier(k, m)), 1e-6);
          }
        }
      }
    }
  }
}

// Control cycles of a lap (off the road, across it) from inputs of zero: full steps went on from a point of
// half the cost and half the defects to where the car drives in circles, and stayed there, at 7.5 to 2000
// times the cost.
TEST(StructuredSolve, ReachesTheOptimumWhereFullStepsGoAstray) {
  struct Cycle {
    double speed, cte, epsi;
    std::array<double, 4> path;
    double optimum;  ///< Ipopt's, with bounds moved outwards by 1e-8
  };
  constexpr double kOptimum = 1e-6;
  const Cycle cycles[] = {
      {29.292514506649212,
       -0.14921512788416713,
       0.061509454119114522,
       {-0.14921512788416713, -0.061587143582100302, 0.003444350632608624, 0.00045592215533555311},
       50.5128819},
      {30.823262893944872,
       -5.9766017904393181,
       -0.65432331645730568,
       {-5.9766017904393181, 0.76704874384896393, 0.34440726602550092, -0.012767773082457926},
       61089.5934},
      {31.020719241006205,
       -0.43577450363775289,
       -0.087039685556922139,
       {-0.43577450363775289, 0.087260155201049738, 0.0058831056585409046, 0.00034225722323718292},
       197.264307}};
  using Own = solver::OcpSolver<StructuredDescribedProblem, kCapacity>;
  const auto own = std::make_unique<Own>();
  for (const Cycle& cycle : cycles) {
    bench::DescribedProblem described;
    described.path = {cycle.path[0], cycle.path[1], cycle.path[2], cycle.path[3]};
    described.speed_reference = 30.0;
    const std::array<double, bench::DescribedProblem::kNx> start{0.0,       0.0,        0.0, cycle.speed,
                                                                 cycle.cte, cycle.epsi, 0.0, 0.0};
    const StructuredDescribedProblem problem{described, start[4]};
    Own::Trajectory answer;
    answer.horizon = 19;
    const auto report = own->solve(problem, problem.without_cte(start), answer);
    EXPECT_EQ(report.status, SolveStatus::kOptimal);
    EXPECT_NEAR(report.cost, cycle.optimum, kOptimum * cycle.optimum) << cycle.speed;
  }
}

TEST(StructuredSolve, AgreesWithTheDensePathInACorridor) {
  using Own = solver::OcpSolver<StructuredCorridorProblem, kCapacity>;
  const auto own = std::make_unique<Own>();
  const auto dense = std::make_unique<solver::OcpSolver<CorridorProblem, kCapacity>>();
  Random random{78};
  for (const int horizon : {2, 10, 20, 40}) {
    for (int turn = 0; turn < 10; ++turn) {
      const auto instance = bench::random_instance<CorridorProblem>(random, horizon);
      bench::DescribedTrajectory<kCapacity> plain;
      plain.horizon = horizon;
      bench::guess_by_path_law(instance, plain);
      const StructuredCorridorProblem problem{instance.problem, instance.start[4], horizon};
      Own::Trajectory answer;
      answer.horizon = horizon;
      answer.u = plain.u;
      const auto report = own->solve(problem, problem.without_cte(instance.start), answer);
      ASSERT_EQ(report.status, SolveStatus::kOptimal) << horizon << ' ' << turn;
      ASSERT_LE(report.complementarity, 1e-6);
      ASSERT_EQ(dense->solve(instance.problem, instance.start, plain).status, SolveStatus::kOptimal);
      const double expected = bench::simulated_cost(instance.problem, instance.start, plain);
      plain.u = answer.u;
      ASSERT_NEAR(bench::simulated_cost(instance.problem, instance.start, plain), expected, 1e-6 * expected)
          << horizon << ' ' << turn;
    }
  }
}

/// At the first stage a constraint on the states alone reaches no slope of an input.
TEST(StructuredSolve, RefusesAConstraintThatIsNotANumberAtAnyStage) {
  using Own = solver::OcpSolver<StructuredCorridorProblem, kCapacity>;
  const auto own = std::make_unique<Own>();
  Random random{80};
  const auto instance = bench::random_instance<CorridorProblem>(random, 20);
  const StructuredCorridorProblem good{instance.problem, instance.start[4], 20};
  for (const std::size_t stage : {0, 1, 7, 8, 19}) {
    for (const bool is_high : {true, false}) {
      StructuredCorridorProblem problem = good;
      (is_high ? problem.high : problem.low)[stage] = std::nan("");
      Own::Trajectory answer;
      answer.horizon = 20;
      const auto start = problem.without_cte(instance.start);
      EXPECT_EQ(own->solve(problem, start, answer).status, SolveStatus::kNotFinite) << stage;
      EXPECT_EQ(own->solve(good, start, answer).status, SolveStatus::kOptimal) << stage;
    }
  }
}

#ifdef CHICANE_SLOW_TESTS
TEST(StructuredSolve, SolvesAFlightAndSaysWhatBinds) {
  using Own = solver::OcpSolver<Flight, kCapacity>;
  const auto own = std::make_unique<Own>(solver::SolverOptions{.max_iterations = 100});
  int exceeded = 0;
  for (const double price : {100.0, 0.1}) {
    for (const std::uint64_t seed : {0, 3, 5, 7}) {
      Random random{seed};
      Flight problem;
      problem.draw(random);
      problem.price = price;
      for (const int horizon : {40, 60}) {
        Own::Trajectory answer;
        answer.horizon = horizon;
        answer.u.fill(problem.idle);
        const auto report = own->solve(problem, problem.start, answer);
        ASSERT_EQ(report.status, SolveStatus::kOptimal) << seed << ' ' << horizon;
        ASSERT_LE(report.stationarity, 1e-6);
        if (report.worst_stage < 0) continue;
        ++exceeded;
        EXPECT_NE(solver::describe(problem, report).find(" ball exceeded by "), std::string::npos);
      }
    }
  }
  EXPECT_GT(exceeded, 0);
}
#endif

TEST(Describe, NamesConstraintStageAndUnit) {
  solver::SolveReport report;
  report.status = SolveStatus::kInfeasible;
  report.violation = 0.12;
  report.worst_stage = 14;
  report.worst_constraint = 1;
  EXPECT_EQ(solver::describe(StructuredCorridorProblem{}, report),
            "infeasible: right edge exceeded by 0.12 m at stage 14");
  report.worst_stage = report.worst_constraint = -1;
  report.status = SolveStatus::kOptimal;
  EXPECT_EQ(solver::describe(StructuredCorridorProblem{}, report), "optimal");
}

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

}  // namespace
}  // namespace chicane
