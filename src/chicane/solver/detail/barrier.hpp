// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/compiler.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/detail/soft_constraint.hpp"
#include "chicane/solver/detail/stage_entries.hpp"
#include "chicane/solver/sparse_row.hpp"

namespace chicane::solver {

/// Penalty of soft constraint `c`.
template <OcpProblem P>
[[nodiscard]] SoftPenalty penalty_of([[maybe_unused]] const P& problem,
                                     [[maybe_unused]] std::size_t c) noexcept {
  if constexpr (P::kNc > 0) return problem.soft_penalty(static_cast<int>(c));
  return {};
}

/// All soft constraints of a horizon, and their common barrier μ (docs/solver.md, eq. 14–21). Each has a
/// slack s of violation with multiplier n, and a slack t of distance with multiplier z. Empty without
/// constraints.
template <OcpProblem P, std::size_t Capacity, class Arch>
class Barrier {
 public:
  static constexpr std::size_t kNc = P::kNc;
  static constexpr std::size_t kNz = P::kNx + P::kNu;
  using V = Stages<Arch>;
  using Step = Iterate<P::kNx, P::kNu, Capacity>;

  /// Starts with a barrier in proportion to the penalties and to the violation at the start; its end is
  /// `final_mu`.
  void start(const P& problem, double final_mu, double violation) noexcept {
    constexpr double kMost = 2.0;  // largest first barrier over the penalties; chosen
    final_ = final_mu;
    count_ = constraint_count(problem);
    mu_ = std::max(final_, highest_penalty(problem) * std::min(std::max(0.5 * violation, kLeast), kMost));
  }
  /// Raises the barrier for a new start, to which small slacks would leave no room.
  void lift(const P& problem) noexcept { mu_ = std::max(mu_, kLeast * highest_penalty(problem)); }

  [[nodiscard]] double mu() const noexcept { return mu_; }
  void set_mu(double mu) noexcept { mu_ = mu; }
  /// Whether the barrier is at its end.
  [[nodiscard]] bool is_final() const noexcept { return count() == 0 || mu_ <= final_; }
  /// Number of active constraints: the first ones of kNc.
  [[nodiscard]] std::size_t count() const noexcept {
    if constexpr (kHasSparseRows<P>) return count_;
    return kNc;
  }

  /// Slacks, multipliers and barrier of one iterate, for a return to it.
  struct Memory {
    double mu = 0.0;
    /// Copies of s, t, n and z.
    double numbers[4][kNc > 0 ? kNc : 1][kStageStride<Capacity>]{};
  };
  void save(Memory& memory, std::size_t horizon) const noexcept {
    memory.mu = mu_;
    const double(*const from[4])[kStride] = {s_, t_, n_, z_};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t c = 0; c < count(); ++c)
        std::copy(from[i][c], from[i][c] + padded_stages(horizon), memory.numbers[i][c]);
    }
  }
  void restore(const Memory& memory, std::size_t horizon) noexcept {
    mu_ = memory.mu;
    double(*const to[4])[kStride] = {s_, t_, n_, z_};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t c = 0; c < count(); ++c)
        std::copy(memory.numbers[i][c], memory.numbers[i][c] + padded_stages(horizon), to[i][c]);
    }
  }

  /// Adapts violation slacks and multipliers of hard constraints to their present penalties.
  void update_penalties(const P& problem, std::size_t horizon) noexcept {
    for (std::size_t c = 0; c < count(); ++c) {
      if (!problem.keeps(c)) continue;
      const double penalty = penalty_of(problem, c).linear;
      for (std::size_t k = 0; k < horizon; ++k) {
        n_[c][k] = std::max(penalty - z_[c][k], 1e-3 * penalty);
        s_[c][k] = mu_ / n_[c][k];
      }
    }
  }

  /// Sets the multipliers of constraints that are not hard to zero.
  void forget_soft(const P& problem) noexcept {
    for (std::size_t c = 0; c < count(); ++c) {
      if (!problem.must_hold(c)) std::fill(std::begin(z_[c]), std::end(z_[c]), 0.0);
    }
  }

  // ---- constraint c of the eight stages from k on
  [[nodiscard]] CHICANE_INLINE SoftConstraint<V> load(std::size_t c, std::size_t k) const noexcept {
    return {V::load(value_[c] + k), V::load(s_[c] + k), V::load(t_[c] + k), V::load(n_[c] + k),
            V::load(z_[c] + k)};
  }
  CHICANE_INLINE void store(std::size_t c, std::size_t k, const SoftConstraint<V>& soft) noexcept {
    soft.value.store(value_[c] + k);
    soft.s.store(s_[c] + k);
    soft.t.store(t_[c] + k);
    soft.n.store(n_[c] + k);
    soft.z.store(z_[c] + k);
  }
  /// Keeps the derivatives of a constraint, for change().
  template <class J>
  CHICANE_INLINE void store_row(std::size_t c, std::size_t k, const J& constraint) noexcept {
    each_slope<V>(constraint,
                  [&](std::size_t j, const V& slope) CHICANE_INLINE { slope.store(row_[c][j] + k); });
  }

  /// First-order change of constraint c of the eight stages from k on under a step.
  V change(const Step& step, std::size_t c, std::size_t k) const noexcept {
    V sum(0.0);
    for (std::size_t i = 0; i < P::kNx; ++i) sum += V::load(row_[c][i] + k) * V::load(step.x[i] + k);
    for (std::size_t m = 0; m < P::kNu; ++m) sum += V::load(row_[c][P::kNx + m] + k) * V::load(step.u[m] + k);
    return sum;
  }

  /// Calls add(k, j, change), with the change of the slope of the stage's model by variable j since the
  /// barrier was `from` (eq. 20).
  template <class Add>
  void each_pull(const P& problem, double from, std::size_t horizon, const Add& add) const noexcept {
    for (std::size_t k = 0; k < horizon && count() > 0; k += 8) {
      std::array<V, kNz> pull;
      pull.fill(V(0.0));
      for (std::size_t c = 0; c < count(); ++c) {
        const SoftConstraint<V> soft = load(c, k);
        const SoftPenalty penalty = penalty_of(problem, c);
        const V more = soft.model(penalty, mu_).slope - soft.model(penalty, from).slope;
        for (std::size_t j = 0; j < kNz; ++j) pull[j] += more * V::load(row_[c][j] + k);
      }
      for (std::size_t j = 0; j < kNz; ++j) {
        for (std::size_t lane = 0; lane < 8 && k + lane < horizon; ++lane) {
          if (pull[j][lane] != 0.0) add(k + lane, j, pull[j][lane]);
        }
      }
    }
  }

  /// Value of constraint c of stage k at the last linearisation.
  [[nodiscard]] double value(std::size_t c, std::size_t k) const noexcept { return value_[c][k]; }
  /// Slack s of violation.
  [[nodiscard]] double violation_slack(std::size_t c, std::size_t k) const noexcept { return s_[c][k]; }
  /// Slack t of distance.
  [[nodiscard]] double distance_slack(std::size_t c, std::size_t k) const noexcept { return t_[c][k]; }
  /// Multiplier of a constraint: cost saved by a unit of room.
  [[nodiscard]] double multiplier(std::size_t c, std::size_t k) const noexcept { return z_[c][k]; }

  /// Sum of the products of slacks and multipliers.
  [[nodiscard]] double gap(std::size_t horizon) const noexcept {
    double sum = 0.0;
    for (std::size_t c = 0; c < count(); ++c) {
      for (std::size_t k = 0; k < horizon; ++k) sum += t_[c][k] * z_[c][k] + s_[c][k] * n_[c][k];
    }
    return sum;
  }

  /// Smoothed penalty of the constraint values of one stage.
  double merit(const P& problem, const std::array<double, kNc>& values) const noexcept {
    double sum = 0.0;
    for (std::size_t c = 0; c < count(); ++c) {
      SoftConstraint<> soft;
      soft.value = values[c];
      soft.centre(penalty_of(problem, c), mu_);
      sum += soft.barrier(penalty_of(problem, c), mu_);
    }
    return sum;
  }

  /// Moves slacks and multipliers along their Newton steps for a step of states and inputs, by at most a
  /// fraction of the way to zero: kFraction, or 1 − μ if that is more. Returns the step length that the
  /// slacks permit.
  double step(const P& problem, const Step& step) noexcept {
    if constexpr (kNc == 0) return 1.0;
    constexpr double kFraction = 0.995;  // usual for the method
    const double fraction = std::max(kFraction, 1.0 - mu_);
    V primal(0.0);  // longest change, in multiples of its value
    V dual(0.0);
    each(problem, step,
         [&](const SoftConstraint<V>& soft, const SoftConstraint<V>& d, auto live, std::size_t, std::size_t) {
           primal = max(select(live, max(-d.s / soft.s, -d.t / soft.t), V(0.0)), primal);
           dual = max(select(live, max(-d.z / soft.z, -d.n / soft.n), V(0.0)), dual);
         });
    const double length = std::min(1.0, fraction / std::max(largest(primal), 1e-30));
    const double dual_length = std::min(1.0, fraction / std::max(largest(dual), 1e-30));
    each(problem, step,
         [&](SoftConstraint<V> soft, const SoftConstraint<V>& d, auto, std::size_t c, std::size_t k) {
           soft.s += length * d.s;
           soft.t += length * d.t;
           soft.z += dual_length * d.z;
           soft.n += dual_length * d.n;
           store(c, k, soft);
         });
    return length;
  }

  /// Lowers the barrier after a full step. It falls faster for a longer permitted step length, and for a
  /// shorter longest move of an input. The factors were chosen.
  void lower(double length, double longest) noexcept {
    constexpr double kNear = 0.1;  // move of an input that counts as small; chosen
    const double least = longest <= kNear ? 0.01 : 0.1;
    const double share = length > 0.9 ? std::min(least, std::sqrt(mu_)) : (length > 0.5 ? 0.2 : 0.6);
    mu_ = std::max(final_, share * mu_);
  }
  /// Lowers the barrier after a descent step whose predicted gain is within the barrier's own gap.
  void lower_for_gain(double gain, std::size_t horizon) noexcept {
    if (gain < mu_ * static_cast<double>(horizon * count())) mu_ = std::max(final_, 0.2 * mu_);
  }

  /// Whether a constraint is violated by more than its cap.
  bool exceeds_a_cap(const P& problem, std::size_t horizon) const noexcept {
    for (std::size_t c = 0; c < count(); ++c) {
      const double cap = penalty_of(problem, c).cap;
      for (std::size_t k = 0; k < horizon; ++k) {
        if (value_[c][k] > cap) return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::size_t kStride = kStageStride<Capacity>;
  /// Least first barrier over the penalties; chosen: a start that keeps all constraints is likely a good one.
  static constexpr double kLeast = 0.002;

  /// Scale of the barrier: the highest penalty.
  static double highest_penalty(const P& problem) noexcept {
    double penalty = 0.0;
    for (std::size_t c = 0; c < constraint_count(problem); ++c) {
      penalty = std::max({penalty, penalty_of(problem, c).linear, 0.1 * penalty_of(problem, c).quadratic});
    }
    return penalty;
  }

  /// Calls visit(constraint, its Newton step, which stages are in the horizon, c, k) for all constraints of
  /// eight stages at a time.
  template <class Visit>
  void each(const P& problem, const Step& step, const Visit& visit) noexcept {
    for (std::size_t k = 0; k < step.horizon; k += 8) {
      const auto live = stages_before<V>(k, step.horizon);
      for (std::size_t c = 0; c < count(); ++c) {
        const SoftConstraint<V> soft = load(c, k);
        visit(soft, soft.step(penalty_of(problem, c), mu_, change(step, c, k)), live, c, k);
      }
    }
  }
  double mu_ = 0.0;          ///< μ
  double final_ = 0.0;       ///< end of μ
  std::size_t count_ = kNc;  ///< count() of sparse problems
  using Lines = double[kNc > 0 ? kNc : 1][kStride];
  alignas(64) Lines value_{};                                  ///< values of the constraints
  alignas(64) Lines s_{};                                      ///< slacks of violation
  alignas(64) Lines t_{};                                      ///< slacks of distance
  alignas(64) Lines n_{};                                      ///< multipliers of s
  alignas(64) Lines z_{};                                      ///< multipliers of t
  alignas(64) double row_[kNc > 0 ? kNc : 1][kNz][kStride]{};  ///< Jacobian; zeros by type stay zero
};

}  // namespace chicane::solver
