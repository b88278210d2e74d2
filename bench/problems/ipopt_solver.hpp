// SPDX-License-Identifier: MIT
#pragma once

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <vector>

#include "problems/cpu_time.hpp"

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

/// Multipliers of lower and upper bounds, and of the equations.
struct Multipliers {
  std::vector<double> low, high, equation;
};

/// A sparse nonlinear program for Ipopt (Wächter, Biegler 2006). `Own` gives sizes(n, m), get_bounds_info()
/// and, of all variables w: cost_at(w), add_gradient(w, g), set_equations(w, g), visit_jacobian(w, put) and
/// visit_hessian(w, factor, multipliers, put), which call put(row, column, value) for the same entries in the
/// same order each time; w and multipliers may be null.
template <class Own>
class SparseNlp : public Ipopt::TNLP {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;

  std::vector<double> start, solution;  ///< of all variables
  double cost = 0.0;                    ///< of the solution
  Multipliers start_multipliers;        ///< asked for by warm_start_init_point
  Multipliers end_multipliers;          ///< of the solution
  double time_in_functions = 0.0;       ///< CPU time of values and derivatives [s]

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    own().sizes(n, m);
    jacobian = hessian = 0;
    own().visit_jacobian(nullptr, [&](int, int, double) { ++jacobian; });
    own().visit_hessian(nullptr, 0.0, nullptr, [&](int, int, double) { ++hessian; });
    style = C_STYLE;
    return true;
  }
  bool get_starting_point(Index, bool, Number* w, bool wants_bounds, Number* low, Number* high, Index,
                          bool wants_equations, Number* equations) override {
    std::copy(start.begin(), start.end(), w);
    if (wants_bounds) {
      std::copy(start_multipliers.low.begin(), start_multipliers.low.end(), low);
      std::copy(start_multipliers.high.begin(), start_multipliers.high.end(), high);
    }
    if (wants_equations)
      std::copy(start_multipliers.equation.begin(), start_multipliers.equation.end(), equations);
    return true;
  }
  bool eval_f(Index, const Number* w, bool, Number& value) override {
    const Stopwatch stopwatch(time_in_functions);
    value = own().cost_at(w);
    return true;
  }
  bool eval_grad_f(Index n, const Number* w, bool, Number* gradient) override {
    const Stopwatch stopwatch(time_in_functions);
    std::fill(gradient, gradient + n, 0.0);
    own().add_gradient(w, gradient);
    return true;
  }
  bool eval_g(Index, const Number* w, bool, Index, Number* g) override {
    const Stopwatch stopwatch(time_in_functions);
    own().set_equations(w, g);
    return true;
  }
  bool eval_jac_g(Index, const Number* w, bool, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    const Stopwatch stopwatch(time_in_functions);
    own().visit_jacobian(w, Entries{rows, columns, values});
    return true;
  }
  bool eval_h(Index, const Number* w, bool, Number factor, Index, const Number* multipliers, bool, Index,
              Index* rows, Index* columns, Number* values) override {
    const Stopwatch stopwatch(time_in_functions);
    own().visit_hessian(w, factor, multipliers, Entries{rows, columns, values});
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* w, const Number* low, const Number* high,
                         Index m, const Number*, const Number* equations, Number value,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    solution.assign(w, w + n);
    cost = value;
    end_multipliers = {{low, low + n}, {high, high + n}, {equations, equations + m}};
  }

 private:
  /// Writes values, or where they are.
  struct Entries {
    Index *rows, *columns;
    Number* values;
    mutable int next = 0;
    void operator()(int row, int column, double value) const {
      if (values != nullptr) {
        values[next] = value;
      } else {
        rows[next] = row;
        columns[next] = column;
      }
      ++next;
    }
  };
  Own& own() { return static_cast<Own&>(*this); }
};

/// Ipopt for one type of nonlinear programs, set up once.
template <class Nlp>
class IpoptRunner {
 public:
  /// The trajectory is the start; then the optimum, or as it was.
  template <class P, class X, class Trajectory>
  Outcome solve(const P& problem, const X& x0, Trajectory& t) {
    return run(*app_, problem, x0, t);
  }
  /// Keeps the multipliers of the last answer, shifted by one interval, for solve_warm().
  void remember() {
    nlp_->start_multipliers = nlp_->end_multipliers;
    nlp_->shift(nlp_->start_multipliers);
  }
  /// Starts from the remembered multipliers, too, with a barrier of 1e-5.
  template <class P, class X, class Trajectory>
  Outcome solve_warm(const P& problem, const X& x0, Trajectory& t) {
    return run(*warm_app_, problem, x0, t);
  }

 private:
  using App = Ipopt::SmartPtr<Ipopt::IpoptApplication>;

  template <class P, class X, class Trajectory>
  Outcome run(Ipopt::IpoptApplication& app, const P& problem, const X& x0, Trajectory& t) {
    nlp_->pose(problem, x0, t);
    nlp_->time_in_functions = 0.0;
    Outcome report;
    const double begin = cpu_time();
    const auto status = app.OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(nlp_)));
    report.time = cpu_time() - begin;
    report.time_in_functions = nlp_->time_in_functions;
    report.is_solved = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
    if (Ipopt::IsValid(app.Statistics())) report.iterations = app.Statistics()->IterationCount();
    report.is_impossible = status == Ipopt::Infeasible_Problem_Detected;
    if (report.is_solved || report.is_impossible) nlp_->give_solution(t);
    return report;
  }

  Ipopt::SmartPtr<Nlp> nlp_{new Nlp};
  App app_ = make_ipopt(false), warm_app_ = make_ipopt(true);
};

}  // namespace chicane::bench
