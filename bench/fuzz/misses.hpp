// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "families/kkt.hpp"
#include "problems/dual.hpp"

namespace chicane::bench {

/// What must hold as equations in the inputs alone: a simulation, and Levenberg and Marquardt's method on the
/// rows that are missed, inputs inside their bounds. Shares no line with the solver; dense, for small
/// problems.
template <solver::OcpProblem P, int Capacity>
class Misses {
 public:
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;

  Misses(const OverArrays<P>& problem, const Trajectory& t)
      : problem_{problem},
        horizon_{t.horizon},
        count_{static_cast<std::size_t>(t.horizon) * kNu},
        start_{t.x[0]} {
    for (int k = 0; k < t.horizon; ++k) {
      const auto& u = t.u[static_cast<std::size_t>(k)];
      inputs_.insert(inputs_.end(), u.begin(), u.end());
    }
  }

  /// Largest miss of the inputs as they are; infinite where they cannot be simulated.
  [[nodiscard]] double worst() { return simulate(inputs_, false) ? worst_ : HUGE_VAL; }

  /// The same after short steps that lessen the sum of squares.
  [[nodiscard]] double worst_after_descent(double enough) {
    if (!simulate(inputs_, true)) return HUGE_VAL;
    double least = worst_;
    double damping = -1.0;
    for (int turn = 0; turn < 60 && least > enough; ++turn) {
      normal_equations();
      double largest = 1e-12;
      for (std::size_t i = 0; i < count_; ++i) largest = std::max(largest, matrix_[i * count_ + i]);
      if (damping < 0.0) damping = 10.0 * largest;
      const double before = sum_;
      bool is_better = false;
      for (int trial = 0; trial < 12 && !is_better; ++trial, damping *= is_better ? 0.1 : 10.0) {
        const std::vector<double> there = stepped(damping);
        is_better = simulate(there, false) && sum_ < before * (1.0 - 1e-6);
        if (is_better) inputs_ = there;
      }
      if (!is_better || !simulate(inputs_, true)) break;
      least = std::min(least, worst_);
    }
    return least;
  }

 private:
  static constexpr std::size_t kNx = P::kNx, kNu = P::kNu, kNz = kNx + kNu;
  using D = Dual<static_cast<int>(kNz)>;

  /// Rows, and with `derivatives` their slopes, at `inputs`. False when a number is not finite.
  bool simulate(const std::vector<double>& inputs, bool derivatives) {
    sum_ = worst_ = 0.0;
    rows_.clear();
    slopes_.clear();
    std::array<double, kNx> at = start_;
    std::vector<double> by_input(kNx * count_, 0.0);  // dx/du
    const auto add = [&](const D& value, int stage) {
      sum_ += 0.5 * value.v * value.v;
      worst_ = std::max(worst_, std::fabs(value.v));
      if (!derivatives) return;
      rows_.push_back(value.v);
      std::vector<double> slope(count_, 0.0);
      chain(value, by_input, stage, slope.data());
      slopes_.insert(slopes_.end(), slope.begin(), slope.end());
    };
    for (int stage = 0; stage < horizon_; ++stage) {
      std::array<D, kNx> x;
      std::array<D, kNu> u;
      for (std::size_t i = 0; i < kNx; ++i) x[i] = D::variable(at[i], static_cast<int>(i));
      for (std::size_t m = 0; m < kNu; ++m)
        u[m] = D::variable(inputs[static_cast<std::size_t>(stage) * kNu + m], static_cast<int>(kNx + m));
      for (const D& h : problem_.template equality<D>(stage, x, u)) add(h, stage);
      if constexpr (P::kNc > 0) {
        int c = 0;
        for (const D& value : problem_.template constraint<D>(stage, x, u)) {
          if (is_hard(problem_, c++) && value.v > 0.0) add(value, stage);
        }
      }
      const auto next = problem_.template dynamics<D>(stage, x, u);
      std::vector<double> by_next(kNx * count_, 0.0);
      for (std::size_t i = 0; i < kNx; ++i) {
        at[i] = next[i].v;
        if (!std::isfinite(at[i])) return false;
        if (derivatives) chain(next[i], by_input, stage, by_next.data() + i * count_);
      }
      by_input.swap(by_next);
    }
    std::array<D, kNx> x;
    for (std::size_t i = 0; i < kNx; ++i) x[i] = D::variable(at[i], static_cast<int>(i));
    for (const D& h : problem_.template terminal_equality<D>(x)) add(h, -1);
    for (const D& g : problem_.template terminal_constraint<D>(x)) {
      if (g.v > 0.0) add(g, -1);
    }
    return std::isfinite(sum_);
  }
  /// Slopes of `value`, a function of the state and, where stage >= 0, of its inputs, by all inputs.
  void chain(const D& value, const std::vector<double>& by_input, int stage, double* slope) const {
    for (std::size_t i = 0; i < kNx; ++i) {
      for (std::size_t j = 0; j < count_; ++j) slope[j] += value.d[i] * by_input[i * count_ + j];
    }
    for (std::size_t m = 0; stage >= 0 && m < kNu; ++m)
      slope[static_cast<std::size_t>(stage) * kNu + m] += value.d[kNx + m];
  }
  void normal_equations() {
    matrix_.assign(count_ * count_, 0.0);
    gradient_.assign(count_, 0.0);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const double* slope = slopes_.data() + r * count_;
      for (std::size_t i = 0; i < count_; ++i) {
        gradient_[i] += slope[i] * rows_[r];
        for (std::size_t j = 0; slope[i] != 0.0 && j <= i; ++j)
          matrix_[i * count_ + j] += slope[i] * slope[j];
      }
    }
  }
  /// Inputs after a step of the shifted normal equations; those at a bound that hinders them stay.
  [[nodiscard]] std::vector<double> stepped(double damping) const {
    std::vector<double> l = matrix_, y = gradient_, there = inputs_;
    std::vector<bool> is_held(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const auto [low, high] = bounds(i);
      is_held[i] = (inputs_[i] <= low && gradient_[i] > 0.0) || (inputs_[i] >= high && gradient_[i] < 0.0);
      l[i * count_ + i] += damping;
      if (!is_held[i]) continue;
      for (std::size_t j = 0; j < count_; ++j) (j < i ? l[i * count_ + j] : l[j * count_ + i]) = 0.0;
      l[i * count_ + i] = 1.0;
      y[i] = 0.0;
    }
    for (std::size_t i = 0; i < count_; ++i) {  // Cholesky
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = l[i * count_ + j];
        for (std::size_t n = 0; n < j; ++n) sum -= l[i * count_ + n] * l[j * count_ + n];
        l[i * count_ + j] = i == j ? std::sqrt(std::max(sum, 1e-30)) : sum / l[j * count_ + j];
      }
    }
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t n = 0; n < i; ++n) y[i] -= l[i * count_ + n] * y[n];
      y[i] /= l[i * count_ + i];
    }
    for (std::size_t i = count_; i-- > 0;) {
      for (std::size_t n = i + 1; n < count_; ++n) y[i] -= l[n * count_ + i] * y[n];
      y[i] /= l[i * count_ + i];
      const auto [low, high] = bounds(i);
      there[i] = std::min(std::max(inputs_[i] - y[i], low), high);
    }
    return there;
  }
  [[nodiscard]] std::pair<double, double> bounds(std::size_t i) const {
    const auto stage = static_cast<int>(i / kNu);
    return {problem_.input_lower(stage)[i % kNu], problem_.input_upper(stage)[i % kNu]};
  }

  const OverArrays<P>& problem_;
  int horizon_;
  std::size_t count_;  ///< of inputs
  std::array<double, P::kNx> start_;
  std::vector<double> inputs_;
  std::vector<double> rows_, slopes_, matrix_, gradient_;
  double sum_ = 0.0;    ///< ½ Σ miss²
  double worst_ = 0.0;  ///< largest miss
};

}  // namespace chicane::bench
