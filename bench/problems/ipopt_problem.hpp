// SPDX-License-Identifier: MIT
#pragma once

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"
#include "problems/cpu_time.hpp"
#include "problems/dual.hpp"

namespace chicane::bench {

/// What Ipopt's answer has beside the variables: of lower and upper bounds, and of the equations.
struct Multipliers {
  std::vector<double> low, high, equation;
};

/// Any OcpProblem as a sparse nonlinear program for Ipopt (Wächter, Biegler 2006): states and inputs as
/// variables, dynamics as equations, soft constraints with explicit slacks, exact first and second
/// derivatives by dual numbers. Variables: u_0, x_1, u_1, …, x_N, then the slacks. Equations: dynamics, then
/// constraints with slacks, then what else must hold.
template <solver::OcpProblem P>
class IpoptProblem : public Ipopt::TNLP {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;
  static constexpr int kNx = P::kNx;
  static constexpr int kNu = P::kNu;
  static constexpr int kNc = P::kNc;
  static constexpr int kNz = kNx + kNu;
  static constexpr int kNh = solver::equality_count<P>();
  static constexpr int kNeh = solver::terminal_equality_count<P>();
  static constexpr int kNec = solver::terminal_constraint_count<P>();

  const P* problem = nullptr;
  std::array<double, kNx> x0{};
  int horizon = 0;
  std::vector<double> start;  ///< of all variables
  std::vector<double> solution;
  double cost = 0.0;
  Multipliers start_multipliers;   ///< asked for by warm_start_init_point
  Multipliers end_multipliers;     ///< of the solution
  double time_in_functions = 0.0;  ///< CPU time of values and derivatives [s]

  static int at_u(int k) { return k * kNz; }
  static int at_x(int k) { return (k - 1) * kNz + kNu; }
  [[nodiscard]] int at_s(int k) const { return horizon * kNz + k * kNc; }
  [[nodiscard]] int equality_row(int k, int n) const { return horizon * (kNx + kNc) + k * kNh + n; }
  [[nodiscard]] int terminal_row(int n) const { return horizon * (kNx + kNc + kNh) + n; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = horizon * (kNz + kNc);
    m = horizon * (kNx + kNc + kNh) + kNeh + kNec;
    jacobian = visit_jacobian(nullptr, [](int, int, double) {});
    hessian = visit_hessian(nullptr, 0.0, nullptr, [](int, int, double) {});
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index, Number* low, Number* high, Index, Number* g_low, Number* g_high) override {
    for (int k = 0; k < horizon; ++k) {
      for (int m = 0; m < kNu; ++m) {
        low[at_u(k) + m] = std::fmax(problem->input_lower(k)[static_cast<std::size_t>(m)], -2e19);
        high[at_u(k) + m] = std::fmin(problem->input_upper(k)[static_cast<std::size_t>(m)], 2e19);
      }
      for (int i = 0; i < kNx; ++i) {
        low[at_x(k + 1) + i] = -2e19;
        high[at_x(k + 1) + i] = 2e19;
        g_low[k * kNx + i] = g_high[k * kNx + i] = 0.0;
      }
      for (int c = 0; c < kNc; ++c) {
        low[at_s(k) + c] = 0.0;
        high[at_s(k) + c] = must_hold(c) ? 0.0 : 2e19;
        g_low[horizon * kNx + k * kNc + c] = -2e19;
        g_high[horizon * kNx + k * kNc + c] = 0.0;
      }
      for (int i = 0; i < kNh; ++i) g_low[equality_row(k, i)] = g_high[equality_row(k, i)] = 0.0;
    }
    for (int i = 0; i < kNeh + kNec; ++i) {
      g_low[terminal_row(i)] = i < kNeh ? 0.0 : -2e19;
      g_high[terminal_row(i)] = 0.0;
    }
    return true;
  }
  bool get_starting_point(Index, bool, Number* w, bool wants_bounds, Number* low, Number* high, Index,
                          bool wants_equations, Number* equations) override {
    std::copy(start.begin(), start.end(), w);
    if (wants_bounds) {
      std::copy(start_multipliers.low.begin(), start_multipliers.low.end(), low);
      std::copy(start_multipliers.high.begin(), start_multipliers.high.end(), high);
    }
    if (wants_equations) {
      std::copy(start_multipliers.equation.begin(), start_multipliers.equation.end(), equations);
    }
    return true;
  }
  bool eval_f(Index, const Number* w, bool, Number& value) override {
    const Stopwatch stopwatch(time_in_functions);
    value = 0.0;
    for (int k = 0; k < horizon; ++k) {
      for (const double r : problem->residual(k, state<double>(w, k), input<double>(w, k)))
        value += 0.5 * r * r;
      if constexpr (kNc > 0) {
        for (int c = 0; c < kNc; ++c) {
          const double s = w[at_s(k) + c];
          value += s * (problem->soft_penalty(c).linear + 0.5 * problem->soft_penalty(c).quadratic * s);
        }
      }
    }
    for (const double r : problem->terminal_residual(state<double>(w, horizon))) value += 0.5 * r * r;
    return true;
  }
  bool eval_grad_f(Index n, const Number* w, bool, Number* gradient) override {
    const Stopwatch stopwatch(time_in_functions);
    using D = Dual<kNz>;
    for (int i = 0; i < n; ++i) gradient[i] = 0.0;
    for (int k = 0; k < horizon; ++k) {
      for (const D& r : problem->residual(k, state<D>(w, k), input<D>(w, k))) {
        for (int v = 0; v < kNz; ++v) {
          if (const int at = position(k, v); at >= 0) gradient[at] += r.v * r.d[static_cast<std::size_t>(v)];
        }
      }
      if constexpr (kNc > 0) {
        for (int c = 0; c < kNc; ++c) {
          const auto penalty = problem->soft_penalty(c);
          gradient[at_s(k) + c] = penalty.linear + penalty.quadratic * w[at_s(k) + c];
        }
      }
    }
    for (const D& r : problem->terminal_residual(state<D>(w, horizon))) {
      for (int i = 0; i < kNx; ++i) gradient[at_x(horizon) + i] += r.v * r.d[static_cast<std::size_t>(i)];
    }
    return true;
  }
  bool eval_g(Index, const Number* w, bool, Index, Number* g) override {
    const Stopwatch stopwatch(time_in_functions);
    for (int k = 0; k < horizon; ++k) {
      const auto x = state<double>(w, k);
      const auto u = input<double>(w, k);
      const auto next = problem->dynamics(k, x, u);
      for (int i = 0; i < kNx; ++i) g[k * kNx + i] = next[static_cast<std::size_t>(i)] - w[at_x(k + 1) + i];
      if constexpr (kNc > 0) {
        const auto values = problem->constraint(k, x, u);
        for (int c = 0; c < kNc; ++c) {
          g[horizon * kNx + k * kNc + c] = values[static_cast<std::size_t>(c)] - w[at_s(k) + c];
        }
      }
      if constexpr (kNh > 0) {
        int row = equality_row(k, 0);
        for (const double h : problem->equality(k, x, u)) g[row++] = h;
      }
    }
    each_at_end(state<double>(w, horizon), [&](int row, double value) { g[row] = value; });
    return true;
  }
  bool eval_jac_g(Index, const Number* w, bool, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    const Stopwatch stopwatch(time_in_functions);
    int entry = 0;
    visit_jacobian(w, [&](int row, int column, double value) {
      if (values != nullptr) {
        values[entry] = value;
      } else {
        rows[entry] = row;
        columns[entry] = column;
      }
      ++entry;
    });
    return true;
  }
  bool eval_h(Index, const Number* w, bool, Number factor, Index, const Number* multipliers, bool, Index,
              Index* rows, Index* columns, Number* values) override {
    const Stopwatch stopwatch(time_in_functions);
    int entry = 0;
    visit_hessian(w, factor, multipliers, [&](int row, int column, double value) {
      if (values != nullptr) {
        values[entry] = value;
      } else {
        rows[entry] = row;
        columns[entry] = column;
      }
      ++entry;
    });
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* w, const Number* low, const Number* high,
                         Index m, const Number*, const Number* equations, Number value,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    solution.assign(w, w + n);
    cost = value;
    end_multipliers = {{low, low + n}, {high, high + n}, {equations, equations + m}};
  }

  /// The trajectory's inputs and states as the point to start from.
  template <int Capacity>
  void take_start(const solver::Trajectory<kNx, kNu, Capacity>& t) {
    horizon = t.horizon;
    start.assign(static_cast<std::size_t>(t.horizon * (kNz + kNc)), 1e-2);
    for (int k = 0; k < t.horizon; ++k) {
      const auto stage = static_cast<std::size_t>(k);
      std::copy(t.u[stage].begin(), t.u[stage].end(), start.begin() + at_u(k));
      std::copy(t.x[stage + 1].begin(), t.x[stage + 1].end(), start.begin() + at_x(k + 1));
    }
  }
  /// The solution's inputs and states.
  template <int Capacity>
  void give_solution(solver::Trajectory<kNx, kNu, Capacity>& t) const {
    for (int k = 0; k < t.horizon; ++k) {
      const auto stage = static_cast<std::size_t>(k);
      std::copy_n(solution.begin() + at_u(k), kNu, t.u[stage].begin());
      std::copy_n(solution.begin() + at_x(k + 1), kNx, t.x[stage + 1].begin());
    }
  }

 private:
  /// Where variable v of (x_k, u_k) stands among the unknowns; −1 for the given x_0.
  static int position(int k, int v) { return v >= kNx ? at_u(k) + v - kNx : (k > 0 ? at_x(k) + v : -1); }

  bool must_hold([[maybe_unused]] int c) const {
    if constexpr (requires { problem->is_hard(0); }) return problem->is_hard(c);
    return false;
  }
  /// Calls visit(row, value) for what must hold at the end.
  template <class X, class Visit>
  void each_at_end([[maybe_unused]] const X& x, [[maybe_unused]] const Visit& visit) const {
    int row = terminal_row(0);
    if constexpr (kNeh > 0) {
      for (const auto& h : problem->terminal_equality(x)) visit(row++, h);
    }
    if constexpr (kNec > 0) {
      for (const auto& c : problem->terminal_constraint(x)) visit(row++, c);
    }
  }

  template <class T>
  static T seed(double value, int index) {
    if constexpr (std::is_same_v<T, double>) {
      return value;
    } else if constexpr (std::is_same_v<decltype(T::v), double>) {
      return T::variable(value, index);
    } else {
      return T::variable(decltype(T::v)::variable(value, index), index);
    }
  }
  template <class T>
  std::array<T, kNx> state(const Number* w, int k) const {
    std::array<T, kNx> x;
    for (int i = 0; i < kNx; ++i) {
      const double value = w == nullptr ? 0.0 : (k == 0 ? x0[static_cast<std::size_t>(i)] : w[at_x(k) + i]);
      x[static_cast<std::size_t>(i)] = seed<T>(value, i);
    }
    return x;
  }
  template <class T>
  static std::array<T, kNu> input(const Number* w, int k) {
    std::array<T, kNu> u;
    for (int m = 0; m < kNu; ++m)
      u[static_cast<std::size_t>(m)] = seed<T>(w == nullptr ? 0.0 : w[at_u(k) + m], kNx + m);
    return u;
  }

  template <class Put>
  int visit_jacobian(const Number* w, const Put& put) {
    using D = Dual<kNz>;
    int count = 0;
    const auto row = [&](int r, int k, const D& value) {
      for (int v = 0; v < kNz; ++v) {
        if (const int at = position(k, v); at >= 0) {
          put(r, at, value.d[static_cast<std::size_t>(v)]);
          ++count;
        }
      }
    };
    for (int k = 0; k < horizon; ++k) {
      const auto x = state<D>(w, k);
      const auto u = input<D>(w, k);
      const auto next = problem->dynamics(k, x, u);
      for (int i = 0; i < kNx; ++i) {
        row(k * kNx + i, k, next[static_cast<std::size_t>(i)]);
        put(k * kNx + i, at_x(k + 1) + i, -1.0);
        ++count;
      }
      if constexpr (kNc > 0) {
        const auto values = problem->constraint(k, x, u);
        for (int c = 0; c < kNc; ++c) {
          row(horizon * kNx + k * kNc + c, k, values[static_cast<std::size_t>(c)]);
          put(horizon * kNx + k * kNc + c, at_s(k) + c, -1.0);
          ++count;
        }
      }
      if constexpr (kNh > 0) {
        int at = equality_row(k, 0);
        for (const D& h : problem->equality(k, x, u)) row(at++, k, h);
      }
    }
    if constexpr (kNeh + kNec > 0) {
      each_at_end(state<D>(w, horizon), [&](int at, const D& value) {
        for (int i = 0; i < kNx; ++i) {
          put(at, at_x(horizon) + i, value.d[static_cast<std::size_t>(i)]);
          ++count;
        }
      });
    }
    return count;
  }

  template <class Put>
  int visit_hessian(const Number* w, double factor, const Number* multipliers, const Put& put) {
    using D = Dual<kNz, Dual<kNz>>;
    int count = 0;
    for (int k = 0; k <= horizon; ++k) {
      D lagrangian(0.0);
      const auto x = state<D>(w, k);
      const auto multiplier = [&](int row) { return multipliers == nullptr ? 0.0 : multipliers[row]; };
      if (k < horizon) {
        const auto u = input<D>(w, k);
        for (const D& r : problem->residual(k, x, u)) lagrangian += (0.5 * factor) * r * r;
        const auto next = problem->dynamics(k, x, u);
        for (int i = 0; i < kNx; ++i)
          lagrangian += multiplier(k * kNx + i) * next[static_cast<std::size_t>(i)];
        if constexpr (kNc > 0) {
          const auto values = problem->constraint(k, x, u);
          for (int c = 0; c < kNc; ++c) {
            lagrangian += multiplier(horizon * kNx + k * kNc + c) * values[static_cast<std::size_t>(c)];
            put(at_s(k) + c, at_s(k) + c, factor * problem->soft_penalty(c).quadratic);
            ++count;
          }
        }
        if constexpr (kNh > 0) {
          int row = equality_row(k, 0);
          for (const D& h : problem->equality(k, x, u)) lagrangian += multiplier(row++) * h;
        }
      } else {
        for (const D& r : problem->terminal_residual(x)) lagrangian += (0.5 * factor) * r * r;
        each_at_end(x, [&](int row, const D& value) { lagrangian += multiplier(row) * value; });
      }
      for (int a = 0; a < (k < horizon ? kNz : kNx); ++a) {
        for (int b = 0; b <= a; ++b) {
          if (position(k, a) < 0 || position(k, b) < 0) continue;
          put(position(k, a), position(k, b),
              lagrangian.d[static_cast<std::size_t>(a)].d[static_cast<std::size_t>(b)]);
          ++count;
        }
      }
    }
    return count;
  }
};

/// The trajectory's inputs and states are the start; on success they are the optimum and its cost is
/// returned, else NaN. What Ipopt calls acceptable is not enough: it may break constraints by 1e-2.
template <solver::OcpProblem P, int Capacity>
double solve_with_ipopt(const P& problem, const std::array<double, P::kNx>& x0,
                        solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  using Nlp = IpoptProblem<P>;
  const Ipopt::SmartPtr<Nlp> nlp = new Nlp;
  nlp->problem = &problem;
  nlp->x0 = x0;
  nlp->take_start(t);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> app = IpoptApplicationFactory();
  app->Options()->SetIntegerValue("print_level", 0);
  app->Options()->SetStringValue("sb", "yes");
  app->Options()->SetNumericValue("tol", 1e-9);
  app->Options()->SetNumericValue("bound_relax_factor", 0.0);
  app->Options()->SetIntegerValue("max_iter", 500);
  app->Options()->SetIntegerValue("acceptable_iter", 0);
  if (app->Initialize() != Ipopt::Solve_Succeeded) return std::nan("");
  const auto status = app->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(nlp)));
  if (status != Ipopt::Solve_Succeeded) return std::nan("");
  nlp->give_solution(t);
  return nlp->cost;
}

}  // namespace chicane::bench
