// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/assert.hpp"
#include "chicane/base/deadline.hpp"
#include "chicane/base/dual.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/riccati.hpp"
#include "chicane/solver/solution.hpp"
#include "chicane/solver/warm_start.hpp"

namespace chicane::solver {

/// Sequential quadratic programming by direct multiple shooting for any OcpProblem (docs/solver.md).
///
/// One turn: linearise every stage with dual numbers, measure optimality with the exact adjoint, solve the
/// stage-structured quadratic program by an active set over Riccati sweeps, step. Steps are full; when they
/// stop improving, the solver goes back to its best iterate and descends by nonlinear roll-outs with line
/// search and Levenberg shift until full steps work.
///
/// One plain object holding its workspace; no allocation, lock, exception, and no clock but the deadline's.
/// Nothing is remembered from solve to solve: the trajectory is the warm start, so a failure cannot poison
/// the next call. One thread.
template <OcpProblem P, int Capacity>
class OcpSolver {
 public:
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  using State = std::array<double, kNx>;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;

  explicit OcpSolver(const SolverOptions& options = {}) noexcept : options_{options} {}

  /// Solves from x0. In: trajectory.horizon in [1, Capacity] and the inputs of the warm start (any values;
  /// states are recomputed). Out: the solution, or the best iterate; its inputs are finite and inside their
  /// bounds whatever the status.
  SolveReport solve(const P& problem, const State& x0, Trajectory& trajectory,
                    Deadline deadline = Deadline::never()) noexcept {
    CHICANE_ASSERT(trajectory.horizon >= 1 && trajectory.horizon <= Capacity);
    SolveReport report;
    if (!start(problem, x0, trajectory)) return give_up(problem, x0, trajectory, report);
    for (;; ++report.iterations) {
      linearise(problem, trajectory, report);
      measure(trajectory, report);
      if (!is_finite(report) && !has_best_) return give_up(problem, x0, trajectory, report);
      if (has_converged(report)) return finish(SolveStatus::kOptimal, problem, trajectory, report);
      const bool budget_spent = report.iterations >= options_.max_iterations || deadline.spent();
      if (keep_best(trajectory, report)) {
        if (report.iterations == 0) guess_working_set(trajectory);
      } else if (!budget_spent && has_lost_its_way(report)) {
        if (!full_steps_) shift_ = std::max(10.0 * shift_, 1.0);
        trajectory = best_;
        full_steps_ = false;
        if (!roll_out(problem, x0, trajectory)) break;
        continue;
      }
      if (budget_spent) break;
      if (!(full_steps_ ? full_step(trajectory, deadline, report) : descend(problem, trajectory, report)))
        break;
    }
    return finish(SolveStatus::kBudgetSpent, problem, trajectory, report);
  }

 private:
  static constexpr std::size_t kCapacity = Capacity;
  static constexpr std::size_t kNz = kNx + kNu;
  static constexpr std::size_t kOne = kNx;
  static constexpr std::size_t kHead = kNx + 1;
  static constexpr int kMaxWorkingSetTurns = 12;
  static constexpr int kPatience = 3;  ///< turns without improvement before full steps are given up
  static constexpr double kDefectShare =
      1e-3;  ///< defects are amplified by the Hessian: a tighter tolerance for them
  using Number = Dual<static_cast<int>(kNz)>;

  static std::size_t size_of(const Trajectory& t) noexcept { return static_cast<std::size_t>(t.horizon); }
  /// Position of variable `i` of (x, u) in z = (x, 1, u).
  static constexpr std::size_t in_z(std::size_t i) noexcept { return i < kNx ? i : i + 1; }

  bool start(const P& problem, const State& x0, Trajectory& trajectory) noexcept {
    full_steps_ = true;
    has_best_ = false;
    idle_turns_ = 0;
    smooth_descents_ = 0;
    needed_descents_ = 2;
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

  // ---- what is known about the iterate
  // -------------------------------------------------------------------------------

  /// One derivative pass over the stages: dynamics, defects, Gauss–Newton cost (eq. 4–7).
  void linearise(const P& problem, const Trajectory& t, SolveReport& report) noexcept {
    report.cost = 0.0;
    report.defect = 0.0;
    const std::size_t horizon = size_of(t);
    for (std::size_t k = 0; k < horizon; ++k) {
      auto& stage = lq_.stage[k];
      const int number = static_cast<int>(k);
      std::array<Number, kNx> x;
      std::array<Number, kNu> u;
      for (std::size_t i = 0; i < kNx; ++i) x[i] = Number::variable(t.x[k][i], static_cast<int>(i));
      for (std::size_t m = 0; m < kNu; ++m) u[m] = Number::variable(t.u[k][m], static_cast<int>(kNx + m));
      const std::array<Number, kNx> next = problem.dynamics(number, x, u);
      for (std::size_t i = 0; i < kNx; ++i) {
        for (std::size_t j = 0; j < kNz; ++j) stage.F[i][in_z(j)] = next[i].d[j];
        const double defect = next[i].v - t.x[k + 1][i];
        stage.F[i][kOne] = defect;
        report.defect = worse(report.defect, std::fabs(defect));
      }
      add_squares(problem.residual(number, x, u), stage.L, gradient_[k], report.cost);
      const auto low = problem.input_lower(number);
      const auto high = problem.input_upper(number);
      for (std::size_t m = 0; m < kNu; ++m) {
        stage.low[m] = low[m] - t.u[k][m];
        stage.high[m] = high[m] - t.u[k][m];
      }
    }
    using TerminalNumber = Dual<static_cast<int>(kNx)>;
    std::array<TerminalNumber, kNx> x;
    for (std::size_t i = 0; i < kNx; ++i)
      x[i] = TerminalNumber::variable(t.x[horizon][i], static_cast<int>(i));
    add_squares(problem.terminal_residual(x), lq_.terminal, terminal_gradient_, report.cost);
  }

  /// ½‖r‖² with its gradient and Gauss–Newton Hessian in z coordinates; most entries of a residual's row are
  /// zero.
  template <class Residual, std::size_t Rows, std::size_t Width, std::size_t Size>
  static void add_squares(const Residual& residual, double (&L)[Rows][Width], double (&gradient)[Size],
                          double& cost) noexcept {
    std::fill(&L[0][0], &L[0][0] + Rows * Width, 0.0);
    std::fill(gradient, gradient + Size, 0.0);
    for (const auto& r : residual) {
      cost += 0.5 * r.v * r.v;
      for (std::size_t i = 0; i < Size; ++i) {
        if (r.d[i] == 0.0) continue;
        gradient[i] += r.v * r.d[i];
        for (std::size_t j = 0; j < Size; ++j) L[in_z(i)][in_z(j)] += r.d[i] * r.d[j];
      }
    }
    for (std::size_t i = 0; i < Size; ++i) L[in_z(i)][kOne] = L[kOne][in_z(i)] = gradient[i];
  }

  /// Exact adjoint λ and slopes dJ/du of the nonlinear problem; the projected slope is the optimality measure
  /// (eq. 12).
  void measure(const Trajectory& t, SolveReport& report) noexcept {
    report.stationarity = 0.0;
    std::array<double, kNx> lambda;
    std::copy(terminal_gradient_, terminal_gradient_ + kNx, lambda.begin());
    for (std::size_t k = size_of(t); k-- > 0;) {
      const auto& stage = lq_.stage[k];
      adjoint_[k] = lambda;
      std::array<double, kNx> previous;
      std::copy(gradient_[k], gradient_[k] + kNx, previous.begin());
      for (std::size_t m = 0; m < kNu; ++m) slope_[k][m] = gradient_[k][kNx + m];
      for (std::size_t i = 0; i < kNx; ++i) {
        for (std::size_t j = 0; j < kNx; ++j) previous[j] += stage.F[i][j] * lambda[i];
        for (std::size_t m = 0; m < kNu; ++m) slope_[k][m] += stage.F[i][kHead + m] * lambda[i];
      }
      for (std::size_t m = 0; m < kNu; ++m) {
        const double projected = std::min(std::max(-slope_[k][m], stage.low[m]), stage.high[m]);
        report.stationarity =
            worse(report.stationarity, std::isnan(slope_[k][m]) ? slope_[k][m] : std::fabs(projected));
      }
      lambda = previous;
    }
  }

  /// The larger one; not-a-number wins.
  static double worse(double a, double b) noexcept { return b <= a ? a : (std::isnan(a) ? a : b); }

  static bool is_finite(const SolveReport& report) noexcept {
    return std::isfinite(report.cost) && std::isfinite(report.defect) && std::isfinite(report.stationarity);
  }
  [[nodiscard]] bool has_converged(const SolveReport& report) const noexcept {
    return report.stationarity <= options_.tolerance && report.defect <= kDefectShare * options_.tolerance;
  }
  static double residual(const SolveReport& report) noexcept {
    return std::max(report.stationarity, report.defect);
  }

  // ---- globalisation
  // -------------------------------------------------------------------------------------------------

  /// True when this is the best iterate so far: by its residuals while steps are full, the latest one while
  /// the cost descends.
  bool keep_best(const Trajectory& trajectory, const SolveReport& report) noexcept {
    if (!is_finite(report)) return false;
    if (full_steps_ && has_best_ && residual(report) >= residual(best_report_)) return false;
    best_ = trajectory;
    best_report_ = report;
    has_best_ = true;
    idle_turns_ = 0;
    return true;
  }

  /// Full steps have not improved for a while, or left the finite numbers.
  bool has_lost_its_way(const SolveReport& report) noexcept {
    if (!full_steps_) return !is_finite(report);
    if (is_finite(report) && ++idle_turns_ < kPatience) return false;
    idle_turns_ = 0;
    return true;
  }

  /// First guess of the working set: inputs at a bound whose cost falls beyond it.
  void guess_working_set(const Trajectory& t) noexcept {
    for (std::size_t k = 0; k < size_of(t); ++k) {
      auto& stage = lq_.stage[k];
      for (std::size_t m = 0; m < kNu; ++m) {
        stage.hold[m] = Hold::kFree;
        if (stage.low[m] >= 0.0 && slope_[k][m] > 0.0) stage.hold[m] = Hold::kLow;
        if (stage.high[m] <= 0.0 && slope_[k][m] < 0.0) stage.hold[m] = Hold::kHigh;
      }
    }
  }

  /// Solves the quadratic program and takes its whole step. False when the deadline came first.
  bool full_step(Trajectory& t, const Deadline& deadline, SolveReport& report) noexcept {
    for (int turn = 0;; ++turn) {
      ++report.sweeps;
      lq_.backward(size_of(t), 0.0, false);
      if (!lq_.forward(size_of(t), false)) break;
      if (deadline.spent()) return false;
      if (turn == kMaxWorkingSetTurns) {
        lq_.forward(size_of(t), true);
        break;
      }
    }
    for (std::size_t k = 0; k < size_of(t); ++k) {
      const auto& stage = lq_.stage[k];
      for (std::size_t i = 0; i < kNx; ++i) t.x[k + 1][i] += lq_.dx[k + 1][i];
      for (std::size_t m = 0; m < kNu; ++m) {
        t.u[k][m] += std::min(std::max(lq_.du[k][m], stage.low[m]), stage.high[m]);
      }
    }
    return true;
  }

  /// One descent step: control-limited dynamic programming with line search on the true cost; the iterate
  /// stays a roll-out. False when no step length and no shift lowers the cost any more.
  bool descend(const P& problem, Trajectory& t, SolveReport& report) noexcept {
    constexpr int kAttempts = 12;
    constexpr int kHalvings = 6;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      ++report.sweeps;
      lq_.backward(size_of(t), shift_, true);
      double scale = 0.0;
      const double expected = expected_change(size_of(t), scale);
      double length = 1.0;
      for (int trial = 0; trial < kHalvings && expected < 0.0; ++trial, length *= 0.5) {
        const double allowed = report.cost + 1e-4 * length * expected + 1e-13 * std::fabs(report.cost);
        if (!(try_step(problem, t, length) <= allowed)) continue;
        t = candidate_;
        accept(length, scale);
        return true;
      }
      if (!(expected < 0.0)) return false;
      smooth_descents_ = 0;
      shift_ = std::max(10.0 * shift_, 1e-3 * scale);
    }
    return false;
  }

  void accept(double length, double scale) noexcept {
    smooth_descents_ = length >= 1.0 && shift_ == 0.0 ? smooth_descents_ + 1 : 0;
    if (length >= 1.0) shift_ = shift_ > 1e-6 * scale ? 0.1 * shift_ : 0.0;
    if (smooth_descents_ < needed_descents_) return;
    full_steps_ = true;
    idle_turns_ = smooth_descents_ = 0;
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

  /// Rolls the gains out through the true dynamics into candidate_ and returns its cost.
  double try_step(const P& problem, const Trajectory& t, double length) noexcept {
    candidate_.horizon = t.horizon;
    candidate_.x[0] = t.x[0];
    double cost = 0.0;
    const std::size_t horizon = size_of(t);
    for (std::size_t k = 0; k < horizon; ++k) {
      const auto& stage = lq_.stage[k];
      for (std::size_t m = 0; m < kNu; ++m) {
        double du = length * stage.gain[m][kOne];
        for (std::size_t i = 0; i < kNx; ++i) du += stage.gain[m][i] * (candidate_.x[k][i] - t.x[k][i]);
        candidate_.u[k][m] = t.u[k][m] + std::min(std::max(du, stage.low[m]), stage.high[m]);
      }
      for (const double r : problem.residual(static_cast<int>(k), candidate_.x[k], candidate_.u[k]))
        cost += 0.5 * r * r;
      candidate_.x[k + 1] = problem.dynamics(static_cast<int>(k), candidate_.x[k], candidate_.u[k]);
    }
    for (const double r : problem.terminal_residual(candidate_.x[horizon])) cost += 0.5 * r * r;
    return cost;
  }

  // ---- endings
  // -------------------------------------------------------------------------------------------------------

  /// Hands out the best iterate; the status follows from its residuals unless it is optimal.
  SolveReport finish(SolveStatus status, const P& problem, Trajectory& trajectory,
                     const SolveReport& report) noexcept {
    SolveReport result = report;
    if (status != SolveStatus::kOptimal) {
      trajectory = best_;
      result = best_report_;
      result.iterations = report.iterations;
      result.sweeps = report.sweeps;
      status =
          residual(result) <= options_.loose_tolerance ? SolveStatus::kBudgetSpent : SolveStatus::kStalled;
    }
    clamp_inputs(problem, trajectory);  // u + (bound - u) may miss the bound by one rounding
    result.status = status;
    return result;
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
  Riccati<kNx, kNu, kCapacity> lq_;
  double gradient_[kCapacity][kNz]{};  ///< of the stage costs
  double terminal_gradient_[kNx]{};
  std::array<State, kCapacity> adjoint_{};  ///< adjoint_[k]: price of x_{k+1}
  double slope_[kCapacity][kNu]{};          ///< dJ/du
  Trajectory best_{};
  Trajectory candidate_{};
  SolveReport best_report_{};
  bool has_best_ = false;
  bool full_steps_ = true;
  int idle_turns_ = 0;
  int smooth_descents_ = 0;
  int needed_descents_ = 2;
  double shift_ = 0.0;
};

}  // namespace chicane::solver
