// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

namespace chicane::lap_time {

/// Functions of the variables z of one node: rates of its states by arc length, equations that vanish, the
/// cost by arc length, and what must not be negative; in this order. The first `states` of z are the states.
class NodeFunctions {
 public:
  int variables = 0;
  int states = 0;
  int equations = 0;
  int inequalities = 0;
  std::vector<double> scale{};  ///< typical size of each variable

  NodeFunctions() = default;
  NodeFunctions(const NodeFunctions&) = default;
  NodeFunctions& operator=(const NodeFunctions&) = default;
  virtual ~NodeFunctions() = default;
  [[nodiscard]] int functions() const noexcept { return states + equations + 1 + inequalities; }
  virtual void values(int node, const double* z, double* out) const = 0;
  /// Also the Jacobian by rows and the Hessian (lower triangle by rows) of the sum weighted by `weights`.
  virtual void derivatives(int node, const double* z, const double* weights, double* out, double* jacobian,
                           double* hessian) const = 0;
};

/// min Σ cost over a ring of nodes with the trapezoidal rule between them (docs/limit.md, eq. 9), by a
/// primal-dual interior-point method with exact second derivatives and a filter (Wächter, Biegler 2006).
/// Deterministic. One thread.
class Collocation {
 public:
  struct Options {
    double tolerance = 1e-6;
    double first_barrier = 0.1;
    double last_barrier = 1e-8;
    double cost_scale = 20.0;  ///< so that the cost of a node is about one
    int most_iterations = 600;
    /// Called with iteration, cost and the largest violated equation; false ends the search. May be empty.
    std::function<bool(int, double, double)> go_on{};
    /// Called with the variables and the largest violation before each iteration; true ends the search as
    /// solved, where less than an optimum is enough. May be empty.
    std::function<bool(const std::vector<double>&, double)> is_enough{};
  };
  struct Report {
    bool is_solved = false;
    bool is_stopped = false;
    int iterations = 0;
    double cost = 0.0;
    double stationarity = 0.0;  ///< largest slope of the Lagrangian, scaled
    double violation = 0.0;     ///< largest violated equation or inequality, scaled
    double barrier = 0.0;
  };

  /// `steps`: length of the interval from node k to the next; `changes`: by how much each state's change over
  /// it is more than the integral of its rate (nodes × states), as a ring's turning. `functions` must outlive
  /// this.
  Collocation(const NodeFunctions& functions, std::vector<double> steps, std::vector<double> changes);

  /// From the nodes' variables `z` one after the other to those of the optimum.
  Report solve(std::vector<double>& z, const Options& options);

 private:
  struct Iterate;
  class Search;

  const NodeFunctions& functions_;
  std::vector<double> steps_;
  std::vector<double> changes_;
};

}  // namespace chicane::lap_time
