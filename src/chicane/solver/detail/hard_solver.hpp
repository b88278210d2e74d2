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

/// OcpSolver for problems with something that must hold beside dynamics and bounds (hard_constraints.hpp):
/// the primal-dual method of detail/hard_rows.hpp, then full steps from its multipliers (docs/solver.md).
/// Where that gets nowhere, restoration (detail/hard_restoration.hpp) proves that no point nearby holds, or
/// finds one, from where the method begins again. Else rounds of an augmented Lagrangian: each is one solve
/// and an update of multipliers, weights and penalties.
template <HardProblem P, int Capacity, class Arch>
class HardSolver {
 public:
  using State = std::array<double, P::kNx>;
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;
  using Multipliers = HardMultipliers<P, Capacity>;

  explicit HardSolver(const SolverOptions& options = {}) noexcept : options_{options}, inner_{options} {}

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
  static constexpr int kMostRounds = 40;  ///< limit of rounds
  static constexpr int kTrialSpent = -1;
  static constexpr double kFirstShare = 10.0;  ///< weighted violation of the guess over its cost
  static constexpr double kLeastWeight = 1e-2, kMostFirstWeight = 10.0, kMostWeight = 1e9;
  static constexpr std::array kHeavier{10.0, 1e3};  ///< factors of the first weights, if those fail

  /// Violations of a trajectory by row: the largest of each.
  struct Misses {
    std::array<double, kNh> equality{};
    std::array<double, kEnd> terminal{};
    std::array<double, kNc> constraint{};
    double cost = 0.0;   ///< the problem's own, with its first penalties
    double total = 0.0;  ///< sum over all rows of all stages

    [[nodiscard]] double worst() const noexcept {
      double worst = 0.0;
      const auto add = [&](const auto& rows) {
        for (const double miss : rows) worst = std::max(worst, miss);
      };
      add(equality);
      add(terminal);
      add(constraint);
      return worst;
    }
  };

  HardReport run(const P& problem, const State& x0, Trajectory& trajectory,
                 const Deadline& deadline) noexcept {
    HardReport report;
    guess_ = trajectory;
    trial_ = 0;
    is_certified_ = is_possible_ = has_restored_ = false;
    start(problem, x0, trajectory);
    int left = options_.max_iterations;
    bool has_begun = multipliers_.is_known;
    std::size_t restarts = has_begun ? kHeavier.size() : 0;
    RoundProgress progress;
    Misses before;
    for (;;) {
      const bool converged = has_begun ? round(x0, trajectory, deadline, left, report)
                                       : first_round(x0, trajectory, deadline, left, report);
      has_begun = true;
      Misses now = measure(problem, trajectory, &report);
      if (report.status == SolveStatus::kNotFinite) return report;
      update(now, progress.is_first() ? nullptr : &before, trajectory.horizon);
      if (converged && now.worst() <= options_.tolerance) return finish(report.status, now, report);
      if (left <= 0 || deadline.spent() || report.rounds >= kMostRounds) break;
      progress.note(now.worst(), converged, last_iterations_);
      before = now;
      const bool is_trial_over = trial_ == kTrialSpent;
      if (is_trial_over) trial_ = 0;
      const bool is_lost = progress.is_lost(now.worst(), first_.worst(), last_iterations_);
      if (is_trial_over ? progress.is_good() : converged && !is_lost) continue;
      if (has_restored_ && restarts < kHeavier.size()) {  // misses count from the start
        begin_again(trajectory, kHeavier[restarts++]);
        trial_ = is_certified_ ? most_of_a_trial() : 0;
      } else if (is_certified_ || (!converged && has_restored_) ||
                 is_infeasible(problem, x0, trajectory, deadline, left, report)) {
        break;
      }
      progress = {};
    }
    Misses now = measure(problem, trajectory, &report);
    for (std::size_t n = kNeh; n < kEnd; ++n) count_distance(now, n);
    const bool is_close = usable(report.status) && now.worst() <= options_.tolerance;
    if (is_close) return finish(SolveStatus::kBudgetSpent, now, report);
    if (is_certified_) return tell_infeasible(problem, x0, trajectory, report);
    if (take_guess(problem, x0, trajectory, report)) now = measure(problem, trajectory, &report);
    return finish(SolveStatus::kStalled, now, report);
  }

  /// Iteration limit of one start: min(100, max_iterations / 5), so that other starts get their turn.
  [[nodiscard]] int most_of_a_trial() const noexcept {
    return std::max(1, std::min(100, options_.max_iterations / 5));
  }
  bool first_round(const State& x0, Trajectory& trajectory, const Deadline& deadline, int& left,
                   HardReport& report) noexcept;
  bool follow(const State& x0, Trajectory& trajectory, const Deadline& deadline, int& left,
              HardReport& report) noexcept;
  /// Restarts from the guess, with the first weights times `factor`.
  void begin_again(Trajectory& trajectory, double factor) noexcept {
    trajectory = guess_;
    start_with_weights(trajectory.horizon, factor);
  }
  /// Takes the simulated guess if its inputs violate less than `trajectory`'s and cost less; true then.
  bool take_guess(const P& problem, const State& x0, Trajectory& trajectory, HardReport& report) noexcept {
    if (!roll_out(problem, x0, guess_)) return false;
    const Misses guess = measure(problem, guess_, nullptr);
    copy_ = trajectory;
    if (roll_out(problem, x0, copy_)) {
      const Misses own = measure(problem, copy_, nullptr);
      if (!(guess.worst() < own.worst() && guess.cost < own.cost)) return false;
    }
    copy_ = trajectory = guess_;
    assess(x0, copy_, false, report);
    return true;
  }
  /// `report` becomes one of `trajectory`, simulated or with its states; its status and its counts stay.
  void assess(const State& x0, Trajectory& trajectory, bool with_states, HardReport& report) noexcept {
    inner_.allow_iterations(0);
    inner_.start_from_states(with_states);
    const SolveReport kept = report;
    static_cast<SolveReport&>(report) = inner_.solve(problem_, x0, trajectory);
    report.status = kept.status;
    report.iterations = kept.iterations;
    report.sweeps = kept.sweeps;
  }

  /// One solve. True when it converged.
  bool round(const State& x0, Trajectory& trajectory, const Deadline& deadline, int& left,
             HardReport& report) noexcept {
    inner_.allow_iterations(trial_ > 0 ? std::min(left, trial_) : left);
    if (log_ != nullptr) log_->begin_round();
    const SolveReport now = can_go_on_ ? inner_.solve_again(problem_, x0, trajectory, deadline)
                                       : inner_.solve(problem_, x0, trajectory, deadline);
    inner_.start_from_states(true);
    can_go_on_ = usable(now.status);
    const int iterations = report.iterations + now.iterations;
    const int sweeps = report.sweeps + now.sweeps;
    static_cast<SolveReport&>(report) = now;
    report.iterations = iterations;
    report.sweeps = sweeps;
    ++report.rounds;
    last_iterations_ = now.iterations;
    left -= std::max(1, now.iterations);
    if (trial_ != 0) trial_ = trial_ > now.iterations ? trial_ - now.iterations : kTrialSpent;
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
  /// Tolerance of rounds: multipliers are as good as the round that yields them, so that loose ones mislead.
  [[nodiscard]] double round_tolerance() const noexcept { return std::min(options_.tolerance, 1e-6); }

  // ---- weights and multipliers
  void start(const P& problem, const State& x0, Trajectory& trajectory) noexcept {
    problem_.problem = &problem;
    problem_.cost_root = 1.0;
    can_go_on_ = false;
    inner_.ask_for(round_tolerance());
    if (!options_.start_from_states) roll_out(problem, x0, trajectory);
    first_ = measure(problem, trajectory, nullptr);
    unit_ = std::isfinite(first_.cost) ? std::max(1.0, first_.cost) : 1.0;
    if (!multipliers_.is_known) return start_with_weights(trajectory.horizon, 1.0);
    inner_.start_from_states(options_.start_from_states);
    put_multipliers(trajectory.horizon);
  }
  /// No multipliers, and the first weights of the guess, times `factor` (eq. 58).
  void start_with_weights(int horizon, double factor) noexcept {
    can_go_on_ = false;
    inner_.ask_for(round_tolerance());
    inner_.start_from_states(options_.start_from_states);
    problem_.cost_root = 1.0;
    problem_.penalty_factor.fill(1.0);
    for (std::size_t n = 0; n < kNh; ++n) {
      problem_.equality_shift[n].values.fill(0.0);
      problem_.set_weight(n, factor * first_weight(first_.equality[n] * horizon));
    }
    for (std::size_t n = 0; n < kEnd; ++n) {
      problem_.terminal_shift[n] = 0.0;
      problem_.terminal_weight[n].set(factor * first_weight(first_.terminal[n]));
    }
  }
  [[nodiscard]] double first_weight(double miss) const noexcept {
    const double weight = kFirstShare * unit_ / std::max(1e-12, 0.5 * miss * miss);
    return std::isfinite(weight) ? std::min(std::max(weight, kLeastWeight), kMostFirstWeight) : 1.0;
  }

  /// y ← y + ρ h; a weight or penalty whose row has not come down enough rises (eq. 57).
  void update(Misses& now, const Misses* before, int horizon) noexcept {
    constexpr double kEnough = 0.1, kRise = 10.0;
    const auto rises = [&](double miss, double last) {
      return before != nullptr && miss > options_.tolerance && miss > kEnough * last;
    };
    const auto raise = [&](auto& weight, double miss, double last) {
      const double old = weight.rho;
      if (rises(miss, last)) weight.set(std::min(kRise * old, std::max(old, kMostWeight * unit_)));
      return old / weight.rho;
    };
    for (std::size_t n = 0; n < kNh; ++n) {
      const double share =
          raise(problem_.equality_weight[n], now.equality[n], before != nullptr ? before->equality[n] : 0.0);
      problem_.set_weight(n, problem_.equality_weight[n].rho);
      for (int k = 0; k < horizon; ++k) {
        const auto stage = static_cast<std::size_t>(k);
        problem_.equality_shift[n][stage] = share * (problem_.equality_shift[n][stage] + equality_[n][stage]);
      }
    }
    for (std::size_t n = 0; n < kEnd; ++n) {
      double& shift = problem_.terminal_shift[n];
      shift += terminal_[n];
      if (n >= kNeh) shift = std::max(0.0, shift);
      count_distance(now, n);
      shift *=
          raise(problem_.terminal_weight[n], now.terminal[n], before != nullptr ? before->terminal[n] : 0.0);
    }
    for (std::size_t c = 0; c < kNc; ++c) {
      if (now.constraint[c] <= options_.tolerance) continue;
      problem_.penalty_factor[c] *= kRise;
      can_go_on_ = false;
    }
    keep_multipliers(horizon);
  }
  /// An inequality whose multiplier is not zero has to hold with equality: its distance counts as a miss.
  void count_distance(Misses& misses, std::size_t n) const noexcept {
    if (problem_.terminal_shift[n] > 0.0) misses.terminal[n] = std::fabs(terminal_[n]);
  }
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

  // ---- what cannot hold (detail/hard_restoration.hpp)
  bool is_infeasible(const P& problem, const State& x0, Trajectory& trajectory, const Deadline& deadline,
                     int& left, HardReport& report) noexcept;
  HardReport tell_infeasible(const P& problem, const State& x0, Trajectory& trajectory,
                             HardReport report) noexcept;
  bool is_proven(const P& problem, const Trajectory& least, double violation) const noexcept;
  void weigh_misses(double share, double unit) noexcept;

  // ---- values
  static bool is_hard([[maybe_unused]] const P& problem, [[maybe_unused]] std::size_t c) noexcept {
    if constexpr (detail::SaysWhatIsHard<P>) return problem.is_hard(static_cast<int>(c));
    return false;
  }
  /// Computes cost and misses of a trajectory; keeps the values of rows, and reports the worst.
  Misses measure(const P& problem, const Trajectory& t, HardReport* report) noexcept {
    Misses misses;
    double worst = 0.0;
    const auto note = [&](double& miss, double value, Kind kind, int stage, std::size_t row) {
      misses.total += value;
      miss = value > miss ? value : miss;
      if (report == nullptr || !(value > worst)) return;
      worst = value;
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
          note(misses.equality[n], std::fabs(equality_[n][stage]), Kind::kEquality, k, n);
        }
      }
      if constexpr (kNc > 0) {
        const auto c = to_array<One>(problem.constraint(k, x, u));
        for (std::size_t n = 0; n < kNc; ++n) {
          const double beyond = std::max(0.0, Evaluate::number(c[n]));
          if (is_hard(problem, n)) {
            note(misses.constraint[n], beyond, Kind::kConstraint, k, n);
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
        note(misses.terminal[n], std::fabs(terminal_[n]), Kind::kTerminalEquality, t.horizon, n);
      }
    }
    if constexpr (kEnd > kNeh) {
      const auto g = to_array<One>(problem.terminal_constraint(x));
      for (std::size_t n = 0; n < kEnd - kNeh; ++n) {
        terminal_[kNeh + n] = Evaluate::number(g[n]);
        note(misses.terminal[kNeh + n], std::max(0.0, terminal_[kNeh + n]), Kind::kTerminalConstraint,
             t.horizon, n);
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
  OcpSolver<Problem, Capacity, Arch> inner_;
  Problem problem_;
  Multipliers multipliers_;
  double unit_ = 1.0;  ///< unit of costs
  Misses first_;       ///< violations of the guess
  IterationLog* log_ = nullptr;
  Trajectory guess_;
  Trajectory copy_;                ///< copy for reports, which may change it
  Trajectory least_;               ///< local minimum of the violation above zero, if is_certified_
  int last_iterations_ = 0;        ///< iterations of the last round
  Multipliers least_multipliers_;  ///< multipliers of the violation alone at least_
  double least_unit_ = 1.0;        ///< unit of the misses there
  bool is_certified_ = false;
  bool has_restored_ = false;  ///< restoration has been tried
  bool is_possible_ = false;   ///< a point without misses has been found
  int trial_ = 0;           ///< iterations that are left for the first weights, kTrialSpent; 0: all of them
  bool can_go_on_ = false;  ///< the next round differs little from the last one
  std::array<std::array<double, Capacity>, kNh> equality_{};  ///< values at the last measure()
  std::array<double, kEnd> terminal_{};
};

/// A class of its own does the work: compilers differ in how they distinguish members of a constrained
/// specialisation from members of the class itself.
template <HardProblem P, int Capacity, class Arch>
class OcpSolver<P, Capacity, Arch> : public HardSolver<P, Capacity, Arch> {
 public:
  using HardSolver<P, Capacity, Arch>::HardSolver;
};

}  // namespace chicane::solver

#include "chicane/solver/detail/hard_restoration.hpp"
