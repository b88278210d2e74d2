// SPDX-License-Identifier: MIT
#pragma once

#include <glpk.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "families/kkt.hpp"

namespace chicane::bench {

/// The linear program, for GLPK, of a problem with linear dynamics and rows. Columns: states from x_1 on,
/// inputs, and the largest miss of the rows that must hold.
template <class P, int Capacity>
class LinearProgram {
 public:
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;
  using Start = std::array<double, P::kNx>;

  LinearProgram(const P& problem, const Start& start, int horizon)
      : problem_{problem}, start_{start}, horizon_{horizon}, lp_{glp_create_prob()} {
    glp_term_out(GLP_OFF);
    glp_add_cols(lp_.get(), miss());
    for (int j = 1; j <= miss(); ++j) glp_set_col_bnds(lp_.get(), j, GLP_FR, 0.0, 0.0);
    glp_set_col_bnds(lp_.get(), miss(), GLP_LO, 0.0, 0.0);
    const std::array<double, P::kNx> no_state{};
    const std::array<double, P::kNu> no_input{};
    const auto x = variables_at<D>(no_state, 0);
    const auto u = variables_at<D>(no_input, P::kNx);
    for (int k = 0; k < horizon; ++k) {
      for (int m = 0; m < P::kNu; ++m) bound_input(k, m);
      int row = 0;
      for (const D& next : problem_.template dynamics<D>(k, x, u))
        add(next, k, state(k + 1, row++), -1.0, GLP_FX);
      for (const D& h : problem_.template equality<D>(k, x, u)) add_equation(h, k);
      row = 0;
      for (const D& c : problem_.template constraint<D>(k, x, u)) {
        if (is_hard(problem_, row++)) add(c, k, miss(), -1.0, GLP_UP);
      }
    }
    for (const D& h : problem_.template terminal_equality<D>(x)) add_equation(h, horizon);
    for (const D& g : problem_.template terminal_constraint<D>(x)) add(g, horizon, miss(), -1.0, GLP_UP);
  }

  /// The least largest miss; not a number where GLPK finds none.
  [[nodiscard]] double least_miss() {
    glp_set_obj_coef(lp_.get(), miss(), 1.0);
    const double least = solve();
    glp_set_obj_coef(lp_.get(), miss(), 0.0);
    return least;
  }
  /// The most that `row`, a linear function of x_N, can be where nothing is missed.
  [[nodiscard]] double most(const Start& row) {
    glp_set_col_bnds(lp_.get(), miss(), GLP_FX, 0.0, 0.0);
    for (int i = 0; i < P::kNx; ++i)
      glp_set_obj_coef(lp_.get(), state(horizon_, i), -row[static_cast<std::size_t>(i)]);
    return -solve();
  }
  /// The largest miss of the inputs that the last least_miss() found, simulated.
  [[nodiscard]] double miss_of_inputs() const {
    Trajectory t;
    t.horizon = horizon_;
    for (int k = 0; k < horizon_; ++k) {
      for (int m = 0; m < P::kNu; ++m)
        t.u[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)] =
            glp_get_col_prim(lp_.get(), input(k, m));
    }
    solver::roll_out(problem_, start_, t);
    return check_kkt(problem_, t, [](int, int) { return 0.0; }).miss;
  }

 private:
  using D = Dual<P::kNx + P::kNu>;
  struct Delete {
    void operator()(glp_prob* lp) const { glp_delete_prob(lp); }
  };

  [[nodiscard]] int state(int k, int i) const { return (k - 1) * P::kNx + i + 1; }  // k >= 1
  [[nodiscard]] int input(int k, int m) const { return horizon_ * P::kNx + k * P::kNu + m + 1; }
  [[nodiscard]] int miss() const { return horizon_ * (P::kNx + P::kNu) + 1; }

  void bound_input(int k, int m) {
    const double low = problem_.input_lower(k)[static_cast<std::size_t>(m)],
                 high = problem_.input_upper(k)[static_cast<std::size_t>(m)];
    const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
    const int kind = has_low && has_high ? (low < high ? GLP_DB : GLP_FX)
                                         : (has_low ? GLP_LO : (has_high ? GLP_UP : GLP_FR));
    glp_set_col_bnds(lp_.get(), input(k, m), kind, low, high);
  }
  /// The row of a linear function of stage k, given at zero, and `factor` times another column: zero, or on
  /// one side of it.
  void add(const D& value, int k, int other, double factor, int kind) {
    std::vector<int> columns{0, other};
    std::vector<double> factors{0.0, factor};
    double offset = value.v;
    for (int v = 0; v < (k < horizon_ ? P::kNx + P::kNu : P::kNx); ++v) {
      const double slope = value.d[static_cast<std::size_t>(v)];
      if (v < P::kNx && k == 0) offset += slope * start_[static_cast<std::size_t>(v)];
      if (slope == 0.0 || (v < P::kNx && k == 0)) continue;
      columns.push_back(v < P::kNx ? state(k, v) : input(k, v - P::kNx));
      factors.push_back(slope);
    }
    const int row = glp_add_rows(lp_.get(), 1);
    glp_set_mat_row(lp_.get(), row, static_cast<int>(columns.size()) - 1, columns.data(), factors.data());
    glp_set_row_bnds(lp_.get(), row, kind, -offset, -offset);
  }
  void add_equation(const D& h, int k) {
    add(h, k, miss(), -1.0, GLP_UP);
    add(h, k, miss(), 1.0, GLP_LO);
  }
  double solve() {
    glp_smcp parameters;
    glp_init_smcp(&parameters);
    parameters.msg_lev = GLP_MSG_OFF;
    parameters.tol_bnd = parameters.tol_dj = 1e-10;
    parameters.tm_lim = 10000;
    glp_scale_prob(lp_.get(), GLP_SF_AUTO);
    glp_adv_basis(lp_.get(), 0);
    const bool is_solved = glp_simplex(lp_.get(), &parameters) == 0 && glp_get_status(lp_.get()) == GLP_OPT;
    return is_solved ? glp_get_obj_val(lp_.get()) : std::numeric_limits<double>::quiet_NaN();
  }

  OverArrays<P> problem_;
  Start start_;
  int horizon_;
  std::unique_ptr<glp_prob, Delete> lp_;
};

}  // namespace chicane::bench
