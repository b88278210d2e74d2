// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <type_traits>

#include "chicane/solver/ocp_solver.hpp"
#include "chicane/solver/warm_start.hpp"
#include "families/kkt.hpp"
#include "fuzz/misses.hpp"

namespace chicane::bench {

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
    const auto multiplier = [&](int k, int c) { return ocp_.constraint_multiplier(k, c); };
    if constexpr (kIsHard) {
      return check_kkt(arrays_, t, multiplier, ocp_);
    } else {
      return check_kkt(arrays_, t, multiplier);
    }
  }

 private:
  static constexpr bool kIsHard = solver::HardProblem<P>;

  [[nodiscard]] bool data_are_good() const {
    for (const double x : case_.start) {
      if (!std::isfinite(x)) return false;
    }
    const auto low = case_.problem.input_lower(0), high = case_.problem.input_upper(0);
    for (std::size_t m = 0; m < low.size(); ++m) {
      if (!(low[m] <= high[m])) return false;
    }
    return true;
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
        for (const auto& c : arrays_.template constraint<Dual<1>>(k, lift(case_.answer.x[stage]),
                                                                  lift(case_.answer.u[stage]))) {
          if (!is_hard(arrays_, row++)) worst = std::max(worst, c.v);
        }
      }
    }
    return worst;
  }
  template <std::size_t N>
  static std::array<Dual<1>, N> lift(const std::array<double, N>& from) {
    std::array<Dual<1>, N> to;
    for (std::size_t i = 0; i < N; ++i) to[i] = Dual<1>(from[i]);
    return to;
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

}  // namespace chicane::bench
