// SPDX-License-Identifier: MIT
#pragma once

#include <hpipm_d_ocp_qp.h>
#include <hpipm_d_ocp_qp_dim.h>
#include <hpipm_d_ocp_qp_ipm.h>
#include <hpipm_d_ocp_qp_sol.h>

#include "references/stage_rows.hpp"

namespace chicane::bench {

/// Sequential quadratic programming in full steps with Gauss and Newton's Hessian; HPIPM (Frison, Diehl 2020)
/// solves each program, from the solution of the last one where it was solved. x_0 is no variable, soft
/// constraints are HPIPM's own. The independent check says when a point is optimal.
template <solver::OcpProblem P, int Capacity>
class HpipmSolver {
 public:
  using Rows = StageRows<P, Capacity>;

  /// The trajectory is the start; then the optimum, or as it was.
  Outcome solve(const P& problem, const std::array<double, P::kNx>& x0, typename Rows::Trajectory& t) {
    constexpr int kMostSteps = 100;
    const bool is_new = rows_.at.horizon != t.horizon;
    rows_.pose(problem, x0, t);
    if (is_new) set_up();
    status_ = 1;
    Outcome outcome;
    const double begin = cpu_time();
    while (outcome.iterations < kMostSteps && !outcome.is_solved && make_step()) {
      ++outcome.iterations;
      const Stopwatch stopwatch(rows_.time_in_functions);
      outcome.is_solved = is_optimal();
    }
    outcome.time = cpu_time() - begin;
    outcome.time_in_functions = rows_.time_in_functions;
    if (outcome.is_solved) t = rows_.at;
    return outcome;
  }

 private:
  using First = typename Rows::First;
  static constexpr int kNx = P::kNx, kNu = P::kNu, kNz = kNx + kNu;
  static constexpr double kTolerance = 1e-6;

  /// Memory of one of HPIPM's structures.
  template <class Size, class Create>
  void create(const Size& size, const Create& create) {
    memory_.emplace_back(static_cast<std::size_t>(size) + 64);
    create(memory_.back().data());
  }
  [[nodiscard]] static constexpr int count_rows(bool is_end) {
    return Rows::equations(is_end) + Rows::limits(is_end);
  }

  void set_up() {
    const int last = rows_.at.horizon;
    memory_.clear();
    create(d_ocp_qp_dim_memsize(last), [&](void* at) { d_ocp_qp_dim_create(last, &dim_, at); });
    for (int k = 0; k <= last; ++k) {
      const bool is_end = k == last;
      d_ocp_qp_dim_set_nx(k, k > 0 ? kNx : 0, &dim_);
      d_ocp_qp_dim_set_nu(k, is_end ? 0 : kNu, &dim_);
      d_ocp_qp_dim_set_nbu(k, is_end ? 0 : kNu, &dim_);
      d_ocp_qp_dim_set_ng(k, count_rows(is_end), &dim_);
      d_ocp_qp_dim_set_ns(k, is_end ? 0 : rows_.slacks, &dim_);
    }
    create(d_ocp_qp_memsize(&dim_), [&](void* at) { d_ocp_qp_create(&dim_, &qp_, at); });
    create(d_ocp_qp_sol_memsize(&dim_), [&](void* at) { d_ocp_qp_sol_create(&dim_, &answer_, at); });
    create(d_ocp_qp_ipm_arg_memsize(&dim_), [&](void* at) { d_ocp_qp_ipm_arg_create(&dim_, &options_, at); });
    d_ocp_qp_ipm_arg_set_default(SPEED, &options_);
    int most = 100;
    d_ocp_qp_ipm_arg_set_iter_max(&most, &options_);
    double tolerance = 1e-8;
    for (auto* set : {&d_ocp_qp_ipm_arg_set_tol_stat, &d_ocp_qp_ipm_arg_set_tol_eq,
                      &d_ocp_qp_ipm_arg_set_tol_ineq, &d_ocp_qp_ipm_arg_set_tol_comp})
      (*set)(&tolerance, &options_);
    create(d_ocp_qp_ipm_ws_memsize(&dim_, &options_),
           [&](void* at) { d_ocp_qp_ipm_ws_create(&dim_, &options_, &work_, at); });
    d_ocp_qp_set_all_zero(&qp_);
    for (int k = 0; k <= last; ++k) set_constants(k);
  }
  /// Sets the bounds of stage k and their penalties.
  void set_constants(int k) {
    const bool is_end = k == rows_.at.horizon;
    std::vector<int> index(kNu), slack_of(static_cast<std::size_t>(kNu), -1);
    for (int m = 0; m < kNu; ++m) index[static_cast<std::size_t>(m)] = m;
    if (!is_end) d_ocp_qp_set_idxbu(k, index.data(), &qp_);
    std::vector<double> mask(static_cast<std::size_t>(count_rows(is_end)), 1.0);  // equations, then limits
    std::fill(mask.begin() + Rows::equations(is_end), mask.end(), 0.0);
    d_ocp_qp_set_lg_mask(k, mask.data(), &qp_);
    if constexpr (P::kNc > 0) {
      if (is_end || rows_.slacks == 0) return;
      slack_of.resize(static_cast<std::size_t>(kNu + Rows::equations(false)), -1);
      slack_of.insert(slack_of.end(), rows_.slack_of.begin(), rows_.slack_of.end());
      std::vector<double> linear, quadratic, zero(static_cast<std::size_t>(rows_.slacks), 0.0);
      for (int c = 0; c < P::kNc; ++c) {
        if (rows_.slack_of[static_cast<std::size_t>(c)] < 0) continue;
        linear.push_back(rows_.problem.soft_penalty(c).linear);
        quadratic.push_back(rows_.problem.soft_penalty(c).quadratic);
      }
      d_ocp_qp_set_idxs_rev(k, slack_of.data(), &qp_);
      for (auto* set : {&d_ocp_qp_set_zl, &d_ocp_qp_set_zu}) (*set)(k, linear.data(), &qp_);
      for (auto* set : {&d_ocp_qp_set_Zl, &d_ocp_qp_set_Zu}) (*set)(k, quadratic.data(), &qp_);
      for (auto* set : {&d_ocp_qp_set_lls, &d_ocp_qp_set_lus}) (*set)(k, zero.data(), &qp_);
    }
  }

  /// Columns of numbers, as HPIPM takes them.
  template <int Rows, int Columns>
  struct Matrix {
    int height = Rows;
    std::array<double, static_cast<std::size_t>(Rows* Columns)> numbers{};
    double& operator()(int i, int j) { return numbers[static_cast<std::size_t>(j * height + i)]; }
    double* data() { return numbers.data(); }
  };
  /// Stage k of the program in steps from the present point.
  void set_stage(int k) {
    const bool is_end = k == rows_.at.horizon;
    const auto at = static_cast<std::size_t>(k);
    constexpr int kMostRows = std::max({1, count_rows(false), count_rows(true)});
    Matrix<kNx, kNx> a, q;
    Matrix<kNx, kNu> b;
    Matrix<kNu, kNx> s;
    Matrix<kNu, kNu> r;
    Matrix<kNx, 1> defect, by_x;
    Matrix<kNu, 1> by_u, low, high;
    Matrix<kMostRows, kNx> c{.height = count_rows(is_end)};
    Matrix<kMostRows, kNu> d{.height = count_rows(is_end)};
    Matrix<kMostRows, 1> limit;
    {
      const Stopwatch stopwatch(rows_.time_in_functions);
      rows_.template each_residual<First>(k, [&](const First& row) {
        for (int v = 0; v < kNz; ++v) {
          const double slope = row.d[static_cast<std::size_t>(v)];
          (v < kNx ? by_x(v, 0) : by_u(v - kNx, 0)) += row.v * slope;
          for (int w = 0; w < kNx; ++w)
            (v < kNx ? q(v, w) : s(v - kNx, w)) += slope * row.d[static_cast<std::size_t>(w)];
          for (int m = 0; v >= kNx && m < kNu; ++m)
            r(v - kNx, m) += slope * row.d[static_cast<std::size_t>(kNx + m)];
        }
      });
      rows_.template each_row<First>(k, [&](typename Rows::Kind kind, int n, const First& row) {
        const bool is_dynamics = kind == Rows::kDynamics;
        const int line = n + (kind == Rows::kLimit ? Rows::equations(is_end) : 0);
        for (int i = 0; i < kNx; ++i)
          (is_dynamics ? a(line, i) : c(line, i)) = row.d[static_cast<std::size_t>(i)];
        for (int m = 0; m < kNu; ++m)
          (is_dynamics ? b(line, m) : d(line, m)) = row.d[static_cast<std::size_t>(kNx + m)];
        if (is_dynamics) defect(n, 0) = row.v - rows_.at.x[at + 1][static_cast<std::size_t>(n)];
        if (!is_dynamics) limit(line, 0) = -row.v;
      });
    }
    if (k > 0) {
      d_ocp_qp_set_Q(k, q.data(), &qp_);
      d_ocp_qp_set_q(k, by_x.data(), &qp_);
      d_ocp_qp_set_C(k, c.data(), &qp_);
    }
    d_ocp_qp_set_lg(k, limit.data(), &qp_);
    d_ocp_qp_set_ug(k, limit.data(), &qp_);
    if (is_end) return;
    for (std::size_t m = 0; m < static_cast<std::size_t>(kNu); ++m) {
      low.numbers[m] = rows_.problem.input_lower(k)[m] - rows_.at.u[at][m];
      high.numbers[m] = rows_.problem.input_upper(k)[m] - rows_.at.u[at][m];
    }
    if (k > 0) {
      d_ocp_qp_set_A(k, a.data(), &qp_);
      d_ocp_qp_set_S(k, s.data(), &qp_);
    }
    d_ocp_qp_set_B(k, b.data(), &qp_);
    d_ocp_qp_set_b(k, defect.data(), &qp_);
    d_ocp_qp_set_R(k, r.data(), &qp_);
    d_ocp_qp_set_r(k, by_u.data(), &qp_);
    d_ocp_qp_set_lbu(k, low.data(), &qp_);
    d_ocp_qp_set_ubu(k, high.data(), &qp_);
    d_ocp_qp_set_D(k, d.data(), &qp_);
  }
  /// One whole step; false where HPIPM ends with a value that is not a number.
  bool make_step() {
    int warm = status_ == 0 ? 2 : 0;
    for (int k = 0; k <= rows_.at.horizon; ++k) set_stage(k);
    d_ocp_qp_ipm_arg_set_warm_start(&warm, &options_);
    d_ocp_qp_ipm_solve(&qp_, &answer_, &options_, &work_);
    d_ocp_qp_ipm_get_status(&work_, &status_);
    for (int k = 0; k <= rows_.at.horizon; ++k) {
      const auto at = static_cast<std::size_t>(k);
      std::array<double, kNx> dx{};
      std::array<double, kNu> du{};
      if (k > 0) d_ocp_qp_sol_get_x(k, &answer_, dx.data());
      for (std::size_t i = 0; i < dx.size(); ++i) rows_.at.x[at][i] += dx[i];
      if (k == rows_.at.horizon) break;
      d_ocp_qp_sol_get_u(k, &answer_, du.data());
      const auto low = rows_.problem.input_lower(k), high = rows_.problem.input_upper(k);
      for (std::size_t m = 0; m < du.size(); ++m)
        rows_.at.u[at][m] = std::clamp(rows_.at.u[at][m] + du[m], low[m], high[m]);
    }
    return status_ != 3;
  }
  bool is_optimal() {
    const auto multiplier = [&](int k, int line) {
      const bool is_end = k == rows_.at.horizon;
      std::vector<double> low(static_cast<std::size_t>(count_rows(is_end))), high = low;
      d_ocp_qp_sol_get_lam_lg(k, &answer_, low.data());
      d_ocp_qp_sol_get_lam_ug(k, &answer_, high.data());
      return high[static_cast<std::size_t>(line)] - low[static_cast<std::size_t>(line)];
    };
    struct Multipliers {
      const decltype(multiplier)& of;
      int last;
      double constraint_multiplier(int k, int c) const { return of(k, Rows::equations(false) + c); }
      double equality_multiplier(int k, int n) const { return of(k, n); }
      double terminal_equality_multiplier(int n) const { return of(last, n); }
      double terminal_constraint_multiplier(int n) const { return of(last, Rows::equations(true) + n); }
    };
    const KktResidual kkt = check_kkt(rows_.problem, rows_.at, Multipliers{multiplier, rows_.at.horizon});
    return std::max({kkt.stationarity, kkt.defect, kkt.miss}) <= kTolerance &&
           kkt.subgradient <= std::sqrt(kTolerance);
  }

  Rows rows_;
  std::vector<std::vector<char>> memory_;
  d_ocp_qp_dim dim_{};
  d_ocp_qp qp_{};
  d_ocp_qp_sol answer_{};
  d_ocp_qp_ipm_arg options_{};
  d_ocp_qp_ipm_ws work_{};
  int status_ = 1;  ///< of the last program; 0: solved
};

}  // namespace chicane::bench
