// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/detail/barrier.hpp"
#include "chicane/solver/detail/evaluation.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/detail/linearisation.hpp"
#include "chicane/solver/detail/lq_solver.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::solver {

/// Steps each of which lowers the cost: control-limited dynamic programming (Tassa, Mansard, Todorov 2014)
/// with line search and Levenberg shift. Slower than full steps; for points from which those fail. The
/// iterates are simulations.
template <OcpProblem P, std::size_t Capacity, class Arch>
class Descent {
 public:
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  using Evaluate = Evaluation<P, Arch>;
  using Point = Iterate<kNx, kNu, Capacity>;
  using Lq = LqSolver<Arch, ProblemPattern<P>, Capacity>;
  using Slacks = Barrier<P, Capacity, Arch>;
  using Linearised = Linearisation<P, Capacity, Arch>;

  /// Starts a solve.
  void start() noexcept {
    shift_ = 0.0;
    forget();
  }
  /// Resets is_smooth() for a new horizon.
  void forget() noexcept { needed_ = 2; }
  /// Starts a descent.
  void begin() noexcept { smooth_ = taken_ = 0; }
  /// Shortens steps, after one that led to values that are not finite.
  void damp() noexcept { shift_ = std::max(10.0 * shift_, 1.0); }

  /// Longest move of an input in the last step.
  [[nodiscard]] double moved() const noexcept { return moved_; }
  /// Whether a few steps were taken, after which exact Hessians are of use.
  [[nodiscard]] bool is_under_way() const noexcept { return taken_ > 3; }
  /// Whether enough whole unshifted steps were taken for another trial of full steps. Each trial doubles the
  /// number for the next one.
  bool is_smooth() noexcept {
    if (smooth_ < needed_) return false;
    smooth_ = 0;
    needed_ *= 2;
    return true;
  }

  /// Simulates the trajectory with the gains as feedback, so that an unstable system stays near it. False,
  /// without a change, if that is not finite.
  bool simulate(const P& problem, Lq& lq, const Slacks& slacks, Point& t) noexcept {
    lq.backward(t.horizon, shift_, true);
    if (!std::isfinite(try_step(problem, t, lq, slacks, 0.0))) return false;
    t = candidate_;
    return true;
  }

  /// Takes one step from t, at which `now` is the linearisation. False if no step length and no shift lowers
  /// the cost, or the deadline came first.
  bool step(const P& problem, const Linearised& now, Lq& lq, Slacks& slacks, Point& t,
            const Deadline& deadline, int& sweeps) noexcept {
    constexpr int kAttempts = 12;        // trials with a larger shift each; chosen
    constexpr int kHalvings = 6;         // trials of a shorter step each; chosen
    constexpr double kArmijo = 1e-4;     // least share of the predicted descent; usual
    constexpr double kRounding = 1e-13;  // rounding of a merit, relative
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      ++sweeps;
      lq.backward(t.horizon, shift_, true);
      double scale = 0.0;
      const double expected = expected_change(lq, t.horizon, scale);
      if (!(expected < 0.0)) return false;
      double length = 1.0;
      for (int trial = 0; trial < kHalvings; ++trial, length *= 0.5) {
        if (deadline.spent()) return false;
        const double allowed = now.merit + kArmijo * length * expected + kRounding * std::fabs(now.merit);
        if (!(try_step(problem, t, lq, slacks, length) <= allowed)) continue;
        moved_ = max_input_change(t, candidate_);
        t = candidate_;
        slacks.lower_for_gain(-expected, t.horizon);
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
  /// Change of merit that the quadratic model predicts for the whole step; `scale`: largest curvature of an
  /// input.
  static double expected_change(const Lq& lq, std::size_t horizon, double& scale) noexcept {
    double change = 0.0;
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        const double own = lq.constant(k, m);
        change += own * lq.feedback[k].g[m];
        for (std::size_t l = 0; l < kNu; ++l)
          change += 0.5 * own * lq.feedback[k].H[m][l] * lq.constant(k, l);
        scale = std::max(scale, lq.feedback[k].H[m][m]);
      }
    }
    return change;
  }

  /// Simulates the gains from t into candidate_ with the constant part times `length`; returns the merit.
  double try_step(const P& problem, const Point& t, const Lq& lq, const Slacks& slacks,
                  double length) noexcept {
    using One = typename Evaluate::One;
    candidate_.horizon = t.horizon;
    for (std::size_t i = 0; i < kNx; ++i) candidate_.x[i][0] = t.x[i][0];
    double merit = 0.0;
    for (std::size_t k = 0; k < t.horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        double du = length * lq.constant(k, m);
        for (std::size_t i = 0; i < kNx; ++i) du += lq.gain(k, m, i) * (candidate_.x[i][k] - t.x[i][k]);
        candidate_.u[m][k] = t.u[m][k] + std::min(std::max(du, lq.lq.low[m][k]), lq.lq.high[m][k]);
      }
      const auto x = candidate_.template state<One>(k);
      const auto u = candidate_.template input<One>(k);
      merit += half_square(problem.residual(static_cast<int>(k), x, u));
      if constexpr (P::kNc > 0) {
        std::array<double, static_cast<std::size_t>(P::kNc)> values;
        const auto constraint = to_array<One>(problem.constraint(static_cast<int>(k), x, u));
        for (std::size_t c = 0; c < values.size(); ++c) values[c] = Evaluate::number(constraint[c]);
        merit += slacks.merit(problem, values);
      }
      const auto next = Evaluate::next(problem, k, x, u);
      for (std::size_t i = 0; i < kNx; ++i) candidate_.x[i][k + 1] = Evaluate::number(next[i]);
    }
    return merit + half_square(problem.terminal_residual(candidate_.template state<One>(t.horizon)));
  }
  template <class Row>
  static double half_square(const Row& row) noexcept {
    double sum = 0.0;
    for (const auto& r : to_array<typename Evaluate::One>(row))
      sum += 0.5 * Evaluate::number(r) * Evaluate::number(r);
    return sum;
  }

  Point candidate_;     ///< point of the line search
  double shift_ = 0.0;  ///< Levenberg shift on the input blocks
  double moved_ = 0.0;  ///< moved()
  int taken_ = 0;       ///< steps since the descent began
  int smooth_ = 0;      ///< whole unshifted steps in succession
  int needed_ = 2;      ///< such steps before a trial of full steps
};

}  // namespace chicane::solver
