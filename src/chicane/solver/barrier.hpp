// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/solver/linearisation.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/soft_constraint.hpp"

namespace chicane::solver {

/// All soft constraints of a horizon and their common barrier μ (docs/solver.md, eq. 14–21). Empty loops
/// without constraints.
template <OcpProblem P, std::size_t Capacity>
class Barrier {
 public:
  static constexpr std::size_t kNc = P::kNc;
  using Lin = Linearisation<P, Capacity>;

  /// Begins with a barrier in proportion to the prices; it will end at `final_mu`.
  void start(const P& problem, double final_mu) noexcept {
    mu_ = start_mu(problem);
    final_ = final_mu;
  }
  /// Raises the barrier again: small slacks would leave a new start no room.
  void lift(const P& problem) noexcept { mu_ = std::max(mu_, 0.01 * start_mu(problem)); }

  [[nodiscard]] double mu() const noexcept { return mu_; }
  [[nodiscard]] bool is_final() const noexcept { return kNc == 0 || mu_ <= final_; }

  /// Puts every constraint on the central path; returns what the barrier adds to the cost there.
  double centre(const P& problem, std::size_t horizon, Lin& now) const noexcept {
    double added = 0.0;
    each(problem, horizon, now,
         [&](SoftConstraint& soft, const SoftPenalty& price, std::size_t, std::size_t) {
           soft.centre(price, mu_);
           added += soft.barrier(price, mu_) - soft.penalty(price);
         });
    return added;
  }

  /// Largest residual of the constraints' own optimality conditions (eq. 15–17).
  double residual(const P& problem, std::size_t horizon, Lin& now) const noexcept {
    double worst = 0.0;
    each(problem, horizon, now,
         [&](const SoftConstraint& soft, const SoftPenalty& price, std::size_t, std::size_t) {
           worst = std::max(worst, soft.residual(price, mu_));
         });
    return worst;
  }

  /// Smoothed penalty of the constraint values of one stage.
  double merit(const P& problem, const std::array<double, kNc>& values) const noexcept {
    double sum = 0.0;
    for (std::size_t c = 0; c < kNc; ++c) {
      SoftConstraint soft;
      soft.value = values[c];
      soft.centre(price_of(problem, c), mu_);
      sum += soft.barrier(price_of(problem, c), mu_);
    }
    return sum;
  }

  /// Moves slacks and multipliers along their Newton steps for the step in `lq`, never beyond 0.995 of the
  /// way to zero; returns the step length that the slacks allow.
  double step(const P& problem, std::size_t horizon, Lin& now, const typename Lin::Lq& lq) const noexcept {
    constexpr double kFraction = 0.995;
    double primal = 1.0;
    double dual = 1.0;
    const auto limit = [](double length, double value, double change) {
      return change < 0.0 ? std::min(length, -kFraction * value / change) : length;
    };
    const auto newton = [&](const SoftConstraint& soft, const SoftPenalty& price, std::size_t k,
                            std::size_t c) { return soft.step(price, mu_, now.soft_change(k, c, lq)); };
    each(problem, horizon, now,
         [&](const SoftConstraint& soft, const SoftPenalty& price, std::size_t k, std::size_t c) {
           const SoftConstraint d = newton(soft, price, k, c);
           primal = limit(limit(primal, soft.s, d.s), soft.t, d.t);
           dual = limit(limit(dual, soft.z, d.z), soft.n, d.n);
         });
    each(problem, horizon, now,
         [&](SoftConstraint& soft, const SoftPenalty& price, std::size_t k, std::size_t c) {
           const SoftConstraint d = newton(soft, price, k, c);
           soft.s += primal * d.s;
           soft.t += primal * d.t;
           soft.z += dual * d.z;
           soft.n += dual * d.n;
         });
    return primal;
  }

  /// Lowers the barrier after a full step, the faster the longer the slacks let it be.
  void lower(double length) noexcept {
    const double share = length > 0.9 ? std::min(0.1, std::sqrt(mu_)) : (length > 0.5 ? 0.2 : 0.6);
    mu_ = std::max(final_, share * mu_);
  }
  /// Lowers it after a descent step once the promised gain is within the barrier's own gap.
  void lower_for_gain(double gain, std::size_t horizon) noexcept {
    if (gain < mu_ * static_cast<double>(horizon * kNc)) mu_ = std::max(final_, 0.2 * mu_);
  }

  bool exceeds_a_cap(const P& problem, std::size_t horizon, Lin& now) const noexcept {
    bool exceeds = false;
    each(problem, horizon, now,
         [&](const SoftConstraint& soft, const SoftPenalty& price, std::size_t, std::size_t) {
           exceeds = exceeds || soft.value > price.cap;
         });
    return exceeds;
  }

 private:
  static SoftPenalty price_of([[maybe_unused]] const P& problem, [[maybe_unused]] std::size_t c) noexcept {
    if constexpr (kNc > 0) return problem.soft_penalty(static_cast<int>(c));
    return {};
  }
  static double start_mu(const P& problem) noexcept {
    double price = 0.0;
    for (std::size_t c = 0; c < kNc; ++c) {
      price = std::max({price, price_of(problem, c).linear, 0.1 * price_of(problem, c).quadratic});
    }
    return 0.2 * price;
  }
  template <class Visit>
  static void each(const P& problem, std::size_t horizon, Lin& now, const Visit& visit) noexcept {
    if constexpr (kNc > 0) {
      for (std::size_t k = 0; k < horizon; ++k) {
        for (std::size_t c = 0; c < kNc; ++c) visit(now.soft[k][c], price_of(problem, c), k, c);
      }
    }
  }

  double mu_ = 0.0;
  double final_ = 0.0;
};

}  // namespace chicane::solver
