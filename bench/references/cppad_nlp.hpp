// SPDX-License-Identifier: MIT
// The described problem for CppAD and Ipopt, as in the course's template. Needs the headers of CppAD; each
// source file that includes this one is compiled without warnings (bench/CMakeLists.txt).
#pragma once

#include <array>
#include <cstddef>
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

namespace chicane::bench {

/// What tells one described problem from another.
struct DescribedTerms {
  double dt = 0.1;                    ///< [s]
  double turn_per_metre = 0.0;        ///< ± 1 / L_f [1/m]
  double speed_reference = 0.0;       ///< as the model's v
  double error_sign = 1.0;            ///< of the last term of cte
  double heading_reach = 1.0;         ///< of the desired yaw (controller/cubic_problem.hpp)
  bool is_lateral_recursive = false;  ///< cte⁺ = cte + v sin eψ dt
  std::array<double, 8> weights{};    ///< of cte, eψ, v, δ, a, Δδ, Δa, v δ
  std::array<double, 4> line{};       ///< coefficients, from the constant on
  bool acts_late = false;             ///< the inputs of a stage act in the next one
  std::array<double, 2> last{};       ///< the inputs before the first, where they act late
};

/// Where the variables of a problem with `nodes` states begin: x, y, ψ, v, cte, eψ, δ, a.
struct CppadLayout {
  std::size_t nodes;
  [[nodiscard]] std::size_t state(std::size_t i, std::size_t k) const { return i * nodes + k; }
  [[nodiscard]] std::size_t steer(std::size_t k) const { return 6 * nodes + k; }
  [[nodiscard]] std::size_t throttle(std::size_t k) const { return 7 * nodes - 1 + k; }
  [[nodiscard]] std::size_t size() const { return 8 * nodes - 2; }
};

/// Cost and equations.
class CppadProblem {
 public:
  using ADvector = CPPAD_TESTVECTOR(CppAD::AD<double>);

  CppadProblem(const DescribedTerms& terms, const CppadLayout& layout) : terms_{terms}, at_{layout} {}

  void operator()(ADvector& fg, const ADvector& vars) const {
    fg[0] = 0.0;
    add_cost(fg[0], vars);
    for (std::size_t i = 0; i < 6; ++i) fg[1 + at_.state(i, 0)] = vars[at_.state(i, 0)];
    for (std::size_t t = 1; t < at_.nodes; ++t) add_equations(fg, vars, t);
  }

 private:
  using Number = CppAD::AD<double>;

  void add_cost(Number& cost, const ADvector& vars) const {
    using CppAD::pow;
    const auto& w = terms_.weights;
    for (std::size_t t = 0; t < at_.nodes; ++t) {
      cost += w[0] * pow(vars[at_.state(4, t)], 2);
      cost += w[1] * pow(vars[at_.state(5, t)], 2);
      cost += w[2] * pow(vars[at_.state(3, t)] - terms_.speed_reference, 2);
    }
    for (std::size_t t = 0; t + 1 < at_.nodes; ++t) {
      cost += w[3] * pow(vars[at_.steer(t)], 2);
      cost += w[4] * pow(vars[at_.throttle(t)], 2);
      if (w[7] > 0.0) cost += w[7] * pow(vars[at_.state(3, t)] * vars[at_.steer(t)], 2);
    }
    for (std::size_t t = 0; t + 2 < at_.nodes; ++t) {
      cost += w[5] * pow(vars[at_.steer(t + 1)] - vars[at_.steer(t)], 2);
      cost += w[6] * pow(vars[at_.throttle(t + 1)] - vars[at_.throttle(t)], 2);
    }
  }

  void add_equations(ADvector& fg, const ADvector& vars, std::size_t t) const {
    using CppAD::atan;
    using CppAD::cos;
    using CppAD::pow;
    using CppAD::sin;
    const double dt = terms_.dt;
    const auto& c = terms_.line;
    const Number x = vars[at_.state(0, t - 1)];
    const Number y = vars[at_.state(1, t - 1)];
    const Number psi = vars[at_.state(2, t - 1)];
    const Number v = vars[at_.state(3, t - 1)];
    const Number epsi = vars[at_.state(5, t - 1)];
    const bool is_late = terms_.acts_late;
    const Number steer = !is_late ? vars[at_.steer(t - 1)]
                         : t > 1  ? vars[at_.steer(t - 2)]
                                  : Number(terms_.last[0]);
    const Number throttle = !is_late ? vars[at_.throttle(t - 1)]
                            : t > 1  ? vars[at_.throttle(t - 2)]
                                     : Number(terms_.last[1]);
    const Number turn = v * steer * (terms_.turn_per_metre * dt);
    const Number f = c[0] + c[1] * x + c[2] * pow(x, 2) + c[3] * pow(x, 3);
    const Number at = x * terms_.heading_reach;
    const Number desired = atan(c[1] + 2.0 * c[2] * at + 3.0 * c[3] * pow(at, 2));
    fg[1 + at_.state(0, t)] = vars[at_.state(0, t)] - (x + v * cos(psi) * dt);
    fg[1 + at_.state(1, t)] = vars[at_.state(1, t)] - (y + v * sin(psi) * dt);
    fg[1 + at_.state(2, t)] = vars[at_.state(2, t)] - (psi + turn);
    fg[1 + at_.state(3, t)] = vars[at_.state(3, t)] - (v + throttle * dt);
    const Number cte = terms_.is_lateral_recursive ? vars[at_.state(4, t - 1)] : f - y;
    fg[1 + at_.state(4, t)] = vars[at_.state(4, t)] - (cte + v * sin(epsi) * (terms_.error_sign * dt));
    fg[1 + at_.state(5, t)] = vars[at_.state(5, t)] - ((psi - desired) + turn);
  }

  const DescribedTerms& terms_;
  CppadLayout at_;
};

using CppadVector = CPPAD_TESTVECTOR(double);
using CppadSolution = CppAD::ipopt::solve_result<CppadVector>;

/// One solve from `start`, whose first states hold; `options`: lines that are added to the template's.
inline CppadSolution solve_with_cppad(const DescribedTerms& terms, const CppadLayout& at,
                                      const CppadVector& start, double steer_limit,
                                      const std::string& options) {
  CppadVector low(at.size()), high(at.size()), g(6 * at.nodes);
  for (std::size_t i = 0; i < at.size(); ++i) low[i] = -1e19, high[i] = 1e19;
  for (std::size_t i = 0; i < 6 * at.nodes; ++i) g[i] = 0.0;
  for (std::size_t i = 0; i < 6; ++i) g[at.state(i, 0)] = start[at.state(i, 0)];
  for (std::size_t k = 0; k + 1 < at.nodes; ++k) {
    low[at.steer(k)] = -steer_limit;
    high[at.steer(k)] = steer_limit;
    low[at.throttle(k)] = -1.0;
    high[at.throttle(k)] = 1.0;
  }
  const std::string all =
      "Integer print_level  0\nString  sb           yes\nSparse  true         forward\n"
      "Sparse  true         reverse\n" +
      options;
  CppadProblem problem{terms, at};
  CppadSolution solution;
  CppAD::ipopt::solve<CppadVector, CppadProblem>(all, start, low, high, g, g, problem, solution);
  return solution;
}

[[nodiscard]] inline bool is_solved(const CppadSolution& solution) {
  return solution.status == CppadSolution::success ||
         solution.status == CppadSolution::stop_at_acceptable_point;
}

}  // namespace chicane::bench
