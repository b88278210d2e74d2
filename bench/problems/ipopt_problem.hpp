// SPDX-License-Identifier: MIT
#pragma once

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "references/stage_rows.hpp"

namespace chicane::bench {

/// Ipopt as it is compared: tolerance as ours, bounds as they are, its own defaults otherwise. `is_hot`:
/// starts from given multipliers with a barrier of 1e-5.
inline Ipopt::SmartPtr<Ipopt::IpoptApplication> make_ipopt(bool is_hot, double tolerance = 1e-6) {
  Ipopt::SmartPtr<Ipopt::IpoptApplication> app = IpoptApplicationFactory();
  app->Options()->SetIntegerValue("print_level", 0);
  app->Options()->SetStringValue("sb", "yes");
  app->Options()->SetNumericValue("tol", tolerance);
  app->Options()->SetNumericValue("bound_relax_factor", 0.0);
  app->Options()->SetIntegerValue("max_iter", 500);
  if (is_hot) {
    app->Options()->SetStringValue("warm_start_init_point", "yes");
    app->Options()->SetNumericValue("mu_init", 1e-5);
    for (const char* push : {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
                             "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
      app->Options()->SetNumericValue(push, 1e-6);
    }
  }
  app->Initialize();
  return app;
}

/// Any OcpProblem for Ipopt (Wächter, Biegler 2006): states and inputs as variables, dynamics as equations,
/// soft constraints with explicit slacks, exact first and second derivatives by dual numbers. Variables: u_0,
/// x_1, u_1, …, x_N, then the slacks. Equations: dynamics, then constraints with slacks, then what else must
/// hold.
template <solver::OcpProblem P, int Capacity>
class IpoptProblem final : public Ipopt::TNLP {
 public:
  using Rows = StageRows<P, Capacity>;
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;
  static constexpr int kNx = P::kNx, kNu = P::kNu, kNc = P::kNc, kNz = kNx + kNu;
  static constexpr int kNh = Rows::equations(false), kNeh = Rows::equations(true), kNec = Rows::limits(true);
  /// Multipliers of lower and upper bounds, and of the equations.
  struct Multipliers {
    std::vector<double> low, high, equation;
  };

  Rows rows;
  double cost = 0.0;              ///< of the solution
  Multipliers start_multipliers;  ///< asked for by warm_start_init_point
  Multipliers end_multipliers;    ///< of the solution

  /// The trajectory's inputs and states as the point to start from.
  void pose(const P& problem, const std::array<double, kNx>& x0, const typename Rows::Trajectory& t) {
    rows.pose(problem, x0, t);
    horizon_ = t.horizon;
    point_.assign(static_cast<std::size_t>(horizon_ * (kNz + kNc)), 1e-2);
    for (int k = 0; k < horizon_; ++k) {
      const auto stage = static_cast<std::size_t>(k);
      std::copy(t.u[stage].begin(), t.u[stage].end(), point_.begin() + at_u(k));
      std::copy(t.x[stage + 1].begin(), t.x[stage + 1].end(), point_.begin() + at_x(k + 1));
    }
  }
  /// The solution's inputs and states.
  void give_solution(typename Rows::Trajectory& t) {
    go_to(point_.data());
    t = rows.at;
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

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = horizon_ * (kNz + kNc);
    m = terminal_row(kNeh + kNec);
    jacobian = hessian = 0;
    visit_jacobian([&](int, int, double) { ++jacobian; });
    visit_hessian(0.0, nullptr, [&](int, int, double) { ++hessian; });
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* low, Number* high, Index m, Number* g_low, Number* g_high) override {
    std::fill(low, low + n, -2e19);
    std::fill(high, high + n, 2e19);
    std::fill(g_low, g_low + m, 0.0);
    std::fill(g_high, g_high + m, 0.0);
    for (int k = 0; k < horizon_; ++k) {
      const auto least = rows.problem.input_lower(k), most = rows.problem.input_upper(k);
      for (int i = 0; i < kNu; ++i) {
        low[at_u(k) + i] = std::fmax(least[static_cast<std::size_t>(i)], -2e19);
        high[at_u(k) + i] = std::fmin(most[static_cast<std::size_t>(i)], 2e19);
      }
      for (int c = 0; c < kNc; ++c) {
        low[at_s(k) + c] = 0.0;
        if (is_hard(rows.problem, c)) high[at_s(k) + c] = 0.0;
        g_low[row_of(k, Rows::kLimit, c)] = -2e19;
      }
    }
    for (int i = 0; i < kNec; ++i) g_low[row_of(horizon_, Rows::kLimit, i)] = -2e19;
    return true;
  }
  bool get_starting_point(Index, bool, Number* w, bool wants_bounds, Number* low, Number* high, Index,
                          bool wants_equations, Number* equations) override {
    const Multipliers& from = start_multipliers;
    std::copy(point_.begin(), point_.end(), w);
    if (wants_bounds) std::copy(from.low.begin(), from.low.end(), low);
    if (wants_bounds) std::copy(from.high.begin(), from.high.end(), high);
    if (wants_equations) std::copy(from.equation.begin(), from.equation.end(), equations);
    return true;
  }
  bool eval_f(Index, const Number* w, bool, Number& value) override {
    const Stopwatch stopwatch(rows.time_in_functions);
    go_to(w);
    value = 0.0;
    for (int k = 0; k <= horizon_; ++k) {
      rows.template each_residual<double>(k, [&](double r) { value += 0.5 * r * r; });
      each_slack(k, [&](int at, const auto& penalty) {
        value += w[at] * (penalty.linear + 0.5 * penalty.quadratic * w[at]);
      });
    }
    return true;
  }
  bool eval_grad_f(Index n, const Number* w, bool, Number* gradient) override {
    const Stopwatch stopwatch(rows.time_in_functions);
    go_to(w);
    std::fill(gradient, gradient + n, 0.0);
    for (int k = 0; k <= horizon_; ++k) {
      rows.template each_residual<First>(k, [&](const First& r) {
        each_slope(k, r, [&](int at, double slope) { gradient[at] += r.v * slope; });
      });
      each_slack(
          k, [&](int at, const auto& penalty) { gradient[at] = penalty.linear + penalty.quadratic * w[at]; });
    }
    return true;
  }
  bool eval_g(Index, const Number* w, bool, Index, Number* g) override {
    const Stopwatch stopwatch(rows.time_in_functions);
    go_to(w);
    for (int k = 0; k <= horizon_; ++k) {
      rows.template each_row<double>(k, [&](Kind kind, int n, double value) {
        const int less = less_of(k, kind, n);
        g[row_of(k, kind, n)] = less < 0 ? value : value - w[less];
      });
    }
    return true;
  }
  bool eval_jac_g(Index, const Number* w, bool, Index, Index, Index* lines, Index* columns,
                  Number* values) override {
    const Stopwatch stopwatch(rows.time_in_functions);
    go_to(w);
    visit_jacobian(Entries{lines, columns, values});
    return true;
  }
  bool eval_h(Index, const Number* w, bool, Number factor, Index, const Number* multipliers, bool, Index,
              Index* lines, Index* columns, Number* values) override {
    const Stopwatch stopwatch(rows.time_in_functions);
    go_to(w);
    visit_hessian(factor, multipliers, Entries{lines, columns, values});
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* w, const Number* low, const Number* high,
                         Index m, const Number*, const Number* equations, Number value,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    point_.assign(w, w + n);
    cost = value;
    end_multipliers = {{low, low + n}, {high, high + n}, {equations, equations + m}};
  }

 private:
  using First = typename Rows::First;
  using Kind = typename Rows::Kind;

  /// Writes values, or where they are.
  struct Entries {
    Index *lines, *columns;
    Number* values;
    mutable int next = 0;
    void operator()(int line, int column, double value) const {
      if (values != nullptr) {
        values[next] = value;
      } else {
        lines[next] = line;
        columns[next] = column;
      }
      ++next;
    }
  };
  /// Calls put(line, column, value) for the same entries in the same order each time.
  template <class Put>
  void visit_jacobian(const Put& put) const {
    for (int k = 0; k <= horizon_; ++k) {
      rows.template each_row<First>(k, [&](Kind kind, int n, const First& value) {
        const int row = row_of(k, kind, n), less = less_of(k, kind, n);
        each_slope(k, value, [&](int at, double slope) { put(row, at, slope); });
        if (less >= 0) put(row, less, -1.0);
      });
    }
  }
  /// The same of the lower triangle of the Lagrangian's Hessian; multipliers may be null.
  template <class Put>
  void visit_hessian(double factor, const Number* multipliers, const Put& put) const {
    using Second = typename Rows::Second;
    for (int k = 0; k <= horizon_; ++k) {
      Second lagrangian(0.0);
      rows.template each_residual<Second>(k, [&](const Second& r) { lagrangian += (0.5 * factor) * r * r; });
      rows.template each_row<Second>(k, [&](Kind kind, int n, const Second& value) {
        lagrangian += (multipliers == nullptr ? 0.0 : multipliers[row_of(k, kind, n)]) * value;
      });
      each_slack(k, [&](int at, const auto& penalty) { put(at, at, factor * penalty.quadratic); });
      for (int a = k > 0 ? 0 : kNx; a < variables(k); ++a) {
        each_slope(
            k, lagrangian.d[static_cast<std::size_t>(a)],
            [&](int at, double slope) { put(position(k, a), at, slope); }, a + 1);
      }
    }
  }

  static int at_u(int k) { return k * kNz; }
  static int at_x(int k) { return (k - 1) * kNz + kNu; }
  [[nodiscard]] int at_s(int k) const { return horizon_ * kNz + k * kNc; }
  [[nodiscard]] int terminal_row(int n) const { return horizon_ * (kNx + kNc + kNh) + n; }
  [[nodiscard]] int row_of(int k, Kind kind, int n) const {
    const bool is_limit = kind == Rows::kLimit;
    if (k == horizon_) return terminal_row(is_limit ? kNeh + n : n);
    if (kind == Rows::kDynamics) return k * kNx + n;
    return is_limit ? horizon_ * kNx + k * kNc + n : horizon_ * (kNx + kNc) + k * kNh + n;
  }
  /// Which unknown is subtracted from a row: the next state, a slack; −1: none.
  [[nodiscard]] int less_of(int k, Kind kind, int n) const {
    if (k == horizon_ || kind == Rows::kEquation) return -1;
    return (kind == Rows::kDynamics ? at_x(k + 1) : at_s(k)) + n;
  }
  /// Of a stage: x_k and u_k, at the end x_N.
  [[nodiscard]] int variables(int k) const { return k < horizon_ ? kNz : kNx; }
  /// Where variable v of (x_k, u_k) stands among the unknowns; x_0 is none.
  static int position(int k, int v) { return v >= kNx ? at_u(k) + v - kNx : at_x(k) + v; }

  /// Puts the functions to these variables, if there are any.
  void go_to(const Number* w) {
    for (int k = 0; k < horizon_ && w != nullptr; ++k) {
      const auto stage = static_cast<std::size_t>(k);
      std::copy_n(w + at_u(k), kNu, rows.at.u[stage].begin());
      std::copy_n(w + at_x(k + 1), kNx, rows.at.x[stage + 1].begin());
    }
  }
  /// Calls visit(position, slope) for the unknowns of stage k, or the first ones of its variables.
  template <class Visit>
  void each_slope(int k, const First& value, const Visit& visit, int count = kNz) const {
    for (int v = k > 0 ? 0 : kNx; v < std::min(count, variables(k)); ++v)
      visit(position(k, v), value.d[static_cast<std::size_t>(v)]);
  }
  /// Calls visit(position, penalty) for the slacks of stage k.
  template <class Visit>
  void each_slack([[maybe_unused]] int k, [[maybe_unused]] const Visit& visit) const {
    if constexpr (kNc > 0) {
      for (int c = 0; k < horizon_ && c < kNc; ++c) visit(at_s(k) + c, rows.problem.soft_penalty(c));
    }
  }

  int horizon_ = 0;
  std::vector<double> point_;  ///< all variables: where a solve starts, then its solution
};

/// Ipopt for one type of problems, set up once: tolerance 1e-6 as ours, its defaults otherwise, bounds as
/// they are.
template <solver::OcpProblem P, int Capacity>
class IpoptSolver {
 public:
  using State = std::array<double, P::kNx>;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;

  /// The trajectory is the start; then the optimum, or as it was.
  Outcome solve(const P& problem, const State& x0, Trajectory& t) { return run(*app_, problem, x0, t); }
  /// Keeps the multipliers of the last answer, shifted by one interval, for solve_warm().
  void remember() {
    nlp_->start_multipliers = nlp_->end_multipliers;
    nlp_->shift(nlp_->start_multipliers);
  }
  /// Starts from the remembered multipliers, too, with a barrier of 1e-5.
  Outcome solve_warm(const P& problem, const State& x0, Trajectory& t) {
    return run(*warm_app_, problem, x0, t);
  }

 private:
  using App = Ipopt::SmartPtr<Ipopt::IpoptApplication>;
  using Nlp = IpoptProblem<P, Capacity>;

  Outcome run(Ipopt::IpoptApplication& app, const P& problem, const State& x0, Trajectory& t) {
    nlp_->pose(problem, x0, t);
    Outcome report;
    const double begin = cpu_time();
    const auto status = app.OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(nlp_)));
    report.time = cpu_time() - begin;
    report.time_in_functions = nlp_->rows.time_in_functions;
    report.is_solved = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
    if (Ipopt::IsValid(app.Statistics())) report.iterations = app.Statistics()->IterationCount();
    report.is_impossible = status == Ipopt::Infeasible_Problem_Detected;
    if (report.is_solved || report.is_impossible) nlp_->give_solution(t);
    return report;
  }

  Ipopt::SmartPtr<Nlp> nlp_{new Nlp};
  App app_ = make_ipopt(false), warm_app_ = make_ipopt(true);
};

/// The trajectory's inputs and states are the start; on success they are the optimum to 1e-9 and its cost is
/// returned, else NaN. Acceptable points of Ipopt count as failures: they may break constraints by 1e-2.
template <solver::OcpProblem P, int Capacity>
double solve_with_ipopt(const P& problem, const std::array<double, P::kNx>& x0,
                        solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
  using Nlp = IpoptProblem<P, Capacity>;
  const Ipopt::SmartPtr<Nlp> nlp = new Nlp;
  nlp->pose(problem, x0, t);
  const auto app = make_ipopt(false, 1e-9);
  app->Options()->SetIntegerValue("acceptable_iter", 0);
  const auto status = app->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(nlp)));
  if (status != Ipopt::Solve_Succeeded) return std::nan("");
  nlp->give_solution(t);
  return nlp->cost;
}

}  // namespace chicane::bench
