// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::solver {

/// Hard constraints: rows that must hold, beside the dynamics and the bounds of inputs. A problem of either
/// level may have any of
///
///     static constexpr int kNh;    template <…> auto equality(k, x, u) const;           // = 0, k < N
///     static constexpr int kNeh;   template <…> auto terminal_equality(x) const;        // = 0 of x_N
///     static constexpr int kNec;   template <…> auto terminal_constraint(x) const;      // <= 0 of x_N
///     bool is_hard(int constraint) const;    // constraint() <= 0 that must hold, whatever its penalty
///     std::string_view equality_name(int) const, terminal_equality_name(int) const,
///         terminal_constraint_name(int) const;                                          // optional
///
/// written like constraint() and terminal_residual(). OcpSolver then solves it by a primal-dual interior
/// point method (docs/solver.md), and its report says where a row is missed and by how much. Choose units in
/// which a miss of `tolerance` does not matter. The soft penalty of a hard constraint is its first penalty.

/// Number of equalities of a stage.
template <class P>
[[nodiscard]] constexpr int equality_count() noexcept {
  if constexpr (requires { P::kNh; }) return P::kNh;
  return 0;
}
/// Number of equalities at the end.
template <class P>
[[nodiscard]] constexpr int terminal_equality_count() noexcept {
  if constexpr (requires { P::kNeh; }) return P::kNeh;
  return 0;
}
/// Number of inequalities at the end.
template <class P>
[[nodiscard]] constexpr int terminal_constraint_count() noexcept {
  if constexpr (requires { P::kNec; }) return P::kNec;
  return 0;
}
namespace detail {
template <class P>
concept SaysWhatIsHard = requires(const P& p) {
  { p.is_hard(0) } -> std::same_as<bool>;
};
}  // namespace detail

/// Concept of a problem with hard constraints.
template <class P>
concept HardProblem = OcpProblem<P> &&
    (equality_count<P>() + terminal_equality_count<P>() + terminal_constraint_count<P>() > 0 ||
     detail::SaysWhatIsHard<P>);

/// Multipliers of hard constraints, d(cost)/d(right-hand side), and their weights at the end of a solve, from
/// which the next one can start.
template <class P, int Capacity>
struct HardMultipliers {
  static constexpr std::size_t kNh = equality_count<P>();
  static constexpr std::size_t kEnd = terminal_equality_count<P>() + terminal_constraint_count<P>();
  std::array<StageData<Capacity>, kNh> equality{};  ///< multipliers of the stages' equalities
  std::array<double, kEnd> terminal{};              ///< multipliers at the end: equalities, then constraints
  std::array<double, kNh> equality_weight{};        ///< weights of the stages' equalities
  std::array<double, kEnd> terminal_weight{};       ///< weights at the end
  std::array<double, P::kNc> penalty_factor{};      ///< factors over hard constraints' first penalties
  bool is_known = false;                            ///< whether a solve starts from these

  /// Shifts to a horizon that begins `steps` stages later; the last ones are repeated.
  void shift(int steps, int horizon) noexcept {
    for (auto& row : equality) {
      for (int k = 0; k < horizon; ++k)
        row[static_cast<std::size_t>(k)] = row.at(k + steps < horizon ? k + steps : horizon - 1);
    }
  }
};

/// Report on rows that must hold.
struct HardReport : SolveReport {
  enum class Kind : std::uint8_t { kNone, kEquality, kTerminalEquality, kTerminalConstraint, kConstraint };
  double miss = 0.0;        ///< largest violation of a row, in the row's unit
  Kind kind = Kind::kNone;  ///< kind of that row; none if all hold exactly
  int miss_stage = -1;      ///< stage of that row
  int miss_row = -1;        ///< index of that row within its kind
  int rounds = 0;           ///< updates of multipliers, with one solve before each
};

}  // namespace chicane::solver
