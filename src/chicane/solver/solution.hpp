// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "chicane/base/compiler.hpp"
#include "chicane/base/text.hpp"

/// Outcome of a solve: status and report.

namespace chicane::solver {

/// The table of SolveStatus. Columns: enumerator, number, name, severity, sentence (base/text.hpp).
// clang-format off
#define CHICANE_SOLVE_STATUSES(ROW)                                                                              \
  /* all residuals <= tolerance */                                                                               \
  ROW(kOptimal, 0, "optimal", kOk, "the solver converged")                                                       \
  /* deadline or max_iterations reached; bounds and hard constraints hold, residuals <= loose_tolerance */       \
  ROW(kBudgetSpent, 1, "budget_spent", kOk, "the solver stopped at its limit, close enough to the optimum")       \
  /* steps as short as rounding permits; residuals may be above tolerance */                                     \
  ROW(kAtFloor, 2, "at_floor", kOk, "the solver converged as far as rounding allows")                            \
  /* no further progress, or budget spent, before loose_tolerance */                                             \
  ROW(kStalled, -1, "stalled", kError, "the solver did not converge")                                            \
  /* converged, but a soft constraint is violated by more than its cap */                                        \
  ROW(kInfeasible, -2, "infeasible", kError, "the constraints cannot all hold")                                  \
  /* a NaN or infinity in the data or an iterate */                                                              \
  ROW(kNotFinite, -3, "not_finite", kError, "the problem contains a number that is not finite")
// clang-format on

#define CHICANE_ENUMERATOR(enumerator, number, name, severity, sentence) enumerator = (number),
/// Outcome of a solve. Zero and above: the solution may be used. Below zero: it must not be.
enum class SolveStatus : std::int8_t { CHICANE_SOLVE_STATUSES(CHICANE_ENUMERATOR) };
#undef CHICANE_ENUMERATOR

#define CHICANE_WORD(enumerator, number, name, severity, sentence) \
  Word<SolveStatus>{SolveStatus::enumerator, name, Severity::severity, sentence},
inline constexpr std::array kSolveStatusWords{CHICANE_SOLVE_STATUSES(CHICANE_WORD)};
#undef CHICANE_WORD

/// Whether the solution may be used.
[[nodiscard]] constexpr bool usable(SolveStatus status) noexcept { return static_cast<int>(status) >= 0; }
[[nodiscard]] constexpr std::string_view to_string(SolveStatus status) noexcept {
  const Word<SolveStatus>* const word = find_word<SolveStatus>(kSolveStatusWords, status);
  return word != nullptr ? word->name : "unknown";
}

/// Report of one solve.
struct SolveReport {
  SolveStatus status = SolveStatus::kNotFinite;
  int iterations = 0;            ///< iterations of the outer (SQP) loop
  int sweeps = 0;                ///< Riccati sweeps, active-set flips included
  double cost = 0.0;             ///< objective at the returned trajectory
  double stationarity = 0.0;     ///< dual residual: ‖u − Proj(u − ∇L)‖∞ from the exact adjoint
  double defect = 0.0;           ///< primal residual: ‖x_{k+1} − f(x_k, u_k)‖∞
  double complementarity = 0.0;  ///< largest residual of the soft constraints' KKT block
  /// Largest violation of a soft constraint, in the constraint's unit; violations above their caps come
  /// first.
  double violation = 0.0;
  int worst_stage = -1;       ///< stage of that violation; -1 if nothing is violated
  int worst_constraint = -1;  ///< constraint of that violation; -1 if nothing is violated
  /// Complementarity gap Σ (t z + s n) of the soft constraints: in a convex problem the barrier costs no
  /// more.
  double gap = 0.0;
};

/// Report of OcpSolver::feedback.
struct FeedbackReport {
  bool is_solved = false;  ///< whether the quadratic program is solved; else inputs were cut to their bounds
  int sweeps = 0;          ///< backward Riccati sweeps for changes of active bounds
};

/// Search of the violation for a report: the largest one above its cap, or the largest of all if none is.
/// Units of constraints differ, so that caps come first.
class WorstViolation {
 public:
  /// Adds the violation of a constraint at a stage.
  CHICANE_INLINE void consider(double value, double cap, std::size_t stage, std::size_t constraint) noexcept {
    const bool is_above = value > cap;
    const bool is_worse = is_above == is_above_ ? value > value_ : is_above;
    if (!is_worse) return;
    value_ = value;
    is_above_ = is_above;
    stage_ = static_cast<int>(stage);
    constraint_ = static_cast<int>(constraint);
  }
  [[nodiscard]] CHICANE_INLINE bool is_above_a_cap() const noexcept { return is_above_; }
  /// Sets violation, stage and constraint of the report.
  CHICANE_INLINE void tell(SolveReport& report) const noexcept {
    report.worst_stage = stage_;
    report.worst_constraint = constraint_;
    if (stage_ >= 0) report.violation = value_;
  }

 private:
  double value_ = 0.0;     ///< worst violation so far
  bool is_above_ = false;  ///< whether it is above its cap
  int stage_ = -1;
  int constraint_ = -1;
};

}  // namespace chicane::solver
