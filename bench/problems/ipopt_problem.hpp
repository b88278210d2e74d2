// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "families/kkt.hpp"
#include "problems/ipopt_solver.hpp"

namespace chicane::bench {

/// Any OcpProblem for Ipopt: states and inputs as variables, dynamics as equations, soft constraints with
/// explicit slacks, exact first and second derivatives by dual numbers. Variables: u_0, x_1, u_1, …, x_N,
/// then the slacks. Equations: dynamics, then constraints with slacks, then what else must hold.
template <solver::OcpProblem P>
class IpoptProblem : public SparseNlp<IpoptProblem<P>> {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;
  static constexpr int kNx = P::kNx, kNu = P::kNu, kNc = P::kNc, kNz = kNx + kNu;
  static constexpr int kNh = solver::equality_count<P>();
  static constexpr int kNeh = solver::terminal_equality_count<P>();
  static constexpr int kNec = solver::terminal_constraint_count<P>();

  /// The trajectory's inputs and states as the point to start from. The problem outlives the solve.
  template <int Capacity>
  void pose(const P& problem, const std::array<double, kNx>& x0,
            const solver::Trajectory<kNx, kNu, Capacity>& t) {
    problem_ = std::make_unique<OverArrays<P>>(OverArrays<P>{problem});
    x0_ = x0;
    horizon_ = t.horizon;
    this->start.assign(static_cast<std::size_t>(t.horizon * (kNz + kNc)), 1e-2);
    for (int k = 0; k < t.horizon; ++k) {
      const auto stage = static_cast<std::size_t>(k);
      std::copy(t.u[stage].begin(), t.u[stage].end(), this->start.begin() + at_u(k));
      std::copy(t.x[stage + 1].begin(), t.x[stage + 1].end(), this->start.begin() + at_x(k + 1));
    }
  }
  /// The solution's inputs and states.
  template <int Capacity>
  void give_solution(solver::Trajectory<kNx, kNu, Capacity>& t) const {
    for (int k = 0; k < t.horizon; ++k) {
      const auto stage = static_cast<std::size_t>(k);
      std::copy_n(this->solution.begin() + at_u(k), kNu, t.u[stage].begin());
      std::copy_n(this->solution.begin() + at_x(k + 1), kNx, t.x[stage + 1].begin());
    }
  }
  /// One stage earlier; the last one stays. What each stage has: variables or equations, then the same number
  /// of soft constraints behind all stages.
  void shift(Multipliers& multipliers) const {
    const auto shift = [&](std::vector<double>& values, int width) {
      const auto move = [&](int begin, int size) {
        const auto first = values.begin() + begin;
        std::copy(first + size, first + horizon_ * size, first);
      };
      if (values.empty()) return;
      move(0, width);
      if constexpr (kNc > 0) move(horizon_ * width, kNc);
    };
    shift(multipliers.low, kNz);
    shift(multipliers.high, kNz);
    shift(multipliers.equation, kNx);
  }

  void sizes(Index& n, Index& m) const {
    n = horizon_ * (kNz + kNc);
    m = horizon_ * (kNx + kNc + kNh) + kNeh + kNec;
  }
  bool get_bounds_info(Index n, Number* low, Number* high, Index m, Number* g_low, Number* g_high) override {
    std::fill(low, low + n, -2e19);
    std::fill(high, high + n, 2e19);
    std::fill(g_low, g_low + m, 0.0);
    std::fill(g_high, g_high + m, 0.0);
    for (int k = 0; k < horizon_; ++k) {
      for (int i = 0; i < kNu; ++i) {
        low[at_u(k) + i] = std::fmax(problem_->input_lower(k)[static_cast<std::size_t>(i)], -2e19);
        high[at_u(k) + i] = std::fmin(problem_->input_upper(k)[static_cast<std::size_t>(i)], 2e19);
      }
      for (int c = 0; c < kNc; ++c) {
        low[at_s(k) + c] = 0.0;
        if (is_hard(*problem_, c)) high[at_s(k) + c] = 0.0;
        g_low[horizon_ * kNx + k * kNc + c] = -2e19;
      }
    }
    for (int i = kNeh; i < kNeh + kNec; ++i) g_low[terminal_row(i)] = -2e19;
    return true;
  }
  double cost_at(const Number* w) const {
    double value = 0.0;
    for (int k = 0; k <= horizon_; ++k) {
      each_residual<double>(w, k, [&](double r) { value += 0.5 * r * r; });
      each_slack(k, [&](int at, const auto& penalty) {
        value += w[at] * (penalty.linear + 0.5 * penalty.quadratic * w[at]);
      });
    }
    return value;
  }
  void add_gradient(const Number* w, Number* gradient) const {
    for (int k = 0; k <= horizon_; ++k) {
      each_residual<First>(w, k, [&](const First& r) {
        each_slope(k, r, [&](int at, double slope) { gradient[at] += r.v * slope; });
      });
      each_slack(
          k, [&](int at, const auto& penalty) { gradient[at] = penalty.linear + penalty.quadratic * w[at]; });
    }
  }
  void set_equations(const Number* w, Number* g) const {
    for (int k = 0; k <= horizon_; ++k) {
      each_row<double>(w, k,
                       [&](int row, double value, int less) { g[row] = less < 0 ? value : value - w[less]; });
    }
  }
  template <class Put>
  void visit_jacobian(const Number* w, const Put& put) const {
    for (int k = 0; k <= horizon_; ++k) {
      each_row<First>(w, k, [&](int row, const First& value, int less) {
        each_slope(k, value, [&](int at, double slope) { put(row, at, slope); });
        if (less >= 0) put(row, less, -1.0);
      });
    }
  }
  template <class Put>
  void visit_hessian(const Number* w, double factor, const Number* multipliers, const Put& put) const {
    using Second = Dual<kNz, First>;
    for (int k = 0; k <= horizon_; ++k) {
      Second lagrangian(0.0);
      each_residual<Second>(w, k, [&](const Second& r) { lagrangian += (0.5 * factor) * r * r; });
      each_row<Second>(w, k, [&](int row, const Second& value, int) {
        lagrangian += (multipliers == nullptr ? 0.0 : multipliers[row]) * value;
      });
      each_slack(k, [&](int at, const auto& penalty) { put(at, at, factor * penalty.quadratic); });
      for (int a = 0; a < variables(k); ++a) {
        for (int b = 0; b <= a && position(k, a) >= 0; ++b) {
          if (position(k, b) < 0) continue;
          put(position(k, a), position(k, b),
              lagrangian.d[static_cast<std::size_t>(a)].d[static_cast<std::size_t>(b)]);
        }
      }
    }
  }

 private:
  using First = Dual<kNz>;

  static int at_u(int k) { return k * kNz; }
  static int at_x(int k) { return (k - 1) * kNz + kNu; }
  [[nodiscard]] int at_s(int k) const { return horizon_ * kNz + k * kNc; }
  [[nodiscard]] int terminal_row(int n) const { return horizon_ * (kNx + kNc + kNh) + n; }
  /// Of a stage: x_k and u_k, at the end x_N.
  [[nodiscard]] int variables(int k) const { return k < horizon_ ? kNz : kNx; }
  /// Where variable v of (x_k, u_k) stands among the unknowns; −1 for the given x_0.
  static int position(int k, int v) { return v >= kNx ? at_u(k) + v - kNx : (k > 0 ? at_x(k) + v : -1); }

  /// Calls visit(position, slope) for the unknowns of stage k.
  template <class Visit>
  void each_slope(int k, const First& value, const Visit& visit) const {
    for (int v = 0; v < variables(k); ++v) {
      if (const int at = position(k, v); at >= 0) visit(at, value.d[static_cast<std::size_t>(v)]);
    }
  }
  /// Calls visit(residual) for each residual of stage k, or of the end.
  template <class T, class Visit>
  void each_residual(const Number* w, int k, const Visit& visit) const {
    if (k < horizon_) {
      for (const T& r : problem_->template residual<T>(k, state<T>(w, k), input<T>(w, k))) visit(r);
    } else {
      for (const T& r : problem_->template terminal_residual<T>(state<T>(w, k))) visit(r);
    }
  }
  /// Calls visit(position, penalty) for the slacks of stage k.
  template <class Visit>
  void each_slack([[maybe_unused]] int k, [[maybe_unused]] const Visit& visit) const {
    if constexpr (kNc > 0) {
      for (int c = 0; k < horizon_ && c < kNc; ++c) visit(at_s(k) + c, problem_->soft_penalty(c));
    }
  }
  /// Calls visit(row, value, less) for the equations of stage k, or of the end: the equation is the value
  /// less the unknown at `less`, where that is not −1.
  template <class T, class Visit>
  void each_row(const Number* w, int k, const Visit& visit) const {
    const auto x = state<T>(w, k);
    int row = terminal_row(0);
    if (k == horizon_) {
      for (const T& h : problem_->template terminal_equality<T>(x)) visit(row++, h, -1);
      for (const T& c : problem_->template terminal_constraint<T>(x)) visit(row++, c, -1);
      return;
    }
    const auto u = input<T>(w, k);
    row = k * kNx;
    int less = at_x(k + 1);
    for (const T& next : problem_->template dynamics<T>(k, x, u)) visit(row++, next, less++);
    row = horizon_ * kNx + k * kNc;
    less = at_s(k);
    for (const T& value : problem_->template constraint<T>(k, x, u)) visit(row++, value, less++);
    row = horizon_ * (kNx + kNc) + k * kNh;
    for (const T& h : problem_->template equality<T>(k, x, u)) visit(row++, h, -1);
  }

  template <class T>
  std::array<T, kNx> state(const Number* w, int k) const {
    std::array<double, kNx> x = x0_;
    if (w != nullptr && k > 0) std::copy_n(w + at_x(k), kNx, x.begin());
    return variables_at<T>(x, 0);
  }
  template <class T>
  static std::array<T, kNu> input(const Number* w, int k) {
    std::array<double, kNu> u{};
    if (w != nullptr) std::copy_n(w + at_u(k), kNu, u.begin());
    return variables_at<T>(u, kNx);
  }

  std::unique_ptr<OverArrays<P>> problem_;
  std::array<double, kNx> x0_{};
  int horizon_ = 0;
};

/// Ipopt for one problem type: tolerance 1e-6 as ours, its defaults otherwise, bounds as they are.
template <solver::OcpProblem P>
using IpoptSolver = IpoptRunner<IpoptProblem<P>>;

/// The trajectory's inputs and states are the start; on success they are the optimum to 1e-9 and its cost is
/// returned, else NaN. Acceptable points of Ipopt count as failures: they may break constraints by 1e-2.
template <solver::OcpProblem P, int Capacity>
double solve_with_ipopt(const P& problem, const std::array<double, P::kNx>& x0,
                        solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  const Ipopt::SmartPtr<IpoptProblem<P>> nlp = new IpoptProblem<P>;
  nlp->pose(problem, x0, t);
  const auto app = make_ipopt(false, 1e-9);
  app->Options()->SetIntegerValue("acceptable_iter", 0);
  const auto status = app->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(nlp)));
  if (status != Ipopt::Solve_Succeeded) return std::nan("");
  nlp->give_solution(t);
  return nlp->cost;
}

}  // namespace chicane::bench
