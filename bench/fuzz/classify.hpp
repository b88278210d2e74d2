// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "chicane/base/random.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "chicane/solver/warm_start.hpp"
#include "problems/dual.hpp"
#include "problems/optimality.hpp"

namespace chicane::bench {

/// Equations that must hold, in the inputs alone: a simulation, and Levenberg and Marquardt's method on the
/// rows that are missed, inputs inside their bounds. Shares no line with the solver; dense, for small
/// problems.
template <solver::OcpProblem P, int Capacity>
class Misses {
 public:
  using Trajectory = solver::Trajectory<P::kNx, P::kNu, Capacity>;

  Misses(const OverArrays<P>& problem, const Trajectory& t)
      : problem_{problem},
        horizon_{t.horizon},
        count_{static_cast<std::size_t>(t.horizon) * kNu},
        start_{t.x[0]} {
    for (int k = 0; k < t.horizon; ++k) {
      const auto& u = t.u[static_cast<std::size_t>(k)];
      inputs_.insert(inputs_.end(), u.begin(), u.end());
    }
  }

  /// Largest miss after short steps that lessen the sum of squares; infinite where the inputs cannot be
  /// simulated.
  [[nodiscard]] double worst_after_descent(double enough) {
    if (!simulate(inputs_, true)) return HUGE_VAL;
    double least = worst_;
    double damping = -1.0;
    for (int turn = 0; turn < 60 && least > enough; ++turn) {
      normal_equations();
      double largest = 1e-12;
      for (std::size_t i = 0; i < count_; ++i) largest = std::max(largest, matrix_[i * count_ + i]);
      if (damping < 0.0) damping = 10.0 * largest;
      const double before = sum_;
      bool is_better = false;
      for (int trial = 0; trial < 12 && !is_better; ++trial, damping *= is_better ? 0.1 : 10.0) {
        const std::vector<double> there = stepped(damping);
        is_better = simulate(there, false) && sum_ < before * (1.0 - 1e-6);
        if (is_better) inputs_ = there;
      }
      if (!is_better || !simulate(inputs_, true)) break;
      least = std::min(least, worst_);
    }
    return least;
  }

 private:
  static constexpr std::size_t kNx = P::kNx, kNu = P::kNu, kNz = kNx + kNu;
  using D = Dual<static_cast<int>(kNz)>;

  /// Rows, and with `derivatives` their slopes, at `inputs`. False when a number is not finite.
  bool simulate(const std::vector<double>& inputs, bool derivatives) {
    sum_ = worst_ = 0.0;
    rows_.clear();
    slopes_.clear();
    std::array<double, kNx> at = start_;
    std::vector<double> by_input(kNx * count_, 0.0);  // dx/du
    const auto add = [&](const D& value, int stage) {
      sum_ += 0.5 * value.v * value.v;
      worst_ = std::max(worst_, std::fabs(value.v));
      if (!derivatives) return;
      rows_.push_back(value.v);
      std::vector<double> slope(count_, 0.0);
      chain(value, by_input, stage, slope.data());
      slopes_.insert(slopes_.end(), slope.begin(), slope.end());
    };
    for (int stage = 0; stage < horizon_; ++stage) {
      std::array<double, kNu> input;
      std::copy_n(inputs.begin() + stage * P::kNu, kNu, input.begin());
      const auto x = variables_at<D>(at, 0);
      const auto u = variables_at<D>(input, P::kNx);
      for (const D& h : problem_.template equality<D>(stage, x, u)) add(h, stage);
      if constexpr (P::kNc > 0) {
        int c = 0;
        for (const D& value : problem_.template constraint<D>(stage, x, u)) {
          if (is_hard(problem_, c++) && value.v > 0.0) add(value, stage);
        }
      }
      const auto next = problem_.template dynamics<D>(stage, x, u);
      std::vector<double> by_next(kNx * count_, 0.0);
      for (std::size_t i = 0; i < kNx; ++i) {
        at[i] = next[i].v;
        if (!std::isfinite(at[i])) return false;
        if (derivatives) chain(next[i], by_input, stage, by_next.data() + i * count_);
      }
      by_input.swap(by_next);
    }
    const auto x = variables_at<D>(at, 0);
    for (const D& h : problem_.template terminal_equality<D>(x)) add(h, -1);
    for (const D& g : problem_.template terminal_constraint<D>(x)) {
      if (g.v > 0.0) add(g, -1);
    }
    return std::isfinite(sum_);
  }
  /// Slopes of `value`, a function of the state and, where stage >= 0, of its inputs, by all inputs.
  void chain(const D& value, const std::vector<double>& by_input, int stage, double* slope) const {
    for (std::size_t i = 0; i < kNx; ++i) {
      for (std::size_t j = 0; j < count_; ++j) slope[j] += value.d[i] * by_input[i * count_ + j];
    }
    for (std::size_t m = 0; stage >= 0 && m < kNu; ++m)
      slope[static_cast<std::size_t>(stage) * kNu + m] += value.d[kNx + m];
  }
  void normal_equations() {
    matrix_.assign(count_ * count_, 0.0);
    gradient_.assign(count_, 0.0);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const double* slope = slopes_.data() + r * count_;
      for (std::size_t i = 0; i < count_; ++i) {
        gradient_[i] += slope[i] * rows_[r];
        for (std::size_t j = 0; slope[i] != 0.0 && j <= i; ++j)
          matrix_[i * count_ + j] += slope[i] * slope[j];
      }
    }
  }
  /// Inputs after a step of the shifted normal equations; those at a bound that hinders them stay.
  [[nodiscard]] std::vector<double> stepped(double damping) const {
    std::vector<double> l = matrix_, y = gradient_, there = inputs_;
    std::vector<bool> is_held(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const auto [low, high] = bounds(i);
      is_held[i] = (inputs_[i] <= low && gradient_[i] > 0.0) || (inputs_[i] >= high && gradient_[i] < 0.0);
      l[i * count_ + i] += damping;
      if (!is_held[i]) continue;
      for (std::size_t j = 0; j < count_; ++j) (j < i ? l[i * count_ + j] : l[j * count_ + i]) = 0.0;
      l[i * count_ + i] = 1.0;
      y[i] = 0.0;
    }
    for (std::size_t i = 0; i < count_; ++i) {  // Cholesky
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = l[i * count_ + j];
        for (std::size_t n = 0; n < j; ++n) sum -= l[i * count_ + n] * l[j * count_ + n];
        l[i * count_ + j] = i == j ? std::sqrt(std::max(sum, 1e-30)) : sum / l[j * count_ + j];
      }
    }
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t n = 0; n < i; ++n) y[i] -= l[i * count_ + n] * y[n];
      y[i] /= l[i * count_ + i];
    }
    for (std::size_t i = count_; i-- > 0;) {
      for (std::size_t n = i + 1; n < count_; ++n) y[i] -= l[n * count_ + i] * y[n];
      y[i] /= l[i * count_ + i];
      const auto [low, high] = bounds(i);
      there[i] = std::min(std::max(inputs_[i] - y[i], low), high);
    }
    return there;
  }
  [[nodiscard]] std::pair<double, double> bounds(std::size_t i) const {
    const auto stage = static_cast<int>(i / kNu);
    return {problem_.input_lower(stage)[i % kNu], problem_.input_upper(stage)[i % kNu]};
  }

  const OverArrays<P>& problem_;
  int horizon_;
  std::size_t count_;  ///< of inputs
  std::array<double, P::kNx> start_;
  std::vector<double> inputs_;
  std::vector<double> rows_, slopes_, matrix_, gradient_;
  double sum_ = 0.0;    ///< ½ Σ miss²
  double worst_ = 0.0;  ///< largest miss
};

/// What is wrong with an answer.
enum class Wrong {
  kNothing,
  kInputs,           ///< not finite, or outside their bounds
  kFalseOptimal,     ///< optimal, infeasible or at the floor, and the conditions of optimality do not hold
  kFalseUsable,      ///< usable, and residuals are above the loose tolerance
  kFalseFeasible,    ///< optimal, and a constraint is violated by more than its cap
  kFalseInfeasible,  ///< though no cap is exceeded, or what is missed can be lessened
  kDearer,     ///< not usable, and costs more than the guess; with something that must hold: misses more, too
  kNotFinite,  ///< though data and simulated guess are finite
  kOptimalData,  ///< usable, though the data are not finite
  kSlow,         ///< took seconds
  kCount
};
inline constexpr const char* kWrongNames[] = {
    "nothing",          "inputs", "false optimal",    "false usable",        "false feasible",
    "false infeasible", "dearer", "false not finite", "usable without data", "slow"};

/// One solve: what goes in, and what came back.
template <class P, int Capacity>
struct FuzzCase {
  P problem;
  std::array<double, P::kNx> start{};
  solver::SolverOptions options;
  solver::Trajectory<P::kNx, P::kNu, Capacity> guess;
  solver::Trajectory<P::kNx, P::kNu, Capacity> answer;
  std::conditional_t<solver::HardProblem<P>, solver::HardReport, solver::SolveReport> report;
};

/// Judges an answer by functions of the problem alone, with dual numbers.
template <class P, int Capacity, class Ocp>
class Judge {
 public:
  using Case = FuzzCase<P, Capacity>;
  Judge(const Case& one, const Ocp& ocp) : case_{one}, ocp_{ocp}, arrays_{one.problem} {}

  [[nodiscard]] Wrong verdict() const {
    using enum solver::SolveStatus;
    const auto status = case_.report.status;
    const bool has_data = data_are_good();
    if (!inputs_are_good(has_data)) return Wrong::kInputs;
    if (!has_data) return status == kNotFinite ? Wrong::kNothing : Wrong::kOptimalData;
    if (status == kNotFinite) return guess_is_finite() ? Wrong::kNotFinite : Wrong::kNothing;
    const KktResidual kkt = check(case_.answer);
    const double tolerance = case_.options.tolerance, loose = case_.options.loose_tolerance;
    if (status == kOptimal || status == kInfeasible) {
      if (!(kIsHard && status == kInfeasible) && !fulfils(kkt, tolerance)) return Wrong::kFalseOptimal;
      if constexpr (kIsHard) {
        if (status == kInfeasible && kkt.miss > tolerance) {
          const double least = Misses<P, Capacity>(arrays_, case_.answer).worst_after_descent(tolerance);
          return least > tolerance ? Wrong::kNothing : Wrong::kFalseInfeasible;
        }
      }
      const double excess = worst_violation() - case_.problem.soft_penalty(0).cap;
      if (status == kOptimal && excess > 1e-12) return Wrong::kFalseFeasible;
      if (status == kInfeasible && excess < -1e-12) return Wrong::kFalseInfeasible;
    }
    if (status == kAtFloor && !fulfils(kkt, std::max(tolerance, 1e-6))) return Wrong::kFalseOptimal;
    if (status == kBudgetSpent && !fulfils(kkt, loose)) return Wrong::kFalseUsable;
    const bool is_chaotic =
        kkt.defect > 1e-9 && case_.report.defect == 0.0;  // a simulation, up to its rounding
    if (status == kStalled && !is_chaotic && costs_more_than_guess()) return Wrong::kDearer;
    return Wrong::kNothing;
  }
  [[nodiscard]] KktResidual check(const solver::Trajectory<P::kNx, P::kNu, Capacity>& t) const {
    return check_kkt(arrays_, t, ocp_);
  }

 private:
  static constexpr bool kIsHard = solver::HardProblem<P>;
  using One = Dual<P::kNx + P::kNu>;

  [[nodiscard]] bool data_are_good() const {
    for (const double x : case_.start) {
      if (!std::isfinite(x)) return false;
    }
    const auto low = case_.problem.input_lower(0), high = case_.problem.input_upper(0);
    return std::equal(low.begin(), low.end(), high.begin(), std::less_equal<>{});
  }
  [[nodiscard]] bool inputs_are_good(bool has_data) const {
    const auto low = case_.problem.input_lower(0), high = case_.problem.input_upper(0);
    for (int k = 0; k < case_.answer.horizon; ++k) {
      for (std::size_t m = 0; m < low.size(); ++m) {
        const double u = case_.answer.u[static_cast<std::size_t>(k)][m];
        if (!std::isfinite(u) || (has_data && !(u >= low[m] && u <= high[m]))) return false;
      }
    }
    return true;
  }
  /// Residuals of an optimum within `tolerance`, and what rounding leaves of them.
  [[nodiscard]] bool fulfils(const KktResidual& kkt, double tolerance) const {
    const double steep = P::kNc > 0 ? case_.problem.soft_penalty(0).quadratic : 0.0;
    return kkt.stationarity <= 1.5 * tolerance + 4.0 * kkt.rounding &&
           kkt.defect <= 1.5 * tolerance + 1e-13 && kkt.miss <= 1.5 * tolerance &&
           kkt.outside <= 0.0 + 1e-9 &&
           kkt.subgradient <= 3.0 * std::sqrt(tolerance) + tolerance * (1.0 + steep);
  }
  [[nodiscard]] double worst_violation() const {
    double worst = -std::numeric_limits<double>::infinity();
    if constexpr (P::kNc > 0) {
      for (int k = 0; k < case_.answer.horizon; ++k) {
        const auto stage = static_cast<std::size_t>(k);
        int row = 0;
        const auto x = variables_at<One>(case_.answer.x[stage], 0);
        for (const One& c :
             arrays_.template constraint<One>(k, x, variables_at<One>(case_.answer.u[stage], P::kNx))) {
          if (!is_hard(arrays_, row++)) worst = std::max(worst, c.v);
        }
      }
    }
    return worst;
  }
  /// Of the guess as the solver takes it: simulated, or its states where those count.
  [[nodiscard]] bool guess_is_finite() const {
    const auto t = std::make_unique<solver::Trajectory<P::kNx, P::kNu, Capacity>>(case_.guess);
    if (!solver::roll_out(case_.problem, case_.start, *t)) return false;
    const KktResidual kkt = check(*t);
    return std::isfinite(kkt.cost + kkt.stationarity) && kkt.cost < 1e100 && kkt.miss < 1e50;
  }
  /// Both simulated.
  [[nodiscard]] bool costs_more_than_guess() const {
    const auto t = std::make_unique<solver::Trajectory<P::kNx, P::kNu, Capacity>>(case_.guess);
    const auto own = std::make_unique<solver::Trajectory<P::kNx, P::kNu, Capacity>>(case_.answer);
    if (!solver::roll_out(case_.problem, case_.start, *t)) return false;
    const KktResidual before = check(*t);
    if (!std::isfinite(before.cost)) return false;
    if (!solver::roll_out(case_.problem, case_.start, *own)) return true;
    const KktResidual after = check(*own);
    if (kIsHard && after.miss <= before.miss * (1.0 + 1e-6) + 1e-9) return false;
    return !(after.cost <= before.cost * (1.0 + 1e-6) + 1e-9);
  }

  const Case& case_;
  const Ocp& ocp_;
  OverArrays<P> arrays_;
};

[[nodiscard]] inline double not_a_number(Random& random) {
  const double u = random.uniform();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return u < 0.4 ? std::numeric_limits<double>::quiet_NaN() : (u < 0.7 ? kInfinity : -kInfinity);
}

/// A random problem with start, guess and options; a few of their numbers are none.
template <class P, int Capacity>
void make_case(Random& random, FuzzCase<P, Capacity>& one) {
  static_cast<typename P::Data&>(one.problem) = P::Data::make(random);
  const auto chance = [&](double share) { return random.uniform() < share; };
  const double wide = chance(0.1) ? 100.0 : 1.0;
  for (double& x : one.start) x = chance(0.002) ? not_a_number(random) : wide * random.normal();
  one.guess.horizon = chance(0.1) ? 1 : 2 + static_cast<int>(random.uniform(0.0, Capacity - 2.0));
  const double guess = chance(0.5) ? 0.0 : (chance(0.1) ? 1e6 : 1.0);
  for (auto& u : one.guess.u) {
    for (double& v : u) v = chance(0.002) ? not_a_number(random) : guess * random.normal();
  }
  for (auto& x : one.guess.x) {
    for (double& v : x) v = chance(0.001) ? not_a_number(random) : random.normal();
  }
  constexpr std::array<double, 7> kTolerances{1e-10, 1e-9, 1e-8, 1e-6, 1e-6, 1e-4, 1e-3};
  one.options = {.tolerance = kTolerances[static_cast<std::size_t>(random.uniform(0.0, 7.0))],
                 .max_iterations = chance(0.3) ? 1 + static_cast<int>(random.uniform(0.0, 30.0)) : 500,
                 .may_start_short = !chance(0.2),
                 .start_from_states = chance(0.3),
                 .second_order = !chance(0.2)};
  if constexpr (requires { one.problem.make_hard(random, one.start, 1); })
    one.problem.make_hard(random, one.start, one.guess.horizon);
  one.answer = one.guess;
}

}  // namespace chicane::bench
