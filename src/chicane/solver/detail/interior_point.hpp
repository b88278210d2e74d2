// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/solver/detail/lq_solver.hpp"
#include "chicane/solver/detail/rate_set.hpp"

namespace chicane::solver {

/// The quadratic program with all bounds on inputs and their changes as barriers: for when corrections of a
/// working set go in circles, which they may with bounds on changes. A primal-dual interior point
/// (docs/solver_constraints.md, eq. 27–29): each sweep is one Newton step, their number hardly depends on the
/// problem, and bounds whose multiplier outgrows their distance are the working set.
template <class Solver>
class InteriorPoint {
 public:
  static constexpr int kMostSweeps = 25;

  /// Leaves a step within about 1e-10 of the optimum in `qp`, and the working set there. Returns the sweeps
  /// it took; it ends early when `must_stop()`. `slope(k, m)`: of the cost by input m, for the scale of
  /// multipliers.
  template <class Slope, class MustStop>
  int solve(Solver& qp, std::size_t horizon, const Slope& slope, const MustStop& must_stop) noexcept {
    save(qp, horizon);
    start(qp, horizon, slope);
    const double last = 1e-11 * mu_;
    int sweeps = 0;
    while (sweeps < kMostSweeps && !must_stop()) {
      ++sweeps;
      each(qp, horizon, [&](const Place& at, Side& side) { side.add(at, qp.lq, mu_); });
      qp.backward(horizon);
      qp.forward(horizon, Solver::Repair::kNone);
      const double length = step(qp, horizon);
      restore(qp, horizon);
      if (mu_ <= last && length > 0.9) break;
      const double left = 1.0 - length;
      mu_ = std::max(last, std::max(0.02, left * left) * mean_product(qp, horizon));
    }
    for (std::size_t k = 0; k < horizon; ++k) std::copy(qp.du[k], qp.du[k] + kNu, du_[k]);
    choose_working_set(qp, horizon);
    return sweeps;
  }
  /// Puts the step of the last solve back into `qp`.
  void put_step(Solver& qp, std::size_t horizon) const noexcept {
    for (std::size_t k = 0; k < horizon; ++k) std::copy(du_[k], du_[k] + kNu, qp.du[k]);
    qp.simulate(horizon);
  }

 private:
  static constexpr std::size_t kNu = Solver::kNu;
  static constexpr std::size_t kNx = Solver::kNx;
  using Lq = typename Solver::Lq;
  using Layout = typename Solver::Layout;
  using Set = RateSet<kNu>;
  enum Kind : std::size_t { kOwnLow, kOwnHigh, kRateLow, kRateHigh, kKinds };

  /// One bound: `bound` − `sign` · value >= 0, of an input or of its change.
  struct Place {
    std::size_t k, m;
    Kind kind;
    double sign;
    double bound;
    [[nodiscard]] bool is_rate() const noexcept { return kind == kRateLow || kind == kRateHigh; }
    [[nodiscard]] double distance(const Solver& qp) const noexcept {
      double value = qp.du[k][m];
      if (is_rate()) value -= qp.dx[k][Solver::rate_state(m)];
      return bound - sign * value;
    }
  };
  /// Its slack t, multiplier z and Newton step.
  struct Side {
    double t = 1.0;
    double z = 0.0;  ///< 0: no such bound
    double dt = 0.0;
    double dz = 0.0;

    /// Adds z⁺ = z + μ/t − D (bound − sign · value), D = z/t, to the stage.
    void add(const Place& at, Lq& lq, double mu) const noexcept {
      const double D = z / t;
      const double g = at.sign * (z + mu / t - D * at.bound);
      const std::size_t u = Layout::kHead + at.m;
      const auto add = [&](std::size_t i, std::size_t j, double amount) {
        lq.set_cost(at.k, i, j, lq.cost(at.k, i, j) + amount);
      };
      add(u, u, D);
      add(u, Layout::kOne, g);
      if (!at.is_rate()) return;
      const std::size_t p = Solver::rate_state(at.m);
      add(u, p, -D);
      add(p, p, D);
      add(Layout::kOne, p, -g);
    }
  };
  /// What add() changes.
  struct Saved {
    double H, g, mixed, previous, pull;
  };

  template <class Visit>
  void each(const Solver& qp, std::size_t horizon, const Visit& visit) noexcept {
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        for (std::size_t n = 0; n < kKinds; ++n) {
          const Kind kind = static_cast<Kind>(n);
          if (side_[k][m][kind].z > 0.0) visit(place(qp, k, m, kind), side_[k][m][kind]);
        }
      }
    }
  }
  static Place place(const Solver& qp, std::size_t k, std::size_t m, Kind kind) noexcept {
    const double bound[] = {-qp.lq.low[m][k], qp.lq.high[m][k], -qp.lq.rate_low[m][k], qp.lq.rate_high[m][k]};
    return {k, m, kind, kind == kOwnHigh || kind == kRateHigh ? 1.0 : -1.0, bound[kind]};
  }
  static bool has_width(const Solver& qp, std::size_t k, std::size_t m) noexcept {
    return qp.lq.high[m][k] > qp.lq.low[m][k];
  }

  /// Slacks at least a tenth of their interval wide; multipliers of ten times the size of the slopes. Inputs
  /// whose bounds are equal are held there.
  template <class Slope>
  void start(Solver& qp, std::size_t horizon, const Slope& slope) noexcept {
    double sum = 0.0;
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) sum += std::fabs(slope(k, m));
    }
    const double price = price_ = std::max(sum / static_cast<double>(horizon * kNu), 1e-6);
    double products = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        qp.hold[k][m] = has_width(qp, k, m) ? Hold::kFree : Hold::kLow;
        for (std::size_t n = 0; n < kKinds; ++n) {
          const Place at = place(qp, k, m, static_cast<Kind>(n));
          Side& side = side_[k][m][n] = {};
          if (!has_bound(qp, at)) continue;
          const Place other = place(qp, k, m, static_cast<Kind>(n ^ 1U));
          const double width = std::min(at.bound + other.bound, 1e3);
          side.t = std::max(std::min(at.bound, 1e3), std::max(0.1 * width, 1e-6));
          side.z = price;
          products += side.t * side.z;
          ++count;
        }
      }
    }
    mu_ = count > 0 ? 10.0 * products / count : 1.0;
    for (std::size_t k = 0; k < horizon; ++k) {  // on the central path
      for (auto& input : side_[k]) {
        for (Side& side : input) side.z = side.z > 0.0 ? mu_ / side.t : 0.0;
      }
    }
  }
  static bool has_bound(const Solver& qp, const Place& at) noexcept {
    if (at.is_rate() && !Solver::has_rate(at.m)) return false;
    return has_width(qp, at.k, at.m) && std::isfinite(at.bound);
  }

  /// Moves slacks and multipliers to the sweep's, never beyond 0.995 of the way to zero; returns the length.
  double step(const Solver& qp, std::size_t horizon) noexcept {
    constexpr double kFraction = 0.995;
    double primal = 0.0;
    double dual = 0.0;
    each(qp, horizon, [&](const Place& at, Side& side) {
      const double distance = at.distance(qp);
      side.dt = distance - side.t;
      side.dz = (mu_ - side.z * distance) / side.t;
      primal = std::max(primal, -side.dt / side.t);
      dual = std::max(dual, -side.dz / side.z);
    });
    const double length = std::min(1.0, kFraction / std::max(primal, 1e-30));
    const double dual_length = std::min(1.0, kFraction / std::max(dual, 1e-30));
    each(qp, horizon, [&](const Place&, Side& side) {
      side.t += length * side.dt;
      side.z += dual_length * side.dz;
    });
    return std::min(length, dual_length);
  }

  /// Mean of t z; what μ is aimed at when steps are short, to come back to the central path.
  double mean_product(const Solver& qp, std::size_t horizon) noexcept {
    double sum = 0.0;
    int count = 0;
    each(qp, horizon, [&](const Place&, const Side& side) {
      sum += side.t * side.z;
      ++count;
    });
    return count > 0 ? sum / count : 0.0;
  }

  void save(const Solver& qp, std::size_t horizon) noexcept {
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        const std::size_t u = Layout::kHead + m;
        Saved& kept = saved_[k][m];
        kept = {qp.lq.cost(k, u, u), qp.lq.cost(k, u, Layout::kOne), 0.0, 0.0, 0.0};
        if (!Solver::has_rate(m)) continue;
        const std::size_t p = Solver::rate_state(m);
        kept.mixed = qp.lq.cost(k, u, p);
        kept.previous = qp.lq.cost(k, p, p);
        kept.pull = qp.lq.cost(k, Layout::kOne, p);
      }
    }
  }
  void restore(Solver& qp, std::size_t horizon) const noexcept {
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        const std::size_t u = Layout::kHead + m;
        const Saved& kept = saved_[k][m];
        qp.lq.set_cost(k, u, u, kept.H);
        qp.lq.set_cost(k, u, Layout::kOne, kept.g);
        if (!Solver::has_rate(m)) continue;
        const std::size_t p = Solver::rate_state(m);
        qp.lq.set_cost(k, u, p, kept.mixed);
        qp.lq.set_cost(k, p, p, kept.previous);
        qp.lq.set_cost(k, Layout::kOne, p, kept.pull);
      }
    }
  }

  /// Bounds with more multiplier than distance.
  void choose_working_set(Solver& qp, std::size_t horizon) noexcept {
    const auto is_active = [&](std::size_t k, std::size_t m, Kind kind) {
      return side_[k][m][kind].z > price_ * side_[k][m][kind].t;
    };
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        if (!has_width(qp, k, m)) continue;
        const Hold own =
            is_active(k, m, kOwnHigh) ? Hold::kHigh : (is_active(k, m, kOwnLow) ? Hold::kLow : Hold::kFree);
        Hold tie = Hold::kFree;
        if (is_active(k, m, kRateHigh)) tie = Hold::kRateHigh;
        if (is_active(k, m, kRateLow)) tie = Hold::kRateLow;
        Set(qp.hold, m).set(k, own, tie);
      }
    }
  }
  double price_ = 1.0;  ///< multiplier that belongs to a distance of 1
  double mu_ = 1.0;
  Side side_[Lq::kStages][kNu][kKinds]{};
  Saved saved_[Lq::kStages][kNu]{};
  double du_[Lq::kStages][kNu]{};
};

}  // namespace chicane::solver
