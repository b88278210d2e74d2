// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::solver {

/// One soft constraint c <= 0 inside the interior-point method: violation s >= 0 and distance t = s − c >= 0
/// with multipliers n and z. Both slacks are eliminated in closed form, so that a stage contains only a
/// multiplier and a curvature (docs/solver.md, eq. 14–21):
///
///     min  linear · s + ½ quadratic · s² − μ log s − μ log t   over s, t = s − c
///
/// V is double, or a pack with one stage, or one problem, in each lane; μ is one number, or a pack as well.
template <class V = double>
struct SoftConstraint {
  static constexpr double kMustHold = -1.0;  ///< cap that marks hard constraints

  V value{0.0};  ///< c at the iterate
  V s{1.0};      ///< slack of violation
  V t{1.0};      ///< slack of distance
  V n{1.0};      ///< multiplier of s
  V z{1.0};      ///< multiplier of t and of the constraint: d(cost)/dc

  /// Contribution of the eliminated slacks to the quadratic program: multiplier `slope` + `curvature` · δc.
  struct Model {
    V slope;
    V curvature;
  };

  /// Puts (s, t, n, z) on the central path for the present value: such a point always exists. Eight steps
  /// (chosen) of Newton's method for linear + quadratic · s = μ/s + μ/t on the smaller slack, from the
  /// solution for quadratic = 0.
  CHICANE_INLINE void centre(const SoftPenalty& penalty, const auto& mu) noexcept {
    if (penalty.cap == kMustHold) {  // the slacks have no room for a violation, which stays a residual
      s = V(1.0) * (mu / penalty.linear);
      t = max(-value, 1e-2 * max(abs(value), V(1.0)));
      n = mu / s;
      z = mu / t;
      return;
    }
    const auto is_violated = value > V(0.0);
    const V gap = abs(value);
    const V beyond = max(value, V(0.0));
    const V total = penalty.linear + penalty.quadratic * beyond + sqrt(penalty.quadratic * mu);
    const V b = total * gap - 2.0 * mu;
    const V root = sqrt(total * gap * total * gap + 4.0 * mu * mu);
    V y = select(b > V(0.0), 2.0 * mu * gap / (b + root), (root - b) / (2.0 * total));
    y = max(y, 1e-3 * mu / total);
    for (int iteration = 0; iteration < 8; ++iteration) {
      const V far = y + gap;
      const V slack = select(is_violated, far, y);
      const V excess = penalty.linear + penalty.quadratic * slack - mu / y - mu / far;
      const V next = y - excess / (penalty.quadratic + mu / (y * y) + mu / (far * far));
      y = max(next, 0.1 * y);
    }
    s = select(is_violated, y + gap, y);
    t = select(is_violated, y, y + gap);
    n = mu / s;
    z = mu / t;
  }

  /// Model of the constraint with its slacks eliminated at barrier μ.
  [[nodiscard]] Model model(const SoftPenalty& penalty, const auto& mu) const noexcept {
    const V D = z / t;
    const V E = n / s + penalty.quadratic;
    const V miss = s - value - t;
    const V b = pull(penalty, mu, miss);
    const V share = D / (E + D);
    return {mu / t - D * miss - share * b, share * E};
  }

  /// Largest residual of the constraint's own optimality conditions at barrier μ.
  [[nodiscard]] V residual(const SoftPenalty& penalty, const auto& mu) const noexcept {
    const V products = max(abs(t * z - mu), abs(s * n - mu));
    const V equations = max(abs(s - value - t), abs(penalty.linear + penalty.quadratic * s - z - n));
    return max(products, equations);
  }

  /// Newton step of the slacks and multipliers when the constraint moves by `change`.
  [[nodiscard]] SoftConstraint step(const SoftPenalty& penalty, const auto& mu,
                                    const V& change) const noexcept {
    const V D = z / t;
    const V miss = s - value - t;
    SoftConstraint d;
    d.value = change;
    d.s = (D * change + pull(penalty, mu, miss)) / (n / s + penalty.quadratic + D);
    d.t = d.s - change + miss;
    d.z = (mu - z * d.t) / t - z;
    d.n = (mu - n * d.s) / s - n;
    return d;
  }

  /// Smoothed penalty: the minimum over both slacks. Pre: centred at `mu`.
  [[nodiscard]] V barrier(const SoftPenalty& penalty, const auto& mu) const noexcept {
    return s * (penalty.linear + 0.5 * penalty.quadratic * s) - mu * (log(s) + log(t));
  }

  /// Exact penalty, without slacks.
  [[nodiscard]] V penalty(const SoftPenalty& penalty) const noexcept {
    const V beyond = max(value, V(0.0));
    return beyond * (penalty.linear + 0.5 * penalty.quadratic * beyond);
  }

 private:
  /// Force on the violation slack when t follows s.
  [[nodiscard]] V pull(const SoftPenalty& penalty, const auto& mu, const V& miss) const noexcept {
    return mu / t + mu / s - z / t * miss - penalty.linear - penalty.quadratic * s;
  }
};

}  // namespace chicane::solver
