// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/barrier.hpp"
#include "chicane/solver/detail/filter.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/detail/lq_solver.hpp"
#include "chicane/solver/detail/soft_constraint.hpp"

namespace chicane::solver {

// Slacks and multipliers of the filter method: those of bounds on inputs, and those of soft constraints.

/// Longest steps that keep slacks (primal) and multipliers (dual) positive.
struct StepLengths {
  double primal = 1.0;
  double dual = 1.0;
};

/// Bounds on inputs as barriers (docs/solver.md, eq. 30–33). Each bound has a slack t > 0 and a multiplier z
/// > 0, kept from iterate to iterate of the nonlinear problem. Eight stages at a time; a bound that does not
/// exist has z = 0 and t = 1, which have no effect.
template <class Solver, std::size_t Capacity, class Arch>
class BoundBarrier {
 public:
  static constexpr std::size_t kNu = Solver::kNu;
  using Lq = typename Solver::Lq;
  using Layout = typename Solver::Layout;
  using V = Stages<Arch>;

  /// Starts at the bounds in `qp`, which belong to the present iterate: slacks at least a share kPush of the
  /// width, multipliers on the central path of `mu`. Inputs whose bounds are equal are held there.
  void start(Solver& qp, std::size_t horizon, double mu) noexcept {
    horizon_ = horizon;
    count_ = 0;
    for (std::size_t m = 0; m < kNu; ++m) {
      for (std::size_t k = 0; k < horizon; ++k)
        qp.hold[k][m] = has_width(qp, k, m) ? Hold::kFree : Hold::kLow;
      for (std::size_t n = 0; n < kKinds; ++n) {
        const auto kind = static_cast<Kind>(n);
        Side& side = side_[m][n];
        side = {};
        for (std::size_t k = 0; k < kStride; ++k) side.t[k] = side.at[k] = 1.0;
        for (std::size_t k = 0; k < horizon; ++k) {
          if (!has_bound(qp, k, m, kind)) continue;
          const double bound = bound_of(qp, k, m, kind);
          const double width = bound + bound_of(qp, k, m, static_cast<Kind>(n ^ 1U));
          side.t[k] = std::max(bound, kPush * std::min(width, kWide));
          side.z[k] = mu / side.t[k];
          side.exists[k] = 1.0;
          ++count_;
        }
      }
    }
  }
  /// Starting value of an input between `low` and `high`.
  static double inside(double u, double low, double high) noexcept {
    if (!(high > low)) return u;
    const double push = kPush * std::min(high - low, kWide);
    return std::min(std::max(u, low + push), high - push);
  }

  struct Residual {
    double product = 0.0;      ///< largest |t z − μ|
    double multipliers = 0.0;  ///< sum of the multipliers
    int count = 0;             ///< number of bounds
  };
  /// Residual of complementarity at the present iterate for barrier `mu`.
  [[nodiscard]] Residual residual(double mu) const noexcept {
    V product(0.0);
    V multipliers(0.0);
    each(*this, [&](std::size_t, Kind, const Side& side, std::size_t k, const auto& exists) {
      const V z = V::load(side.z + k);
      product = max(product, select(exists, abs(V::load(side.t + k) * z - mu), V(0.0)));
      multipliers += z;
    });
    return {largest(product), sum(multipliers), count_};
  }
  /// Force of the bound multipliers on input m of stage k.
  [[nodiscard]] double pull(std::size_t k, std::size_t m) const noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n < kKinds; ++n) sum += sign(static_cast<Kind>(n)) * side_[m][n].z[k];
    return sum;
  }
  /// Adds z + μ/t − D·bound and D = z/t to the stages (eq. 31).
  void add_to(Solver& qp, double mu) const noexcept {
    each(*this, [&](std::size_t m, Kind kind, const Side& side, std::size_t k0, const auto& exists) {
      const V z = V::load(side.z + k0), t = V::load(side.t + k0);
      alignas(64) double D[8], g[8];
      (z / t).store(D);
      select(exists, sign(kind) * (z + mu / t - z / t * bounds_of(qp, k0, m, kind)), V(0.0)).store(g);
      const std::size_t u = Layout::kHead + m;
      for (std::size_t lane = 0; lane < 8 && k0 + lane < horizon_; ++lane) {
        const auto add = [&](std::size_t i, std::size_t j, double amount) {
          qp.lq.set_cost(k0 + lane, i, j, qp.lq.cost(k0 + lane, i, j) + amount);
        };
        if (D[lane] == 0.0) continue;
        add(u, u, D[lane]);
        add(u, Layout::kOne, g[lane]);
      }
    });
  }

  /// Finds the directions for a step from the present iterate, whose bounds are in `qp`, and their longest
  /// lengths.
  template <class Step>
  StepLengths find(const Solver& qp, const Step& step, double mu, double fraction) noexcept {
    V primal(0.0);
    V dual(0.0);
    each(*this, [&](std::size_t m, Kind kind, Side& side, std::size_t k, const auto& exists) {
      const V value = V::load(step.u[m] + k);
      const V t = V::load(side.t + k), z = V::load(side.z + k);
      const V bound = bounds_of(qp, k, m, kind);
      const V distance = bound - sign(kind) * value;
      const V dt = select(exists, distance - t, V(0.0));
      const V dz = select(exists, (mu - z * distance) / t, V(0.0));
      dt.store(side.dt + k);
      dz.store(side.dz + k);
      select(exists, bound - t, V(0.0)).store(side.miss + k);
      primal = max(primal, -dt / t);
      dual = max(dual, select(exists, -dz / z, V(0.0)));
    });
    return {std::min(1.0, fraction / std::max(largest(primal), 1e-30)),
            std::min(1.0, fraction / std::max(largest(dual), 1e-30))};
  }
  /// Slope of the barriers along the direction.
  [[nodiscard]] double slope(double mu) const noexcept {
    V total(0.0);
    each(*this, [&](std::size_t, Kind, const Side& side, std::size_t k, const auto&) {
      total -= V::load(side.dt + k) / V::load(side.t + k);
    });
    return mu * sum(total);
  }
  /// Adds miss and logarithms at `length` of the direction: bounds are linear.
  void measure(double length, Merit& merit) noexcept {
    V misses(0.0);
    V logs(0.0);
    each(*this, [&](std::size_t, Kind, Side& side, std::size_t k, const auto&) {
      V at = V::load(side.t + k);
      if (length > 0.0) at += length * V::load(side.dt + k);
      at.store(side.at + k);
      misses += abs(V::load(side.miss + k));
      logs += log(at);
    });
    merit.miss += (1.0 - length) * sum(misses);
    merit.logs += sum(logs);
  }
  /// Adds miss and logarithms at another point than the step's; the bounds in `qp` belong to `from`.
  template <class Point>
  void measure_at(const Solver& qp, const Point& point, const Point& from, Merit& merit) noexcept {
    V misses(0.0);
    V logs(0.0);
    each(*this, [&](std::size_t m, Kind kind, Side& side, std::size_t k, const auto& exists) {
      const V moved = V::load(point.u[m] + k) - V::load(from.u[m] + k);
      const V distance = bounds_of(qp, k, m, kind) - sign(kind) * moved;
      const V at = select(exists, max(distance, 1e-3 * V::load(side.t + k)), V(1.0));
      at.store(side.at + k);
      misses += select(exists, abs(distance - at), V(0.0));
      logs += log(at);
    });
    merit.miss += sum(misses);
    merit.logs += sum(logs);
  }
  /// Moves to the point of the last measure(); multipliers by `dual_length` of their direction.
  void move(double dual_length, double mu) noexcept {
    constexpr double kFar = 1e10;  // largest factor between z and μ / t; usual for the method
    each(*this, [&](std::size_t, Kind, Side& side, std::size_t k, const auto& exists) {
      const V t = V::load(side.at + k);
      const V z = V::load(side.z + k) + dual_length * V::load(side.dz + k);
      t.store(side.t + k);
      select(exists, min(max(z, mu / (kFar * t)), kFar * mu / t), V(0.0)).store(side.z + k);
    });
  }

  /// Puts inputs near a bound into the working set of `qp`.
  void choose_working_set(Solver& qp) const noexcept {
    constexpr double kActive = 1e-3;  // distance over the width that counts as at the bound; chosen
    for (std::size_t k = 0; k < horizon_; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        if (!has_width(qp, k, m)) continue;
        const auto is_active = [&](Kind kind) {
          const Side& side = side_[m][kind];
          const Side& other = side_[m][kind ^ 1U];
          return side.exists[k] != 0.0 &&
                 side.t[k] < kActive * (other.exists[k] != 0.0 ? side.t[k] + other.t[k] : 1.0);
        };
        qp.hold[k][m] = is_active(kHigh) ? Hold::kHigh : (is_active(kLow) ? Hold::kLow : Hold::kFree);
      }
    }
  }

 private:
  static constexpr std::size_t kStride = padded_stages(Capacity);
  static constexpr double kPush = 1e-2;  ///< least first slack over the width; usual for the method
  static constexpr double kWide = 1e2;   ///< largest width that counts for it; chosen
  enum Kind : std::size_t { kLow, kHigh, kKinds };
  /// One bound of one input, stage after stage.
  struct alignas(64) Side {
    double t[kStride]{}, z[kStride]{};    ///< slack and multiplier
    double dt[kStride]{}, dz[kStride]{};  ///< their directions
    double at[kStride]{};                 ///< slack of a trial
    double miss[kStride]{};               ///< distance to the bound less the slack
    double exists[kStride]{};             ///< 1 for a bound that exists, else 0
  };
  static constexpr double sign(Kind kind) noexcept { return kind == kHigh ? 1.0 : -1.0; }
  /// Bounds of input m in direction `kind`, of the stages from k on.
  static const double* bound_at(const Solver& qp, std::size_t k, std::size_t m, Kind kind) noexcept {
    return (kind == kLow ? qp.lq.low[m] : qp.lq.high[m]) + k;
  }
  static double bound_of(const Solver& qp, std::size_t k, std::size_t m, Kind kind) noexcept {
    return sign(kind) * *bound_at(qp, k, m, kind);
  }
  static V bounds_of(const Solver& qp, std::size_t k, std::size_t m, Kind kind) noexcept {
    return sign(kind) * V::load(bound_at(qp, k, m, kind));
  }
  static bool has_width(const Solver& qp, std::size_t k, std::size_t m) noexcept {
    return qp.lq.high[m][k] > qp.lq.low[m][k];
  }
  static bool has_bound(const Solver& qp, std::size_t k, std::size_t m, Kind kind) noexcept {
    return has_width(qp, k, m) && std::isfinite(bound_of(qp, k, m, kind));
  }
  /// Calls visit(input, kind, side, stage, which of the eight from it on exist).
  template <class Self, class Visit>
  static void each(Self& self, const Visit& visit) noexcept {
    for (std::size_t m = 0; m < kNu; ++m) {
      for (std::size_t n = 0; n < kKinds; ++n) {
        auto& side = self.side_[m][n];
        for (std::size_t k = 0; k < self.horizon_; k += 8)
          visit(m, static_cast<Kind>(n), side, k, V::load(side.exists + k) > V(0.0));
      }
    }
  }

  Side side_[kNu][kKinds]{};
  std::size_t horizon_ = 0;  ///< stages
  int count_ = 0;            ///< bounds that exist
};

/// Directions of the slacks and multipliers of soft constraints, for a line search (docs/solver.md, eq.
/// 18–20).
template <OcpProblem P, std::size_t Capacity, class Arch>
class SoftSteps {
 public:
  static constexpr std::size_t kNc = P::kNc;
  using Slacks = Barrier<P, Capacity, Arch>;
  using V = typename Slacks::V;
  using Step = typename Slacks::Step;

  /// Directions of slacks and multipliers for a step of states and inputs; returns the longest step lengths.
  StepLengths find(const P& problem, const Slacks& slacks, const Step& step, double fraction) noexcept {
    V primal(0.0);
    V dual(0.0);
    slope_ = 0.0;
    V slope(0.0);
    const double mu = slacks.mu();
    for (std::size_t k = 0; k < step.horizon; k += 8) {
      const auto live = stages_before<V>(k, step.horizon);
      for (std::size_t c = 0; c < slacks.count(); ++c) {
        const SoftPenalty penalty = penalty_of(problem, c);
        const SoftConstraint<V> soft = slacks.load(c, k);
        const V change = slacks.change(step, c, k);
        const SoftConstraint<V> d = soft.step(penalty, mu, change);
        primal = max(select(live, max(-d.s / soft.s, -d.t / soft.t), V(0.0)), primal);
        dual = max(select(live, max(-d.z / soft.z, -d.n / soft.n), V(0.0)), dual);
        const V pulled = soft.model(penalty, mu).slope * change;  // part that the stage's gradient contains
        const V own = (penalty.linear + penalty.quadratic * soft.s - mu / soft.s) * d.s - mu / soft.t * d.t;
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
  /// Slope of the slacks' cost along the direction, less the part that the stages' gradients contain.
  [[nodiscard]] double slope() const noexcept { return slope_; }

  /// Adds miss, cost without barriers and logarithms of constraint c of the stages from k on, which has
  /// `value` there, at `length` of the direction.
  template <class Mask>
  void measure(const SoftPenalty& penalty, const Slacks& slacks, std::size_t c, std::size_t k, const V& value,
               double length, const Mask& live, V& miss, V& cost, V& logs) noexcept {
    const SoftConstraint<V> soft = slacks.load(c, k);
    V s = soft.s;
    V t = soft.t;
    if (length > 0.0) {
      s += length * V::load(s_[c] + k);
      t += length * V::load(t_[c] + k);
      t = select(s - value > t, s - value, t);  // a larger slack of distance costs nothing
    }
    s.store(s_at_[c] + k);
    t.store(t_at_[c] + k);
    miss += select(live, abs(s - value - t), V(0.0));
    cost += select(live, s * (penalty.linear + 0.5 * penalty.quadratic * s), V(0.0));
    logs += select(live, log(s) + log(t), V(0.0));
  }
  /// Moves to the point of the last measure(); multipliers by `dual_length` of their direction.
  void move(Slacks& slacks, std::size_t horizon, double dual_length) noexcept {
    constexpr double kFar = 1e10;  // largest factor between a multiplier and the central path's; usual
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
  using Lines = double[kNc > 0 ? kNc : 1][kStride];
  alignas(64) Lines s_{}, t_{}, s_at_{}, t_at_{};  ///< directions of the slacks, slacks of a trial
  alignas(64) Lines z_{}, n_{};                    ///< directions of the multipliers
  double slope_ = 0.0;                             ///< slope()
};

}  // namespace chicane::solver
