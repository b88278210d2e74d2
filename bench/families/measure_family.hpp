// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "chicane/base/random.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "chicane/solver/warm_start.hpp"
#include "families/list.hpp"
#if defined(CHICANE_HAVE_IPOPT)
#include "problems/ipopt_problem.hpp"
#endif
#if defined(CHICANE_HAVE_PEERS)
#include "references/fatrop_solver.hpp"
#include "references/hpipm_solver.hpp"
#endif

namespace chicane::bench {

/// Whether a family has instances that leave no solution.
template <class P>
concept HasImpossible = requires(P p, Random& random) {
  p.draw(random, true);
};

/// How the instances of a family are drawn, and solved by all.
template <class P>
class FamilyMeasurement {
 public:
  static constexpr int kHorizon = P::kHorizon;
  using State = std::array<double, P::kNx>;
  using Solver = solver::OcpSolver<P, kHorizon>;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, kHorizon>;

  static P instance(int seed, bool is_impossible = false) {
    Random random{static_cast<std::uint64_t>(seed) * 7919U + 17U};
    P problem;
    if constexpr (HasImpossible<P>) {
      problem.draw(random, is_impossible);
    } else {
      problem.draw(random);
    }
    return problem;
  }
  /// The guess that belongs to a start.
  static Trajectory guess(const P& problem, NaiveStart start) {
    Trajectory t;
    t.horizon = kHorizon;
    for (auto& u : t.u) u = problem.idle;
    solver::roll_out(problem, problem.start, t);
    for (int k = 0; k <= kHorizon && start == NaiveStart::kLine; ++k) {
      const double share = static_cast<double>(k) / kHorizon;
      for (std::size_t i = 0; i < P::kNx; ++i)
        t.x[static_cast<std::size_t>(k)][i] = problem.start[i] + share * (problem.goal[i] - problem.start[i]);
    }
    return t;
  }

  static FamilySolves solve(const FamilyRequest& request, NaiveStart start, References& references) {
    const auto ocp = make_solver(request, start == NaiveStart::kLine);
    FamilySolves all;
    for (int seed = request.first; seed < request.first + request.instances; ++seed) {
      const P problem = instance(seed, request.is_impossible);
      const auto begin = std::make_unique<Trajectory>(guess(problem, start));
      const auto t = std::make_unique<Trajectory>();
      const auto multipliers = std::make_unique<Multipliers>();
      FamilySolve& one =
          all.emplace_back(solve_ours(*ocp, request, problem, problem.start, *begin, *t, *multipliers));
      one.seed = seed;
      const bool is_asked = !one.by[kOurs].is_solved || seed - request.first < request.ipopt_instances;
      const std::string key = std::string(P::kName) + (request.is_impossible ? " impossible|" : "|") +
                              std::string(to_string(start)) + "|" + std::to_string(seed);
      if (const auto known = references.find(key); known != references.end()) {
        one.by[kIpopt] = known->second;
      } else if (kHasIpopt && request.with_ipopt && is_asked) {
        one.by[kIpopt] = references[key] = ask_ipopt(problem, *begin);
      }
      if (request.with_peers) ask_peers(problem, *begin, one);
    }
    return all;
  }

  /// Cycles of a controller: the first input is driven, a little is added to the state, the answer is shifted
  /// by a stage and solved again. Ipopt gets the same start in each cycle, once alone and once with its own
  /// multipliers of the cycle before.
  static FamilySolves drive(const FamilyRequest& request) {
    constexpr int kCycles = 20;
    constexpr double kDisturbance = 1e-3;
    const auto first = make_solver(request, false), ocp = make_solver(request, true);
    FamilySolves all;
    for (int seed = request.first; seed < request.first + request.instances; ++seed) {
      const P problem = instance(seed);
      const OverArrays<P> arrays{problem};
      Random random{static_cast<std::uint64_t>(seed) + 1000U};
      State x = problem.start;
      const auto begin = std::make_unique<Trajectory>(guess(problem, NaiveStart::kIdle));
      const auto plan = std::make_unique<Trajectory>(*begin);
      const auto multipliers = std::make_unique<Multipliers>();
      FamilySolve one = solve_ours(*first, request, problem, x, *begin, *plan, *multipliers);
      if (solver::usable(one.report.status)) start_ipopt(problem, *plan);
      for (int cycle = 0; cycle < kCycles && solver::usable(one.report.status); ++cycle) {
        const State next = arrays.template dynamics<double>(0, x, plan->u[0]);
        for (std::size_t i = 0; i < x.size(); ++i)
          x[i] = next[i] + kDisturbance * std::max(1.0, std::fabs(next[i])) * random.normal();
        solver::shift(*plan, 1.0);
        plan->x[0] = x;
        multipliers->shift(1, kHorizon);
        *begin = *plan;
        one = solve_ours(*ocp, request, problem, x, *begin, *plan, *multipliers);
        one.seed = seed;
        follow_by_ipopt(problem, x, *begin, one);
        all.push_back(one);
      }
    }
    return all;
  }

 private:
  using Multipliers = solver::HardMultipliers<P, kHorizon>;

  static std::unique_ptr<Solver> make_solver(const FamilyRequest& request, bool starts_from_states) {
    return std::make_unique<Solver>(solver::SolverOptions{.tolerance = request.tolerance,
                                                          .max_iterations = request.max_iterations,
                                                          .start_from_states = starts_from_states});
  }
  /// The lesser of two measured times.
  static FamilySolve solve_ours(Solver& ocp, const FamilyRequest& request, const P& problem, const State& x0,
                                const Trajectory& begin, Trajectory& t, Multipliers& multipliers) {
    FamilySolve one;
    Outcome& ours = one.by[kOurs];
    ours.time = 1e30;
    const Multipliers known = multipliers;
    for (int repeat = 0; repeat < 2; ++repeat) {
      t = begin;
      multipliers = known;
      const double now = cpu_time();
      if constexpr (solver::HardProblem<P>) {
        one.report = ocp.solve(problem, x0, t, multipliers);
      } else {
        one.report = ocp.solve(problem, x0, t);
      }
      ours.time = std::min(ours.time, cpu_time() - now);
    }
    one.kkt = check_kkt(problem, t, ocp);
    ours.is_solved = one.has(solver::SolveStatus::kOptimal);
    ours.is_impossible = one.has(solver::SolveStatus::kInfeasible);
    ours.iterations = one.report.iterations;
    ours.cost = one.kkt.cost;
    one.is_false = ours.is_solved && !(one.worst() <= 1.5 * request.tolerance + one.kkt.rounding &&
                                       one.kkt.subgradient <= 2.0 * std::sqrt(request.tolerance));
    return one;
  }

#if defined(CHICANE_HAVE_IPOPT)
  static constexpr bool kHasIpopt = true;
  static auto& ipopt() {
    static IpoptSolver<P, kHorizon> solver;
    return solver;
  }
  static Outcome ask_ipopt(const P& problem, const Trajectory& begin) {
    const auto t = std::make_unique<Trajectory>(begin);
    Outcome outcome = ipopt().solve(problem, problem.start, *t);
    if (outcome.is_impossible) {
      for (int k = 0; k < kHorizon; ++k) {
        const auto low = problem.input_lower(k), high = problem.input_upper(k);
        auto& u = t->u[static_cast<std::size_t>(k)];
        for (std::size_t m = 0; m < u.size(); ++m) u[m] = std::clamp(u[m], low[m], high[m]);
      }
      solver::roll_out(problem, problem.start, *t);
    }
    const KktResidual kkt = check_kkt(problem, *t);
    outcome.cost = outcome.is_impossible ? kkt.total : kkt.cost;
    return outcome;
  }
  static void start_ipopt(const P& problem, Trajectory t) { ipopt().solve(problem, problem.start, t); }
  static void follow_by_ipopt(const P& problem, const State& x0, const Trajectory& begin, FamilySolve& one) {
    const auto t = std::make_unique<Trajectory>(begin);
    ipopt().remember();
    one.by[kHotIpopt] = ipopt().solve_warm(problem, x0, *t);
    *t = begin;
    one.by[kIpopt] = ipopt().solve(problem, x0, *t);
    one.by[kIpopt].cost = check_kkt(problem, *t).cost;
  }
#else
  static constexpr bool kHasIpopt = false;
  static Outcome ask_ipopt(const P&, const Trajectory&) { return {}; }
  static void start_ipopt(const P&, const Trajectory&) {}
  static void follow_by_ipopt(const P&, const State&, const Trajectory&, FamilySolve&) {}
#endif
#if defined(CHICANE_HAVE_PEERS)
  static void ask_peers(const P& problem, const Trajectory& begin, FamilySolve& one) {
    static HpipmSolver<P, kHorizon> hpipm;
    static FatropSolver<P, kHorizon> fatrop;
    const auto ask = [&](auto& solver, Outcome& answer) {
      for (int repeat = 0; repeat < 2; ++repeat) {
        const auto t = std::make_unique<Trajectory>(begin);
        Outcome outcome = solver.solve(problem, problem.start, *t);
        if (!outcome.is_solved || (answer.is_solved && outcome.time > answer.time)) continue;
        outcome.cost = check_kkt(problem, *t).cost;
        answer = outcome;
      }
    };
    ask(hpipm, one.by[kHpipm]);
    ask(fatrop, one.by[kFatrop]);
  }
#else
  static void ask_peers(const P&, const Trajectory&, FamilySolve&) {}
#endif
};

/// A family as the table of all has it. Closed loops leave out families whose first stage is another than
/// those that follow.
template <class P>
[[nodiscard]] Family family_of() {
  using Measurement = FamilyMeasurement<P>;
  if constexpr (requires { requires !P::kRecedes; }) {
    return {P::kName, &Measurement::solve, nullptr, HasImpossible<P>};
  } else {
    return {P::kName, &Measurement::solve, &Measurement::drive, HasImpossible<P>};
  }
}

}  // namespace chicane::bench
