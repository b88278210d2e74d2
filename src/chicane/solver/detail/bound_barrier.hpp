// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/math.hpp"
#include "chicane/solver/detail/lq_solver.hpp"
#include "chicane/solver/detail/rate_set.hpp"

namespace chicane::solver {

/// How far a step may go so that slacks, and multipliers, stay positive.
struct StepLengths {
  double primal = 1.0;
  double dual = 1.0;
};

/// The bounds on inputs and on their changes as barriers (docs/solver.md, eq. 30–33): each has a slack t > 0
/// and a multiplier z > 0. Kept from iterate to iterate of the nonlinear problem, unlike those of
/// InteriorPoint.
template <class Solver, std::size_t Capacity>
class BoundBarrier {
 public:
  static constexpr std::size_t kNu = Solver::kNu;
  using Lq = typename Solver::Lq;
  using Layout = typename Solver::Layout;

  /// Slacks of the bounds as they are in `qp` at the present iterate, at least `push` of their width;
  /// multipliers on the central path of `mu`. Inputs whose bounds are equal are held there.
  void start(Solver& qp, std::size_t horizon, double mu) noexcept {
    horizon_ = horizon;
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        qp.hold[k][m] = has_width(qp, k, m) ? Hold::kFree : Hold::kLow;
        for (std::size_t n = 0; n < kKinds; ++n) {
          const auto kind = static_cast<Kind>(n);
          Side& side = side_[k][m][n] = {};
          if (!has_bound(qp, k, m, kind)) continue;
          const double bound = bound_of(qp, k, m, kind);
          const double width = bound + bound_of(qp, k, m, static_cast<Kind>(n ^ 1U));
          side.t = std::max(bound, kPush * std::min(width, kWide));
          side.z = mu / side.t;
          side.exists = true;
        }
      }
    }
  }
  /// Where an input between `low` and `high` may start.
  static double inside(double u, double low, double high) noexcept {
    if (!(high > low)) return u;
    const double push = kPush * std::min(high - low, kWide);
    return std::min(std::max(u, low + push), high - push);
  }

  /// Largest of the multipliers' conditions at the present iterate for barrier `mu`: products, and the
  /// equations of slacks. Adds what the multipliers pull to `slope` of the inputs, and to `adjoint` of the
  /// states that hold previous ones.
  struct Residual {
    double product = 0.0;
    double multipliers = 0.0;  ///< sum of all
    int count = 0;
  };
  [[nodiscard]] Residual residual(double mu) const noexcept {
    Residual r;
    each([&](std::size_t, std::size_t, Kind, const Side& side) {
      r.product = std::max(r.product, std::fabs(side.t * side.z - mu));
      r.multipliers += side.z;
      ++r.count;
    });
    return r;
  }
  /// What the multipliers of the bounds of input m of stage k pull at it, and at the state that its change
  /// starts from.
  [[nodiscard]] double pull(std::size_t k, std::size_t m) const noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n < kKinds; ++n)
      sum += side_[k][m][n].exists ? sign(static_cast<Kind>(n)) * side_[k][m][n].z : 0.0;
    return sum;
  }
  [[nodiscard]] double rate_pull(std::size_t k, std::size_t m) const noexcept {
    double sum = 0.0;
    for (std::size_t n = kRateLow; n < kKinds; ++n)
      sum -= side_[k][m][n].exists ? sign(static_cast<Kind>(n)) * side_[k][m][n].z : 0.0;
    return sum;
  }
  /// Sum of |bound − value − t|.
  [[nodiscard]] double miss(const Solver& qp) const noexcept {
    double sum = 0.0;
    each([&](std::size_t k, std::size_t m, Kind kind, const Side& side) {
      sum += std::fabs(bound_of(qp, k, m, kind) - side.t);
    });
    return sum;
  }

  /// Adds z + μ/t − D·bound and D = z/t to the stages (eq. 31).
  void add_to(Solver& qp, double mu) const noexcept {
    each([&](std::size_t k, std::size_t m, Kind kind, const Side& side) {
      const double D = side.z / side.t;
      const double g = sign(kind) * (side.z + mu / side.t - D * bound_of(qp, k, m, kind));
      const std::size_t u = Layout::kHead + m;
      const auto add = [&](std::size_t i, std::size_t j, double amount) {
        qp.lq.set_cost(k, i, j, qp.lq.cost(k, i, j) + amount);
      };
      add(u, u, D);
      add(u, Layout::kOne, g);
      if (!is_rate(kind)) return;
      const std::size_t p = Solver::rate_state(m);
      add(u, p, -D);
      add(p, p, D);
      add(Layout::kOne, p, -g);
    });
  }

  /// The directions that belong to the step in `qp`; how far they may be followed.
  StepLengths find(const Solver& qp, double mu, double fraction) noexcept {
    double primal = 0.0;
    double dual = 0.0;
    each([&](std::size_t k, std::size_t m, Kind kind, Side& side) {
      double value = qp.du[k][m];
      if (is_rate(kind)) value -= qp.dx[k][Solver::rate_state(m)];
      const double distance = bound_of(qp, k, m, kind) - sign(kind) * value;
      side.dt = distance - side.t;
      side.dz = (mu - side.z * distance) / side.t;
      side.miss = bound_of(qp, k, m, kind) - side.t;
      primal = std::max(primal, -side.dt / side.t);
      dual = std::max(dual, -side.dz / side.z);
    });
    return {std::min(1.0, fraction / std::max(primal, 1e-30)),
            std::min(1.0, fraction / std::max(dual, 1e-30))};
  }
  /// Slope of the barriers along the direction.
  [[nodiscard]] double slope(double mu) const noexcept {
    double sum = 0.0;
    each([&](std::size_t, std::size_t, Kind, const Side& side) { sum -= mu * side.dt / side.t; });
    return sum;
  }
  /// Miss and barriers at `length` of the direction: bounds are linear.
  void measure(double length, double mu, double& miss, double& cost) noexcept {
    each([&](std::size_t, std::size_t, Kind, Side& side) {
      side.at = length > 0.0 ? side.t + length * side.dt : side.t;
      miss += (1.0 - length) * std::fabs(side.miss);
      cost -= mu * log(side.at);
    });
  }
  /// The same where input m of stage k moves by `moved(k, m)`.
  template <class Moved>
  void measure_at(const Solver& qp, double mu, const Moved& moved, double& miss, double& cost) noexcept {
    each([&](std::size_t k, std::size_t m, Kind kind, Side& side) {
      double value = moved(k, m);
      if (is_rate(kind)) value -= moved(k - 1, m);
      const double distance = bound_of(qp, k, m, kind) - sign(kind) * value;
      side.at = std::max(distance, 1e-3 * side.t);
      miss += std::fabs(distance - side.at);
      cost -= mu * log(side.at);
    });
  }
  /// To where the last measure() was; multipliers by `dual_length` of their direction.
  void move(double dual_length, double mu) noexcept {
    constexpr double kFar = 1e10;
    each([&](std::size_t, std::size_t, Kind, Side& side) {
      side.t = side.at;
      side.z += dual_length * side.dz;
      side.z = std::min(std::max(side.z, mu / (kFar * side.t)), kFar * mu / side.t);
    });
  }
  /// `u` cut to a share of the way to its own bounds, from where it moved 0.
  [[nodiscard]] double cut(const Solver& qp, std::size_t k, std::size_t m, double moved,
                           double share) const noexcept {
    return std::min(std::max(moved, share * qp.lq.low[m][k]), share * qp.lq.high[m][k]);
  }

  /// Bounds at a thousandth of their width or less become the working set of `qp`.
  void choose_working_set(Solver& qp) const noexcept {
    constexpr double kActive = 1e-3;
    for (std::size_t k = 0; k < horizon_; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        if (!has_width(qp, k, m)) continue;
        const auto is_active = [&](Kind kind) {
          const Side& side = side_[k][m][kind];
          const Side& other = side_[k][m][kind ^ 1U];
          return side.exists && side.t < kActive * (other.exists ? side.t + other.t : 1.0);
        };
        const Hold own = is_active(kOwnHigh) ? Hold::kHigh : (is_active(kOwnLow) ? Hold::kLow : Hold::kFree);
        Hold tie = Hold::kFree;
        if (is_active(kRateHigh)) tie = Hold::kRateHigh;
        if (is_active(kRateLow)) tie = Hold::kRateLow;
        RateSet<kNu>(qp.hold, m).set(k, own, tie);
      }
    }
  }

 private:
  static constexpr double kPush = 1e-2;  ///< of the width
  static constexpr double kWide = 1e2;
  enum Kind : std::size_t { kOwnLow, kOwnHigh, kRateLow, kRateHigh, kKinds };
  struct Side {
    double t = 1.0, z = 1.0;
    double dt = 0.0, dz = 0.0;
    double at = 1.0;  ///< slack of a trial
    double miss = 0.0;
    bool exists = false;
  };
  static constexpr bool is_rate(Kind kind) noexcept { return kind == kRateLow || kind == kRateHigh; }
  static constexpr double sign(Kind kind) noexcept {
    return kind == kOwnHigh || kind == kRateHigh ? 1.0 : -1.0;
  }
  static double bound_of(const Solver& qp, std::size_t k, std::size_t m, Kind kind) noexcept {
    switch (kind) {
      case kOwnLow:
        return -qp.lq.low[m][k];
      case kOwnHigh:
        return qp.lq.high[m][k];
      case kRateLow:
        return -qp.lq.rate_low[m][k];
      default:
        return qp.lq.rate_high[m][k];
    }
  }
  static bool has_width(const Solver& qp, std::size_t k, std::size_t m) noexcept {
    return qp.lq.high[m][k] > qp.lq.low[m][k];
  }
  static bool has_bound(const Solver& qp, std::size_t k, std::size_t m, Kind kind) noexcept {
    if (is_rate(kind) && !Solver::has_rate(m)) return false;
    return has_width(qp, k, m) && std::isfinite(bound_of(qp, k, m, kind));
  }
  template <class Self, class Visit>
  static void visit_all(Self& self, const Visit& visit) noexcept {
    for (std::size_t k = 0; k < self.horizon_; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        for (std::size_t n = 0; n < (Solver::kHasRates ? kKinds : kRateLow); ++n) {
          if (self.side_[k][m][n].exists) visit(k, m, static_cast<Kind>(n), self.side_[k][m][n]);
        }
      }
    }
  }
  template <class Visit>
  void each(const Visit& visit) const noexcept {
    visit_all(*this, visit);
  }
  template <class Visit>
  void each(const Visit& visit) noexcept {
    visit_all(*this, visit);
  }

  Side side_[Lq::kStages][kNu][kKinds]{};
  std::size_t horizon_ = 0;
};

}  // namespace chicane::solver
