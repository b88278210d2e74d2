// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "chicane/base/assert.hpp"
#include "chicane/base/deadline.hpp"
#include "chicane/solver/barrier.hpp"
#include "chicane/solver/descent.hpp"
#include "chicane/solver/linearisation.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/progress.hpp"
#include "chicane/solver/riccati.hpp"
#include "chicane/solver/solution.hpp"
#include "chicane/solver/warm_start.hpp"

namespace chicane::solver {

/// Sequential quadratic programming by direct multiple shooting for any OcpProblem (docs/solver.md).
///
/// One turn: linearise every stage with dual numbers, measure optimality with the exact adjoint, solve the
/// stage-structured quadratic program by an active set over Riccati sweeps, step. Soft constraints enter by a
/// primal-dual interior point whose slacks are eliminated stage by stage. Steps are full; when they stop
/// improving, the solver goes back to its best iterate and descends by nonlinear roll-outs with line search
/// and Levenberg shift until full steps work again.
///
/// One plain object holding its workspace; no allocation, lock, exception, and no clock but the deadline's.
/// Nothing is remembered from solve to solve: the trajectory is the warm start, so a failure cannot poison
/// the next call. One thread.
template <OcpProblem P, int Capacity>
class OcpSolver {
 public:
  using State = std::array<double, P::kNx>;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;

  explicit OcpSolver(const SolverOptions& options = {}) noexcept : options_{options} {}

  /// Solves from x0. In: trajectory.horizon in [1, Capacity] and the inputs of the warm start (any values;
  /// states are recomputed). Out: the solution, or the best iterate; its inputs are finite and inside their
  /// bounds whatever the status. Data that are not finite, or bounds that cross, end with kNotFinite. The
  /// deadline is asked before every sweep.
  SolveReport solve(const P& problem, const State& x0, Trajectory& trajectory,
                    Deadline deadline = Deadline::never()) noexcept {
    CHICANE_ASSERT(trajectory.horizon >= 1 && trajectory.horizon <= Capacity);
    SolveReport report;
    if (!start(problem, x0, trajectory)) return give_up(problem, x0, trajectory, report);
    for (;; ++report.iterations) {
      look(problem, trajectory, report);
      if (!is_finite(report) && !has_best_) return give_up(problem, x0, trajectory, report);
      if (is_growing(trajectory) && residual(report) <= kGoodEnoughToGrow) {
        if (!grow(problem, trajectory)) break;
        continue;
      }
      if (has_converged(report)) return finish(SolveStatus::kOptimal, problem, trajectory, report);
      const bool budget_spent = report.iterations >= options_.max_iterations || deadline.spent();
      if (!keep_best(trajectory, report) && !budget_spent && has_lost_its_way(report)) {
        if (!(may_grow(trajectory) ? start_short(problem, trajectory) : go_back(problem, trajectory))) break;
        continue;
      }
      if (budget_spent) break;
      if (!(full_steps_ ? full_step(problem, trajectory, deadline, report)
                        : descend(problem, trajectory, report)))
        break;
    }
    return finish(SolveStatus::kBudgetSpent, problem, trajectory, report);
  }

 private:
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  static constexpr int kChances = 3;       ///< sweeps that may correct the whole working set in vain
  static constexpr int kFirstHorizon = 5;  ///< of the growing horizons
  static constexpr int kMaxGrowth = 16;
  static constexpr double kGoodEnoughToGrow = 1e-1;
  static constexpr double kDefectShare = 1e-7;   ///< of the tolerance: Hessians amplify defects
  static constexpr double kCurvaturePays = 6.0;  ///< further turns that exact curvature costs

  static std::size_t size_of(const Trajectory& t) noexcept { return static_cast<std::size_t>(t.horizon); }

  bool start(const P& problem, const State& x0, Trajectory& trajectory) noexcept {
    full_steps_ = is_fresh_ = true;
    has_best_ = has_curvature_ = has_grown_ = false;
    progress_.restart();
    descent_.start();
    barrier_.start(problem, options_.tolerance);
    target_ = trajectory.horizon;
    for (const double value : x0) {
      if (!std::isfinite(value)) return false;
    }
    for (int k = 0; k < trajectory.horizon; ++k) {
      const auto low = problem.input_lower(k);
      const auto high = problem.input_upper(k);
      for (std::size_t m = 0; m < kNu; ++m) {
        if (!(low[m] <= high[m])) return false;
      }
    }
    if (roll_out(problem, x0, trajectory)) return true;
    for (auto& u : trajectory.u) u.fill(0.0);
    return roll_out(problem, x0, trajectory);
  }

  /// Linearises the iterate and measures it. Slacks start on the central path, and return to it while the
  /// cost descends.
  void look(const P& problem, const Trajectory& t, SolveReport& report) noexcept {
    now_.evaluate(problem, t, lq_, report);
    merit_ = report.cost;
    if (is_fresh_ || !full_steps_) merit_ += barrier_.centre(problem, size_of(t), now_);
    report.complementarity = barrier_.residual(problem, size_of(t), now_);
    now_.measure(t, lq_, report);
    if (is_fresh_) guess_working_set(t);
    is_fresh_ = false;
    now_.add_soft(problem, size_of(t), barrier_.mu(), lq_);
    if (options_.second_order) weigh_curvature(problem, t, report);
  }

  static bool is_finite(const SolveReport& report) noexcept {
    return std::isfinite(report.cost) && std::isfinite(report.defect) && std::isfinite(report.stationarity);
  }
  [[nodiscard]] bool has_converged(const SolveReport& report) const noexcept {
    return report.stationarity <= options_.tolerance &&
           now_.relative_defect <= kDefectShare * options_.tolerance &&
           report.complementarity <= options_.tolerance && barrier_.is_final();
  }
  static double residual(const SolveReport& report) noexcept {
    return std::max({report.stationarity, report.defect, report.complementarity});
  }

  // ---- second order

  /// Gauss–Newton converges linearly; when its rate promises many more turns, the missing second derivatives
  /// are evaluated once and kept: the rest of the way is short.
  void weigh_curvature(const P& problem, const Trajectory& t, const SolveReport& report) noexcept {
    const bool pays = full_steps_
                          ? progress_.turns_left(residual(report), options_.tolerance) > kCurvaturePays
                          : descent_.is_under_way();
    if (pays) {
      now_.evaluate_curvature(problem, t);
      has_curvature_ = true;
    }
    if (has_curvature_) now_.add_curvature(size_of(t), 1.0, lq_);
  }

  // ---- full steps

  /// First guess of the working set: inputs at a bound whose cost falls beyond it.
  void guess_working_set(const Trajectory& t) noexcept {
    for (std::size_t k = 0; k < size_of(t); ++k) {
      auto& stage = lq_.stage[k];
      for (std::size_t m = 0; m < kNu; ++m) {
        stage.hold[m] = Hold::kFree;
        if (stage.low[m] >= 0.0 && now_.slope[k][m] > 0.0) stage.hold[m] = Hold::kLow;
        if (stage.high[m] <= 0.0 && now_.slope[k][m] < 0.0) stage.hold[m] = Hold::kHigh;
      }
    }
  }

  /// Solves the quadratic program: working-set turns, all corrections at once as long as that lowers their
  /// number. False when the deadline came first.
  bool solve_qp(std::size_t horizon, const Deadline& deadline, SolveReport& report) noexcept {
    using Repair = typename decltype(lq_)::Repair;
    constexpr int kMaxSweeps = 20;
    int fewest = std::numeric_limits<int>::max();
    int chances = kChances;
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
      ++report.sweeps;
      const double extra = lq_.backward(horizon, 0.0, false);
      if (extra > 0.0 && has_curvature_) {  // indefinite: Gauss–Newton is not
        now_.add_curvature(horizon, -1.0, lq_);
        has_curvature_ = false;
        continue;
      }
      const int contradictions = lq_.forward(horizon, chances > 0 ? Repair::kAll : Repair::kLast);
      if (contradictions == 0) return true;
      if (deadline.spent()) return false;
      chances = contradictions < fewest ? kChances : chances - 1;
      fewest = std::min(fewest, contradictions);
    }
    lq_.backward(horizon, 0.0, true);
    lq_.forward(horizon, Repair::kClip);
    return true;
  }

  /// Takes the whole step of the quadratic program. False when the deadline came first.
  bool full_step(const P& problem, Trajectory& t, const Deadline& deadline, SolveReport& report) noexcept {
    if (!solve_qp(size_of(t), deadline, report)) return false;
    const double length = barrier_.step(problem, size_of(t), now_, lq_);
    if (!is_growing(t)) barrier_.lower(length);
    double longest = 0.0;
    for (std::size_t k = 0; k < size_of(t); ++k) {
      const auto& stage = lq_.stage[k];
      for (std::size_t i = 0; i < kNx; ++i) t.x[k + 1][i] += length * lq_.dx[k + 1][i];
      for (std::size_t m = 0; m < kNu; ++m) {
        const double du = std::min(std::max(lq_.du[k][m], stage.low[m]), stage.high[m]);
        t.u[k][m] += length * du;
        longest = std::max(longest, std::fabs(du));
      }
    }
    progress_.note(longest, !barrier_.is_final() && !is_growing(t));
    return true;
  }

  // ---- globalisation

  /// True when this is the best iterate so far: by its residuals while steps are full, the latest one while
  /// the cost descends.
  bool keep_best(const Trajectory& trajectory, const SolveReport& report) noexcept {
    if (!is_finite(report)) return false;
    if (full_steps_ && has_best_ && !progress_.is_good() && residual(report) >= residual(best_report_))
      return false;
    best_ = trajectory;
    best_report_ = report;
    has_best_ = true;
    return true;
  }

  /// Steps have not improved for a while, or left the finite numbers.
  bool has_lost_its_way(const SolveReport& report) noexcept {
    return !is_finite(report) || (full_steps_ && progress_.is_lost());
  }

  /// Back to the best iterate, to descend from there. False when its inputs cannot be simulated.
  bool go_back(const P& problem, Trajectory& trajectory) noexcept {
    if (!full_steps_) descent_.damp();
    full_steps_ = has_curvature_ = false;
    descent_.begin();
    barrier_.lift(problem);
    trajectory = best_;
    SolveReport unused;
    look(problem, trajectory, unused);
    if (descent_.simulate(problem, lq_, barrier_, trajectory)) return true;
    const State x0 = trajectory.x[0];
    return roll_out(problem, x0, trajectory);
  }

  /// The second rung: solve a short horizon first and let it grow. Short problems are easy, and each is a
  /// good start for the next one.
  [[nodiscard]] bool is_growing(const Trajectory& t) const noexcept { return t.horizon < target_; }
  [[nodiscard]] bool may_grow(const Trajectory& t) const noexcept {
    return options_.may_start_short && !has_grown_ && t.horizon > kFirstHorizon;
  }
  bool start_short(const P& problem, Trajectory& t) noexcept {
    const State x0 = t.x[0];
    t = best_;
    t.horizon = kFirstHorizon;
    has_grown_ = true;
    barrier_.start(problem, options_.tolerance);
    return restart(problem, x0, t);
  }
  bool grow(const P& problem, Trajectory& t) noexcept {
    const std::size_t known = size_of(t);
    t.horizon = std::min(target_, t.horizon + std::min((t.horizon + 1) / 2, kMaxGrowth));
    for (std::size_t k = known; k < size_of(t); ++k) t.u[k] = t.u[known - 1];
    const State x0 = t.x[0];
    return restart(problem, x0, t);
  }
  bool restart(const P& problem, const State& x0, Trajectory& t) noexcept {
    full_steps_ = is_fresh_ = true;
    has_best_ = has_curvature_ = false;
    progress_.restart();
    descent_.forget();
    return roll_out(problem, x0, t);
  }

  /// The last rung: one step that lowers the cost. False when there is none.
  bool descend(const P& problem, Trajectory& t, SolveReport& report) noexcept {
    if (!descent_.step(problem, lq_, barrier_, merit_, t, report.sweeps)) return false;
    if (!descent_.is_smooth()) return true;
    full_steps_ = true;
    has_best_ = false;
    progress_.restart();
    return true;
  }

  // ---- endings

  /// Hands out the best iterate, extended to the whole horizon; unless it is optimal, its residuals decide
  /// the status.
  SolveReport finish(SolveStatus status, const P& problem, Trajectory& trajectory,
                     SolveReport report) noexcept {
    if (status != SolveStatus::kOptimal) {
      const int iterations = report.iterations;
      const int sweeps = report.sweeps;
      if (has_best_) {
        trajectory = best_;
        report = best_report_;
      }
      if (is_growing(trajectory) || !has_best_) {
        while (is_growing(trajectory)) grow(problem, trajectory);
        look(problem, trajectory, report);
        if (!is_finite(report)) return give_up(problem, trajectory.x[0], trajectory, report);
      }
      report.iterations = iterations;
      report.sweeps = sweeps;
      const bool is_close = residual(report) <= options_.loose_tolerance;
      status = is_close ? SolveStatus::kBudgetSpent : SolveStatus::kStalled;
    } else if (barrier_.exceeds_a_cap(problem, size_of(trajectory), now_)) {
      status = SolveStatus::kInfeasible;
    }
    clamp_inputs(problem, trajectory);  // u + (bound − u) may miss the bound by one rounding
    report.status = status;
    return report;
  }

  /// The data are not finite: leaves admissible inputs and finite states behind.
  SolveReport give_up(const P& problem, const State& x0, Trajectory& trajectory,
                      SolveReport report) noexcept {
    for (auto& u : trajectory.u) u.fill(0.0);
    clamp_inputs(problem, trajectory);
    for (auto& x : trajectory.x) {
      for (std::size_t i = 0; i < kNx; ++i) x[i] = std::isfinite(x0[i]) ? x0[i] : 0.0;
    }
    report.status = SolveStatus::kNotFinite;
    return report;
  }

  SolverOptions options_;
  Linearisation<P, Capacity> now_;  ///< of the present iterate
  Riccati<kNx, kNu, Capacity> lq_;  ///< its quadratic program
  Barrier<P, Capacity> barrier_;
  Descent<P, Capacity> descent_;
  Progress progress_;
  Trajectory best_{};
  SolveReport best_report_{};
  bool has_best_ = false;
  bool full_steps_ = true;
  bool has_curvature_ = false;
  bool has_grown_ = false;
  bool is_fresh_ = true;  ///< slacks and working set are to be guessed anew
  int target_ = 0;        ///< horizon asked for
  double merit_ = 0.0;    ///< cost with the barrier's smoothed penalties
};

}  // namespace chicane::solver
