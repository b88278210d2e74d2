// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "chicane/base/pack.hpp"

namespace chicane::solver {

/// What is known of one entry of a Jacobian before the program runs.
enum class Entry : std::uint8_t { kZero, kOne, kValue };

/// A pattern is a type that says which entries of the stages of a linear-quadratic problem can be other than
/// zero, in z = (δx, 1, δu): F (δx⁺ = F z; column Nx, the defect, is always there) and L (cost ½ zᵀ L z,
/// symmetric; its row and column Nx, the gradient, are read where L says so and the entry (Nx, Nx) never is).
/// This one knows nothing: every entry counts.
///
/// kRateState[m] is the number of the state that holds the previous value of input m, where the problem has
/// bounds on how fast that input changes; -1 where it has none.
template <std::size_t Nx, std::size_t Nu>
struct FullPattern {
  static constexpr std::size_t kNx = Nx;
  static constexpr std::size_t kNu = Nu;
  static constexpr std::size_t kNz = Nx + 1 + Nu;
  static constexpr std::array<std::array<Entry, kNz>, Nx> kF = [] {
    std::array<std::array<Entry, kNz>, Nx> f{};
    for (auto& row : f) row.fill(Entry::kValue);
    return f;
  }();
  static constexpr std::array<std::array<bool, kNz>, kNz> kL = [] {
    std::array<std::array<bool, kNz>, kNz> l{};
    for (auto& row : l) row.fill(true);
    return l;
  }();
  static constexpr std::array<int, Nu> kRateState = [] {
    std::array<int, Nu> none{};
    none.fill(-1);
    return none;
  }();
};

/// Numbers the entries of a pattern that are stored.
template <class Pattern>
struct Layout {
  static constexpr std::size_t kNx = Pattern::kNx;
  static constexpr std::size_t kNu = Pattern::kNu;
  static constexpr std::size_t kNz = kNx + 1 + kNu;
  static constexpr std::size_t kOne = kNx;       ///< index of the constant in z
  static constexpr std::size_t kHead = kNx + 1;  ///< index of the first input in z
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  static constexpr std::size_t kLanes = (kNx + 7) / 8 * 8;  ///< rows over the states, padded to whole packs

  using JacobianTable = std::array<std::array<std::size_t, kNz>, kNx>;
  using CostTable = std::array<std::array<std::size_t, kNz>, kNz>;

  /// F[i][j] is entry kF[i][j]; kNone where it is 0 or 1.
  static constexpr JacobianTable kF = [] {
    JacobianTable table{};
    std::size_t next = 0;
    for (std::size_t i = 0; i < kNx; ++i) {
      for (std::size_t j = 0; j < kNz; ++j)
        table[i][j] = Pattern::kF[i][j] == Entry::kValue || j == kOne ? next++ : kNone;
    }
    return table;
  }();
  static constexpr std::size_t kFCount = [] {
    std::size_t count = 0;
    for (const auto& row : kF) {
      for (const std::size_t entry : row) count += entry != kNone ? 1 : 0;
    }
    return count;
  }();

  /// L[i][j] = L[j][i] is entry kL[i][j]; kNone where it is 0, and for the constant squared.
  static constexpr CostTable kL = [] {
    CostTable table{};
    std::size_t next = 0;
    for (std::size_t i = 0; i < kNz; ++i) {
      for (std::size_t j = i; j < kNz; ++j) {
        const bool is_stored = Pattern::kL[i][j] && !(i == kOne && j == kOne);
        table[i][j] = table[j][i] = is_stored ? next++ : kNone;
      }
    }
    return table;
  }();
  static constexpr std::size_t kLCount = [] {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kNz; ++i) {
      for (std::size_t j = i; j < kNz; ++j) count += kL[i][j] != kNone ? 1 : 0;
    }
    return count;
  }();

  /// Whether row i of L has entries among the states.
  static constexpr bool has_row(std::size_t i) noexcept {
    for (std::size_t j = 0; j < kNx; ++j) {
      if (kL[i][j] != kNone) return true;
    }
    return false;
  }
  static constexpr bool has_rate_bounds() noexcept {
    for (const int state : Pattern::kRateState) {
      if (state >= 0) return true;
    }
    return false;
  }
};

/// One linear-quadratic problem: the stages' Jacobians, costs and bounds, and the terminal cost.
///
/// Jacobians and bounds lie stage after stage entry by entry (a pack over eight stages is one store; a sweep
/// reads single numbers). Costs lie as rows over the states, ready for registers; the few entries among
/// inputs and gradient of inputs lie like Jacobians.
template <class Pattern, std::size_t Capacity>
struct LqProblem {
  using Layout = solver::Layout<Pattern>;
  static constexpr std::size_t kNx = Layout::kNx;
  static constexpr std::size_t kNu = Layout::kNu;
  static constexpr std::size_t kLanes = Layout::kLanes;
  /// Room for whole packs of eight stages; not a multiple of half a kibibyte, which would put all entries of
  /// a stage into the same lines of the cache.
  static constexpr std::size_t kStride =
      (Capacity + 7) / 8 * 8 + ((Capacity + 7) / 8 % 8 == 0 ? std::size_t{8} : std::size_t{0});
  static constexpr std::size_t kCornerCount = kNu + kNu * (kNu + 1) / 2;

  alignas(64) double F[Layout::kFCount][kStride]{};  ///< F[Layout::kF[i][j]][k]
  alignas(64) double low[kNu][kStride]{};            ///< bounds on δu; infinite where there are none
  alignas(64) double high[kNu][kStride]{};
  alignas(64) double rate_low[kNu][kStride]{};  ///< bounds on δu − δx_previous, where the pattern has them
  alignas(64) double rate_high[kNu][kStride]{};
  alignas(64) double row[kStride][Layout::kNz][kLanes]{};  ///< L[i][j] for j < Nx, of stage k
  alignas(64) double corner[kCornerCount][kStride]{};      ///< L[u_m][1], and L[u_m][u_l] for l <= m
  alignas(64) double terminal[kNx + 1][kLanes]{};          ///< P_N; its last row is the gradient

  /// Place of L[u_m][1] and of L[u_m][u_l] in `corner`.
  static constexpr std::size_t corner_gradient(std::size_t m) noexcept { return m; }
  static constexpr std::size_t corner_of(std::size_t m, std::size_t l) noexcept {
    const std::size_t a = m > l ? m : l;
    const std::size_t b = m > l ? l : m;
    return kNu + a * (a + 1) / 2 + b;
  }

  /// Sets the costs of the eight stages from `k` (a multiple of 8) on; entries as numbered by Layout::kL.
  template <class Arch>
  [[gnu::always_inline]] void set_cost(std::size_t k,
                                       const std::array<Pack<Arch, 8>, Layout::kLCount>& entry) noexcept {
    using Stages = Pack<Arch, 8>;
    unroll<Layout::kNz>([&](auto i) __attribute__((always_inline)) {
      if constexpr (Layout::has_row(i)) {
        unroll<(kNx + 7) / 8>([&](auto block) __attribute__((always_inline)) {
          Stages rows[8];
          unroll<8>([&](auto lane) __attribute__((always_inline)) {
            constexpr std::size_t kJ = block * 8 + lane;
            rows[lane] = Stages(0.0);
            if constexpr (kJ < kNx) {
              if constexpr (Layout::kL[i][kJ] != Layout::kNone) rows[lane] = entry[Layout::kL[i][kJ]];
            }
          });
          transpose(rows);
          for (std::size_t stage = 0; stage < 8; ++stage) {
            rows[stage].store(row[k + stage][i] + block * 8);
          }
        });
      }
    });
    unroll<kNu>([&](auto m) __attribute__((always_inline)) {
      constexpr std::size_t kU = Layout::kHead + m;
      if constexpr (Layout::kL[kU][Layout::kOne] != Layout::kNone)
        entry[Layout::kL[kU][Layout::kOne]].store(&corner[corner_gradient(m)][k]);
      unroll<m + 1>([&](auto l) __attribute__((always_inline)) {
        if constexpr (Layout::kL[kU][Layout::kHead + l] != Layout::kNone)
          entry[Layout::kL[kU][Layout::kHead + l]].store(&corner[corner_of(m, l)][k]);
      });
    });
  }

  /// The entry L[i][j] = L[j][i] of stage k, for code that does not work on eight stages at once.
  void set_cost(std::size_t k, std::size_t i, std::size_t j, double value) noexcept {
    if (j < kNx) row[k][i][j] = value;
    if (i < kNx) row[k][j][i] = value;
    const std::size_t first = i < j ? i : j;
    const std::size_t last = i < j ? j : i;
    if (first == Layout::kOne && last > Layout::kOne)
      corner[corner_gradient(last - Layout::kHead)][k] = value;
    if (first > Layout::kOne) corner[corner_of(last - Layout::kHead, first - Layout::kHead)][k] = value;
  }

  /// F[i][j] of stage k.
  [[nodiscard]] double jacobian(std::size_t k, std::size_t i, std::size_t j) const noexcept {
    if (Layout::kF[i][j] != Layout::kNone) return F[Layout::kF[i][j]][k];
    return Pattern::kF[i][j] == Entry::kOne ? 1.0 : 0.0;
  }
};

}  // namespace chicane::solver
