// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/math_pack.hpp"
#include "chicane/solver/detail/barrier.hpp"
#include "chicane/solver/detail/bound_barrier.hpp"
#include "chicane/solver/detail/soft_constraint.hpp"

namespace chicane::solver {

/// Directions of the slacks and multipliers of a barrier's soft constraints, to be followed by as much as a
/// line search finds good (docs/solver.md, eq. 18–20).
template <OcpProblem P, std::size_t Capacity, class Arch>
class SoftSteps {
 public:
  static constexpr std::size_t kNc = P::kNc;
  using Slacks = Barrier<P, Capacity, Arch>;
  using V = typename Slacks::V;
  using Step = typename Slacks::Step;

  /// Those that belong to a step of states and inputs; how far they may be followed.
  StepLengths find(const P& problem, const Slacks& slacks, const Step& step, double fraction) noexcept {
    V primal(0.0);
    V dual(0.0);
    slope_ = 0.0;
    V slope(0.0);
    const double mu = slacks.mu();
    for (std::size_t k = 0; k < step.horizon; k += 8) {
      const auto live =
          stage_number(StageLanes<V>{static_cast<int>(k)}) < V(static_cast<double>(step.horizon));
      for (std::size_t c = 0; c < slacks.count(); ++c) {
        const SoftPenalty price = price_of(problem, c);
        const SoftConstraint<V> soft = slacks.load(c, k);
        const V change = slacks.change(step, c, k);
        const SoftConstraint<V> d = soft.step(price, mu, change);
        primal = max(select(live, max(-d.s / soft.s, -d.t / soft.t), V(0.0)), primal);
        dual = max(select(live, max(-d.z / soft.z, -d.n / soft.n), V(0.0)), dual);
        const V pulled = soft.model(price, mu).slope * change;  // what the stage's gradient has of it
        const V own = (price.linear + price.quadratic * soft.s - mu / soft.s) * d.s - mu / soft.t * d.t;
        slope += select(live, own - pulled, V(0.0));
        d.s.store(s_[c] + k);
        d.t.store(t_[c] + k);
        d.z.store(z_[c] + k);
        d.n.store(n_[c] + k);
      }
    }
    slope_ = sum(slope);
    return {std::min(1.0, fraction / std::max(largest(primal), 1e-30)),
            std::min(1.0, fraction / std::max(largest(dual), 1e-30))};
  }
  /// Slope along the direction of what the slacks cost, less what the stages' gradients have of it.
  [[nodiscard]] double slope() const noexcept { return slope_; }

  /// Adds miss, cost without barriers and logarithms of constraint c of the stages from k on, which has
  /// `value` there, at `length` of the direction.
  template <class Mask>
  void measure(const SoftPenalty& price, const Slacks& slacks, std::size_t c, std::size_t k, const V& value,
               double length, const Mask& live, V& miss, V& cost, V& logs) noexcept {
    const SoftConstraint<V> soft = slacks.load(c, k);
    V s = soft.s;
    V t = soft.t;
    if (length > 0.0) {
      s += length * V::load(s_[c] + k);
      t += length * V::load(t_[c] + k);
      t = select(s - value > t, s - value, t);  // more room costs nothing
    }
    s.store(s_at_[c] + k);
    t.store(t_at_[c] + k);
    miss += select(live, abs(s - value - t), V(0.0));
    cost += select(live, s * (price.linear + 0.5 * price.quadratic * s), V(0.0));
    logs += select(live, log(s) + log(t), V(0.0));
  }
  /// To where the last measure() was; multipliers by `dual_length` of their direction.
  void move(Slacks& slacks, std::size_t horizon, double dual_length) noexcept {
    constexpr double kFar = 1e10;
    const double mu = slacks.mu();
    for (std::size_t k = 0; k < horizon; k += 8) {
      for (std::size_t c = 0; c < slacks.count(); ++c) {
        SoftConstraint<V> soft = slacks.load(c, k);
        soft.s = V::load(s_at_[c] + k);
        soft.t = V::load(t_at_[c] + k);
        soft.z += dual_length * V::load(z_[c] + k);
        soft.n += dual_length * V::load(n_[c] + k);
        soft.z = min(max(soft.z, mu / (kFar * soft.t)), kFar * mu / soft.t);
        soft.n = min(max(soft.n, mu / (kFar * soft.s)), kFar * mu / soft.s);
        slacks.store(c, k, soft);
      }
    }
  }

 private:
  static constexpr std::size_t kStride = kStageStride<Capacity>;
  alignas(64) double s_[kNc > 0 ? kNc : 1][kStride]{};
  alignas(64) double t_[kNc > 0 ? kNc : 1][kStride]{};
  alignas(64) double s_at_[kNc > 0 ? kNc : 1][kStride]{};
  alignas(64) double t_at_[kNc > 0 ? kNc : 1][kStride]{};
  alignas(64) double z_[kNc > 0 ? kNc : 1][kStride]{};
  alignas(64) double n_[kNc > 0 ? kNc : 1][kStride]{};
  double slope_ = 0.0;
};

}  // namespace chicane::solver
