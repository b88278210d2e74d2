// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "chicane/base/compiler.hpp"
#include "chicane/base/deadline.hpp"
#include "chicane/solver/detail/barrier.hpp"
#include "chicane/solver/detail/descent.hpp"
#include "chicane/solver/detail/evaluation.hpp"
#include "chicane/solver/detail/filter_method.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/detail/linearisation.hpp"
#include "chicane/solver/detail/lq_solver.hpp"
#include "chicane/solver/detail/progress.hpp"
#include "chicane/solver/detail/roll_out.hpp"
#include "chicane/solver/detail/stage_entries.hpp"
#include "chicane/solver/detail/working_set_qp.hpp"
#include "chicane/solver/iteration_log.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"
#include "chicane/solver/warm_start.hpp"

namespace chicane::solver {

/// Sequential quadratic programming by direct multiple shooting for any OcpProblem (docs/solver.md).
///
/// One iteration: linearise all stages, eight at a time; measure optimality with the exact adjoint; solve the
/// stage-structured quadratic program by an active set over Riccati sweeps; step. Soft constraints enter by a
/// primal-dual interior point whose slacks are eliminated stage by stage. Steps are full, first
/// Gauss–Newton's, near the solution Newton's. When they stop improving, a primal-dual interior point method
/// with a filter line search begins again from the guess (detail/filter_method.hpp). Problems with kRealTime
/// do without it: they solve growing horizons, then descend by simulations with a line search.
///
/// One plain object holding its workspace; no allocation, lock, exception, and no clock but the deadline's.
/// Nothing is remembered from solve to solve: the trajectory is the warm start, so a failure cannot poison
/// the next call. Problem and trajectory are used during the call only; multipliers are those of
/// the last solve. One thread at a time; objects share nothing, so different threads may each use their own.
/// `Arch`: the instruction set that its translation unit is compiled for.
template <OcpProblem P, int Capacity, class Arch = arch::Native>
class OcpSolver {
 public:
  using State = std::array<double, P::kNx>;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;

  explicit OcpSolver(const SolverOptions& options = {}) noexcept : options_{options} {}

  // Sets options from the next solve on: all of them, or SolverOptions::max_iterations, tolerance,
  // start_from_states alone.
  void set_options(const SolverOptions& options) noexcept { options_ = options; }
  void allow_iterations(int most) noexcept { options_.max_iterations = most; }
  void ask_for(double tolerance) noexcept { options_.tolerance = tolerance; }
  void start_from_states(bool do_so) noexcept { options_.start_from_states = do_so; }

  /// Solves from x0. In: trajectory.horizon in [1, Capacity] and the inputs of the warm start (any values;
  /// states are recomputed, but for SolverOptions::start_from_states). Out: the solution, or the best
  /// iterate; its inputs are finite and inside their bounds whatever the status. Data that are not finite, or
  /// bounds that cross, end with kNotFinite. The deadline is checked in every iteration and before every
  /// correction of the working set; a step under way is finished.
  SolveReport solve(const P& problem, const State& x0, Trajectory& trajectory,
                    Deadline deadline = Deadline::never()) noexcept {
    CHICANE_ASSERT(trajectory.horizon >= 1 && trajectory.horizon <= Capacity);
    SolveReport report;
    if (!start(problem, x0, trajectory)) return give_up(problem, x0, trajectory, report);
    return run(problem, x0, trajectory, deadline, report);
  }
  /// Solves again after a small change of the problem's functions, from the end of the last solve: iterate,
  /// slacks, multipliers and working set are kept. Pre: the last solve was usable; horizon, bounds and
  /// penalties are the same; `trajectory` is the last answer.
  SolveReport solve_again(const P& problem, const State& x0, Trajectory& trajectory,
                          Deadline deadline = Deadline::never()) noexcept {
    begin();
    is_again_ = true;
    is_fresh_ = false;
    is_exact_ = options_.second_order;
    return run(problem, x0, trajectory, deadline, {});
  }

  // ---- preparation and feedback apart

  /// Linearises and factorises at the answer, so that feedback() takes a few sweeps. Call it after a usable
  /// solve, or after one that ended at its limit with a finite answer. False if the result is not finite.
  bool prepare(const P& problem) noexcept;
  /// Solves the quadratic program of prepare() from x0, with inputs inside their bounds. Soft and hard
  /// constraints keep the active set of the prepared point; input bounds become active and inactive. May be
  /// called many times.
  FeedbackReport feedback(const State& x0, Trajectory& trajectory) noexcept;

  /// Adds iterations to `log`, which must outlive the solver, from the next solve on. Null: no log.
  void record_iterations(IterationLog* log) noexcept { log_ = log; }

  // ---- the filter method alone, for HardSolver

  /// Start of the method.
  enum class Begin {
    kGuess,  ///< at the guess
    kNear,   ///< at a guess near the solution, with a low barrier
    kHere    ///< where the last call ended, with a lower barrier
  };
  /// Lowers the barrier to its end in at most `most` iterations, counted in `report`. True if that succeeds:
  /// solve_again() continues with full steps. Hard rows are equations (detail/hard_rows.hpp), and `problem`
  /// gets their multipliers.
  bool follow_barrier(P& problem, const State& x0, Trajectory& trajectory, const Deadline& deadline, int most,
                      Begin begin, SolveReport& report) noexcept;
  /// Adapts the slacks of hard constraints to changed penalties.
  void update_penalties(const P& problem) noexcept { barrier_.update_penalties(problem, t_.horizon); }

  /// Ends solves where full steps fail, because the primal-dual method comes before them.
  void take_only_full_steps() noexcept { only_full_steps_ = true; }
  /// Keeps the present point for take_point().
  void keep_point() noexcept {
    kept_ = t_;
    barrier_.save(kept_slacks_, t_.horizon);
  }
  /// Returns the kept point, its inputs inside their bounds, as the answer.
  SolveReport take_point(const P& problem, Trajectory& trajectory) noexcept;

  /// Multiplier of state i of x_{k+1} after a solve, i.e. d(cost)/dx of the stages after it; k < horizon.
  [[nodiscard]] double adjoint(int k, int i) const noexcept { return now_.adjoint[i][k]; }
  /// The multiplier of the bounds of input m of stage k: d(cost)/d(bound), 0 between them.
  [[nodiscard]] double bound_multiplier(int k, int m) const noexcept { return now_.slope[m][k]; }
  /// Multiplier of soft constraint c of stage k: cost saved by a unit of room.
  [[nodiscard]] double constraint_multiplier(int k, int c) const noexcept {
    return barrier_.multiplier(static_cast<std::size_t>(c), static_cast<std::size_t>(k));
  }

 private:
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  static constexpr std::size_t kSize = Capacity;
  // Chosen, unless said otherwise.
  static constexpr std::size_t kFirstHorizon = 5;    ///< first of the growing horizons
  static constexpr std::size_t kMaxGrowth = 16;      ///< largest growth of a horizon at once
  static constexpr double kGoodEnoughToGrow = 1e-1;  ///< residual at which the horizon grows
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kDefectShare = 1e-7;    ///< largest defect over the tolerance: Hessians amplify it
  static constexpr double kDefectFloor = 2e-15;   ///< least tolerance of defects: ten roundings
  static constexpr double kRounding = 2.2e-16;    ///< rounding of doubles
  static constexpr double kFloorResidual = 1e-6;  ///< largest residual of kAtFloor
  static constexpr bool kCanFilter = has_filter_method<P>();
  /// Longest step from which on Hessians are exact; shorter for dense problems, whose Hessians cost more.
  static constexpr double kNear = has_cheap_curvature<P>() ? 1e-1 : 1e-2;

  using Evaluate = Evaluation<P, Arch>;
  using Lq = LqSolver<Arch, ProblemPattern<P>, kSize>;
  using V = Stages<Arch>;

  /// Iterates from the present point to the end of the solve.
  CHICANE_INLINE SolveReport run(const P& problem, const State& x0, Trajectory& trajectory,
                                 const Deadline& deadline, SolveReport report) noexcept {
    for (;; ++report.iterations, work_ += share_of_horizon()) {
      if constexpr (kCanFilter) {
        if (is_filtering_ && !filter_iteration(problem, deadline, report)) break;
        if (is_filtering_) continue;
      }
      linearise(problem, report);
      if (log_ != nullptr)
        log_->add(report, full_steps_ ? Iteration::Kind::kFullStep : Iteration::Kind::kDescent,
                  barrier_.mu());
      if (!is_finite(report) && !has_best_) {
        if (stand_still(problem, report)) continue;
        return give_up(problem, x0, trajectory, report);
      }
      if (is_growing() && residual(report) <= kGoodEnoughToGrow) {
        if (!grow(problem)) break;
        continue;
      }
      if (has_converged(report)) return finish(SolveStatus::kOptimal, problem, trajectory, report);
      const bool budget_spent = work_ >= options_.max_iterations || deadline.spent();
      const bool is_astray = goes_astray(report);
      shows_best_ = keep_best(report) && !is_astray;
      if (!shows_best_ && !budget_spent && (is_astray || has_lost_its_way(report))) {
        if (is_at_floor(report)) return finish(SolveStatus::kAtFloor, problem, trajectory, report);
        if (!recover(problem, trajectory, report)) break;
        continue;
      }
      if (budget_spent) break;
      const bool goes_on =
          full_steps_ ? full_step(problem, trajectory, deadline, report) : descend(problem, deadline, report);
      if (!goes_on) break;
    }
    return finish(SolveStatus::kBudgetSpent, problem, trajectory, report);
  }

  /// Resets the state of a solve.
  CHICANE_INLINE void begin() noexcept {
    full_steps_ = is_fresh_ = true;
    has_best_ = shows_best_ = is_exact_ = has_grown_ = false;
    is_filtering_ = has_filtered_ = stands_still_ = is_again_ = false;
    work_ = 0.0;
    progress_.restart();
    course_ = {};
    descent_.start();
  }
  /// Starts at the guess. False if the data are not finite or bounds cross.
  bool start(const P& problem, const State& x0, const Trajectory& trajectory) noexcept {
    begin();
    target_ = static_cast<std::size_t>(trajectory.horizon);
    t_.horizon = target_;
    for (std::size_t i = 0; i < kNx; ++i) {
      if (!std::isfinite(x0[i])) return false;
      t_.x[i][0] = x0[i];
    }
    for (std::size_t k = 0; k < target_; ++k) {
      const auto low = problem.input_lower(static_cast<int>(k));
      const auto high = problem.input_upper(static_cast<int>(k));
      for (std::size_t m = 0; m < kNu; ++m) {
        if (!(low[m] <= high[m] && low[m] < kInfinity && high[m] > -kInfinity)) return false;
        now_.lower[m][k] = low[m];
        now_.upper[m][k] = high[m];
      }
    }
    const bool is_good = take_guess(problem, trajectory);
    barrier_.start(problem, final_barrier(problem), Evaluate::violation(problem, t_));
    return is_good;
  }
  /// Final barrier of soft constraints. With hard constraints it is so low that all barriers together cost no
  /// more than the tolerance.
  [[nodiscard]] double final_barrier([[maybe_unused]] const P& problem) const noexcept {
    if constexpr (kHasHardRows<P>) {
      constexpr double kLeast = 1e-11;  // least barrier: below it slopes are all rounding
      const std::size_t count = constraint_count(problem);
      bool must_hold = false;
      for (std::size_t c = 0; c < count; ++c) must_hold = must_hold || problem.keeps(c);
      const double products = 2.0 * static_cast<double>(target_ * count);
      if (must_hold) return std::max(options_.tolerance / products, std::min(options_.tolerance, kLeast));
    }
    return options_.tolerance;
  }
  /// Takes the inputs of the warm start, with its states or simulated ones; inputs of zero if that diverges.
  bool take_guess(const P& problem, const Trajectory& trajectory) noexcept {
    t_.horizon = target_;
    for (std::size_t m = 0; m < kNu; ++m) {
      for (std::size_t k = 0; k < target_; ++k)
        t_.u[m][k] = nearest(trajectory.u[k][m], now_.lower[m][k], now_.upper[m][k]);
    }
    if ((options_.start_from_states && take_states(trajectory)) || roll_out(problem)) return true;
    fill_inputs();
    if (roll_out(problem)) return true;
    if (kCanFilter) hold_states();
    return kCanFilter;
  }
  /// Takes inputs of zero and the first state everywhere.
  void hold_states() noexcept {
    fill_inputs();
    stands_still_ = true;
    for (std::size_t i = 0; i < kNx; ++i) std::fill(t_.x[i] + 1, t_.x[i] + t_.horizon + 1, t_.x[i][0]);
  }
  /// Takes hold_states() for a simulation whose functions are not finite. False if that was done before.
  bool stand_still(const P& problem, const SolveReport& report) noexcept;
  /// Takes the states of the warm start from x_1 on. False if one is not finite.
  bool take_states(const Trajectory& trajectory) noexcept {
    double sum = 0.0;
    for (std::size_t k = 1; k <= t_.horizon; ++k) {
      for (std::size_t i = 0; i < kNx; ++i) {
        t_.x[i][k] = trajectory.x[k][i];
        sum += 0.0 * t_.x[i][k];
      }
    }
    return sum == 0.0;
  }
  /// The admissible value nearest to `value`, or to zero when that is not a number.
  static double nearest(double value, double low, double high) noexcept {
    return std::min(std::max(std::isfinite(value) ? value : 0.0, low), high);
  }
  bool bring_inside() noexcept;
  /// Writes an iterate, its inputs inside their bounds: u + (bound − u) may miss the bound by one rounding.
  void write(const Iterate<kNx, kNu, kSize>& from, Trajectory& trajectory) const noexcept {
    from.write(trajectory);
    for (std::size_t k = 0; k < from.horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m)
        trajectory.u[k][m] = nearest(trajectory.u[k][m], now_.lower[m][k], now_.upper[m][k]);
    }
  }
  /// Sets inputs to zero, or to the nearest bound.
  void fill_inputs() noexcept {
    for (std::size_t m = 0; m < kNu; ++m) {
      for (std::size_t k = 0; k < t_.horizon; ++k)
        t_.u[m][k] = nearest(0.0, now_.lower[m][k], now_.upper[m][k]);
    }
  }
  /// Simulates the inputs from x_0. True when every state is finite.
  bool roll_out(const P& problem) noexcept { return RollOut<P, Arch>::run(problem, t_); }

  /// Linearises at the present point and sets the report. Slacks start on the central path, and return to it
  /// in descents.
  void linearise(const P& problem, SolveReport& report) noexcept {
    const bool centre = is_fresh_ || !full_steps_;
    const double share = std::max(kDefectShare * options_.tolerance, kDefectFloor);
    const auto with_order = [&](auto order) {
      now_.template linearise<order>(problem, t_, centre, share, barrier_, lq_.lq, report);
    };
    if constexpr (has_hessians<P>()) {
      is_exact_ ? with_order(std::integral_constant<int, 2>{}) : with_order(std::integral_constant<int, 1>{});
    } else {
      with_order(std::integral_constant<int, 1>{});
    }
    qp_.choose(is_fresh_);
    is_fresh_ = false;
  }

  static bool is_finite(const SolveReport& report) noexcept {
    return std::isfinite(report.cost + report.defect + report.stationarity + report.complementarity);
  }
  [[nodiscard]] bool has_converged(const SolveReport& report) const noexcept {
    return (!kCanFilter || is_finite(report)) && report.stationarity <= options_.tolerance &&
           now_.defect_excess <= 0.0 && report.complementarity <= options_.tolerance && barrier_.is_final();
  }
  static double residual(const SolveReport& report) noexcept {
    return std::max({report.stationarity, report.defect, report.complementarity});
  }

  // ---- full steps

  /// Linearises again with Gauss–Newton's Hessians.
  void take_gauss_newton(const P& problem) noexcept {
    is_exact_ = false;
    SolveReport unused;
    linearise(problem, unused);
  }

  /// Takes the whole step of the quadratic program. False at the deadline, or if no recovery succeeds.
  bool full_step(const P& problem, const Trajectory& trajectory, const Deadline& deadline,
                 SolveReport& report) noexcept {
    using Outcome = typename WorkingSetQp<Lq>::Outcome;
    const bool may_circle = kCanFilter && options_.may_start_short && !has_filtered_ && !only_full_steps_;
    const Outcome outcome = qp_.solve(
        lq_, t_.horizon, is_exact_, [&] { take_gauss_newton(problem); }, deadline, may_circle, report.sweeps);
    if (outcome != Outcome::kSolved)
      return outcome == Outcome::kCircles && recover(problem, trajectory, report);
    const double longest = collect_step<Arch, true>(lq_, t_.horizon, step_);
    const double length = barrier_.step(problem, step_);
    if (!is_growing()) barrier_.lower(length, longest);
    add_step<Arch>(t_, length, step_, t_);
    progress_.note(longest, !barrier_.is_final() && !is_growing());
    if (log_ != nullptr) log_->set_step(length * longest);
    is_exact_ = options_.second_order && ((longest <= kNear && curvature_pays()) || is_crawling());
    return true;
  }
  /// Whether exact Hessians save time: always for structured problems, whose second derivatives cost little;
  /// for dense ones if Gauss–Newton needs more iterations than they cost.
  [[nodiscard]] bool curvature_pays() const noexcept {
    constexpr double kIterations = 6.0;  // cost of exact Hessians in iterations, about; chosen
    return has_cheap_curvature<P>() || progress_.is_slow(0.1 * options_.tolerance, kIterations);
  }
  /// Whether Gauss–Newton would need tens of iterations, or the filter method has found a point near the
  /// solution. Does not depend on the units of the inputs.
  [[nodiscard]] bool is_crawling() const noexcept {
    constexpr double kIterations = 20.0;  // chosen
    return kCanFilter && (has_filtered_ || only_full_steps_ ||
                          (barrier_.is_final() && progress_.is_slow(0.1 * options_.tolerance, kIterations)));
  }

  // ---- the filter method (detail/ocp_fallback.hpp)

  /// Recovery when full steps fail. False if nothing helps.
  bool recover(const P& problem, const Trajectory& trajectory, SolveReport& report) noexcept {
    if constexpr (kCanFilter) {
      if (only_full_steps_) return false;
      if (options_.may_start_short) return begin_filter(problem, trajectory, report);
    }
    return may_grow() ? start_short(problem, trajectory) : go_back(problem);
  }
  /// Starts the filter method. False if it cannot start.
  bool begin_filter(const P& problem, const Trajectory& trajectory, SolveReport& report) noexcept;
  /// Perturbs the start by rounding-like amounts.
  void break_symmetry() noexcept;
  /// One iteration of the filter method. False at its end without a solution.
  bool filter_iteration(const P& problem, const Deadline& deadline, SolveReport& report) noexcept;
  void record_filter_iteration(const SolveReport& report) noexcept;
  /// Answers without a solution by the cheapest known point.
  void take_cheapest(const P& problem, const Trajectory& trajectory, SolveReport& report) noexcept;
  /// Whether steps are as short as rounding permits.
  bool is_at_floor(const SolveReport& report) noexcept;

  // ---- globalisation

  /// Keeps the present iterate if it is the best so far: the one of least residual while steps are full, the
  /// latest one in a descent. True if it is.
  bool keep_best(const SolveReport& report) noexcept {
    if (!is_finite(report)) return false;
    if (full_steps_ && has_best_ && !progress_.is_good() && residual(report) >= residual(best_report_))
      return false;
    best_ = t_;
    best_report_ = report;
    if constexpr (kCanFilter) barrier_.save(best_slacks_, t_.horizon);
    has_best_ = true;
    return true;
  }

  /// Whether full steps have not become shorter for a while, or the iterate is not finite.
  [[nodiscard]] bool has_lost_its_way(const SolveReport& report) const noexcept {
    return !is_finite(report) || (full_steps_ && progress_.is_lost());
  }
  /// Whether full steps make cost and defects worse.
  bool goes_astray(const SolveReport& report) noexcept {
    return options_.may_start_short && full_steps_ && !has_grown_ && !has_filtered_ &&
           (kCanFilter || barrier_.is_final()) && course_.leads_astray(report.cost, report.defect);
  }

  /// Returns to the best iterate, to descend from there. False if its inputs cannot be simulated.
  bool go_back(const P& problem) noexcept {
    if (!full_steps_) descent_.damp();
    full_steps_ = is_exact_ = false;
    descent_.begin();
    barrier_.lift(problem);
    t_ = best_;
    SolveReport unused;
    linearise(problem, unused);
    return descent_.simulate(problem, lq_, barrier_, t_) || roll_out(problem);
  }

  /// Whether the horizon is still shorter than the problem's: short problems are easier, and each is a good
  /// start for the next one.
  [[nodiscard]] bool is_growing() const noexcept { return t_.horizon < target_; }
  [[nodiscard]] bool may_grow() const noexcept {
    return options_.may_start_short && !has_grown_ && t_.horizon > kFirstHorizon;
  }
  /// Cost of an iteration over one of the whole horizon.
  [[nodiscard]] double share_of_horizon() const noexcept {
    return static_cast<double>(t_.horizon) / static_cast<double>(target_);
  }
  /// Starts again with a short horizon.
  bool start_short(const P& problem, const Trajectory& trajectory) noexcept;
  /// Extends the horizon; the last input is repeated.
  bool grow(const P& problem) noexcept;
  /// Starts full steps at the simulated present inputs.
  bool restart(const P& problem) noexcept;

  /// Takes one step that lowers the cost. False if there is none.
  bool descend(const P& problem, const Deadline& deadline, SolveReport& report) noexcept;

  // ---- endings

  /// Whether residuals and barrier are within the loose tolerance.
  [[nodiscard]] bool is_close(const SolveReport& report) const noexcept {
    const double gap = kCanFilter && barrier_.count() > 0 ? barrier_.mu() : 0.0;
    const double digits = kCanFilter ? kRounding * std::fabs(report.cost) : 0.0;  // rounding of a cost
    return std::max({residual(report), gap, digits}) <= options_.loose_tolerance;
  }
  /// Linearises at the best iterate.
  void linearise_best(const P& problem, SolveReport& report) noexcept;
  /// Returns the best iterate with its report.
  SolveReport finish(SolveStatus status, const P& problem, Trajectory& trajectory,
                     SolveReport report) noexcept;
  SolveReport give_up(const P& problem, const State& x0, Trajectory& trajectory, SolveReport report) noexcept;

  SolverOptions options_;
  Linearisation<P, kSize, Arch> now_;  ///< linearisation at the present iterate
  Lq lq_;                              ///< quadratic program there
  WorkingSetQp<Lq> qp_;                ///< solver of that program
  using Slacks = Barrier<P, kSize, Arch>;
  Slacks barrier_;  ///< soft constraints
  Descent<P, kSize, Arch> descent_;
  Progress progress_;  ///< lengths of full steps
  Course course_;      ///< cost and defects of full steps
  using Filter = FilterMethod<P, kSize, Arch>;
  std::conditional_t<kCanFilter, Filter, Nothing> filter_;
  Iterate<kNx, kNu, kSize> t_;     ///< present iterate
  Iterate<kNx, kNu, kSize> step_;  ///< step to the next iterate
  Iterate<kNx, kNu, kSize> best_;  ///< best iterate so far
  SolveReport best_report_{};      ///< report of the best iterate
  IterationLog* log_ = nullptr;    ///< record_iterations()
  bool has_best_ = false;          ///< whether there is a best iterate
  bool shows_best_ = false;        ///< whether the last linearisation was at the best iterate
  bool full_steps_ = true;         ///< full steps, else descent
  bool is_exact_ = false;          ///< whether the next linearisation has exact Hessians
  bool has_grown_ = false;         ///< whether this solve has started with a short horizon
  bool is_filtering_ = false;      ///< whether the filter method makes the steps
  bool has_filtered_ = false;      ///< whether this solve has used the filter method
  bool stands_still_ = false;      ///< whether the start could not be simulated
  bool is_again_ = false;          ///< whether the start is near the solution
  bool only_full_steps_ = false;   ///< take_only_full_steps()
  bool is_fresh_ = true;           ///< whether slacks and working set must be guessed
  std::size_t target_ = 0;         ///< horizon of the problem
  double work_ = 0.0;              ///< iterations so far, weighted by their share of the horizon
  std::conditional_t<kHasHardRows<P>, Iterate<kNx, kNu, kSize>, Nothing> kept_;        ///< keep_point()
  std::conditional_t<kHasHardRows<P>, typename Slacks::Memory, Nothing> kept_slacks_;  ///< slacks of kept_
  std::conditional_t<kCanFilter, typename Slacks::Memory, Nothing> best_slacks_;       ///< slacks of best_
};

}  // namespace chicane::solver

#include "chicane/solver/detail/hard_solver.hpp"
#include "chicane/solver/detail/ocp_fallback.hpp"
