// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "chicane/base/compiler.hpp"
#include "chicane/base/text.hpp"

namespace chicane::solver {

/// The table of SolveStatus. Columns: enumerator, number, name, severity, sentence (base/text.hpp).
// clang-format off
#define CHICANE_SOLVE_STATUSES(ROW)                                                                              \
  /* all residuals <= tolerance */                                                                               \
  ROW(kOptimal, 0, "optimal", kOk, "the solver converged")                                                       \
  /* deadline or max_iterations reached; input bounds and what must hold do, residuals <= loose_tolerance */     \
  ROW(kBudgetSpent, 1, "budget_spent", kOk, "the solver stopped at its limit, close enough to the optimum")       \
  /* steps are as short as rounding lets them; a residual above tolerance is what is left of it */               \
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
  double violation = 0.0;  ///< largest soft-constraint violation, in the constraint's own unit; of those
                           ///< above their caps, where one is
  int worst_stage = -1;    ///< stage of the worst violation; -1 if nothing is violated
  int worst_constraint = -1;
  double gap = 0.0;  ///< complementarity gap Σ (t z + s n) of the soft constraints: what the barrier costs,
                     ///< at most in a convex problem
};

/// Report of OcpSolver::feedback.
struct FeedbackReport {
  bool is_solved = false;  ///< the quadratic program is; else inputs were cut to their bounds
  int sweeps = 0;          ///< Riccati sweeps backwards that a change of active bounds took
};

/// Finds the violation for a report: the largest, but one above its cap before all others, which may have
/// other units.
class WorstViolation {
 public:
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
  CHICANE_INLINE void tell(SolveReport& report) const noexcept {
    report.worst_stage = stage_;
    report.worst_constraint = constraint_;
    if (stage_ >= 0) report.violation = value_;
  }

 private:
  double value_ = 0.0;
  bool is_above_ = false;
  int stage_ = -1;
  int constraint_ = -1;
};

}  // namespace chicane::solver
