// SPDX-License-Identifier: MIT
#include "stack/cppad_solver.hpp"

#include <algorithm>
#include <iostream>
#include <string>

// The CppAD of r-cran-tmb expects these from R.
#define CSKIP(...) __VA_ARGS__
static std::ostream& Rcout = std::cout;
template <class T>
struct isDouble {
  enum { value = false };
};
template <>
struct isDouble<double> {
  enum { value = true };
};
#include <cppad/cppad.hpp>
#include <cppad/ipopt/solve.hpp>

#include "problems/cpu_time.hpp"

namespace chicane::bench {
namespace {

using controller::CubicProblem;
using controller::CubicTrajectory;

/// Where the variables of a problem with `nodes` states begin: x, y, ψ, v, cte, eψ, δ, a.
struct Layout {
  std::size_t nodes;
  [[nodiscard]] std::size_t state(std::size_t i, std::size_t k) const { return i * nodes + k; }
  [[nodiscard]] std::size_t steer(std::size_t k) const { return 6 * nodes + k; }
  [[nodiscard]] std::size_t throttle(std::size_t k) const { return 7 * nodes - 1 + k; }
  [[nodiscard]] std::size_t size() const { return 8 * nodes - 2; }
};

/// Cost and equations, as in the course's template.
struct FgEval {
  using ADvector = CPPAD_TESTVECTOR(CppAD::AD<double>);
  const CubicProblem& problem;
  const CubicProblem::State& begin;
  Layout at;

  void operator()(ADvector& fg, const ADvector& vars) const {
    fg[0] = 0.0;
    add_cost(fg[0], vars);
    for (std::size_t i = 0; i < 6; ++i) fg[1 + at.state(i, 0)] = vars[at.state(i, 0)];
    for (std::size_t t = 1; t < at.nodes; ++t) add_equations(fg, vars, t);
  }

 private:
  /// The residuals of CubicProblem carry √(2 weight).
  [[nodiscard]] double weight(std::size_t i) const { return 0.5 * problem.root[i] * problem.root[i]; }

  void add_cost(CppAD::AD<double>& cost, const ADvector& vars) const {
    using CppAD::pow;
    const std::size_t nodes = at.nodes;
    for (std::size_t t = 0; t < nodes; ++t) {
      cost += weight(0) * pow(vars[at.state(4, t)], 2);
      cost += weight(1) * pow(vars[at.state(5, t)], 2);
      cost += weight(2) * pow(vars[at.state(3, t)] - problem.speed_reference, 2);
    }
    for (std::size_t t = 0; t + 1 < nodes; ++t) {
      cost += weight(3) * pow(vars[at.steer(t)], 2);
      cost += weight(4) * pow(vars[at.throttle(t)], 2);
      cost += weight(7) * pow(vars[at.state(3, t)] * vars[at.steer(t)], 2);
    }
    for (std::size_t t = 0; t + 2 < nodes; ++t) {
      cost += weight(5) * pow(vars[at.steer(t + 1)] - vars[at.steer(t)], 2);
      cost += weight(6) * pow(vars[at.throttle(t + 1)] - vars[at.throttle(t)], 2);
    }
  }

  void add_equations(ADvector& fg, const ADvector& vars, std::size_t t) const {
    using CppAD::atan;
    using CppAD::cos;
    using CppAD::pow;
    using CppAD::sin;
    using Number = CppAD::AD<double>;
    const double dt = problem.dt;
    const auto& c = problem.line.c;
    const Number x = vars[at.state(0, t - 1)];
    const Number y = vars[at.state(1, t - 1)];
    const Number psi = vars[at.state(2, t - 1)];
    const Number v = vars[at.state(3, t - 1)];
    const Number epsi = vars[at.state(5, t - 1)];
    const bool is_late = problem.acts_late;
    const Number steer = !is_late ? vars[at.steer(t - 1)] : t > 1 ? vars[at.steer(t - 2)] : Number(begin[5]);
    const Number throttle = !is_late ? vars[at.throttle(t - 1)]
                            : t > 1  ? vars[at.throttle(t - 2)]
                                     : Number(begin[6]);
    const Number turn = v * steer * (problem.turn_per_metre * dt);
    const Number f = c[0] + c[1] * x + c[2] * pow(x, 2) + c[3] * pow(x, 3);
    const Number desired = atan(c[1] + 2.0 * c[2] * x + 3.0 * c[3] * pow(x, 2));
    fg[1 + at.state(0, t)] = vars[at.state(0, t)] - (x + v * cos(psi) * dt);
    fg[1 + at.state(1, t)] = vars[at.state(1, t)] - (y + v * sin(psi) * dt);
    fg[1 + at.state(2, t)] = vars[at.state(2, t)] - (psi + turn);
    fg[1 + at.state(3, t)] = vars[at.state(3, t)] - (v + throttle * dt);
    fg[1 + at.state(4, t)] = vars[at.state(4, t)] - ((f - y) + v * sin(epsi) * (problem.error_sign * dt));
    fg[1 + at.state(5, t)] = vars[at.state(5, t)] - ((psi - desired) + turn);
  }
};

class CppadSolver final : public controller::CubicSolver, public SolveClock {
 public:
  [[nodiscard]] double last() const noexcept override { return last_; }

  solver::SolveReport solve(const CubicProblem& problem, const CubicProblem::State& begin,
                            CubicTrajectory& answer, Deadline /*deadline*/) noexcept override {
    const double started = cpu_time();
    const solver::SolveReport report = solved(problem, begin, answer);
    last_ = cpu_time() - started;
    return report;
  }

 private:
  using Vector = CPPAD_TESTVECTOR(double);

  static solver::SolveReport solved(const CubicProblem& problem, const CubicProblem::State& begin,
                                    CubicTrajectory& answer) {
    const auto horizon = static_cast<std::size_t>(answer.horizon);
    const Layout at{horizon + 1};
    Vector start(at.size()), low(at.size()), high(at.size());
    Vector g_low(6 * at.nodes), g_high(6 * at.nodes);
    for (std::size_t i = 0; i < at.size(); ++i) start[i] = 0.0, low[i] = -1e19, high[i] = 1e19;
    for (std::size_t i = 0; i < 6 * at.nodes; ++i) g_low[i] = g_high[i] = 0.0;
    const double first[6] = {begin[0], begin[1], begin[2], begin[3], problem.first_lateral_error, begin[4]};
    for (std::size_t i = 0; i < 6; ++i)
      start[at.state(i, 0)] = g_low[at.state(i, 0)] = g_high[at.state(i, 0)] = first[i];
    for (std::size_t k = 0; k < horizon; ++k) {
      low[at.steer(k)] = -problem.steer_limit;
      high[at.steer(k)] = problem.steer_limit;
      low[at.throttle(k)] = -1.0;
      high[at.throttle(k)] = 1.0;
    }
    const std::string options =
        "Integer print_level  0\nString  sb           yes\nSparse  true         forward\n"
        "Sparse  true         reverse\nNumeric max_cpu_time 10\n";
    FgEval fg{problem, begin, at};
    CppAD::ipopt::solve_result<Vector> solution;
    CppAD::ipopt::solve<Vector, FgEval>(options, start, low, high, g_low, g_high, fg, solution);
    return read(solution, at, begin, answer);
  }

  static solver::SolveReport read(const CppAD::ipopt::solve_result<Vector>& solution, const Layout& at,
                                  const CubicProblem::State& begin, CubicTrajectory& answer) {
    solver::SolveReport report;
    using Result = CppAD::ipopt::solve_result<Vector>;
    const bool is_solved =
        solution.status == Result::success || solution.status == Result::stop_at_acceptable_point;
    report.status = is_solved ? solver::SolveStatus::kOptimal : solver::SolveStatus::kStalled;
    if (!is_solved) return report;
    report.cost = solution.obj_value;
    for (std::size_t k = 0; k < at.nodes; ++k) {
      auto& x = answer.x[k];
      for (std::size_t i = 0; i < 4; ++i) x[i] = solution.x[at.state(i, k)];
      x[4] = solution.x[at.state(5, k)];
      x[5] = k == 0 ? begin[5] : answer.u[k - 1][0];
      x[6] = k == 0 ? begin[6] : answer.u[k - 1][1];
      if (k + 1 == at.nodes) break;
      // Ipopt relaxes bounds by 1e-8.
      answer.u[k] = {solution.x[at.steer(k)], std::clamp(solution.x[at.throttle(k)], -1.0, 1.0)};
    }
    return report;
  }

  double last_ = 0.0;
};

}  // namespace

TimedSolver make_cppad_solver() {
  auto solver = std::make_unique<CppadSolver>();
  const SolveClock* clock = solver.get();
  return {std::move(solver), clock};
}

}  // namespace chicane::bench
