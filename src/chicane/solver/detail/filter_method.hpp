// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "chicane/base/deadline.hpp"
#include "chicane/base/math.hpp"
#include "chicane/solver/detail/barrier.hpp"
#include "chicane/solver/detail/evaluation.hpp"
#include "chicane/solver/detail/filter.hpp"
#include "chicane/solver/detail/filter_slacks.hpp"
#include "chicane/solver/detail/hard_rows.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/detail/linearisation.hpp"
#include "chicane/solver/detail/lq_solver.hpp"
#include "chicane/solver/detail/progress.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::solver {

/// A primal-dual interior point method with a filter line search over multiple shooting
/// (docs/solver.md, eq. 30–37; after Wächter, Biegler 2006). States, inputs, slacks and multipliers
/// of the dynamics are all unknowns; Hessians are exact, and shifted until the quadratic program is convex.
/// Slower than full steps with a working set, and works from where those fail.
template <OcpProblem P, std::size_t Capacity, class Arch>
class FilterMethod {
 public:
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  static constexpr std::size_t kNc = P::kNc;
  static constexpr std::size_t kNz = kNx + kNu;
  using Evaluate = Evaluation<P, Arch>;
  using V = Stages<Arch>;
  using Point = Iterate<kNx, kNu, Capacity>;
  using Lq = LqSolver<Arch, ProblemPattern<P>, Capacity>;
  using Layout = typename Lq::Layout;
  using Bounds = BoundBarrier<Lq, Capacity, Arch>;
  using Slacks = Barrier<P, Capacity, Arch>;
  using Linearised = Linearisation<P, Capacity, Arch>;
  enum class Outcome {
    kGoing,   ///< a step was taken
    kSolved,  ///< the problem of the last barrier is solved, loosely: near the solution
    kStuck,   ///< no step and no simulation helps
    kSpent    ///< the deadline is spent
  };

  /// Starts at `t`, whose inputs are moved off their bounds. The last barrier is `final_mu` in the problem's
  /// unit of costs; the first one is lower if `is_near` a solution.
  void start(const P& problem, double final_mu, bool is_exact, bool is_near, Linearised& now, Lq& lq,
             Slacks& slacks, Point& t, SolveReport& report) noexcept {
    for (std::size_t m = 0; m < kNu; ++m) {
      for (std::size_t k = 0; k < t.horizon; ++k)
        t.u[m][k] = Bounds::inside(t.u[m][k], now.lower[m][k], now.upper[m][k]);
    }
    has_multipliers_ = false;
    is_exact_ = is_exact;
    is_fresh_ = is_new_barrier_ = are_sides_new_ = true;
    is_here_known_ = false;
    mu_ = kFirstBarrier;
    slacks.set_mu(kFirstBarrier);
    if constexpr (kHasHardRows<P>) {
      if (rows_ != nullptr) {
        rows_->hard_penalty = kHardPenalty;
        now.hard.begin(*rows_);
      }
    }
    linearise<1>(problem, now, lq, slacks, t, report);
    double steepest = 0.0;
    keep_gradient(lq, t.horizon);
    for (std::size_t k = 0; k < t.horizon; ++k) {
      for (const double slope : gradient_[k]) steepest = std::max(steepest, std::fabs(slope));
    }
    for (std::size_t i = 0; i < kNx; ++i) steepest = std::max(steepest, std::fabs(lq.lq.terminal[kNx][i]));
    unit_ = std::isfinite(steepest) ? std::max(1.0, steepest / kSteep) : 1.0;
    mu_ = (is_near ? kNearBarrier : kFirstBarrier) * unit_;
    final_mu_ = std::min(final_mu, mu_);
    slacks.set_mu(mu_);
    is_fresh_ = true;
    if constexpr (kHasHardRows<P>) {
      if (rows_ != nullptr) {
        rows_->hard_penalty = kHardPenalty * unit_;
        now.hard.weigh(kRowWeight * unit_, rows_->violation_penalty, t.horizon);
      }
    }
    last_shift_ = forced_shift_ = 0.0;
    failures_ = simulations_ = 0;
    candidate_ = t;
    short_steps_ = leaps_ = 0;
    floor_ = {};
    rows_lag_ = false;
    last_missed_ = 0.0;
  }
  /// Makes hard rows of the problem `rows` equations with slacks and multipliers, which the problem keeps.
  /// Null: they are residuals like others. Call it before start().
  void take_rows(P* rows) noexcept { rows_ = rows; }
  [[nodiscard]] double mu() const noexcept { return mu_; }
  /// Hands the working set of the present point over to `lq`, and keeps what resume() needs.
  void hand_over(const Linearised& now, Lq& lq) noexcept {
    bounds_.choose_working_set(lq);
    for (std::size_t i = 0; i < kNx; ++i)
      std::copy(now.adjoint[i], now.adjoint[i] + candidate_.horizon, multipliers_[i]);
  }
  /// Continues with a lower barrier from the point of hand_over(). False if the barrier cannot be lower.
  bool resume(Linearised& now, Slacks& slacks, Point& t, bool is_fresh) noexcept {
    constexpr double kLeast = 1e-13;  // least barrier, in the unit of costs; chosen
    if (final_mu_ <= kLeast * unit_) return false;
    final_mu_ = std::max(kLeast * unit_, 1e-2 * final_mu_);
    floor_ = {};
    t = candidate_;
    for (std::size_t i = 0; i < kNx; ++i)
      std::copy(multipliers_[i], multipliers_[i] + t.horizon, now.adjoint[i]);
    slacks.set_mu(mu_);
    is_fresh_ = is_fresh;
    is_new_barrier_ = true;
    is_here_known_ = false;
    return true;
  }
  /// Number of successive iterations, up to the last one, with a short step length.
  [[nodiscard]] int short_steps() const noexcept { return short_steps_; }
  /// Longest move of an input in the last step.
  [[nodiscard]] double moved() const noexcept { return moved_; }
  /// Present point; after start().
  [[nodiscard]] const Point& point() const noexcept { return candidate_; }

  /// Makes one linearisation and one step from t. Pre: `t` is unchanged since the last call.
  Outcome iterate(const P& problem, Linearised& now, Lq& lq, Slacks& slacks, Point& t,
                  const Deadline& deadline, SolveReport& report) noexcept {
    if constexpr (kHasHardRows<P>) {
      if (rows_ != nullptr && rows_lag_)
        now.hard.raise(*rows_, kRise, kMostRowWeight * unit_, mu_, t.horizon);
    }
    linearise(problem, now, lq, slacks, t, report);
    if (!std::isfinite(report.cost + report.defect + report.complementarity)) return Outcome::kStuck;
    if (are_sides_new_) bounds_.start(lq, t.horizon, mu_);
    are_sides_new_ = false;
    const double error = residual(now, lq, t, report);
    const bool is_solved = error <= kSolvedAt * mu_;
    rows_lag_ = !is_solved && missed_ >= error && missed_ > 0.5 * last_missed_ && length_ > 0.9;
    last_missed_ = missed_;
    const double floor = std::max(kFloor * unit_, kHasHardRows<P> && mu_ <= final_mu_ ? kLooseFloor : 0.0);
    if (is_solved || floor_.is_reached(error, floor)) {
      candidate_ = t;
      if (mu_ <= final_mu_) return is_solved || error <= floor ? Outcome::kSolved : Outcome::kStuck;
      const double last = mu_;
      lower_barrier(slacks);
      follow_barrier(problem, last, now, lq, slacks, t.horizon);
    }
    if (!is_here_known_) here_ = measure(problem, now, slacks, t, 0.0);
    is_here_known_ = false;
    const Merit here = here_;
    if (!here.is_finite()) return Outcome::kStuck;
    if (is_new_barrier_) {
      filter_.reset(1e4 * std::max(1.0, here.miss));
      small_miss_ = 1e-4 * std::max(1.0, here.miss);
      is_new_barrier_ = false;
    }
    keep_gradient(lq, t.horizon);
    bounds_.add_to(lq, mu_);
    if (deadline.spent()) return Outcome::kSpent;
    if (!factorise(lq, t.horizon, report.sweeps)) {
      failures_ = std::max(failures_, 1);
      return recover(problem, lq, t);
    }
    lq.forward(t.horizon, Lq::Repair::kNone);
    collect_step<Arch, false>(lq, t.horizon, step_);
    return search(problem, now, lq, slacks, t, here, deadline);
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Chosen; kSteep, kSolvedAt and the barriers as usual for the method (Wächter, Biegler 2006).
  static constexpr double kNearBarrier = 1e-3;  ///< first barrier near a solution
  static constexpr double kFirstBarrier = 0.1;  ///< first barrier for gradients of at most kSteep
  static constexpr double kSteep = 100.0;       ///< slope of costs up to which they need no scaling
  static constexpr double kShort = 0.1;         ///< length up to which a step is short
  static constexpr int kShortInSuccession =
      3;                                       ///< short steps before a leap: a whole step without the filter
  static constexpr int kMostLeaps = 4;         ///< limit of leaps
  static constexpr double kRowWeight = 1e6;    ///< first weight ρ of hard rows, in the unit of costs
  static constexpr double kHardPenalty = 1e6;  ///< penalty of hard constraints, in the unit of costs
  static constexpr double kRise = 10.0;        ///< rise of a weight whose multipliers lag behind
  static constexpr double kMostRowWeight = 1e10;  ///< largest weight of hard rows, in the unit of costs
  static constexpr double kSolvedAt = 10.0;  ///< error over the barrier at which its problem counts as solved
  static constexpr double kLooseFloor = 1e-2;  ///< largest error by rounding at the last barrier of hard rows
  static constexpr double kFloor = 1e-5;       ///< largest error by rounding, in the unit of costs

  /// Position of variable i of (x, u) in z = (x, 1, u).
  static constexpr std::size_t z(std::size_t i) noexcept { return i < kNx ? i : i + 1; }

  // ---- linearisation

  /// Linearises with derivatives up to Order.
  template <int Order>
  void linearise(const P& problem, Linearised& now, Lq& lq, Slacks& slacks, const Point& t,
                 SolveReport& report) noexcept {
    if constexpr (kHasHardRows<P>) {
      if (rows_ != nullptr && is_fresh_ && now.hard.is_ready()) centre_rows(problem, now, t);
    }
    now.state_residual = has_multipliers_ ? residual_ : nullptr;
    now.template linearise<Order>(problem, t, is_fresh_, 1.0, slacks, lq.lq, report);
    now.state_residual = nullptr;
    is_fresh_ = false;
  }
  /// Puts hard rows on their central path.
  void centre_rows(const P& problem, Linearised& now, const Point& t) noexcept;
  /// Linearises with exact Hessians, or Gauss–Newton's as long as there are no multipliers.
  void linearise(const P& problem, Linearised& now, Lq& lq, Slacks& slacks, const Point& t,
                 SolveReport& report) noexcept {
    if constexpr (has_hessians<P>()) {
      if (has_multipliers_ && is_exact_) return linearise<2>(problem, now, lq, slacks, t, report);
    }
    linearise<1>(problem, now, lq, slacks, t, report);
  }

  /// Error of the barrier problem's optimality conditions (eq. 34).
  double residual(const Linearised& now, const Lq& lq, const Point& t, const SolveReport& report) noexcept;
  /// Lowers the barrier, and the merit of the present point with it.
  void lower_barrier(Slacks& slacks) noexcept {
    const double share = mu_ / unit_, last = mu_;
    mu_ = std::max(final_mu_, unit_ * std::min(0.2 * share, share * std::sqrt(share)));
    here_.cost += (last - mu_) * here_.logs;
    slacks.set_mu(mu_);
    is_new_barrier_ = true;
    floor_ = {};
  }

  /// Updates the linearisation of the present point after the barrier was lowered from `last`: only slopes
  /// change, by the forces of slacks (eq. 20, 53).
  void follow_barrier(const P& problem, double last, Linearised& now, Lq& lq, const Slacks& slacks,
                      std::size_t horizon) noexcept {
    slacks.each_pull(problem, last, horizon, [&](std::size_t k, std::size_t j, double pull) {
      lq.lq.set_cost(k, z(j), Layout::kOne, lq.lq.cost(k, z(j), Layout::kOne) + pull);
    });
    if constexpr (kHasHardRows<P>) {
      if (rows_ == nullptr) return;
      now.hard.set_rows(*rows_, mu_, horizon, lq.lq.terminal[kNx],
                        [&](std::size_t k, std::size_t j, double pull) {
                          lq.lq.set_cost(k, z(j), Layout::kOne, lq.lq.cost(k, z(j), Layout::kOne) + pull);
                        });
    }
  }

  // ---- the step

  /// Copies the gradients of the stage costs, before bounds add to them.
  void keep_gradient(const Lq& lq, std::size_t horizon) noexcept {
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t i = 0; i < kNz; ++i) gradient_[k][i] = lq.lq.cost(k, z(i), Layout::kOne);
    }
  }
  /// Factorises, with Hessians shifted until the quadratic program is convex (eq. 33). False if no shift
  /// suffices.
  bool factorise(Lq& lq, std::size_t horizon, int& sweeps) noexcept {
    const double most = 1e10 * unit_;
    shift_ = forced_shift_;
    forced_shift_ = 0.0;
    while (shift_ <= most) {
      ++sweeps;
      if (!(lq.backward_shifted(horizon, shift_) > 0.0)) {
        if (shift_ > 0.0) last_shift_ = shift_;
        return true;
      }
      const bool is_known = last_shift_ > 0.0;
      if (shift_ > 0.0) {
        shift_ *= is_known ? 8.0 : 100.0;
      } else {
        shift_ = is_known ? std::max(1e-12 * unit_, last_shift_ / 3.0) : 1e-4 * unit_;
      }
    }
    last_shift_ = 0.0;
    return false;
  }
  /// Slope of cost and barriers along the step.
  double slope_along(const Lq& lq, std::size_t horizon) const noexcept {
    double sum = bounds_.slope(mu_) + soft_.slope();
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t i = 0; i < kNx; ++i) sum += gradient_[k][i] * step_.x[i][k];
      for (std::size_t m = 0; m < kNu; ++m) sum += gradient_[k][kNx + m] * step_.u[m][k];
    }
    for (std::size_t i = 0; i < kNx; ++i) sum += lq.lq.terminal[kNx][i] * step_.x[i][horizon];
    return sum;
  }

  // ---- the line search

  /// Halves the step until the filter accepts it. After some trials simulations that keep a share of the
  /// defects are tried, too.
  Outcome search(const P& problem, Linearised& now, const Lq& lq, Slacks& slacks, Point& t, const Merit& here,
                 const Deadline& deadline) noexcept {
    constexpr int kPatience = 4;        // trials before a simulation is tried; chosen
    constexpr double kFraction = 0.99;  // least share of the way of a slack to zero; usual for the method
    const double fraction = std::max(kFraction, 1.0 - mu_ / unit_);
    const StepLengths own = bounds_.find(lq, step_, mu_, fraction);
    const StepLengths soft = soft_.find(problem, slacks, step_, fraction);
    double dual = std::min(own.dual, soft.dual);
    double length = std::min(own.primal, soft.primal);
    double slope = slope_along(lq, t.horizon);
    if constexpr (kHasHardRows<P>) {
      if (rows_ != nullptr) {
        const StepLengths hard = now.hard.find(problem, step_, mu_, fraction);
        dual = std::min(dual, hard.dual);
        length = std::min(length, hard.primal);
        slope += now.hard.slope();
      }
    }
    const double least = least_length(here, slope);
    // After short steps in succession, which the filter causes where whole steps would converge (Maratos
    // effect), one whole step is taken without the filter.
    const bool crawls = kHasHardRows<P> && short_steps_ >= kShortInSuccession && leaps_ < kMostLeaps;
    for (int trial = 0; trial == 0 || length >= least; ++trial, length *= 0.5) {
      if (deadline.spent()) return Outcome::kSpent;
      add_step<Arch>(t, length, step_, candidate_);
      Merit there = measure(problem, now, slacks, candidate_, length);
      bool is_good = is_acceptable(here, there, slope, length);
      // A step whose second order opens defects (Maratos effect) is simulated: the same direction without
      // them.
      const bool opens_defects = kHasHardRows<P> && there.miss > here.miss;
      if (!is_good && (trial >= kPatience || opens_defects)) {
        const bool is_there = simulate(problem, lq, t, length);
        there = is_there ? measure(problem, now, slacks, candidate_, length, &lq, &t)
                         : Merit{kInfinity, kInfinity};
        is_good = is_there && is_acceptable(here, there, slope, length);
      }
      if (!is_good && crawls && trial == 0 && there.is_finite()) {
        is_good = is_new_barrier_ = true;
        ++leaps_;
      }
      if (!is_good) continue;
      if (length >= 0.05 || there.miss <= 0.9 * here.miss) failures_ = 0;
      short_steps_ = length < kShort ? short_steps_ + 1 : 0;
      length_ = length;
      moved_ = max_input_change(t, candidate_);
      floor_.note_step(equal_within_rounding<Arch>(t, candidate_) && !(there.miss < 0.9 * here.miss));
      t = candidate_;
      here_ = there;
      is_here_known_ = true;
      bounds_.move(dual, mu_);
      soft_.move(slacks, t.horizon, dual);
      const double share = has_multipliers_ ? length : 1.0;
      if constexpr (kHasHardRows<P>) {
        if (rows_ != nullptr) now.hard.move(*rows_, share, dual, mu_, t.horizon);
      }
      take_multipliers(lq, now, t.horizon, share);
      has_multipliers_ = true;
      return Outcome::kGoing;
    }
    last_shift_ = shift_;
    return recover(problem, lq, t);
  }
  /// Whether a point is accepted by the rule of Wächter and Biegler: enough descent if the equations hold and
  /// the step promises it, else less violation or less cost.
  bool is_acceptable(const Merit& here, const Merit& there, double slope, double length) noexcept {
    if (!filter_.accepts(there)) return false;
    const double rounding = 1e-13 * std::fabs(here.cost);
    const bool promises = slope < 0.0 && length > worth(here.miss, slope);
    if (here.miss <= small_miss_ && promises)
      return there.cost <= here.cost + 1e-4 * length * slope + rounding;
    const bool is_better = there.miss <= (1.0 - Filter::kMissMargin) * here.miss + 1e-14 ||
                           there.cost <= here.cost - Filter::kCostMargin * here.miss + rounding;
    if (is_better) filter_.add(here);
    return is_better;
  }
  /// Length from which on the descent of a step outweighs the miss: miss^1.1 / (−slope)^2.3. Pre: slope < 0.
  static double worth(double miss, double slope) noexcept {
    return miss > 0.0 ? exp(1.1 * log(miss) - 2.3 * log(-slope)) : 0.0;
  }
  /// Least length that the line search tries.
  double least_length(const Merit& here, double slope) const noexcept {
    double least = Filter::kMissMargin;
    if (slope < 0.0) {
      least = std::min(least, Filter::kCostMargin * here.miss / -slope);
      if (here.miss <= small_miss_) least = std::min(least, worth(here.miss, slope));
    }
    return std::max(0.05 * least, 1e-10);
  }
  /// Moves the multipliers of the dynamics by `length` of their direction.
  void take_multipliers(const Lq& lq, Linearised& now, std::size_t horizon, double length) noexcept {
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t i = 0; i < kNx; ++i) {
        double& multiplier = now.adjoint[i][k];
        multiplier += length * (lq.multiplier(k + 1, i) - multiplier);
      }
    }
  }

  /// Merit of `point` with the slacks at `length` of their direction (0: at the present point). With `from`,
  /// whose bounds are in `lq`, slacks of bounds are those of `point`.
  Merit measure(const P& problem, Linearised& now, const Slacks& slacks, const Point& point, double length,
                const Lq* lq = nullptr, const Point* from = nullptr) noexcept;

  /// Values of the hard rows of the end by their residuals.
  static auto unshifted(const P& problem, const double* residuals) noexcept {
    std::array<double, static_cast<std::size_t>(P::kNe) + 1> values{};
    if constexpr (kHasHardRows<P>) {
      for (std::size_t n = 0; n < Linearised::Hard::kEndRows; ++n)
        values[n] = residuals[n] / problem.terminal_weight[n].root - problem.terminal_shift[n];
    }
    return values;
  }
  /// Values of the hard rows of the end at t.
  static auto end_rows(const P& problem, const Point& t) noexcept {
    double residuals[P::kNe + 1]{};
    Evaluate::end_cost(problem, t, residuals);
    return unshifted(problem, residuals);
  }

  // ---- recovery when no step is accepted

  /// Recovers: first by a larger shift, then by new multipliers and slacks, then by a simulation, which has
  /// no defects. With hard rows restoration follows instead of a simulation.
  Outcome recover(const P& problem, const Lq& lq, Point& t) noexcept {
    constexpr int kMostSimulations = 8;  // limit in one solve; chosen
    candidate_ = t;
    ++failures_;
    if (failures_ == 1) {
      forced_shift_ = last_shift_ = std::max(100.0 * last_shift_, 1e-2 * unit_);
      return Outcome::kGoing;
    }
    is_new_barrier_ = is_fresh_ = true;
    has_multipliers_ = false;
    if (failures_ == 2) return Outcome::kGoing;
    failures_ = 1;
    if constexpr (kHasHardRows<P>) {
      if (rows_ != nullptr && rows_->violation_penalty == 0.0) return Outcome::kStuck;
    }
    if (++simulations_ > kMostSimulations) return Outcome::kStuck;
    if (!simulate(problem, lq, t, 1.0, 0.0) && !simulate(problem, lq, t, 0.0, 0.0)) {
      candidate_ = t;
      return Outcome::kStuck;
    }
    t = candidate_;
    are_sides_new_ = true;
    return Outcome::kGoing;
  }
  /// Simulates a step of `length` with its feedback; the rest of each defect stays.
  bool simulate(const P& problem, const Lq& lq, const Point& t, double length) noexcept {
    return simulate(problem, lq, t, 1.0, length, 1.0 - length);
  }
  /// Simulates candidate_: inputs of t, with `feedback` times the gains and `length` of the step's constant
  /// part, cut to 0.99 of the way to their bounds; a share `kept` of each defect stays. False if it is not
  /// finite.
  bool simulate(const P& problem, const Lq& lq, const Point& t, double feedback, double length,
                double kept = 0.0) noexcept;

  Bounds bounds_;                      ///< slacks of the inputs' bounds
  SoftSteps<P, Capacity, Arch> soft_;  ///< directions of the soft constraints' slacks
  Filter filter_;
  Point step_;       ///< step of the quadratic program
  Point candidate_;  ///< point of the line search; between iterations the present one
  alignas(64) double residual_[kNx][kStageStride<Capacity>]{};  ///< residual of optimality in the states
  double multipliers_[kNx][Capacity]{};                         ///< multipliers at the last hand_over()
  double gradient_[Capacity][kNz]{};                            ///< gradients of the stage costs
  double mu_ = kFirstBarrier;                                   ///< present barrier
  double final_mu_ = 1e-6;                                      ///< last barrier
  double unit_ = 1.0;                                           ///< unit of costs
  double small_miss_ = 0.0;                                     ///< miss up to which the cost has to fall
  double shift_ = 0.0;                                          ///< shift of this iteration's Hessians
  double last_shift_ = 0.0;                                     ///< last shift that was needed
  double forced_shift_ = 0.0;                                   ///< least shift of the next iteration
  bool is_exact_ = true;                                        ///< whether Hessians are exact
  bool has_multipliers_ = false;  ///< whether multipliers of the dynamics are known
  bool is_fresh_ = true;          ///< whether the slacks of soft constraints go to their central path
  bool is_new_barrier_ = true;    ///< whether the filter belongs to another barrier
  bool are_sides_new_ = true;     ///< whether the slacks of bounds belong to another point
  int short_steps_ = 0;           ///< short steps in succession
  int leaps_ = 0;                 ///< whole steps without the filter
  FloorWatch floor_;
  P* rows_ = nullptr;           ///< take_rows()
  double moved_ = 0.0;          ///< moved()
  double length_ = 0.0;         ///< length of the last step
  double missed_ = 0.0;         ///< residual of the hard rows
  double last_missed_ = 0.0;    ///< residual of the hard rows one iteration before
  bool rows_lag_ = false;       ///< whether the hard rows' residual is the largest and hardly falls
  Merit here_{};                ///< merit of the present point
  bool is_here_known_ = false;  ///< whether the line search has set here_
  int failures_ = 0;            ///< recoveries without progress since
  int simulations_ = 0;         ///< simulations in this solve
};

}  // namespace chicane::solver

#include "chicane/solver/detail/filter_trials.hpp"
