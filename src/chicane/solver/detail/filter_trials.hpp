// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include "chicane/solver/detail/filter_method.hpp"

namespace chicane::solver {

// Points of the filter method: error of an iterate, merit of a trial point, and points by simulation.

template <OcpProblem P, std::size_t Capacity, class Arch>
double FilterMethod<P, Capacity, Arch>::residual(const Linearised& now, const Lq& lq, const Point& t,
                                                 const SolveReport& report) noexcept {
  if (!has_multipliers_) return std::numeric_limits<double>::infinity();
  double dual = 0.0;
  double dynamics_multipliers = 0.0;
  for (std::size_t i = 0; i < kNx; ++i) {
    for (std::size_t k = 1; k < t.horizon; ++k) {
      dual = std::max(dual, std::fabs(residual_[i][k]));
      dynamics_multipliers += std::fabs(now.adjoint[i][k]);
    }
    double end = lq.lq.terminal[kNx][i] - now.adjoint[i][t.horizon - 1];
    if constexpr (kHasHardRows<P>) end -= rows_ != nullptr ? now.hard.excess(*rows_, i) : 0.0;
    dual = std::max(dual, std::fabs(end));
  }
  for (std::size_t m = 0; m < kNu; ++m) {
    for (std::size_t k = 0; k < t.horizon; ++k) {
      if (lq.hold[k][m] == Hold::kFree)
        dual = std::max(dual, std::fabs(now.slope[m][k] + bounds_.pull(k, m)));
    }
  }
  const auto sides = bounds_.residual(mu_);
  const double count = static_cast<double>(t.horizon * kNx) + sides.count;
  const double scale = std::max(kSteep, (dynamics_multipliers + sides.multipliers) / count / unit_) / kSteep;
  double missed = report.defect * unit_;
  if constexpr (kHasHardRows<P>) {
    if (rows_ != nullptr) missed_ = now.hard.residual(*rows_, mu_, unit_, t.horizon);
    if (rows_ != nullptr) missed = std::max(missed, missed_);
  }
  return std::max(std::max({dual, sides.product, report.complementarity}) / scale, missed);
}

template <OcpProblem P, std::size_t Capacity, class Arch>
Merit FilterMethod<P, Capacity, Arch>::measure(const P& problem, [[maybe_unused]] Linearised& now,
                                               const Slacks& slacks, const Point& point, double length,
                                               const Lq* lq, const Point* from) noexcept {
  V cost(0.0);
  V miss(0.0);
  V logs(0.0);
  for (std::size_t k = 0; k < point.horizon; k += 8) {
    const auto live = stages_before<V>(k, point.horizon);
    const auto values = Evaluate::values(problem, point, k);
    cost += select(live, values.cost, V(0.0));
    for (std::size_t c = 0; c < slacks.count(); ++c)
      soft_.measure(penalty_of(problem, c), slacks, c, k, values.constraint[c], length, live, miss, cost,
                    logs);
    for (std::size_t i = 0; i < kNx; ++i)
      miss += select(live, abs(values.next[i] - V::load_unaligned(point.x[i] + k + 1)), V(0.0));
    if constexpr (Evaluate::kHardRows > 0) {
      for (std::size_t n = 0; n < Evaluate::kHardRows; ++n) {
        if (rows_ != nullptr) {
          now.hard.measure(problem, n, k, values.hard[n], length, live, miss, cost, logs);
        } else {
          cost += select(live, 0.5 * values.hard[n] * values.hard[n], V(0.0));
        }
      }
    }
  }
  Merit merit{sum(miss), sum(cost), sum(logs)};
  double ends[P::kNe + 1];
  merit.cost += Evaluate::end_cost(problem, point, rows_ != nullptr ? ends : nullptr);
  if constexpr (kHasHardRows<P>) {
    if (rows_ != nullptr) now.hard.measure_end(unshifted(problem, ends), length, merit);
  }
  if (from == nullptr) {
    bounds_.measure(length, merit);
  } else {
    bounds_.measure_at(*lq, point, *from, merit);
  }
  merit.cost -= mu_ * merit.logs;
  return merit;
}

template <OcpProblem P, std::size_t Capacity, class Arch>
void FilterMethod<P, Capacity, Arch>::centre_rows(const P& problem, Linearised& now,
                                                  const Point& t) noexcept {
  if constexpr (Evaluate::kHardRows > 0) {
    for (std::size_t k = 0; now.hard.is_elastic() && k < t.horizon; k += 8) {
      const auto values = Evaluate::values(problem, t, k);
      for (std::size_t n = 0; n < Evaluate::kHardRows; ++n)
        now.hard.centre(n, k, Linearised::Hard::row_value(problem, n, k, values.hard[n]), mu_);
    }
  }
  now.hard.centre_end(end_rows(problem, t), mu_);
  now.hard.set_rows(*rows_, mu_, t.horizon);
}

template <OcpProblem P, std::size_t Capacity, class Arch>
bool FilterMethod<P, Capacity, Arch>::simulate(const P& problem, const Lq& lq, const Point& t,
                                               double feedback, double length, double kept) noexcept {
  using One = typename Evaluate::One;
  constexpr double kShare = 0.99;  // largest share of the way to a bound; chosen
  candidate_.horizon = t.horizon;
  for (std::size_t i = 0; i < kNx; ++i) candidate_.x[i][0] = t.x[i][0];
  for (std::size_t k = 0; k < t.horizon; ++k) {
    for (std::size_t m = 0; m < kNu; ++m) {
      double du = length * lq.constant(k, m);
      for (std::size_t i = 0; feedback > 0.0 && i < kNx; ++i)
        du += feedback * lq.gain(k, m, i) * (candidate_.x[i][k] - t.x[i][k]);
      du = std::min(std::max(du, kShare * lq.lq.low[m][k]), kShare * lq.lq.high[m][k]);
      candidate_.u[m][k] = t.u[m][k] + du;
    }
    const auto next =
        Evaluate::next(problem, k, candidate_.template state<One>(k), candidate_.template input<One>(k));
    double sum = 0.0;
    for (std::size_t i = 0; i < kNx; ++i) {
      candidate_.x[i][k + 1] = Evaluate::number(next[i]) - kept * lq.lq.stage[k].defect(i);
      sum += 0.0 * candidate_.x[i][k + 1];
    }
    if (!(sum == 0.0)) return false;
  }
  return true;
}

}  // namespace chicane::solver
