// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/base/dual.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/riccati.hpp"
#include "chicane/solver/soft_constraint.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::solver {

/// Everything the solver knows about one trajectory: values, first derivatives by dual numbers, exact
/// adjoint, and on request the second derivatives that Gauss–Newton leaves out. Fills the stages of the
/// linear-quadratic problem (docs/solver.md, eq. 4–7).
template <OcpProblem P, std::size_t Capacity>
class Linearisation {
 public:
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  static constexpr std::size_t kNc = P::kNc;
  static constexpr std::size_t kNz = kNx + kNu;
  static constexpr std::size_t kOne = kNx;
  static constexpr std::size_t kHead = kNx + 1;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, static_cast<int>(Capacity)>;
  using Lq = Riccati<kNx, kNu, Capacity>;
  using Soft = std::array<SoftConstraint, kNc>;

  std::array<Soft, Capacity> soft{};  ///< values and slacks of the soft constraints
  double relative_defect = 0.0;       ///< largest defect as a share of 1 + |x|
  double slope[Capacity][kNu]{};      ///< dJ/du along the dynamics, from the exact adjoint

  /// Position of variable `i` of (x, u) in z = (x, 1, u).
  static constexpr std::size_t in_z(std::size_t i) noexcept { return i < kNx ? i : i + 1; }

  /// Values and first derivatives of every stage. Sets cost, defect and violation of the report.
  void evaluate(const P& problem, const Trajectory& t, Lq& lq, SolveReport& report) noexcept {
    report.cost = report.defect = report.violation = relative_defect = 0.0;
    report.worst_stage = report.worst_constraint = -1;
    const auto horizon = static_cast<std::size_t>(t.horizon);
    for (std::size_t k = 0; k < horizon; ++k) evaluate_stage(problem, t, k, lq.stage[k], report);
    std::array<Dual<P::kNx>, kNx> x;
    for (std::size_t i = 0; i < kNx; ++i) x[i] = Dual<P::kNx>::variable(t.x[horizon][i], static_cast<int>(i));
    add_squares(problem.terminal_residual(x), lq.terminal, terminal_gradient_, report.cost);
  }

  /// Exact adjoint λ and slopes dJ/du; the slope projected on the bounds is the optimality measure (eq. 12).
  void measure(const Trajectory& t, const Lq& lq, SolveReport& report) noexcept {
    report.stationarity = 0.0;
    std::array<double, kNx> lambda;
    std::copy(terminal_gradient_, terminal_gradient_ + kNx, lambda.begin());
    for (auto k = static_cast<std::size_t>(t.horizon); k-- > 0;) {
      const auto& stage = lq.stage[k];
      adjoint_[k] = lambda;
      double g[kNz];
      std::copy(gradient_[k], gradient_[k] + kNz, g);
      for (std::size_t c = 0; c < kNc; ++c) {
        for (std::size_t i = 0; i < kNz; ++i) g[i] += soft[k][c].z * soft_row_[k][c][i];
      }
      for (std::size_t i = 0; i < kNx; ++i) {
        for (std::size_t j = 0; j < kNz; ++j) g[j] += stage.F[i][in_z(j)] * lambda[i];
      }
      std::copy(g, g + kNx, lambda.begin());
      for (std::size_t m = 0; m < kNu; ++m) {
        slope[k][m] = g[kNx + m];
        const double projected = std::min(std::max(-slope[k][m], stage.low[m]), stage.high[m]);
        report.stationarity =
            worse(report.stationarity, std::isnan(slope[k][m]) ? slope[k][m] : std::fabs(projected));
      }
    }
  }

  /// Adds the eliminated slacks at barrier μ to the stages (eq. 20–21).
  void add_soft(const P& problem, std::size_t horizon, double mu, Lq& lq) const noexcept {
    if constexpr (kNc > 0) {
      for (std::size_t k = 0; k < horizon; ++k) {
        for (std::size_t c = 0; c < kNc; ++c) {
          const auto model = soft[k][c].model(problem.soft_penalty(static_cast<int>(c)), mu);
          add_row(lq.stage[k].L, soft_row_[k][c], model.slope, model.curvature);
        }
      }
    }
  }

  /// First-order change of soft constraint c of stage k under the step in `lq`.
  [[nodiscard]] double soft_change(std::size_t k, std::size_t c, const Lq& lq) const noexcept {
    double change = 0.0;
    for (std::size_t i = 0; i < kNx; ++i) change += soft_row_[k][c][i] * lq.dx[k][i];
    for (std::size_t m = 0; m < kNu; ++m) change += soft_row_[k][c][kNx + m] * lq.du[k][m];
    return change;
  }

  /// Second derivatives that Gauss–Newton leaves out: Σ r ∇²r + λ ∇²f + z ∇²c by nested duals (eq. 22). Costs
  /// about (Nx + Nu) first-order passes. Pre: measure().
  void evaluate_curvature(const P& problem, const Trajectory& t) noexcept {
    const auto horizon = static_cast<std::size_t>(t.horizon);
    for (std::size_t k = 0; k < horizon; ++k) {
      const int number = static_cast<int>(k);
      std::array<Twice<kNz>, kNx> x;
      std::array<Twice<kNz>, kNu> u;
      for (std::size_t i = 0; i < kNx; ++i) x[i] = twice<kNz>(t.x[k][i], i);
      for (std::size_t m = 0; m < kNu; ++m) u[m] = twice<kNz>(t.u[k][m], kNx + m);
      auto& H = curvature_[k];
      H = {};
      const auto next = problem.dynamics(number, x, u);
      for (std::size_t i = 0; i < kNx; ++i) add_hessian(next[i], adjoint_[k][i], H);
      for (const auto& r : problem.residual(number, x, u)) add_hessian(r, r.v.v, H);
      if constexpr (kNc > 0) {
        const auto constraint = problem.constraint(number, x, u);
        for (std::size_t c = 0; c < kNc; ++c) add_hessian(constraint[c], soft[k][c].z, H);
      }
    }
    std::array<Twice<kNx>, kNx> x;
    for (std::size_t i = 0; i < kNx; ++i) x[i] = twice<kNx>(t.x[horizon][i], i);
    terminal_curvature_ = {};
    for (const auto& r : problem.terminal_residual(x)) add_hessian(r, r.v.v, terminal_curvature_);
  }

  /// Adds `weight` times the second derivatives kept by evaluate_curvature() to the stages.
  void add_curvature(std::size_t horizon, double weight, Lq& lq) const noexcept {
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t i = 0; i < kNz; ++i) {
        for (std::size_t j = 0; j < kNz; ++j) lq.stage[k].L[in_z(i)][in_z(j)] += weight * curvature_[k][i][j];
      }
    }
    for (std::size_t i = 0; i < kNx; ++i) {
      for (std::size_t j = 0; j < kNx; ++j) lq.terminal[i][j] += weight * terminal_curvature_[i][j];
    }
  }

 private:
  using Number = Dual<static_cast<int>(kNz)>;

  template <std::size_t N>
  using Square = std::array<std::array<double, N>, N>;
  template <std::size_t N>
  using Twice = Dual<static_cast<int>(N), Dual<static_cast<int>(N)>>;

  template <std::size_t N>
  static Twice<N> twice(double value, std::size_t index) noexcept {
    const int i = static_cast<int>(index);
    return Twice<N>::variable(Dual<static_cast<int>(N)>::variable(value, i), i);
  }
  template <std::size_t N>
  static void add_hessian(const Twice<N>& value, double weight, Square<N>& H) noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) H[i][j] += weight * value.d[i].d[j];
    }
  }

  void evaluate_stage(const P& problem, const Trajectory& t, std::size_t k, typename Lq::Stage& stage,
                      SolveReport& report) noexcept {
    const int number = static_cast<int>(k);
    std::array<Number, kNx> x;
    std::array<Number, kNu> u;
    for (std::size_t i = 0; i < kNx; ++i) x[i] = Number::variable(t.x[k][i], static_cast<int>(i));
    for (std::size_t m = 0; m < kNu; ++m) u[m] = Number::variable(t.u[k][m], static_cast<int>(kNx + m));
    const std::array<Number, kNx> next = problem.dynamics(number, x, u);
    for (std::size_t i = 0; i < kNx; ++i) {
      for (std::size_t j = 0; j < kNz; ++j) stage.F[i][in_z(j)] = next[i].d[j];
      stage.F[i][kOne] = next[i].v - t.x[k + 1][i];
      const double defect = std::fabs(stage.F[i][kOne]);
      report.defect = worse(report.defect, defect);
      relative_defect = worse(relative_defect, defect / (1.0 + std::fabs(next[i].v)));
    }
    add_squares(problem.residual(number, x, u), stage.L, gradient_[k], report.cost);
    if constexpr (kNc > 0) {
      const std::array<Number, kNc> constraint = problem.constraint(number, x, u);
      for (std::size_t c = 0; c < kNc; ++c) {
        soft[k][c].value = constraint[c].v;
        soft_row_[k][c] = constraint[c].d;
        report.cost += soft[k][c].penalty(problem.soft_penalty(static_cast<int>(c)));
        if (constraint[c].v <= report.violation) continue;
        report.violation = constraint[c].v;
        report.worst_stage = number;
        report.worst_constraint = static_cast<int>(c);
      }
    }
    const auto low = problem.input_lower(number);
    const auto high = problem.input_upper(number);
    for (std::size_t m = 0; m < kNu; ++m) {
      stage.low[m] = low[m] - t.u[k][m];
      stage.high[m] = high[m] - t.u[k][m];
    }
  }

  /// ½‖r‖² with gradient and Gauss–Newton Hessian in z coordinates.
  template <class Residual, std::size_t Rows, std::size_t Width, std::size_t Size>
  static void add_squares(const Residual& residual, double (&L)[Rows][Width], double (&gradient)[Size],
                          double& cost) noexcept {
    std::fill(&L[0][0], &L[0][0] + Rows * Width, 0.0);
    std::fill(gradient, gradient + Size, 0.0);
    for (const auto& r : residual) {
      cost += 0.5 * r.v * r.v;
      for (std::size_t i = 0; i < Size; ++i) gradient[i] += r.v * r.d[i];
      add_row(L, r.d, r.v, 1.0);
    }
  }

  /// Adds slope · row to the linear and curvature · rowᵀ row to the quadratic part; most entries of a row are
  /// zero.
  template <std::size_t Rows, std::size_t Width, std::size_t Size>
  static void add_row(double (&L)[Rows][Width], const std::array<double, Size>& row, double slope,
                      double curvature) noexcept {
    for (std::size_t i = 0; i < Size; ++i) {
      if (row[i] == 0.0) continue;
      const double scaled = curvature * row[i];
      for (std::size_t j = 0; j < Size; ++j) L[in_z(i)][in_z(j)] += scaled * row[j];
      L[in_z(i)][kOne] += slope * row[i];
      L[kOne][in_z(i)] += slope * row[i];
    }
  }

  /// The larger one; not-a-number wins.
  static double worse(double a, double b) noexcept { return b <= a ? a : (std::isnan(a) ? a : b); }

  double gradient_[Capacity][kNz]{};  ///< of the stage costs without soft constraints
  double terminal_gradient_[kNx]{};
  std::array<std::array<double, kNx>, Capacity> adjoint_{};  ///< adjoint_[k]: price of x_{k+1}
  std::array<std::array<std::array<double, kNz>, kNc>, Capacity>
      soft_row_{};  ///< Jacobian of the soft constraints
  std::array<Square<kNz>, Capacity> curvature_{};
  Square<kNx> terminal_curvature_{};
};

}  // namespace chicane::solver
