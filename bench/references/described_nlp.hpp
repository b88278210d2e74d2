// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "problems/described_problem.hpp"
#include "problems/ipopt_solver.hpp"

namespace chicane::bench {

/// The described problem for Ipopt at its best: six states, derivatives by hand, only the entries that are
/// not zero. Variables stage by stage, s_0 u_0 s_1 u_1 ... s_N; s_0 is fixed by its bounds. Equations
/// s_{k+1} - f(s_k, u_k) = 0.
class DescribedNlp final : public SparseNlp<DescribedNlp> {
 public:
  static constexpr int kNs = 6;
  static constexpr int kNz = 8;
  static int at_s(int k) { return kNz * k; }
  static int at_u(int k) { return kNz * k + kNs; }

  template <int Capacity>
  void pose(const DescribedProblem& problem, const std::array<double, DescribedProblem::kNx>& x0,
            const DescribedTrajectory<Capacity>& t) {
    problem_ = &problem;
    horizon_ = t.horizon;
    start.assign(static_cast<std::size_t>(kNz * horizon_ + kNs), 0.0);
    for (int k = 0; k <= horizon_; ++k) {
      const auto stage = static_cast<std::size_t>(k);
      const auto& from = k == 0 ? x0 : t.x[stage];
      std::copy_n(from.begin(), kNs, start.begin() + at_s(k));
      if (k < horizon_) std::copy(t.u[stage].begin(), t.u[stage].end(), start.begin() + at_u(k));
    }
  }
  /// The solution's inputs.
  template <int Capacity>
  void give_solution(DescribedTrajectory<Capacity>& t) const {
    for (int k = 0; k < horizon_; ++k)
      std::copy_n(solution.begin() + at_u(k), 2, t.u[static_cast<std::size_t>(k)].begin());
  }
  /// One stage earlier; the last one stays.
  static void shift(Multipliers& multipliers) {
    const auto shift = [](std::vector<double>& values, std::ptrdiff_t width) {
      std::copy(values.begin() + width, values.end(), values.begin());
    };
    shift(multipliers.low, kNz);
    shift(multipliers.high, kNz);
    shift(multipliers.equation, kNs);
  }

  void sizes(Index& n, Index& m) const {
    n = kNz * horizon_ + kNs;
    m = kNs * horizon_;
  }
  bool get_bounds_info(Index n, Number* x_low, Number* x_high, Index m, Number* g_low,
                       Number* g_high) override {
    std::fill(x_low, x_low + n, -2e19);
    std::fill(x_high, x_high + n, 2e19);
    std::fill(g_low, g_low + m, 0.0);
    std::fill(g_high, g_high + m, 0.0);
    std::copy_n(start.begin(), kNs, x_low);
    std::copy_n(start.begin(), kNs, x_high);
    for (int k = 0; k < horizon_; ++k) {
      for (int i = 0; i < 2; ++i) {
        x_low[at_u(k) + i] = problem_->input_lower(k)[static_cast<std::size_t>(i)];
        x_high[at_u(k) + i] = problem_->input_upper(k)[static_cast<std::size_t>(i)];
      }
    }
    return true;
  }
  double cost_at(const Number* z) const {
    double sum = 0.0;
    for (int k = 0; k <= horizon_; ++k) {
      const double* s = z + at_s(k);
      const double dv = s[3] - problem_->speed_reference;
      sum += kCte * s[4] * s[4] + kEpsi * s[5] * s[5] + kSpeed * dv * dv;
      if (k == horizon_) break;
      const double* u = z + at_u(k);
      sum += kInput[0] * u[0] * u[0] + kInput[1] * u[1] * u[1];
      for (int i = 0; k > 0 && i < 2; ++i) {
        const double change = u[i] - u[i - kNz];
        sum += kChange[i] * change * change;
      }
    }
    return sum;
  }
  void add_gradient(const Number* z, Number* gradient) const {
    for (int k = 0; k <= horizon_; ++k) {
      const double* s = z + at_s(k);
      gradient[at_s(k) + 3] = 2.0 * kSpeed * (s[3] - problem_->speed_reference);
      gradient[at_s(k) + 4] = 2.0 * kCte * s[4];
      gradient[at_s(k) + 5] = 2.0 * kEpsi * s[5];
      if (k == horizon_) break;
      const double* u = z + at_u(k);
      for (int i = 0; i < 2; ++i) {
        gradient[at_u(k) + i] += 2.0 * kInput[i] * u[i];
        if (k == 0) continue;
        const double slope = 2.0 * kChange[i] * (u[i] - u[i - kNz]);
        gradient[at_u(k) + i] += slope;
        gradient[at_u(k - 1) + i] -= slope;
      }
    }
  }
  void set_equations(const Number* z, Number* g) const {
    const auto& c = problem_->path;
    for (int k = 0; k < horizon_; ++k) {
      const double* s = z + at_s(k);
      const double* u = z + at_u(k);
      const double* next = z + at_s(k + 1);
      double* row = g + kNs * k;
      const double turn = s[3] * u[0] * kTurn;
      row[0] = next[0] - (s[0] + s[3] * std::cos(s[2]) * kDt);
      row[1] = next[1] - (s[1] + s[3] * std::sin(s[2]) * kDt);
      row[2] = next[2] - (s[2] + turn);
      row[3] = next[3] - (s[3] + u[1] * kDt);
      row[4] =
          next[4] - (c[0] + s[0] * (c[1] + s[0] * (c[2] + s[0] * c[3])) - s[1] + s[3] * std::sin(s[5]) * kDt);
      row[5] = next[5] - (s[2] - std::atan(slope(s[0])) + turn);
    }
  }
  template <class Put>
  void visit_jacobian(const Number* z, const Put& put) const {
    for (int k = 0; k < horizon_; ++k) {
      std::array<double, kEntries> entry{};
      if (z != nullptr) entry = stage_jacobian(z + at_s(k), z + at_u(k));
      for (int e = 0; e < kEntries; ++e)
        put(kNs * k + kRow[e], kNz * k + kColumn[e], -entry[static_cast<std::size_t>(e)]);
      for (int i = 0; i < kNs; ++i) put(kNs * k + i, at_s(k + 1) + i, 1.0);
    }
  }
  /// Lower triangle of factor · ∇²cost + λᵀ∇²g, always the same entries in the same order; z may be null.
  template <class Put>
  void visit_hessian(const Number* z, double factor, const Number* lambda, const Put& put) const {
    for (int k = 0; k <= horizon_; ++k) {
      const int s0 = at_s(k);
      double xx = 0.0, pp = 0.0, pv = 0.0, ve = 0.0, vd = 0.0, ee = 2.0 * factor * kEpsi;
      if (z != nullptr && k < horizon_) {
        const double* s = z + s0;
        const double* m = lambda + kNs * k;
        const double c = std::cos(s[2]);
        const double n = std::sin(s[2]);
        const double g = slope(s[0]);
        const double h = bend(s[0]);
        const double w = 1.0 / (1.0 + g * g);
        xx = -m[4] * h + m[5] * (6.0 * problem_->path[3] - 2.0 * g * h * h * w) * w;
        pp = s[3] * kDt * (m[0] * c + m[1] * n);
        pv = kDt * (m[0] * n - m[1] * c);
        ve = -m[4] * std::cos(s[5]) * kDt;
        ee += m[4] * s[3] * std::sin(s[5]) * kDt;
        vd = -(m[2] + m[5]) * kTurn;
      }
      put(s0 + 3, s0 + 3, 2.0 * factor * kSpeed);
      put(s0 + 4, s0 + 4, 2.0 * factor * kCte);
      put(s0 + 5, s0 + 5, ee);
      if (k == horizon_) break;
      put(s0, s0, xx);
      put(s0 + 2, s0 + 2, pp);
      put(s0 + 3, s0 + 2, pv);
      put(s0 + 5, s0 + 3, ve);
      put(at_u(k), s0 + 3, vd);
      const double changes = (k > 0 ? 1.0 : 0.0) + (k < horizon_ - 1 ? 1.0 : 0.0);
      for (int i = 0; i < 2; ++i) {
        put(at_u(k) + i, at_u(k) + i, 2.0 * factor * (kInput[i] + changes * kChange[i]));
        if (k > 0) put(at_u(k) + i, at_u(k - 1) + i, -2.0 * factor * kChange[i]);
      }
    }
  }

 private:
  static constexpr double kDt = DescribedProblem::kStep;
  static constexpr double kTurn = kDt / DescribedProblem::kLength;
  static constexpr double kCte = 200.0, kEpsi = 200.0, kSpeed = 0.1;
  static constexpr double kInput[] = {1.0, 1.0};
  static constexpr double kChange[] = {10.0, 1.0};
  static constexpr int kEntries = 19;  ///< of a stage's Jacobian [∂f/∂s ∂f/∂u] that are not always zero
  static constexpr int kRow[kEntries] = {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5};
  static constexpr int kColumn[kEntries] = {0, 2, 3, 1, 2, 3, 2, 3, 6, 3, 7, 0, 1, 3, 5, 0, 2, 3, 6};

  [[nodiscard]] double slope(double x) const {
    const auto& c = problem_->path;
    return c[1] + x * (2.0 * c[2] + x * 3.0 * c[3]);
  }
  [[nodiscard]] double bend(double x) const { return 2.0 * problem_->path[2] + 6.0 * problem_->path[3] * x; }

  [[nodiscard]] std::array<double, kEntries> stage_jacobian(const double* s, const double* u) const {
    const double c = std::cos(s[2]);
    const double n = std::sin(s[2]);
    const double g = slope(s[0]);
    return {1.0,
            -s[3] * n * kDt,
            c * kDt,
            1.0,
            s[3] * c * kDt,
            n * kDt,
            1.0,
            u[0] * kTurn,
            s[3] * kTurn,
            1.0,
            kDt,
            g,
            -1.0,
            std::sin(s[5]) * kDt,
            s[3] * std::cos(s[5]) * kDt,
            -bend(s[0]) / (1.0 + g * g),
            1.0,
            u[0] * kTurn,
            s[3] * kTurn};
  }

  const DescribedProblem* problem_ = nullptr;
  int horizon_ = 0;
};

}  // namespace chicane::bench
