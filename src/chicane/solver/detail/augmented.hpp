// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/soft_constraint.hpp"
#include "chicane/solver/detail/stage_entries.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/sparse_row.hpp"

namespace chicane::solver {

namespace detail {

template <class Row, class Factor, std::size_t... n>
CHICANE_INLINE inline auto scaled(const Row& row, const Factor& factor, std::index_sequence<n...>) {
  return std::make_tuple(factor(n, std::get<n>(row))...);
}
/// Row of map(n, entry) for each entry: a tuple, or an array if `row` is one.
template <class Row, class Map>
CHICANE_INLINE inline auto map_row(const Row& row, const Map& map) {
  return scaled(row, map, std::make_index_sequence<std::tuple_size_v<Row>>{});
}
template <class T, std::size_t N, class Map>
CHICANE_INLINE inline std::array<T, N> map_row(const std::array<T, N>& row, const Map& map) {
  std::array<T, N> result;
  for (std::size_t n = 0; n < N; ++n) result[n] = map(n, row[n]);
  return result;
}
/// Concatenates two rows.
template <class A, class B>
CHICANE_INLINE inline auto join(const A& a, const B& b) {
  return std::tuple_cat(a, b);
}
template <class T, std::size_t N, std::size_t M>
CHICANE_INLINE inline std::array<T, N + M> join(const std::array<T, N>& a, const std::array<T, M>& b) {
  std::array<T, N + M> result;
  for (std::size_t n = 0; n < N; ++n) result[n] = a[n];
  for (std::size_t n = 0; n < M; ++n) result[N + n] = b[n];
  return result;
}

}  // namespace detail

/// Augmented Lagrangian of a problem, up to a constant (docs/solver.md, eq. 56): the problem with its
/// equalities and terminal constraints as further residuals √ρ (h + y/ρ). All other functions are the
/// problem's.
template <HardProblem P, int Capacity>
class Augmented {
 public:
  static constexpr int kNx = P::kNx, kNu = P::kNu, kNc = P::kNc;
  static constexpr int kEqualities = equality_count<P>();
  static constexpr int kEndEqualities = terminal_equality_count<P>();
  static constexpr int kEndConstraints = terminal_constraint_count<P>();
  static constexpr int kOwnResiduals = P::kNr, kOwnEnd = P::kNe;
  static constexpr int kNr = P::kNr + kEqualities;
  static constexpr int kNe = P::kNe + kEndEqualities + kEndConstraints;
  static constexpr bool kGaussNewton = !has_hessians<P>();
  static constexpr bool kHasSparseRows = solver::kHasSparseRows<P>;

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  /// Weight of a hard row: √ρ and ρ.
  struct Weight {
    double root = 1.0;
    double rho = 1.0;
    void set(double weight) noexcept {
      rho = weight;
      root = std::sqrt(weight);
    }
  };
  const P* problem = nullptr;
  double cost_root = 1.0;                             ///< root of the weight of the problem's own cost
  std::array<Weight, kEqualities> equality_weight{};  ///< weights of the stages' equalities
  std::array<StageData<Capacity>, kEqualities> equality_root{};   ///< roots of these weights for each stage
  std::array<StageData<Capacity>, kEqualities> equality_shift{};  ///< y/ρ of the stages' equalities
  std::array<Weight, kEndEqualities + kEndConstraints> terminal_weight{};  ///< weights at the end
  std::array<double, kEndEqualities + kEndConstraints> terminal_shift{};   ///< y/ρ at the end
  std::array<double, kNc> penalty_factor{};  ///< factors of the constraints' penalties
  double violation_penalty = 0.0;            ///< penalty of violated hard rows in restoration; else 0
  double limit_share = 1.0;     ///< share of violation_penalty for hard constraints of the stages
  double hard_penalty = 0.0;    ///< penalty of hard constraints in the primal-dual method: none is violated
  bool is_primal_dual = false;  ///< rows in the form of the primal-dual method (detail/hard_rows.hpp)

  /// Sets ρ of equality n for all stages.
  void set_weight(std::size_t n, double weight) noexcept {
    equality_weight[n].set(weight);
    equality_root[n].values.fill(equality_weight[n].root);
  }

  template <class K, class X, class U>
  requires requires(const P& p, K k, const X& x, const U& u) { p.dynamics(k, x, u); }
  CHICANE_INLINE auto dynamics(K k, const X& x, const U& u) const { return problem->dynamics(k, x, u); }

  template <class K, class X, class U>
  requires requires(const P& p, K k, const X& x, const U& u) { p.residual(k, x, u); }
  CHICANE_INLINE auto residual(K k, const X& x, const U& u) const {
    const auto own = detail::map_row(
        problem->residual(k, x, u), [&](std::size_t, const auto& r) CHICANE_INLINE { return cost_root * r; });
    if constexpr (kEqualities > 0) {
      const auto shifted = [&](std::size_t n, const auto& h) CHICANE_INLINE {
        return equality_root[n].at(k) * (h + equality_shift[n].at(k));
      };
      return detail::join(own, detail::map_row(problem->equality(k, x, u), shifted));
    } else {
      return own;
    }
  }
  template <class X>
  requires requires(const P& p, const X& x) { p.terminal_residual(x); }
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    const auto own =
        detail::map_row(problem->terminal_residual(x),
                        [&](std::size_t, const auto& r) CHICANE_INLINE { return cost_root * r; });
    return with_constraints(with_equalities(own, x), x);
  }
  template <class K, class X, class U>
  requires(kNc > 0 && requires(const P& p, K k, const X& x, const U& u) { p.constraint(k, x, u); })
      CHICANE_INLINE auto constraint(K k, const X& x, const U& u) const {
    return problem->constraint(k, x, u);
  }

  /// Whether constraint c is hard.
  [[nodiscard]] bool must_hold(std::size_t c) const noexcept {
    if constexpr (detail::SaysWhatIsHard<P>) return problem->is_hard(static_cast<int>(c));
    return false;
  }
  /// Whether constraint c is hard and restoration is not at work.
  [[nodiscard]] bool keeps(std::size_t c) const noexcept { return violation_penalty == 0.0 && must_hold(c); }
  [[nodiscard]] std::size_t constraint_count() const noexcept { return solver::constraint_count(*problem); }
  [[nodiscard]] SoftPenalty soft_penalty(int c) const requires(kNc > 0) {
    SoftPenalty penalty = problem->soft_penalty(c);
    penalty.linear *= penalty_factor[static_cast<std::size_t>(c)];
    penalty.quadratic *= penalty_factor[static_cast<std::size_t>(c)];
    if constexpr (detail::SaysWhatIsHard<P>) {
      if (problem->is_hard(c)) {
        penalty.cap = 1e30;
        if (is_primal_dual) penalty = {hard_penalty, 0.0, SoftConstraint<>::kMustHold};
        if (violation_penalty > 0.0) penalty = {limit_share * violation_penalty, 0.0, 1e30};
      }
    }
    return penalty;
  }
  [[nodiscard]] auto input_lower(int k) const { return problem->input_lower(k); }
  [[nodiscard]] auto input_upper(int k) const { return problem->input_upper(k); }

 private:
  /// Residuals of the end, with those of its equalities.
  template <class Row, class X>
  CHICANE_INLINE auto with_equalities(const Row& row, const X& x) const {
    if constexpr (kEndEqualities > 0) {
      const auto weighted = [&](std::size_t n, const auto& h)
                                CHICANE_INLINE { return terminal_weight[n].root * (h + terminal_shift[n]); };
      return detail::join(row, detail::map_row(problem->terminal_equality(x), weighted));
    } else {
      return row;
    }
  }
  /// Residuals of the end, with those of its inequalities.
  template <class Row, class X>
  CHICANE_INLINE auto with_constraints(const Row& row, const X& x) const {
    if constexpr (kEndConstraints > 0) {
      const auto weighted = [&](std::size_t n, const auto& g) CHICANE_INLINE {
        return terminal_weight[kEndEqualities + n].root * active_part(g + terminal_shift[kEndEqualities + n]);
      };
      return detail::join(row, detail::map_row(problem->terminal_constraint(x), weighted));
    } else {
      return row;
    }
  }
  /// Counted part of an inequality: all of it in the primal-dual method, else the part above zero.
  template <class T>
  CHICANE_INLINE auto active_part(const T& value) const {
    if constexpr (AnySparseRow<T>) {
      return is_primal_dual ? value : positive_part(value);
    } else {
      return select(value > (is_primal_dual ? -kInfinity : 0.0), value, 0.0);
    }
  }
};

}  // namespace chicane::solver
