// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/detail/augmented.hpp"
#include "chicane/solver/detail/evaluation.hpp"
#include "chicane/solver/detail/progress.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/ocp_solver.hpp"

namespace chicane::solver {

/// OcpSolver for problems with hard constraints (hard_constraints.hpp): the primal-dual method of
/// detail/hard_rows.hpp, then full steps from its multipliers (docs/solver.md). If that fails, restoration
/// (detail/hard_restoration.hpp) proves that no point nearby is feasible, or finds one, from which the method
/// starts again.
template <HardProblem P, int Capacity, class Arch>
class HardSolver {
 public:
  using State = std::array<double, P::kNx>;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;
  using Multipliers = HardMultipliers<P, Capacity>;

  explicit HardSolver(const SolverOptions& options = {}) noexcept : options_{options}, inner_{options} {
    inner_.take_only_full_steps();
  }

  void set_options(const SolverOptions& options) noexcept {
    options_ = options;
    inner_.set_options(options);
  }
  /// Sets SolverOptions::max_iterations for all rounds together, from the next solve on.
  void allow_iterations(int most) noexcept { options_.max_iterations = most; }

  /// Solves as OcpSolver::solve does. A usable answer violates nothing by more than `tolerance`, also with
  /// kBudgetSpent; kInfeasible: the violation has a local minimum above zero here.
  HardReport solve(const P& problem, const State& x0, Trajectory& trajectory,
                   Deadline deadline = Deadline::never()) noexcept {
    multipliers_.is_known = false;
    return run(problem, x0, trajectory, deadline);
  }
  /// Solves from multipliers and weights of an earlier solve, if they are known, and replaces them by this
  /// solve's.
  HardReport solve(const P& problem, const State& x0, Trajectory& trajectory, Multipliers& multipliers,
                   Deadline deadline = Deadline::never()) noexcept {
    multipliers_ = multipliers;
    const HardReport report = run(problem, x0, trajectory, deadline);
    multipliers = multipliers_;
    return report;
  }

  /// Prepares feedback as OcpSolver does; hard rows enter with multipliers and weights of the last solve.
  bool prepare() noexcept { return inner_.prepare(problem_); }
  FeedbackReport feedback(const State& x0, Trajectory& trajectory) noexcept {
    return inner_.feedback(x0, trajectory);
  }
  void record_iterations(IterationLog* log) noexcept {
    log_ = log;
    inner_.record_iterations(log);
  }

  /// Multipliers after a solve, d(cost)/d(right-hand side).
  [[nodiscard]] double equality_multiplier(int k, int n) const noexcept {
    return multipliers_.equality[static_cast<std::size_t>(n)].at(k);
  }
  [[nodiscard]] double terminal_equality_multiplier(int n) const noexcept {
    return multipliers_.terminal[static_cast<std::size_t>(n)];
  }
  [[nodiscard]] double terminal_constraint_multiplier(int n) const noexcept {
    return multipliers_.terminal[static_cast<std::size_t>(kNeh + n)];
  }
  /// Adjoint, as in OcpSolver.
  [[nodiscard]] double adjoint(int k, int i) const noexcept { return inner_.adjoint(k, i); }
  [[nodiscard]] double bound_multiplier(int k, int m) const noexcept { return inner_.bound_multiplier(k, m); }
  [[nodiscard]] double constraint_multiplier(int k, int c) const noexcept {
    return inner_.constraint_multiplier(k, c);
  }

 private:
  using Problem = Augmented<P, Capacity>;
  using Evaluate = Evaluation<Problem, Arch>;
  using One = typename Evaluate::One;
  using Kind = HardReport::Kind;
  static constexpr std::size_t kNh = Problem::kEqualities, kNc = P::kNc;
  static constexpr std::size_t kNeh = Problem::kEndEqualities;
  static constexpr std::size_t kEnd = kNeh + Problem::kEndConstraints;
  // Chosen.
  static constexpr int kMostIterations = 200;  ///< limit of iterations from one start
  static constexpr int kMostFullSteps = 15;    ///< limit of full steps in one round
  static constexpr int kMostBarriers = 2;      ///< lower barriers that are tried if full steps fail
  static constexpr double kLeastShare = 1e-8;  ///< least share of the cost in restoration
  static constexpr double kLight = 1e-9;       ///< weight of rows that is negligible beside their multipliers

  /// Violations of a trajectory.
  struct Misses {
    double worst = 0.0;     ///< largest violation
    double cost = 0.0;      ///< cost of the problem, with its first penalties
    double total = 0.0;     ///< sum of the violations of all rows of all stages
    double weighted = 0.0;  ///< sum of the rows' values, each times its multiplier
  };

  /// The whole solve, from multipliers_ if they are known.
  HardReport run(const P& problem, const State& x0, Trajectory& trajectory,
                 const Deadline& deadline) noexcept {
    HardReport report;
    report.status = SolveStatus::kStalled;
    guess_ = trajectory;
    is_certified_ = is_possible_ = false;
    least_total_ = 0.0;
    start(problem, x0, trajectory);
    int left = options_.max_iterations;
    if (multipliers_.is_known && finish_steps(problem, x0, trajectory, deadline, left, report)) return report;
    // Starts of the method: the guess; the point that restoration finds from its last point; the points that
    // restoration finds from the guess, with different first shares of the cost.
    constexpr std::array kShares{0.0, kLeastShare, 100.0, 1.0, 10.0};
    for (std::size_t attempt = 0; attempt < kShares.size() && left > 0 && !deadline.spent(); ++attempt) {
      attempt == 1 ? inner_.start_from_states(true) : begin_again(trajectory);
      if (attempt > 0 && is_infeasible(problem, x0, trajectory, kShares[attempt], deadline, left, report)) {
        if (is_final_) break;
      } else if (follow(Begin::kGuess, x0, trajectory, deadline, left, report)) {
        int barriers = 0;
        do {
          if (finish_steps(problem, x0, trajectory, deadline, left, report)) return report;
        } while (++barriers <= kMostBarriers && left > 0 &&
                 follow(Begin::kHere, x0, trajectory, deadline, left, report));
        if (take_point(problem, trajectory, report)) return report;
      }
    }
    if (is_certified_) return report_infeasible(problem, x0, trajectory, report);
    return stall(problem, x0, trajectory, report);
  }
  /// Answers without a solution: the last point, or the simulated guess if it violates less and costs less.
  HardReport stall(const P& problem, const State& x0, Trajectory& trajectory, HardReport report) noexcept {
    forget_multipliers();
    copy_ = trajectory;
    bool is_guess = roll_out(problem, x0, guess_);
    if (is_guess && roll_out(problem, x0, copy_)) {
      const Misses guess = measure(problem, guess_, nullptr), own = measure(problem, copy_, nullptr);
      is_guess = guess.worst < own.worst && guess.cost < own.cost;
    }
    if (is_guess) trajectory = guess_;
    clamp_inputs(problem, trajectory);
    copy_ = trajectory;
    assess(x0, copy_, !is_guess, report);
    if (report.status != SolveStatus::kNotFinite)
      return finish(SolveStatus::kStalled, measure(problem, trajectory, &report), report);
    trajectory = copy_;
    return report;
  }
  using Begin = typename OcpSolver<Augmented<P, Capacity>, Capacity, Arch>::Begin;
  bool follow(Begin begin, const State& x0, Trajectory& trajectory, const Deadline& deadline, int& left,
              HardReport& report) noexcept;
  /// Returns to the guess, without multipliers.
  void begin_again(Trajectory& trajectory) noexcept {
    trajectory = guess_;
    inner_.start_from_states(options_.start_from_states);
    forget_multipliers();
  }
  /// Resets weights, shifts and penalties to those of a problem without multipliers.
  void forget_multipliers() noexcept {
    can_go_on_ = false;
    problem_.cost_root = 1.0;
    problem_.penalty_factor.fill(1.0);
    for (std::size_t n = 0; n < kNh; ++n) {
      problem_.equality_shift[n].values.fill(0.0);
      problem_.set_weight(n, 1.0);
    }
    for (auto& weight : problem_.terminal_weight) weight.set(1.0);
    problem_.terminal_shift.fill(0.0);
  }
  /// Full steps with the known multipliers, in rounds that improve the multipliers (eq. 57). True at a
  /// solution, or at a usable point at the end of the budget.
  bool finish_steps(const P& problem, const State& x0, Trajectory& trajectory, const Deadline& deadline,
                    int& left, HardReport& report) noexcept {
    constexpr int kMostRounds = 10;  // chosen
    constexpr double kEnough = 0.5;  // largest share of the misses that a round may leave; chosen
    double last = std::numeric_limits<double>::infinity();
    for (int n = 0; n < kMostRounds && left > 0; ++n) {
      const bool converged = round(x0, trajectory, deadline, left, report);
      const Misses now = update(measure(problem, trajectory, &report), trajectory.horizon);
      const bool holds = now.worst <= options_.tolerance;
      const bool is_last = left <= 0 || deadline.spent();
      if (holds && (converged || (is_last && usable(report.status)))) {
        report = finish(report.status, now, report);
        return true;
      }
      if (!converged || !(now.worst <= kEnough * last)) return false;
      last = now.worst;
    }
    return false;
  }
  /// Answers with the point at the end of the barrier, for full steps that do not converge. True if it is
  /// usable.
  bool take_point(const P& problem, Trajectory& trajectory, HardReport& report) noexcept {
    put_light(point_multipliers_, trajectory.horizon);
    inner_.ask_for(options_.tolerance);
    HardReport seen = report;
    take(inner_.take_point(problem_, trajectory), seen);
    const Misses now = measure(problem, trajectory, &seen);
    multipliers_ = point_multipliers_;
    if (!usable(seen.status) || now.worst > options_.tolerance) return false;
    if (exceeds_a_cap(seen)) seen.status = SolveStatus::kInfeasible;
    report = finish(seen.status, now, seen);
    return true;
  }
  /// Makes `report` a report on `trajectory`, simulated or with its states; status and counts stay.
  void assess(const State& x0, Trajectory& trajectory, bool with_states, HardReport& report) noexcept {
    inner_.allow_iterations(0);
    inner_.start_from_states(with_states);
    const SolveReport kept = report;
    static_cast<SolveReport&>(report) = inner_.solve(problem_, x0, trajectory);
    if (report.status != SolveStatus::kNotFinite) report.status = kept.status;
    report.iterations = kept.iterations, report.sweeps = kept.sweeps;
  }
  /// Makes `report` the report of one more solve, with the counts of all solves.
  static void take(const SolveReport& now, HardReport& report) noexcept {
    const int iterations = report.iterations + now.iterations, sweeps = report.sweeps + now.sweeps;
    static_cast<SolveReport&>(report) = now;
    report.iterations = iterations, report.sweeps = sweeps;
  }

  /// One solve with the present multipliers. True if it converges.
  bool round(const State& x0, Trajectory& trajectory, const Deadline& deadline, int& left,
             HardReport& report) noexcept {
    inner_.allow_iterations(std::min(left, kMostFullSteps));
    if (log_ != nullptr) log_->begin_round();
    const SolveReport now = can_go_on_ ? inner_.solve_again(problem_, x0, trajectory, deadline)
                                       : inner_.solve(problem_, x0, trajectory, deadline);
    inner_.start_from_states(true);
    can_go_on_ = usable(now.status);
    take(now, report);
    ++report.rounds;
    left -= std::max(1, now.iterations);
    const double residual = std::max({now.stationarity, now.defect, now.complementarity});
    if (now.status == SolveStatus::kAtFloor && residual <= options_.tolerance)
      report.status = exceeds_a_cap(now) ? SolveStatus::kInfeasible : SolveStatus::kOptimal;
    return now.status == SolveStatus::kOptimal || now.status == SolveStatus::kAtFloor ||
           now.status == SolveStatus::kInfeasible;
  }

  [[nodiscard]] bool exceeds_a_cap(const SolveReport& report) const noexcept {
    const int c = report.worst_constraint;
    return c >= 0 && report.violation > penalty_of(problem_, static_cast<std::size_t>(c)).cap;
  }
  /// Tolerance of rounds: multipliers are only as accurate as the round that yields them.
  [[nodiscard]] double round_tolerance() const noexcept { return std::min(options_.tolerance, 1e-6); }

  // ---- weights and multipliers

  /// Starts a solve; puts known multipliers into the problem.
  void start(const P& problem, const State& x0, Trajectory& trajectory) noexcept {
    problem_.problem = &problem;
    problem_.cost_root = 1.0;
    can_go_on_ = false;
    inner_.ask_for(round_tolerance());
    if (!options_.start_from_states) roll_out(problem, x0, trajectory);
    const double cost = measure(problem, trajectory, nullptr).cost;
    unit_ = std::isfinite(cost) ? std::max(1.0, cost) : 1.0;
    if (!multipliers_.is_known) return;
    inner_.start_from_states(options_.start_from_states);
    put_multipliers(trajectory.horizon);
  }
  /// Updates the multipliers, y ← y + ρ h (eq. 57). An inequality with a multiplier other than zero has to
  /// hold with equality: its distance counts as a miss.
  Misses update(Misses now, int horizon) noexcept {
    for (std::size_t n = 0; n < kNh; ++n) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(horizon); ++k)
        problem_.equality_shift[n][k] += equality_[n][k];
    }
    for (std::size_t n = 0; n < kEnd; ++n) {
      double& shift = problem_.terminal_shift[n];
      shift += terminal_[n];
      if (n < kNeh) continue;
      shift = std::max(0.0, shift);
      if (shift > 0.0) now.worst = std::max(now.worst, std::fabs(terminal_[n]));
    }
    keep_multipliers(horizon);
    return now;
  }
  /// Copies multipliers, weights and penalties of the problem to multipliers_.
  void keep_multipliers(int horizon) noexcept {
    multipliers_.is_known = true;
    for (std::size_t n = 0; n < kNh; ++n) {
      multipliers_.equality_weight[n] = problem_.equality_weight[n].rho;
      for (std::size_t k = 0; k < static_cast<std::size_t>(horizon); ++k)
        multipliers_.equality[n][k] = problem_.equality_weight[n].rho * problem_.equality_shift[n][k];
    }
    for (std::size_t n = 0; n < kEnd; ++n) {
      multipliers_.terminal_weight[n] = problem_.terminal_weight[n].rho;
      multipliers_.terminal[n] = problem_.terminal_weight[n].rho * problem_.terminal_shift[n];
    }
    multipliers_.penalty_factor = problem_.penalty_factor;
  }
  /// Puts multipliers into the problem, with negligible weights.
  void put_light(const Multipliers& multipliers, int horizon) noexcept {
    multipliers_ = multipliers;
    multipliers_.equality_weight.fill(kLight);
    multipliers_.terminal_weight.fill(kLight);
    put_multipliers(horizon);
  }
  /// Copies multipliers_, weights and penalties to the problem.
  void put_multipliers(int horizon) noexcept {
    for (std::size_t n = 0; n < kNh; ++n) {
      problem_.set_weight(n, multipliers_.equality_weight[n]);
      for (std::size_t k = 0; k < static_cast<std::size_t>(horizon); ++k)
        problem_.equality_shift[n][k] = multipliers_.equality[n][k] / multipliers_.equality_weight[n];
    }
    for (std::size_t n = 0; n < kEnd; ++n) {
      problem_.terminal_weight[n].set(multipliers_.terminal_weight[n]);
      problem_.terminal_shift[n] = multipliers_.terminal[n] / multipliers_.terminal_weight[n];
    }
    problem_.penalty_factor = multipliers_.penalty_factor;
  }

  // ---- restoration (detail/hard_restoration.hpp)
  bool is_infeasible(const P& problem, const State& x0, Trajectory& trajectory, double share,
                     const Deadline& deadline, int& left, HardReport& report) noexcept;
  HardReport report_infeasible(const P& problem, const State& x0, Trajectory& trajectory,
                               HardReport report) noexcept;
  bool is_proven(const P& problem, const State& x0, const Trajectory& least, double violation,
                 bool converged) noexcept;
  void weigh_misses(double share, double unit) noexcept;
  static void count(const SolveReport& seen, int& left, HardReport& report) noexcept {
    report.iterations += seen.iterations;
    report.sweeps += seen.sweeps;
    left -= seen.iterations;
  }

  // ---- values

  /// Computes cost and misses of a trajectory; keeps the values of rows, and reports the worst one.
  Misses measure(const P& problem, const Trajectory& t, HardReport* report) noexcept {
    Misses misses;
    const auto note = [&](double value, Kind kind, int stage, std::size_t row) {
      misses.total += value;
      if (!(value > misses.worst)) return;
      misses.worst = value;
      if (report == nullptr) return;
      report->miss = value;
      report->kind = kind;
      report->miss_stage = stage;
      report->miss_row = static_cast<int>(row);
    };
    if (report != nullptr) {
      report->miss = 0.0;
      report->kind = Kind::kNone;
      report->miss_stage = report->miss_row = -1;
    }
    for (int k = 0; k < t.horizon; ++k) {
      const auto stage = static_cast<std::size_t>(k);
      const auto x = to_array<One>(t.x[stage]);
      const auto u = to_array<One>(t.u[stage]);
      add_squares(problem.residual(k, x, u), misses.cost);
      if constexpr (kNh > 0) {
        const auto h = to_array<One>(problem.equality(k, x, u));
        for (std::size_t n = 0; n < kNh; ++n) {
          equality_[n][stage] = Evaluate::number(h[n]);
          misses.weighted += multipliers_.equality[n].at(k) * equality_[n][stage];
          note(std::fabs(equality_[n][stage]), Kind::kEquality, k, n);
        }
      }
      if constexpr (kNc > 0) {
        const auto c = to_array<One>(problem.constraint(k, x, u));
        for (std::size_t n = 0; n < kNc; ++n) {
          const double beyond = std::max(0.0, Evaluate::number(c[n]));
          if (problem_.must_hold(n)) {
            misses.weighted += inner_.constraint_multiplier(k, static_cast<int>(n)) * Evaluate::number(c[n]);
            note(beyond, Kind::kConstraint, k, n);
          } else {
            const SoftPenalty penalty = penalty_of(problem, n);
            misses.cost += beyond * (penalty.linear + 0.5 * penalty.quadratic * beyond);
          }
        }
      }
    }
    const auto x = to_array<One>(t.x[static_cast<std::size_t>(t.horizon)]);
    add_squares(problem.terminal_residual(x), misses.cost);
    if constexpr (kNeh > 0) {
      const auto h = to_array<One>(problem.terminal_equality(x));
      for (std::size_t n = 0; n < kNeh; ++n) {
        terminal_[n] = Evaluate::number(h[n]);
        misses.weighted += multipliers_.terminal[n] * terminal_[n];
        note(std::fabs(terminal_[n]), Kind::kTerminalEquality, t.horizon, n);
      }
    }
    if constexpr (kEnd > kNeh) {
      const auto g = to_array<One>(problem.terminal_constraint(x));
      for (std::size_t n = 0; n < kEnd - kNeh; ++n) {
        terminal_[kNeh + n] = Evaluate::number(g[n]);
        misses.weighted += multipliers_.terminal[kNeh + n] * terminal_[kNeh + n];
        note(std::max(0.0, terminal_[kNeh + n]), Kind::kTerminalConstraint, t.horizon, n);
      }
    }
    return misses;
  }
  template <class Row>
  static void add_squares(const Row& row, double& sum) noexcept {
    for (const One& r : to_array<One>(row)) sum += 0.5 * Evaluate::number(r) * Evaluate::number(r);
  }

  static HardReport finish(SolveStatus status, const Misses& now, HardReport report) noexcept {
    report.status = status;
    report.cost = now.cost;
    return report;
  }

  SolverOptions options_;
  OcpSolver<Problem, Capacity, Arch> inner_;  ///< solver of the augmented Lagrangian
  Problem problem_;                           ///< augmented Lagrangian of the problem
  Multipliers multipliers_;                   ///< multipliers of the answer
  double unit_ = 1.0;                         ///< unit of costs
  IterationLog* log_ = nullptr;               ///< record_iterations()
  Trajectory guess_;                          ///< guess of the solve
  Trajectory copy_;                           ///< copy for reports, which may change it
  Multipliers point_multipliers_;             ///< multipliers at the end of the barrier
  Trajectory least_;                          ///< local minimum of the violation above zero, if is_certified_
  Multipliers least_multipliers_;             ///< multipliers of the violation alone there
  double least_total_ = 0.0;                  ///< sum of the misses there
  double least_unit_ = 1.0;                   ///< unit of the misses there
  bool is_certified_ = false;                 ///< whether such a minimum is proven
  bool is_final_ = false;                     ///< whether no other start would end elsewhere
  bool is_possible_ = false;                  ///< whether a point without misses has been found
  bool can_go_on_ = false;                    ///< whether the next round differs little from the last one
  std::array<std::array<double, Capacity>, kNh> equality_{};  ///< equalities at the last measure()
  std::array<double, kEnd> terminal_{};                       ///< rows of the end at the last measure()
};

/// Specialisation for problems with hard constraints. HardSolver does the work, because compilers differ in
/// how they distinguish members of a constrained specialisation from members of the primary template.
template <HardProblem P, int Capacity, class Arch>
class OcpSolver<P, Capacity, Arch> : public HardSolver<P, Capacity, Arch> {
 public:
  using HardSolver<P, Capacity, Arch>::HardSolver;
};

}  // namespace chicane::solver

#include "chicane/solver/detail/hard_restoration.hpp"
