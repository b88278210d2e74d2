// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/solver/barrier.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/riccati.hpp"

namespace chicane::solver {

/// Steps that lower the true cost every time: control-limited dynamic programming (Tassa, Mansard, Todorov
/// 2014) with line search and Levenberg shift. Slower than full steps, and works from where those fail. The
/// iterates are simulations.
template <OcpProblem P, int Capacity>
class Descent {
 public:
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  static constexpr std::size_t kOne = kNx;
  static constexpr std::size_t kHead = kNx + 1;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;
  using Lq = Riccati<kNx, kNu, static_cast<std::size_t>(Capacity)>;
  using Slacks = Barrier<P, static_cast<std::size_t>(Capacity)>;

  /// A new solve.
  void start() noexcept {
    shift_ = 0.0;
    forget();
  }
  /// A new horizon: what was learned about full steps no longer counts.
  void forget() noexcept { needed_ = 2; }
  /// Descents begin here.
  void begin() noexcept { smooth_ = taken_ = 0; }
  /// The last step led to values that are not finite.
  void damp() noexcept { shift_ = std::max(10.0 * shift_, 1.0); }

  /// Near enough to the solution for exact curvature.
  [[nodiscard]] bool is_under_way() const noexcept { return taken_ > 3; }
  /// Whole unshifted steps were taken: full steps may be tried again. Each yes makes the next one harder.
  bool is_smooth() noexcept {
    if (smooth_ < needed_) return false;
    smooth_ = 0;
    needed_ *= 2;
    return true;
  }

  /// Simulates the trajectory with the gains as feedback, so that an unstable system stays near it. False,
  /// and nothing changed, when that is not finite.
  bool simulate(const P& problem, Lq& lq, const Slacks& slacks, Trajectory& t) noexcept {
    lq.backward(static_cast<std::size_t>(t.horizon), shift_, true);
    if (!std::isfinite(try_step(problem, t, lq, slacks, 0.0))) return false;
    t = candidate_;
    return true;
  }

  /// One step from t with merit `merit`. False when no step length and no shift lowers it any more.
  bool step(const P& problem, Lq& lq, Slacks& slacks, double merit, Trajectory& t, int& sweeps) noexcept {
    constexpr int kAttempts = 12;
    constexpr int kHalvings = 6;
    const auto horizon = static_cast<std::size_t>(t.horizon);
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      ++sweeps;
      lq.backward(horizon, shift_, true);
      double scale = 0.0;
      const double expected = expected_change(lq, horizon, scale);
      if (!(expected < 0.0)) return false;
      double length = 1.0;
      for (int trial = 0; trial < kHalvings; ++trial, length *= 0.5) {
        const double allowed = merit + 1e-4 * length * expected + 1e-13 * std::fabs(merit);
        if (!(try_step(problem, t, lq, slacks, length) <= allowed)) continue;
        t = candidate_;
        slacks.lower_for_gain(-expected, horizon);
        ++taken_;
        smooth_ = length >= 1.0 && shift_ == 0.0 ? smooth_ + 1 : 0;
        if (length >= 1.0) shift_ = shift_ > 1e-6 * scale ? 0.1 * shift_ : 0.0;
        return true;
      }
      smooth_ = 0;
      shift_ = std::max(10.0 * shift_, 1e-3 * scale);
    }
    return false;
  }

 private:
  /// Change of merit that the quadratic model promises for the whole step; `scale`: largest curvature of an
  /// input.
  static double expected_change(const Lq& lq, std::size_t horizon, double& scale) noexcept {
    double change = 0.0;
    for (std::size_t k = 0; k < horizon; ++k) {
      const auto& stage = lq.stage[k];
      for (std::size_t m = 0; m < kNu; ++m) {
        const double own = stage.gain[m][kOne];
        change += own * stage.gradient[m][kOne];
        for (std::size_t l = 0; l < kNu; ++l) {
          change += 0.5 * own * stage.gradient[m][kHead + l] * stage.gain[l][kOne];
        }
        scale = std::max(scale, stage.gradient[m][kHead + m]);
      }
    }
    return change;
  }

  /// Simulates the gains from t into candidate_ with the constant part times `length`; returns the merit.
  double try_step(const P& problem, const Trajectory& t, const Lq& lq, const Slacks& slacks,
                  double length) noexcept {
    candidate_.horizon = t.horizon;
    candidate_.x[0] = t.x[0];
    double merit = 0.0;
    const auto horizon = static_cast<std::size_t>(t.horizon);
    for (std::size_t k = 0; k < horizon; ++k) {
      const auto& stage = lq.stage[k];
      const int number = static_cast<int>(k);
      const auto& x = candidate_.x[k];
      for (std::size_t m = 0; m < kNu; ++m) {
        double du = length * stage.gain[m][kOne];
        for (std::size_t i = 0; i < kNx; ++i) du += stage.gain[m][i] * (x[i] - t.x[k][i]);
        candidate_.u[k][m] = t.u[k][m] + std::min(std::max(du, stage.low[m]), stage.high[m]);
      }
      for (const double r : problem.residual(number, x, candidate_.u[k])) merit += 0.5 * r * r;
      if constexpr (P::kNc > 0)
        merit += slacks.merit(problem, problem.constraint(number, x, candidate_.u[k]));
      candidate_.x[k + 1] = problem.dynamics(number, x, candidate_.u[k]);
    }
    for (const double r : problem.terminal_residual(candidate_.x[horizon])) merit += 0.5 * r * r;
    return merit;
  }

  Trajectory candidate_{};
  double shift_ = 0.0;  ///< Levenberg shift on the input blocks
  int taken_ = 0;       ///< steps since the descent began
  int smooth_ = 0;      ///< whole unshifted ones in a row
  int needed_ = 2;      ///< of these before full steps are tried again
};

}  // namespace chicane::solver
