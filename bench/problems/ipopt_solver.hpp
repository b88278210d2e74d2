// SPDX-License-Identifier: MIT
#pragma once

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <algorithm>
#include <array>
#include <vector>

#include "problems/cpu_time.hpp"
#include "problems/ipopt_problem.hpp"
#include "references/ipopt_settings.hpp"

namespace chicane::bench {

struct IpoptReport {
  bool is_solved = false;
  bool is_impossible = false;  ///< a local minimum of what is missed: the trajectory is that
  int iterations = 0;
  double time = 0.0;               ///< CPU time from the call to the answer [s]
  double time_in_functions = 0.0;  ///< values and derivatives of the problem in it [s]
};

/// Ipopt for one problem type, set up once: tolerance 1e-6 as ours, its defaults otherwise, bounds as they
/// are.
template <solver::OcpProblem P>
class IpoptSolver {
 public:
  IpoptSolver() : nlp_(new Nlp), app_(make_ipopt(false)), warm_app_(make_ipopt(true)) {}

  /// The trajectory is the start; then the optimum, or as it was.
  template <int Capacity>
  IpoptReport solve(const P& problem, const std::array<double, P::kNx>& x0,
                    solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
    return run(*app_, problem, x0, t);
  }
  /// Keeps the multipliers of the last answer, shifted by one interval, for solve_warm().
  void remember() {
    constexpr int kEquations = P::kNx;
    nlp_->start_multipliers = nlp_->end_multipliers;
    shift(nlp_->start_multipliers.low, Nlp::kNz);
    shift(nlp_->start_multipliers.high, Nlp::kNz);
    shift(nlp_->start_multipliers.equation, kEquations);
  }
  /// Starts from the remembered multipliers, too, with a barrier of 1e-5.
  template <int Capacity>
  IpoptReport solve_warm(const P& problem, const std::array<double, P::kNx>& x0,
                         solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
    return run(*warm_app_, problem, x0, t);
  }

 private:
  using Nlp = IpoptProblem<P>;
  using App = Ipopt::SmartPtr<Ipopt::IpoptApplication>;

  template <int Capacity>
  IpoptReport run(Ipopt::IpoptApplication& app, const P& problem, const std::array<double, P::kNx>& x0,
                  solver::Trajectory<P::kNx, P::kNu, Capacity>& t) {
    nlp_->problem = &problem;
    nlp_->x0 = x0;
    nlp_->take_start(t);
    nlp_->time_in_functions = 0.0;
    IpoptReport report;
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

  /// One stage earlier; the last one stays. What each stage has: `width` numbers, then the same number of
  /// soft constraints behind all stages.
  void shift(std::vector<double>& values, int width) const {
    const auto stages = nlp_->horizon;
    const auto move = [&](int begin, int size) {
      const auto first = values.begin() + begin;
      std::copy(first + size, first + stages * size, first);
    };
    if (values.empty()) return;
    move(0, width);
    if constexpr (P::kNc > 0) move(stages * width, P::kNc);
  }

  Ipopt::SmartPtr<Nlp> nlp_;
  App app_, warm_app_;
};

}  // namespace chicane::bench
