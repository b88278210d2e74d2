// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "chicane/base/random.hpp"
#include "families/measure_family.hpp"

namespace chicane::bench {

/// Cycles of a controller: the first input is driven, a little is added to the state, the answer is shifted
/// by a stage and solved again. Ipopt gets the same start in each cycle, once alone and once with its own
/// multipliers of the cycle before.
template <class P>
class LoopMeasurement {
 public:
  static LoopRow drive(const FamilyRequest& request) {
    LoopMeasurement loop{request};
    for (int i = request.first; i < request.first + request.instances; ++i) loop.drive_one(i);
    return loop.row();
  }

 private:
  static constexpr int kCycles = 20;
  static constexpr double kDisturbance = 1e-3;
  using Measurement = FamilyMeasurement<P>;
  using Trajectory = typename Measurement::Trajectory;
  using Solver = solver::OcpSolver<P, P::kHorizon>;

  explicit LoopMeasurement(const FamilyRequest& request)
      : ocp_{std::make_unique<Solver>(options(request, true))},
        first_{std::make_unique<Solver>(options(request, false))} {}

  static solver::SolverOptions options(const FamilyRequest& request, bool is_warm) {
    return {.tolerance = request.tolerance,
            .max_iterations = request.max_iterations,
            .start_from_states = is_warm};
  }

  void drive_one(int seed) {
    const FamilyInstance<P> one = Measurement::instance(seed);
    const OverArrays<P> arrays{one.problem};
    Random random{static_cast<std::uint64_t>(seed) + 1000U};
    auto x = one.start;
    auto plan = std::make_unique<Trajectory>(Measurement::guess(one, NaiveStart::kIdle));
    typename Multipliers::Type multipliers{};
    if (!solver::usable(solve_with(*first_, one.problem, x, *plan, multipliers).status)) return;
#if defined(CHICANE_HAVE_IPOPT)
    const auto reference_plan = std::make_unique<Trajectory>(*plan);
    ipopt_.solve(arrays, x, *reference_plan);
#endif
    for (int cycle = 0; cycle < kCycles; ++cycle) {
      const auto next = arrays.template dynamics<double>(0, x, plan->u[0]);
      for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = next[i] + kDisturbance * std::max(1.0, std::fabs(next[i])) * random.normal();
      solver::shift(*plan, 1.0);
      plan->x[0] = x;
      if constexpr (solver::HardProblem<P>) multipliers.shift(1, P::kHorizon);
      const Trajectory start = *plan;
      solve(one.problem, x, start, *plan, multipliers);
      compare(arrays, x, start, *plan);
      if (!is_usable_) return;
    }
  }

  /// The multipliers of what must hold, if anything must.
  struct Multipliers {
    template <class Q>
    struct Of {
      using Type = int;
    };
    template <solver::HardProblem Q>
    struct Of<Q> {
      using Type = solver::HardMultipliers<Q, P::kHorizon>;
    };
    using Type = typename Of<P>::Type;
  };

  static solver::SolveReport solve_with(Solver& ocp, const P& problem, const std::array<double, P::kNx>& x,
                                        Trajectory& plan,
                                        [[maybe_unused]] typename Multipliers::Type& multipliers) {
    if constexpr (solver::HardProblem<P>) {
      return ocp.solve(problem, x, plan, multipliers);
    } else {
      return ocp.solve(problem, x, plan);
    }
  }

  /// The lesser of two measured times.
  void solve(const P& problem, const std::array<double, P::kNx>& x, const Trajectory& start, Trajectory& plan,
             typename Multipliers::Type& multipliers) {
    double time = 1e30;
    auto known = multipliers;
    for (int repeat = 0; repeat < 2; ++repeat) {
      plan = start;
      known = multipliers;
      const double begin = cpu_time();
      report_ = solve_with(*ocp_, problem, x, plan, known);
      time = std::min(time, cpu_time() - begin);
    }
    multipliers = known;
    is_usable_ = solver::usable(report_.status);
    is_optimal_ = report_.status == solver::SolveStatus::kOptimal;
    time_ = time;
    times_.push_back(time);
    iterations_.push_back(report_.iterations);
    ++row_.solves;
    row_.usable += is_usable_ ? 1 : 0;
    row_.optimal += is_optimal_ ? 1 : 0;
  }

  void compare([[maybe_unused]] const OverArrays<P>& arrays,
               [[maybe_unused]] const std::array<double, P::kNx>& x, [[maybe_unused]] const Trajectory& start,
               [[maybe_unused]] const Trajectory& plan) {
#if defined(CHICANE_HAVE_IPOPT)
    const auto cost = [&](const Trajectory& t) {
      const auto nothing = [](int, int) { return 0.0; };
      return check_kkt(arrays, t, nothing).cost;
    };
    const auto t = std::make_unique<Trajectory>(start);
    ipopt_.remember();
    const Outcome warm = ipopt_.solve_warm(arrays, x, *t);
    *t = start;
    const Outcome report = ipopt_.solve(arrays, x, *t);
    row_.reference += report.is_solved ? 1 : 0;
    if (!report.is_solved || !is_optimal_) return;
    ++row_.both;
    ratios_.push_back(report.time / time_);
    if (warm.is_solved) warm_ratios_.push_back(warm.time / time_);
    const double theirs = cost(*t);
    row_.higher += cost(plan) > theirs + 1e-2 * std::fabs(theirs) + 1e-6 ? 1 : 0;
#endif
  }

  LoopRow row() {
    row_.family = P::kName;
    row_.iterations = detail::at_share(iterations_, 0.5);
    row_.time = detail::at_share(times_, 0.5);
    row_.most_time = detail::at_share(times_, 0.99);
    row_.ratio = detail::at_share(ratios_, 0.5);
    row_.least_ratio = detail::at_share(ratios_, 0.01);
    row_.warm_ratio = detail::at_share(warm_ratios_, 0.5);
    return row_;
  }

  LoopRow row_;
  std::unique_ptr<Solver> ocp_, first_;
  solver::SolveReport report_;
  bool is_usable_ = false, is_optimal_ = false;
  double time_ = 0.0;
  std::vector<double> times_, iterations_, ratios_, warm_ratios_;
#if defined(CHICANE_HAVE_IPOPT)
  IpoptSolver<OverArrays<P>> ipopt_;
#endif
};

/// How a family is driven; null where its first stage is another than those that follow.
template <class P>
[[nodiscard]] auto loop_of() -> LoopRow (*)(const FamilyRequest&) {
  if constexpr (requires { requires !P::kRecedes; }) {
    return nullptr;
  } else {
    return &LoopMeasurement<P>::drive;
  }
}

}  // namespace chicane::bench
