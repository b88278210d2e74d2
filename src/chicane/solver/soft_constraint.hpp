// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::solver {

/// One soft constraint c <= 0 inside the interior-point method: violation s >= 0 and distance t = s − c >= 0
/// with multipliers n and z. Both slacks are eliminated in closed form, so a stage sees only a multiplier and
/// a curvature (docs/solver.md, eq. 16–21):
///
///     min  linear · s + ½ quadratic · s² − μ log s − μ log t   over s, t = s − c
struct SoftConstraint {
  double value = 0.0;  ///< c at the iterate
  double s = 1.0;
  double t = 1.0;
  double n = 1.0;
  double z = 1.0;  ///< price of the constraint: d(cost)/dc

  /// What the eliminated slacks add to the quadratic program: multiplier `slope` + `curvature` · δc.
  struct Model {
    double slope;
    double curvature;
  };

  /// Puts (s, t, n, z) on the central path for the present value: an interior point always exists and needs
  /// no memory. Newton's method for linear + quadratic · s = μ/s + μ/t on the smaller slack, from the
  /// solution for quadratic = 0.
  void centre(const SoftPenalty& price, double mu) noexcept {
    const double gap = std::fabs(value);
    const double beyond = std::max(value, 0.0);
    const double total = price.linear + price.quadratic * beyond + sqrt(price.quadratic * mu);
    const double b = total * gap - 2.0 * mu;
    const double root = sqrt(total * gap * total * gap + 4.0 * mu * mu);
    double y = b > 0.0 ? 2.0 * mu * gap / (b + root) : (root - b) / (2.0 * total);
    y = std::max(y, 1e-3 * mu / total);
    for (int turn = 0; turn < 8; ++turn) {
      const double far = y + gap;
      const double slack = value > 0.0 ? far : y;
      const double excess = price.linear + price.quadratic * slack - mu / y - mu / far;
      const double next = y - excess / (price.quadratic + mu / (y * y) + mu / (far * far));
      y = std::max(next, 0.1 * y);
    }
    s = value > 0.0 ? y + gap : y;
    t = value > 0.0 ? y : y + gap;
    n = mu / s;
    z = mu / t;
  }

  [[nodiscard]] Model model(const SoftPenalty& price, double mu) const noexcept {
    const double D = z / t;
    const double E = n / s + price.quadratic;
    const double miss = s - value - t;
    const double b = pull(price, mu, miss);
    return {mu / t - D * miss - D * b / (E + D), D * E / (E + D)};
  }

  /// Largest residual of the constraint's own optimality conditions at barrier μ.
  [[nodiscard]] double residual(const SoftPenalty& price, double mu) const noexcept {
    const double products = std::max(std::fabs(t * z - mu), std::fabs(s * n - mu));
    const double equations =
        std::max(std::fabs(s - value - t), std::fabs(price.linear + price.quadratic * s - z - n));
    return std::max(products, equations);
  }

  /// Newton step of the slacks and multipliers when the constraint moves by `change`.
  [[nodiscard]] SoftConstraint step(const SoftPenalty& price, double mu, double change) const noexcept {
    const double D = z / t;
    const double miss = s - value - t;
    SoftConstraint d;
    d.value = change;
    d.s = (D * change + pull(price, mu, miss)) / (n / s + price.quadratic + D);
    d.t = d.s - change + miss;
    d.z = (mu - z * d.t) / t - z;
    d.n = (mu - n * d.s) / s - n;
    return d;
  }

  /// Smoothed penalty: the minimum above. Pre: centred at `mu`.
  [[nodiscard]] double barrier(const SoftPenalty& price, double mu) const noexcept {
    return s * (price.linear + 0.5 * price.quadratic * s) - mu * (log(s) + log(t));
  }

  /// The exact penalty, without slacks.
  [[nodiscard]] double penalty(const SoftPenalty& price) const noexcept {
    const double beyond = std::max(value, 0.0);
    return beyond * (price.linear + 0.5 * price.quadratic * beyond);
  }

 private:
  [[nodiscard]] double pull(const SoftPenalty& price, double mu, double miss) const noexcept {
    return mu / t + mu / s - z / t * miss - price.linear - price.quadratic * s;
  }
};

}  // namespace chicane::solver
