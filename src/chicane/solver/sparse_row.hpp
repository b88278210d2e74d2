// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "chicane/base/compiler.hpp"
#include "chicane/base/pack.hpp"

/// Rows of a problem whose pattern is known at run time, not at compile time: for problems that come as data,
/// such as those written in Python. Such a problem has `static constexpr bool kHasSparseRows = true`. For
/// derivatives its functions are called with arrays of SparseSeed and return arrays of SparseRow; all else is
/// as in level 1.

namespace chicane::solver {

/// A variable of a stage (of eight stages, if V is a pack) for functions with derivatives up to Order.
template <class V, int Order>
struct SparseSeed {
  V v;
};

/// Place of a derivative: by variable i, or by the pair i <= j, in (x, u).
struct SparseEntry {
  std::uint16_t i = 0;
  std::uint16_t j = 0;
  std::uint32_t slot = 0;  ///< index into SparseRow::slots
};

/// Value and derivatives of one row. Its pointers are to memory of the problem, valid until the next call of
/// the same function.
template <class V>
struct SparseRow {
  static constexpr bool kIsDense = true;  // rows are looped over
  static constexpr bool kIsSparse = true;

  V v{0.0};
  V scale{1.0};                             ///< factor of all derivatives
  const V* slots = nullptr;                 ///< derivatives; null for a row that the problem does not have
  const SparseEntry* slopes = nullptr;      ///< places of the first derivatives
  const SparseEntry* curvatures = nullptr;  ///< places of the second derivatives
  std::uint32_t slope_count = 0;
  std::uint32_t curvature_count = 0;
  std::uint32_t stride = 1;  ///< distance between slots

  [[nodiscard]] CHICANE_INLINE bool is_absent() const noexcept { return slots == nullptr; }
  /// Calls visit(i, first derivative).
  template <class Visit>
  CHICANE_INLINE void each_slope(const Visit& visit) const noexcept {
    for (std::uint32_t n = 0; n < slope_count; ++n)
      visit(slopes[n].i, scale * slots[slopes[n].slot * stride]);
  }
  /// Calls visit(i, j, second derivative) with i <= j.
  template <class Visit>
  CHICANE_INLINE void each_curvature(const Visit& visit) const noexcept {
    for (std::uint32_t n = 0; n < curvature_count; ++n)
      visit(curvatures[n].i, curvatures[n].j, scale * slots[curvatures[n].slot * stride]);
  }
  template <class S>
  CHICANE_INLINE friend SparseRow operator*(const S& factor, SparseRow row) noexcept {
    row.v = factor * row.v;
    row.scale = factor * row.scale;
    return row;
  }
  template <class S>
  CHICANE_INLINE friend SparseRow operator+(SparseRow row, const S& shift) noexcept {
    row.v = row.v + shift;
    return row;
  }
  CHICANE_INLINE friend SparseRow positive_part(SparseRow row) noexcept requires std::is_same_v<V, double> {
    if (!(row.v <= 0.0)) return row;
    row.v = row.scale = 0.0;
    return row;
  }
};

template <class Row>
concept AnySparseRow = requires {
  requires Row::kIsSparse;
};

/// Whether a problem has sparse rows.
template <class P>
inline constexpr bool kHasSparseRows = requires {
  requires P::kHasSparseRows;
};

}  // namespace chicane::solver
