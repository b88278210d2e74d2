// SPDX-License-Identifier: MIT
#pragma once

#include <fatrop/fatrop.hpp>
#include <limits>
#include <memory>
#include <numeric>

#include "references/stage_rows.hpp"

namespace chicane::bench {

/// A problem for fatrop (Vanroye, Sathya, De Schutter, Decré 2023): x_0 is no variable, slacks of soft
/// constraints are inputs, exact Hessians.
template <solver::OcpProblem P, int Capacity>
class FatropProblem final : public fatrop::Nlp<fatrop::OcpType> {
 public:
  using Rows = StageRows<P, Capacity>;
  using Info = fatrop::ProblemInfo<fatrop::OcpType>;
  using Vec = fatrop::VecRealView;
  Rows rows;

  void set_sizes() {
    const int last = rows.at.horizon;
    const auto n = static_cast<std::size_t>(last);
    std::vector<int> nu(n + 1, P::kNu + rows.slacks), nx(n + 1, P::kNx),
        equations(n + 1, Rows::equations(false)), limits(n + 1, P::kNu + rows.slacks + P::kNc);
    nx[0] = nu[n] = 0;
    equations[n] = Rows::equations(true);
    limits[n] = Rows::limits(true);
    dims_ = std::make_unique<fatrop::ProblemDims<fatrop::OcpType>>(last + 1, nu, nx, equations, limits);
    const auto sum = [&](const std::vector<int>& of) { return std::accumulate(of.begin(), of.end(), 0); };
    sizes_ = {sum(nu) + sum(nx), sum(equations) + sum(limits) + last * P::kNx, sum(limits)};
  }
  const fatrop::NlpDims& nlp_dims() const override { return sizes_; }
  const fatrop::ProblemDims<fatrop::OcpType>& problem_dims() const override { return *dims_; }

  int eval_objective(const Info& info, double scale, const Vec& x, const Vec&, double& cost) override {
    const Stopwatch stopwatch(rows.time_in_functions);
    go_to(info, x);
    cost = 0.0;
    for (int k = 0; k <= rows.at.horizon; ++k)
      rows.template each_residual<double>(k, [&](double r) { cost += 0.5 * scale * r * r; });
    each_slack(info, [&](int at, int, const auto& penalty) {
      const double s = x.data()[at];
      cost += scale * s * (penalty.linear + 0.5 * penalty.quadratic * s);
    });
    return 0;
  }
  int eval_objective_gradient(const Info& info, double scale, const Vec& x, const Vec&, Vec& gradient,
                              Vec& by_slacks) override {
    const Stopwatch stopwatch(rows.time_in_functions);
    by_slacks = 0.0;
    gradient = 0.0;
    go_to(info, x);
    double* const g = gradient.data();
    for (int k = 0; k <= rows.at.horizon; ++k) {
      rows.template each_residual<First>(k, [&](const First& r) {
        each_variable(
            k, [&](std::size_t v, int at) { g[info.offsets_primal_u[k] + at] += scale * r.v * r.d[v]; });
      });
    }
    each_slack(info, [&](int at, int, const auto& penalty) {
      g[at] = scale * (penalty.linear + penalty.quadratic * x.data()[at]);
    });
    return 0;
  }
  int eval_constraint_violation(const Info& info, const Vec& x, const Vec& s, Vec& result) override {
    const Stopwatch stopwatch(rows.time_in_functions);
    go_to(info, x);
    double* const g = result.data();
    for (int k = 0; k <= rows.at.horizon; ++k) {
      const double* const u = x.data() + info.offsets_primal_u[k];
      if (k < rows.at.horizon) std::copy_n(u, inputs(), g + info.offsets_g_eq_slack[k]);
      rows.template each_row<double>(k, [&](Kind kind, int n, double value) {
        if (kind == Rows::kDynamics)
          value -= rows.at.x[static_cast<std::size_t>(k + 1)][static_cast<std::size_t>(n)];
        if (const int slack = slack_of(k, kind, n); slack >= 0) value -= u[P::kNu + slack];
        g[place(info, k, kind, n)] = value;
      });
    }
    const int count = info.number_of_g_eq_slack;
    result.block(count, info.offset_g_eq_slack) =
        result.block(count, info.offset_g_eq_slack) - s.block(count, 0);
    return 0;
  }
  int eval_constr_jac(const Info& info, const Vec& x, const Vec&,
                      fatrop::Jacobian<fatrop::OcpType>& jacobian) override {
    const Stopwatch stopwatch(rows.time_in_functions);
    go_to(info, x);
    for (int k = 0; k <= rows.at.horizon; ++k) {
      const auto stage = static_cast<std::size_t>(k);
      MAT& limits = clear(jacobian.Gg_ineqt[stage]);
      std::array<MAT*, 3> blocks{nullptr, &clear(jacobian.Gg_eqt[stage]), &limits};
      if (k < rows.at.horizon) blocks[0] = &clear(jacobian.BAbt[stage]);
      for (int m = 0; k < rows.at.horizon && m < inputs(); ++m) entry(limits, m, m) = 1.0;
      rows.template each_row<First>(k, [&](Kind kind, int n, const First& value) {
        const int column = n + first_row(k, kind);
        each_variable(k, [&](std::size_t v, int at) { entry(*blocks[kind], at, column) = value.d[v]; });
        if (const int slack = slack_of(k, kind, n); slack >= 0) entry(limits, P::kNu + slack, column) = -1.0;
      });
    }
    return 0;
  }
  int eval_lag_hess(const Info& info, double scale, const Vec& x, const Vec&, const Vec& multipliers,
                    fatrop::Hessian<fatrop::OcpType>& hessian) override {
    using Second = typename Rows::Second;
    const Stopwatch stopwatch(rows.time_in_functions);
    go_to(info, x);
    for (int k = 0; k <= rows.at.horizon; ++k) {
      Second lagrangian(0.0);
      rows.template each_residual<Second>(k, [&](const Second& r) { lagrangian += (0.5 * scale) * r * r; });
      rows.template each_row<Second>(k, [&](Kind kind, int n, const Second& value) {
        lagrangian += multipliers.data()[place(info, k, kind, n)] * value;
      });
      MAT& to = clear(hessian.RSQrqt[static_cast<std::size_t>(k)]);
      each_variable(k, [&](std::size_t a, int i) {
        each_variable(k, [&](std::size_t b, int j) { entry(to, i, j) = lagrangian.d[a].d[b]; });
      });
    }
    each_slack(info, [&](int at, int k, const auto& penalty) {
      const int i = at - info.offsets_primal_u[k];
      entry(hessian.RSQrqt[static_cast<std::size_t>(k)].mat(), i, i) = scale * penalty.quadratic;
    });
    return 0;
  }
  int get_bounds(const Info& info, Vec& lower, Vec& upper) override {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    lower = -kInfinity;
    upper = 0.0;
    for (int k = 0; k < rows.at.horizon; ++k) {
      const auto low = rows.problem.input_lower(k), high = rows.problem.input_upper(k);
      for (int m = 0; m < inputs(); ++m) {
        const bool is_input = m < P::kNu;
        lower(info.offsets_slack[k] + m) = is_input ? low[static_cast<std::size_t>(m)] : 0.0;
        upper(info.offsets_slack[k] + m) = is_input ? high[static_cast<std::size_t>(m)] : kInfinity;
      }
    }
    return 0;
  }
  int get_initial_primal(const Info& info, Vec& x) override {
    x = 1e-2;  // the slacks
    each_number(info, x, rows.at, [](double& variable, double value) { variable = value; });
    return 0;
  }
  void get_primal_damping(const Info&, Vec& damping) override { damping = 0.0; }
  void apply_jacobian_s_transpose(const Info& info, const Vec& multipliers, double alpha, const Vec& y,
                                  Vec& out) override {
    const int count = info.number_of_slack_variables;
    out = alpha * y;
    out.block(count, 0) = out.block(count, 0) - multipliers.block(count, info.offset_g_eq_slack);
  }
  /// Puts the functions to these variables.
  void go_to(const Info& info, const Vec& x) {
    each_number(info, x, rows.at, [](double variable, double& value) { value = variable; });
  }

 private:
  using First = typename Rows::First;
  using Kind = typename Rows::Kind;

  [[nodiscard]] int inputs() const { return P::kNu + rows.slacks; }
  [[nodiscard]] int slack_of(int k, Kind kind, int n) const {
    return k < rows.at.horizon && kind == Rows::kLimit ? rows.slack_of[static_cast<std::size_t>(n)] : -1;
  }
  /// Behind the bounds of the inputs.
  [[nodiscard]] int first_row(int k, Kind kind) const {
    return k < rows.at.horizon && kind == Rows::kLimit ? inputs() : 0;
  }
  [[nodiscard]] int place(const Info& info, int k, Kind kind, int n) const {
    const auto& offsets = kind == Rows::kDynamics   ? info.offsets_g_eq_dyn
                          : kind == Rows::kEquation ? info.offsets_g_eq_path
                                                    : info.offsets_g_eq_slack;
    return offsets[static_cast<std::size_t>(k)] + first_row(k, kind) + n;
  }
  static double& entry(MAT& of, int i, int j) { return fatrop::blasfeo_matel_wrap(&of, i, j); }
  static MAT& clear(fatrop::MatRealAllocated& matrix) {
    MAT& mat = matrix.mat();
    fatrop::blasfeo_gese_wrap(mat.m, mat.n, 0.0, &mat, 0, 0);
    return mat;
  }
  /// Calls visit(number in (x, u), place among the stage's inputs, slacks and states).
  template <class Visit>
  void each_variable(int k, const Visit& visit) const {
    const bool is_end = k == rows.at.horizon;
    for (int m = 0; m < P::kNu && !is_end; ++m) visit(static_cast<std::size_t>(P::kNx + m), m);
    for (int i = 0; i < P::kNx && k > 0; ++i) visit(static_cast<std::size_t>(i), (is_end ? 0 : inputs()) + i);
  }
  /// Calls visit(variable, number of the trajectory).
  template <class Variables, class Visit>
  void each_number(const Info& info, Variables& x, typename Rows::Trajectory& t, const Visit& visit) const {
    for (int k = 0; k <= t.horizon; ++k) {
      auto* const w = x.data() + info.offsets_primal_u[k];
      each_variable(k, [&](std::size_t v, int at) {
        const auto stage = static_cast<std::size_t>(k);
        visit(w[at], v < P::kNx ? t.x[stage][v] : t.u[stage][v - P::kNx]);
      });
    }
  }
  /// Calls visit(place among all variables, stage, penalty).
  template <class Visit>
  void each_slack([[maybe_unused]] const Info& info, [[maybe_unused]] const Visit& visit) const {
    if constexpr (P::kNc > 0) {
      for (int k = 0; k < rows.at.horizon; ++k) {
        for (int c = 0; c < P::kNc; ++c) {
          if (const int slack = slack_of(k, Rows::kLimit, c); slack >= 0)
            visit(info.offsets_primal_u[k] + P::kNu + slack, k, rows.problem.soft_penalty(c));
        }
      }
    }
  }

  std::unique_ptr<fatrop::ProblemDims<fatrop::OcpType>> dims_;
  fatrop::NlpDims sizes_;
};

/// fatrop: tolerance 1e-6 and 1000 iterations, its own defaults otherwise; set up once for a horizon.
template <solver::OcpProblem P, int Capacity>
class FatropSolver {
 public:
  /// The trajectory is the start; then the optimum, or as it was.
  Outcome solve(const P& problem, const std::array<double, P::kNx>& x0,
                solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
    const bool is_new = problem_->rows.at.horizon != t.horizon;
    problem_->rows.pose(problem, x0, t);
    if (is_new) set_up();
    Outcome outcome;
    const double begin = cpu_time();
    const auto status = algorithm_->optimize();
    outcome.time = cpu_time() - begin;
    outcome.time_in_functions = problem_->rows.time_in_functions;
    outcome.iterations = builder_->get_ipdata()->iteration_number();
    using Flag = fatrop::IpSolverReturnFlag;
    outcome.is_solved = status == Flag::Success || status == Flag::StopAtAcceptablePoint;
    outcome.is_impossible = status == Flag::LocalInfeasibility;
    problem_->go_to(algorithm_->info(), algorithm_->solution_primal());
    if (outcome.is_solved) t = problem_->rows.at;
    return outcome;
  }

 private:
  using Type = fatrop::OcpType;
  void set_up() {
    problem_->set_sizes();
    builder_ = std::make_unique<fatrop::IpAlgBuilder<Type>>(problem_);
    options_ = std::make_unique<fatrop::OptionRegistry>();
    algorithm_ = builder_->with_options_registry(options_.get()).build();
    options_->set_option("print_level", 0);
    options_->set_option("suppress_banner", true);
    options_->set_option("tolerance", 1e-6);
    options_->set_option("max_iter", 1000);
  }
  std::unique_ptr<fatrop::OptionRegistry> options_;  // knows what it sets: one for each builder
  std::shared_ptr<FatropProblem<P, Capacity>> problem_ = std::make_shared<FatropProblem<P, Capacity>>();
  std::unique_ptr<fatrop::IpAlgBuilder<Type>> builder_;
  std::shared_ptr<fatrop::IpAlgorithm<Type>> algorithm_;
};

}  // namespace chicane::bench
