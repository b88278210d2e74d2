// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

/// Optimal control problem over a closed road, made discrete by collocation, and its solution.

namespace chicane::lap_time {

/// Functions of the variables z of one node, in this order: rates of its states by arc length, equations (=
/// 0), cost by arc length, inequalities (>= 0). The first `states` of z are the states.
class NodeFunctions {
 public:
  int variables = 0, states = 0, equations = 0, inequalities = 0;  ///< their numbers
  std::vector<double> scale{};                                     ///< typical size of each variable

  NodeFunctions() = default;
  NodeFunctions(const NodeFunctions&) = default;
  NodeFunctions& operator=(const NodeFunctions&) = default;
  virtual ~NodeFunctions() = default;
  /// Number of functions.
  [[nodiscard]] int functions() const noexcept { return states + equations + 1 + inequalities; }
  /// Values of all functions.
  virtual void values(int node, const double* z, double* out) const = 0;
  /// Values, the Jacobian by rows, and the Hessian of the sum weighted by `weights` (lower triangle by rows).
  virtual void derivatives(int node, const double* z, const double* weights, double* out, double* jacobian,
                           double* hessian) const = 0;
};

/// min Σ cost over a ring of nodes with the trapezoidal rule between them (docs/limit.md, eq. 9), by a
/// primal-dual interior-point method with exact second derivatives and a filter (Wächter, Biegler 2006).
/// Deterministic. One thread.
class Collocation {
 public:
  struct Options {
    double tolerance = 1e-6;     ///< limit of stationarity, violation and complementarity, scaled
    double first_barrier = 0.1;  ///< μ at the start
    double last_barrier = 1e-8;  ///< μ at the end
    double cost_scale = 20.0;    ///< scale at which the cost of a node is about 1
    int most_iterations = 600;   ///< limit of iterations
    /// Progress callback: iteration, cost and largest violated equation; false ends the search. May be empty.
    std::function<bool(int, double, double)> go_on{};
    /// Early end: gets the variables and the largest violation before each iteration; true ends the search as
    /// solved before it reaches an optimum. May be empty.
    std::function<bool(const std::vector<double>&, double)> is_enough{};
  };
  struct Report {
    bool is_solved = false;   ///< an optimum within the tolerance, or Options::is_enough
    bool is_stopped = false;  ///< Options::go_on ended the search
    int iterations = 0;
    double cost = 0.0;          ///< sum of the costs
    double stationarity = 0.0;  ///< largest slope of the Lagrangian, scaled
    double violation = 0.0;     ///< largest violated equation or inequality, scaled
    double barrier = 0.0;       ///< μ
  };

  /// `steps`: length of the interval from node k to the next. `changes`: part of each state's change over the
  /// interval that is not the integral of its rate (nodes × states), such as the road's turning. `functions`
  /// must outlive this.
  Collocation(const NodeFunctions& functions, std::vector<double> steps, std::vector<double> changes);

  /// Solves from the nodes' variables `z`, one node after the other, and replaces them by the optimum's.
  Report solve(std::vector<double>& z, const Options& options);

 private:
  struct Iterate;
  class Search;

  const NodeFunctions& functions_;
  std::vector<double> steps_;
  std::vector<double> changes_;
};

}  // namespace chicane::lap_time
