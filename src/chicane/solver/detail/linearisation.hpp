// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>

#include "chicane/base/compiler.hpp"
#include "chicane/solver/detail/barrier.hpp"
#include "chicane/solver/detail/evaluation.hpp"
#include "chicane/solver/detail/hard_rows.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/detail/pattern.hpp"
#include "chicane/solver/detail/stage_entries.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::solver {

/// Linearisation at an iterate: values and derivatives of every stage, exact adjoint, optimality measures,
/// and the stages of the quadratic program (docs/solver.md, eq. 4–13, 22). Works from the horizon's end,
/// eight stages at a time: evaluates them in lanes, runs the adjoint through them, adds up costs.
template <OcpProblem P, std::size_t Capacity, class Arch>
class Linearisation {
 public:
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  static constexpr std::size_t kNc = P::kNc;
  static constexpr int kVariables = P::kNx + P::kNu;
  using V = Stages<Arch>;
  using Pattern = ProblemPattern<P>;
  using Layout = solver::Layout<Pattern>;
  using Lq = LqProblem<Pattern, Capacity>;
  using Point = Iterate<kNx, kNu, Capacity>;
  using Slacks = Barrier<P, Capacity, Arch>;

  alignas(64) double slope[kNu][kStageStride<Capacity>]{};    ///< dJ/du along the dynamics
  alignas(64) double adjoint[kNx][kStageStride<Capacity>]{};  ///< adjoint[i][k]: multiplier of x_{k+1}
  alignas(64) double lower[kNu][kStageStride<Capacity>]{};    ///< bounds of the inputs
  alignas(64) double upper[kNu][kStageStride<Capacity>]{};    ///< bounds of the inputs
  using Hard = std::conditional_t<kHasHardRows<P>, HardRows<P, Capacity, Arch>, Nothing>;
  Hard hard;                   ///< hard rows, for the primal-dual method
  double merit = 0.0;          ///< cost with the barrier's smoothed penalties, if slacks were centred
  double defect_excess = 0.0;  ///< largest defect less its tolerance; <= 0: all are small enough
  /// Residual of optimality in the states, [i][k] of x_k, k = 1 … horizon. Not null: multipliers of the
  /// dynamics are unknowns, so that linearisations leave `adjoint` unchanged and write the residual here.
  double (*state_residual)[kStageStride<Capacity>] = nullptr;

  /// Linearises at `t`. With Order 2 the stages get exact Hessians of the Lagrangian, else Gauss–Newton's.
  /// `centre`: puts slacks on the central path first. `defect_share`: tolerance of defects over 1 + |x|. Sets
  /// cost, defect, stationarity, complementarity and violation of the report.
  template <int Order>
  void linearise(const P& problem, const Point& t, bool centre, double defect_share, Slacks& slacks, Lq& lq,
                 SolveReport& report) noexcept {
    Sums sums;
    double lambda[kNx];
    sums.end_cost = linearise_end<Order>(problem, t, lq, lambda);
    for (std::size_t k = (t.horizon - 1) / 8 * 8 + 8; k > 0; k -= 8)
      linearise_stages<kHasOneLinearisation ? 2 : Order>(
          problem, t, k - 8, {centre, defect_share, Order == 2}, slacks, lambda, lq, sums);
    sums.finish(*this, report);
  }

 private:
  using Evaluate = Evaluation<P, Arch>;
  using Entries = StageEntries<P, V>;
  using Costs = typename Entries::Costs;
  using Jacobians = typename Entries::Jacobians;
  using Gradient = typename Entries::Gradient;

  /// Whether one linearisation of second order serves both kinds of Hessians: it compiles faster, and
  /// curvature costs little.
  static constexpr bool kHasOneLinearisation =
      StructuredProblem<P> && has_hessians<P>() && has_filter_method<P>();
  /// Options of a linearisation, as linearise() has them.
  struct How {
    bool centre;
    double defect_share;
    bool is_exact;  ///< exact Hessians
  };

  /// Sums over the horizon, eight stages side by side.
  struct Sums {
    double end_cost = 0.0;
    V cost{0.0}, smoothing{0.0};
    V defect{0.0}, defects{0.0}, defect_excess{-1.0};
    V stationarity{0.0}, slopes{0.0};
    V complementarity{0.0}, violation{0.0}, values{0.0};

    /// Sets the results of the linearisation and the report.
    void finish(Linearisation& now, SolveReport& report) const noexcept {
      report.cost = end_cost + sum(cost);
      now.merit = report.cost + sum(smoothing);
      now.defect_excess = largest(defect_excess);
      // A maximum may lose a not-a-number, a sum does not.
      report.defect = is_number(sum(defects)) ? largest(defect) : kNotANumber;
      report.stationarity = is_number(sum(slopes)) ? largest(stationarity) : kNotANumber;
      const bool has_values = is_number(sum(values));
      report.complementarity = has_values ? largest(complementarity) : kNotANumber;
      report.violation = has_values ? largest(violation) : kNotANumber;
    }
    static bool is_number(double x) noexcept { return !std::isnan(x); }
    static constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  };

  /// Sets the quadratic model of the terminal cost and the adjoint there; returns the cost.
  template <int Order>
  double linearise_end(const P& problem, const Point& t, Lq& lq, double (&lambda)[kNx]) noexcept {
    for (auto& row : lq.terminal) std::fill(std::begin(row), std::end(row), 0.0);
    const auto rows = Evaluate::template end<Order>(problem, t);
    double cost = 0.0;
    each_row<typename Evaluate::EndValue, Order>(rows, [&](auto n, const auto& r) CHICANE_INLINE {
      const double value = Evaluate::number(r.v);
      double weight = value;  // weight of the curvature
      if constexpr (kHasHardRows<P>) {
        if (n >= std::size_t{P::kOwnEnd})
          weight = keep_end_row(problem, n - std::size_t{P::kOwnEnd}, r, value);
      }
      cost += 0.5 * value * value;
      add_end_row<Order>(r, value, weight, lq);
    });
    for (std::size_t i = 0; i < kNx; ++i) {
      lambda[i] = lq.terminal[kNx][i];
      if constexpr (kHasHardRows<P>) lambda[i] -= problem.is_primal_dual ? hard.excess(problem, i) : 0.0;
    }
    return cost;
  }

  /// Stores a hard row of the end; returns the multiplier of its curvature.
  template <class R>
  double keep_end_row(const P& problem, std::size_t n, const R& r, double value) noexcept {
    hard.store_end(n, value);
    each_slope<typename Evaluate::EndValue>(r, [&](std::size_t i, const auto& by) {
      if (i < kNx) hard.store_end_slope(n, i, Evaluate::number(by));
    });
    return problem.is_primal_dual ? hard.end_weight(problem, n) : value;
  }
  /// Stores the hard rows of stages. In the primal-dual method they count in `gradient` by their multipliers.
  template <int Order, class Row>
  void keep_rows(const P& problem, const Row& residual, std::size_t k0, Gradient& gradient) noexcept {
    each_row<V, Order>(residual, [&](auto n, const auto& r) CHICANE_INLINE {
      if (n < own_residuals<P>()) return;
      hard.store(n - own_residuals<P>(), k0, r);
      if (problem.is_primal_dual)
        Entries::template add_gradient<void>(n, r, curvature_weight(problem, n, k0, r.v) - r.v, gradient);
    });
  }
  /// Weight of residual n's curvature: its value, or the multiplier of a hard row.
  V curvature_weight([[maybe_unused]] const P& problem, [[maybe_unused]] std::size_t n,
                     [[maybe_unused]] std::size_t k0, const V& value) const noexcept {
    if constexpr (kHasHardRows<P>) {
      if (n >= own_residuals<P>() && problem.is_primal_dual)
        return hard.stage_weight(problem, n - own_residuals<P>(), k0);
    }
    return value;
  }

  /// Adds one terminal residual: its gradient, Gauss–Newton's Hessian, and with Order 2 its curvature.
  template <int Order, class R>
  CHICANE_INLINE static void add_end_row(const R& r, double value, [[maybe_unused]] double weight,
                                         Lq& lq) noexcept {
    using EndValue = typename Evaluate::EndValue;
    each_slope<EndValue>(r, [&](std::size_t i, const auto& by) CHICANE_INLINE {
      if (i >= kNx) return;
      lq.terminal[kNx][i] += value * Evaluate::number(by);
      each_slope<EndValue>(r, [&](std::size_t j, const auto& other) CHICANE_INLINE {
        if (j < kNx) lq.terminal[i][j] += Evaluate::number(by) * Evaluate::number(other);
      });
    });
    const auto add = [&](std::size_t i, std::size_t j, double curvature) CHICANE_INLINE {
      if (i >= kNx || j >= kNx) return;
      lq.terminal[i][j] += weight * curvature;
      if (i != j) lq.terminal[j][i] += weight * curvature;
    };
    if constexpr (AnySparseRow<R>) {
      if constexpr (Order == 2) r.each_curvature(add);
    } else if constexpr (AnyJet<R>) {
      jet::repeat<R::kSecond.size()>([&](auto n) CHICANE_INLINE {
        constexpr Pair p = members<R::kSecond>()[n];
        add(p.i, p.j, Evaluate::number(r.curvatures[n]));
      });
    }
  }

  /// Linearises the eight stages from k0 on; stages beyond the horizon have no effect.
  template <int Order>
  void linearise_stages(const P& problem, const Point& t, std::size_t k0, const How& how, Slacks& slacks,
                        double (&lambda)[kNx], Lq& lq, Sums& sums) noexcept {
    const auto rows = [&]() CHICANE_INLINE {
      if constexpr (is_compact<Pattern>()) return evaluate<Order>(problem, t, k0);
      if constexpr (!is_compact<Pattern>()) return Evaluate::template stages<Order>(problem, t, k0);
    }();
    const auto live = stages_before<V>(k0, t.horizon);
    Jacobians f;
    Costs l;
    Gradient gradient;  // gradient of the stage cost with the current multipliers of the constraints

    collect_dynamics<Order>(rows.next, t, k0, live, how.defect_share, f, sums);
    add_residuals<Order>(rows.residual, live, gradient, l, sums);
    if constexpr (kHasHardRows<P> && Evaluate::kHardRows > 0)
      keep_rows<Order>(problem, rows.residual, k0, gradient);
    if constexpr (kNc > 0)
      add_soft<Order>(problem, rows.constraint, k0, live, how.centre, slacks, gradient, l, sums);
    if (!has_filter_method<P>() || state_residual == nullptr) [[likely]] {
      if constexpr (Layout::is_large()) run_large_adjoint(t.horizon, k0, f, gradient, lambda);
      if constexpr (!Layout::is_large()) run_adjoint(t.horizon, k0, f, gradient, lambda);
    } else {
      measure_states(k0, f, gradient);
    }
    measure(t, k0, live, f, gradient, lq, sums);
    if constexpr (Order == 2) {
      if (how.is_exact) add_curvature(problem, rows, k0, slacks, l);
    }
    if constexpr (is_compact<Pattern>()) {
      lq.set_by_tables(k0, f, l);
    } else {
      lq.set(k0, f, l);
    }
  }
  /// Evaluates the stages in a function that is not inlined, which compiles faster.
  template <int Order>
  [[gnu::noinline]] static auto evaluate(const P& problem, const Point& t, std::size_t k0) noexcept {
    return Evaluate::template stages<Order>(problem, t, k0);
  }

  /// Sets Jacobians and defects of the dynamics.
  template <int Order, class Row, class Mask>
  CHICANE_INLINE static void collect_dynamics(const Row& next, const Point& t, std::size_t k0,
                                              const Mask& live, double defect_share, Jacobians& f,
                                              Sums& sums) noexcept {
    each_row<V, Order>(next, [&](auto i, const auto& row) CHICANE_INLINE {
      const V defect = row.v - V::load_unaligned(t.x[i] + k0 + 1);
      Entries::set_jacobian(i, row, defect, f);
      const V size = select(live, abs(defect), V(0.0));
      sums.defect = max(sums.defect, size);
      sums.defects += size;
      sums.defect_excess = max(sums.defect_excess, size - defect_share * (1.0 + abs(row.v)));
    });
  }

  /// Adds ½‖r‖² with its gradient and Gauss–Newton Hessian.
  template <int Order, class Row, class Mask>
  CHICANE_INLINE static void add_residuals(const Row& residual, const Mask& live, Gradient& gradient,
                                           Costs& l, Sums& sums) noexcept {
    V squares(0.0);
    Entries::template clear<Row>(gradient, l);
    each_row<V, Order>(residual, [&](auto n, const auto& r) CHICANE_INLINE {
      squares += r.v * r.v;
      Entries::template add_gradient<Row>(n, r, r.v, gradient);
      Entries::template add_square<Row>(n, r, V(1.0), l);
    });
    Entries::set_gradient(gradient, l);
    sums.cost += select(live, 0.5 * squares, V(0.0));
  }

  /// Adds soft constraints: their multipliers to the gradient, their eliminated slacks to the quadratic
  /// program (eq. 20, 21).
  template <int Order, class Row,
            class Mask>  // NOLINTNEXTLINE(readability-function-size): all sums of a linearisation
  CHICANE_INLINE static void add_soft(const P& problem, const Row& constraint, std::size_t k0,
                                      const Mask& live, bool centre, Slacks& slacks, Gradient& gradient,
                                      Costs& l, Sums& sums) noexcept {
    const double mu = slacks.mu();
    each_row<V, Order>(constraint, [&](auto n, const auto& c) CHICANE_INLINE {
      const SoftPenalty penalty = penalty_of(problem, n);
      SoftConstraint<V> soft = slacks.load(n, k0);
      soft.value = c.v;
      if (centre) {
        soft.centre(penalty, mu);
        sums.smoothing += select(live, soft.barrier(penalty, mu) - soft.penalty(penalty), V(0.0));
      }
      slacks.store(n, k0, soft);
      slacks.store_row(n, k0, c);
      const auto model = soft.model(penalty, mu);
      Entries::template add_gradient<void>(n, c, soft.z, gradient);
      Entries::add_to_gradient(c, model.slope, l);
      Entries::template add_square<void>(n, c, model.curvature, l);
      sums.cost += select(live, soft.penalty(penalty), V(0.0));
      sums.complementarity = max(sums.complementarity, select(live, soft.residual(penalty, mu), V(0.0)));
      sums.violation = max(sums.violation, select(live, c.v, V(0.0)));
      sums.values += select(live, c.v, V(0.0));
    });
  }

  /// Runs λ_k = g_x + Aᵀ λ_{k+1} through the stages of the group, last first: the only sequential part.
  CHICANE_INLINE void run_adjoint(std::size_t horizon, std::size_t k0, const Jacobians& f,
                                  const Gradient& gradient, double (&lambda)[kNx]) noexcept {
    double now[kNx];  // kept in registers
    unroll<kNx>([&](auto i) CHICANE_INLINE { now[i] = lambda[i]; });
    for (std::size_t lane = std::min<std::size_t>(8, horizon - k0); lane-- > 0;) {
      double before[kNx];
      unroll<kNx>([&](auto j) CHICANE_INLINE {
        adjoint[j][k0 + lane] = now[j];
        double sum = gradient[j][lane];
        unroll<kNx>([&](auto i) CHICANE_INLINE {
          if constexpr (Pattern::kF[i][j] == Entry::kOne) sum += now[i];
          if constexpr (Pattern::kF[i][j] == Entry::kValue)
            sum = fused_multiply_add<Arch>(f[Layout::kF[i][j]][lane], now[i], sum);
        });
        before[j] = sum;
      });
      unroll<kNx>([&](auto i) CHICANE_INLINE { now[i] = before[i]; });
    }
    unroll<kNx>([&](auto i) CHICANE_INLINE { lambda[i] = now[i]; });
  }

  /// Runs the adjoint in loops, for large problems with dense Jacobians.
  void run_large_adjoint(std::size_t horizon, std::size_t k0, const Jacobians& f, const Gradient& gradient,
                         double (&lambda)[kNx]) noexcept {
    for (std::size_t lane = std::min<std::size_t>(8, horizon - k0); lane-- > 0;) {
      double before[kNx];
      for (std::size_t j = 0; j < kNx; ++j) {
        adjoint[j][k0 + lane] = lambda[j];
        before[j] = gradient[j][lane];
      }
      for (std::size_t i = 0; i < kNx; ++i) {
        for (std::size_t j = 0; j < kNx; ++j)
          before[j] = fused_multiply_add<Arch>(f[Layout::kF[i][j]][lane], lambda[i], before[j]);
      }
      std::copy(before, before + kNx, lambda);
    }
  }

  /// Sets state_residual of the group: g_x + Aᵀ λ_{k+1} − λ_k.
  void measure_states(std::size_t k0, const Jacobians& f, const Gradient& gradient) noexcept {
    const auto store = [&](std::size_t j, const V& sum) {
      sum.store(state_residual[j] + k0);
      for (std::size_t lane = k0 == 0 ? 1 : 0; lane < 8; ++lane)
        state_residual[j][k0 + lane] -= adjoint[j][k0 + lane - 1];
    };
    if constexpr (Layout::is_large()) {
      for (std::size_t j = 0; j < kNx; ++j) {
        V sum = gradient[j];
        for (std::size_t i = 0; i < kNx; ++i)
          sum = fused_multiply_add(f[Layout::kF[i][j]], V::load(adjoint[i] + k0), sum);
        store(j, sum);
      }
    } else {
      unroll<kNx>([&](auto j) CHICANE_INLINE {
        V sum = gradient[j];
        unroll<kNx>([&](auto i) CHICANE_INLINE {
          if constexpr (Pattern::kF[i][j] == Entry::kOne) sum += V::load(adjoint[i] + k0);
          if constexpr (Pattern::kF[i][j] == Entry::kValue)
            sum = fused_multiply_add(f[Layout::kF[i][j]], V::load(adjoint[i] + k0), sum);
        });
        store(j, sum);
      });
    }
  }

  /// Sets slopes of the inputs, stationarity (eq. 12) and bounds on the step.
  template <class Mask>
  CHICANE_INLINE void measure(const Point& t, std::size_t k0, const Mask& live, const Jacobians& f,
                              const Gradient& gradient, Lq& lq, Sums& sums) noexcept {
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      constexpr std::size_t column = Layout::kHead + m;
      V sum = gradient[kNx + m];
      unroll<kNx>([&](auto i) CHICANE_INLINE {
        if constexpr (Pattern::kF[i][column] == Entry::kOne) sum += V::load(adjoint[i] + k0);
        if constexpr (Pattern::kF[i][column] == Entry::kValue)
          sum = fused_multiply_add(f[Layout::kF[i][column]], V::load(adjoint[i] + k0), sum);
      });
      sum.store(slope[m] + k0);
      const V u = V::load(t.u[m] + k0);
      const V low = V::load(lower[m] + k0) - u;
      const V high = V::load(upper[m] + k0) - u;
      low.store(lq.low[m] + k0);
      high.store(lq.high[m] + k0);
      sums.slopes += select(live, sum, V(0.0));
      const V projected = select(live, abs(min(max(-sum, low), high)), V(0.0));
      sums.stationarity = max(sums.stationarity, projected);
    });
  }

  /// Adds the second-order terms that Gauss–Newton leaves out: Σ r ∇²r + λ ∇²f + z ∇²c (eq. 22).
  template <class StageRows>
  CHICANE_INLINE void add_curvature(const P& problem, const StageRows& rows, std::size_t k0,
                                    const Slacks& slacks, Costs& l) const noexcept {
    each_row<V, 2>(rows.next, [&](auto i, const auto& f)
                                  CHICANE_INLINE { Entries::add_curvature(f, V::load(adjoint[i] + k0), l); });
    each_row<V, 2>(rows.residual, [&](auto n, const auto& r) CHICANE_INLINE {
      Entries::add_curvature(r, curvature_weight(problem, n, k0, r.v), l);
    });
    if constexpr (kNc > 0) {
      each_row<V, 2>(rows.constraint, [&](auto n, const auto& c) CHICANE_INLINE {
        Entries::add_curvature(c, slacks.load(n, k0).z, l);
      });
    }
  }
};

}  // namespace chicane::solver
