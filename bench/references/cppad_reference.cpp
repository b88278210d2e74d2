// SPDX-License-Identifier: MIT
#include "references/cppad_reference.hpp"

#include <iostream>

// The CppAD of r-cran-tmb expects these five from R.
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

/// Where the variables of a problem with `nodes` states begin.
struct Layout {
  std::size_t nodes;
  [[nodiscard]] std::size_t state(std::size_t i, std::size_t k) const { return i * nodes + k; }
  [[nodiscard]] std::size_t steer(std::size_t k) const { return 6 * nodes + k; }
  [[nodiscard]] std::size_t throttle(std::size_t k) const { return 7 * nodes - 1 + k; }
  [[nodiscard]] std::size_t size() const { return 8 * nodes - 2; }
};

/// Cost and equations, as in the template.
struct FgEval {
  using ADvector = CPPAD_TESTVECTOR(CppAD::AD<double>);
  const DescribedProblem& problem;
  Layout at;

  void operator()(ADvector& fg, const ADvector& vars) const {
    using CppAD::atan;
    using CppAD::cos;
    using CppAD::pow;
    using CppAD::sin;
    constexpr double dt = DescribedProblem::kStep;
    constexpr double Lf = DescribedProblem::kLength;
    const std::size_t N = at.nodes;
    const auto& c = problem.path;
    fg[0] = 0.0;
    for (std::size_t t = 0; t < N; ++t) {
      fg[0] += 200.0 * pow(vars[at.state(4, t)], 2);
      fg[0] += 200.0 * pow(vars[at.state(5, t)], 2);
      fg[0] += 0.1 * pow(vars[at.state(3, t)] - problem.speed_reference, 2);
    }
    for (std::size_t t = 0; t + 1 < N; ++t) {
      fg[0] += pow(vars[at.steer(t)], 2);
      fg[0] += pow(vars[at.throttle(t)], 2);
    }
    for (std::size_t t = 0; t + 2 < N; ++t) {
      fg[0] += 10.0 * pow(vars[at.steer(t + 1)] - vars[at.steer(t)], 2);
      fg[0] += pow(vars[at.throttle(t + 1)] - vars[at.throttle(t)], 2);
    }
    for (std::size_t i = 0; i < 6; ++i) fg[1 + at.state(i, 0)] = vars[at.state(i, 0)];
    for (std::size_t t = 1; t < N; ++t) {
      const auto x = vars[at.state(0, t - 1)];
      const auto y = vars[at.state(1, t - 1)];
      const auto psi = vars[at.state(2, t - 1)];
      const auto v = vars[at.state(3, t - 1)];
      const auto epsi = vars[at.state(5, t - 1)];
      const auto delta = vars[at.steer(t - 1)];
      const auto f = c[0] + c[1] * x + c[2] * pow(x, 2) + c[3] * pow(x, 3);
      const auto psides = atan(c[1] + 2.0 * c[2] * x + 3.0 * c[3] * pow(x, 2));
      fg[1 + at.state(0, t)] = vars[at.state(0, t)] - (x + v * cos(psi) * dt);
      fg[1 + at.state(1, t)] = vars[at.state(1, t)] - (y + v * sin(psi) * dt);
      fg[1 + at.state(2, t)] = vars[at.state(2, t)] - (psi + v * delta / Lf * dt);
      fg[1 + at.state(3, t)] = vars[at.state(3, t)] - (v + vars[at.throttle(t - 1)] * dt);
      fg[1 + at.state(4, t)] = vars[at.state(4, t)] - ((f - y) + v * sin(epsi) * dt);
      fg[1 + at.state(5, t)] = vars[at.state(5, t)] - ((psi - psides) + v * delta / Lf * dt);
    }
  }
};

class CppadReference final : public Reference<DescribedProblem> {
 public:
  [[nodiscard]] std::string_view name() const override { return "cppad"; }
  [[nodiscard]] Outcome solve(const Instance& now, const Instance*, Trajectory& answer) override {
    using Dvector = CPPAD_TESTVECTOR(double);
    const auto horizon = static_cast<std::size_t>(now.guess.horizon);
    const Layout at{horizon + 1};
    Dvector start(at.size());
    Dvector low(at.size());
    Dvector high(at.size());
    Dvector g_low(6 * at.nodes);
    Dvector g_high(6 * at.nodes);
    for (std::size_t k = 0; k <= horizon; ++k) {
      const auto& x = k == 0 ? now.start : now.guess.x[k];
      for (std::size_t i = 0; i < 6; ++i) {
        start[at.state(i, k)] = x[i];
        low[at.state(i, k)] = -1e19;
        high[at.state(i, k)] = 1e19;
        g_low[at.state(i, k)] = g_high[at.state(i, k)] = k == 0 ? x[i] : 0.0;
      }
      if (k == horizon) break;
      const auto lower = now.problem.input_lower(static_cast<int>(k));
      const auto upper = now.problem.input_upper(static_cast<int>(k));
      start[at.steer(k)] = now.guess.u[k][0];
      start[at.throttle(k)] = now.guess.u[k][1];
      low[at.steer(k)] = lower[0];
      high[at.steer(k)] = upper[0];
      low[at.throttle(k)] = lower[1];
      high[at.throttle(k)] = upper[1];
    }
    const std::string options =
        "Integer print_level  0\nString  sb           yes\nSparse  true         forward\n"
        "Sparse  true         reverse\nNumeric max_cpu_time 10\nNumeric tol          1e-6\n"
        "Numeric bound_relax_factor 0\n";
    FgEval fg{now.problem, at};
    CppAD::ipopt::solve_result<Dvector> solution;
    Outcome outcome;
    const double begin = cpu_time();
    CppAD::ipopt::solve<Dvector, FgEval>(options, start, low, high, g_low, g_high, fg, solution);
    outcome.time = cpu_time() - begin;
    outcome.is_solved = solution.status == CppAD::ipopt::solve_result<Dvector>::success ||
                        solution.status == CppAD::ipopt::solve_result<Dvector>::stop_at_acceptable_point;
    answer = now.guess;
    for (std::size_t k = 0; outcome.is_solved && k < horizon; ++k)
      answer.u[k] = {solution.x[at.steer(k)], solution.x[at.throttle(k)]};
    return outcome;
  }
};

}  // namespace

void add_cppad(References& references) {
  references.described.push_back(std::make_unique<CppadReference>());
  references.versions +=
      std::string(references.versions.empty() ? "" : ", ") + "CppAD of r-cran-tmb (" CPPAD_PACKAGE_STRING ")";
}

}  // namespace chicane::bench
