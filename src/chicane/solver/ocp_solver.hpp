// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "chicane/base/assert.hpp"
#include "chicane/base/deadline.hpp"
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
  static constexpr std::size_t kNc = P::kNc;
  static constexpr std::size_t kOne = kNx;
  static constexpr std::size_t kHead = kNx + 1;
  static constexpr int kPatience =
      3;  ///< turns without improvement before curvature is used while descending
  static constexpr int kFirstHorizon = 5;  ///< of the growing horizons
  static constexpr int kMaxGrowth = 16;
  static constexpr double kGoodEnoughToGrow = 1e-1;
  static constexpr double kDefectShare = 1e-7;  ///< of the tolerance: Hessians amplify defects
  static constexpr double kCurvaturePays =
      6.0;  ///< expected further turns above which exact curvature is worth its cost

  static SoftPenalty price_of([[maybe_unused]] const P& problem, [[maybe_unused]] std::size_t c) noexcept {
    if constexpr (kNc > 0) return problem.soft_penalty(static_cast<int>(c));
    return {};
  }
  static std::size_t size_of(const Trajectory& t) noexcept { return static_cast<std::size_t>(t.horizon); }

  bool start(const P& problem, const State& x0, Trajectory& trajectory) noexcept {
    full_steps_ = is_fresh_ = true;
    has_best_ = has_curvature_ = has_grown_ = false;
    smooth_descents_ = 0;
    progress_.restart();
    needed_descents_ = 2;
    target_ = trajectory.horizon;
    mu_ = start_mu(problem);
    shift_ = 0.0;
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

  /// Linearises the iterate and measures it.
  void look(const P& problem, const Trajectory& t, SolveReport& report) noexcept {
    now_.evaluate(problem, t, lq_, report);
    if constexpr (kNc > 0) look_at_soft(problem, t, report);
    now_.measure(t, lq_, report);
    if (is_fresh_) guess_working_set(t);
    is_fresh_ = false;
    now_.add_soft(problem, size_of(t), mu_, lq_);
    if (options_.second_order) weigh_curvature(problem, t, report);
  }

  static bool is_finite(const SolveReport& report) noexcept {
    return std::isfinite(report.cost) && std::isfinite(report.defect) && std::isfinite(report.stationarity);
  }
  [[nodiscard]] bool has_converged(const SolveReport& report) const noexcept {
    const bool soft_done = kNc == 0 || (mu_ <= final_mu() && report.complementarity <= options_.tolerance);
    return report.stationarity <= options_.tolerance &&
           now_.relative_defect <= kDefectShare * options_.tolerance && soft_done;
  }
  static double residual(const SolveReport& report) noexcept {
    return std::max({report.stationarity, report.defect, report.complementarity});
  }

  // ---- soft constraints

  [[nodiscard]] double final_mu() const noexcept { return options_.tolerance; }

  /// Slacks start on the central path, and return to it while the cost descends, where the barrier's own cost
  /// is the merit.
  void look_at_soft(const P& problem, const Trajectory& t, SolveReport& report) noexcept {
    report.complementarity = 0.0;
    merit_ = report.cost;
    for (std::size_t k = 0; k < size_of(t); ++k) {
      for (std::size_t c = 0; c < kNc; ++c) {
        SoftConstraint& soft = now_.soft[k][c];
        const SoftPenalty price = price_of(problem, c);
        if (is_fresh_ || !full_steps_) soft.centre(price, mu_);
        if (!full_steps_) merit_ += soft.barrier(price, mu_) - soft.penalty(price);
        report.complementarity = std::max(report.complementarity, soft.residual(price, mu_));
      }
    }
  }

  static double start_mu(const P& problem) noexcept {
    double price = 0.0;
    for (std::size_t c = 0; c < kNc; ++c) {
      const SoftPenalty penalty = price_of(problem, c);
      price = std::max({price, penalty.linear, 0.1 * penalty.quadratic});
    }
    return 0.2 * price;
  }

  /// Moves slacks and multipliers along their Newton steps, never beyond 0.995 of the way to zero; returns
  /// the step length that the primal ones allow, and lowers the barrier the faster the longer it was.
  double step_soft(const P& problem, std::size_t horizon) noexcept {
    constexpr double kFraction = 0.995;
    double primal = 1.0;
    double dual = 1.0;
    const auto each = [&](const auto& visit) {
      for (std::size_t k = 0; k < horizon; ++k) {
        for (std::size_t c = 0; c < kNc; ++c) {
          SoftConstraint& soft = now_.soft[k][c];
          visit(soft, soft.step(price_of(problem, c), mu_, now_.soft_change(k, c, lq_)));
        }
      }
    };
    const auto limit = [](double length, double value, double change) {
      return change < 0.0 ? std::min(length, -kFraction * value / change) : length;
    };
    each([&](const SoftConstraint& soft, const SoftConstraint& step) {
      primal = limit(limit(primal, soft.s, step.s), soft.t, step.t);
      dual = limit(limit(dual, soft.z, step.z), soft.n, step.n);
    });
    each([&](SoftConstraint& soft, const SoftConstraint& step) {
      soft.s += primal * step.s;
      soft.t += primal * step.t;
      soft.z += dual * step.z;
      soft.n += dual * step.n;
    });
    if (horizon == static_cast<std::size_t>(target_)) lower_barrier(primal);
    return primal;
  }

  void lower_barrier(double length) noexcept {
    const double share = length > 0.9 ? std::min(0.1, std::sqrt(mu_)) : (length > 0.5 ? 0.2 : 0.6);
    mu_ = std::max(final_mu(), share * mu_);
  }

  // ---- second order

  /// Gauss–Newton converges linearly; when its rate promises many more turns, the missing second derivatives
  /// are evaluated once and kept: the rest of the way is short.
  void weigh_curvature(const P& problem, const Trajectory& t, const SolveReport& report) noexcept {
    const bool pays = full_steps_
                          ? progress_.turns_left(residual(report), options_.tolerance) > kCurvaturePays
                          : descents_ > kPatience;
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
    int chances = kPatience;
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
      chances = contradictions < fewest ? kPatience : chances - 1;
      fewest = std::min(fewest, contradictions);
    }
    lq_.backward(horizon, 0.0, true);
    lq_.forward(horizon, Repair::kClip);
    return true;
  }

  /// Takes the whole step of the quadratic program. False when the deadline came first.
  bool full_step(const P& problem, Trajectory& t, const Deadline& deadline, SolveReport& report) noexcept {
    if (!solve_qp(size_of(t), deadline, report)) return false;
    const double length = kNc > 0 ? step_soft(problem, size_of(t)) : 1.0;
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
    progress_.note(longest, kNc > 0 && mu_ > final_mu() && !is_growing(t));
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
    if (!full_steps_) shift_ = std::max(10.0 * shift_, 1.0);
    full_steps_ = has_curvature_ = false;
    smooth_descents_ = descents_ = 0;
    mu_ = std::max(mu_, 0.01 * start_mu(problem));
    SolveReport unused;
    look(problem, best_, unused);  // an unstable system stays near the nodes only with feedback
    lq_.backward(size_of(best_), shift_, true);
    if (std::isfinite(try_step(problem, best_, 0.0))) {
      trajectory = candidate_;
      return true;
    }
    const State x0 = trajectory.x[0];
    trajectory = best_;
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
    mu_ = start_mu(problem);
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
    needed_descents_ = 2;
    return roll_out(problem, x0, t);
  }

  /// One descent step: control-limited dynamic programming with line search on the true cost; the iterate
  /// stays a roll-out. False when no step length and no shift lowers the cost any more.
  bool descend(const P& problem, Trajectory& t, SolveReport& report) noexcept {
    constexpr int kAttempts = 12;
    constexpr int kHalvings = 6;
    const double merit = kNc > 0 ? merit_ : report.cost;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      ++report.sweeps;
      lq_.backward(size_of(t), shift_, true);
      double scale = 0.0;
      const double expected = expected_change(size_of(t), scale);
      if (!(expected < 0.0)) return false;
      double length = 1.0;
      for (int trial = 0; trial < kHalvings; ++trial, length *= 0.5) {
        const double allowed = merit + 1e-4 * length * expected + 1e-13 * std::fabs(merit);
        if (!(try_step(problem, t, length) <= allowed)) continue;
        t = candidate_;
        if (-expected < mu_ * static_cast<double>(size_of(t) * kNc)) mu_ = std::max(final_mu(), 0.2 * mu_);
        accept(length, scale);
        return true;
      }
      smooth_descents_ = 0;
      shift_ = std::max(10.0 * shift_, 1e-3 * scale);
    }
    return false;
  }

  void accept(double length, double scale) noexcept {
    ++descents_;
    smooth_descents_ = length >= 1.0 && shift_ == 0.0 ? smooth_descents_ + 1 : 0;
    if (length >= 1.0) shift_ = shift_ > 1e-6 * scale ? 0.1 * shift_ : 0.0;
    if (smooth_descents_ < needed_descents_) return;
    full_steps_ = true;
    has_best_ = false;
    smooth_descents_ = 0;
    progress_.restart();
    needed_descents_ *= 2;
  }

  /// Change of cost that the quadratic model promises for the whole step; `scale`: largest curvature of an
  /// input.
  [[nodiscard]] double expected_change(std::size_t horizon, double& scale) const noexcept {
    double change = 0.0;
    for (std::size_t k = 0; k < horizon; ++k) {
      const auto& stage = lq_.stage[k];
      for (std::size_t m = 0; m < kNu; ++m) {
        const double own = stage.gain[m][kOne];
        change += own * stage.gradient[m][kOne];
        for (std::size_t l = 0; l < kNu; ++l)
          change += 0.5 * own * stage.gradient[m][kHead + l] * stage.gain[l][kOne];
        scale = std::max(scale, stage.gradient[m][kHead + m]);
      }
    }
    return change;
  }

  /// Rolls the gains out through the true dynamics into candidate_ and returns its merit.
  double try_step(const P& problem, const Trajectory& t, double length) noexcept {
    candidate_.horizon = t.horizon;
    candidate_.x[0] = t.x[0];
    double merit = 0.0;
    for (std::size_t k = 0; k < size_of(t); ++k) {
      const auto& stage = lq_.stage[k];
      const int number = static_cast<int>(k);
      const State& x = candidate_.x[k];
      for (std::size_t m = 0; m < kNu; ++m) {
        double du = length * stage.gain[m][kOne];
        for (std::size_t i = 0; i < kNx; ++i) du += stage.gain[m][i] * (x[i] - t.x[k][i]);
        candidate_.u[k][m] = t.u[k][m] + std::min(std::max(du, stage.low[m]), stage.high[m]);
      }
      for (const double r : problem.residual(number, x, candidate_.u[k])) merit += 0.5 * r * r;
      if constexpr (kNc > 0) merit += soft_merit(problem, problem.constraint(number, x, candidate_.u[k]));
      candidate_.x[k + 1] = problem.dynamics(number, x, candidate_.u[k]);
    }
    for (const double r : problem.terminal_residual(candidate_.x[size_of(t)])) merit += 0.5 * r * r;
    return merit;
  }

  double soft_merit(const P& problem, const std::array<double, kNc>& values) const noexcept {
    double merit = 0.0;
    for (std::size_t c = 0; c < kNc; ++c) {
      const SoftPenalty price = price_of(problem, c);
      SoftConstraint soft;
      soft.value = values[c];
      soft.centre(price, mu_);
      merit += soft.barrier(price, mu_);
    }
    return merit;
  }

  // ---- endings

  /// Hands out the best iterate; unless it is optimal, its residuals decide the status.
  SolveReport finish(SolveStatus status, const P& problem, Trajectory& trajectory,
                     const SolveReport& report) noexcept {
    SolveReport result = report;
    if (status != SolveStatus::kOptimal) {
      if (has_best_) trajectory = best_;
      result = best_report_;
      while (is_growing(trajectory)) {
        grow(problem, trajectory);
        if (!is_growing(trajectory)) look(problem, trajectory, result);
      }
      result.iterations = report.iterations;
      result.sweeps = report.sweeps;
      status =
          residual(result) <= options_.loose_tolerance ? SolveStatus::kBudgetSpent : SolveStatus::kStalled;
    }
    if (status == SolveStatus::kOptimal && violates_a_cap(problem, size_of(trajectory)))
      status = SolveStatus::kInfeasible;
    clamp_inputs(problem, trajectory);  // u + (bound − u) may miss the bound by one rounding
    result.status = status;
    return result;
  }

  [[nodiscard]] bool violates_a_cap(const P& problem, std::size_t horizon) const noexcept {
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t c = 0; c < kNc; ++c) {
        if (now_.soft[k][c].value > price_of(problem, c).cap) return true;
      }
    }
    return false;
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
  Trajectory best_{};
  Trajectory candidate_{};
  SolveReport best_report_{};
  bool has_best_ = false;
  bool full_steps_ = true;
  bool has_curvature_ = false;
  bool has_grown_ = false;
  bool is_fresh_ = true;  ///< slacks and working set are to be guessed anew
  int target_ = 0;        ///< horizon asked for
  Progress progress_;
  int smooth_descents_ = 0;
  int descents_ = 0;
  int needed_descents_ = 2;
  double shift_ = 0.0;  ///< Levenberg shift on the input blocks
  double mu_ = 0.0;     ///< barrier of the soft constraints
  double merit_ = 0.0;
};

}  // namespace chicane::solver
