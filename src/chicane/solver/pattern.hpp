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

  /// Whether row i of L has entries among the states, and its place among those rows that have.
  static constexpr bool has_cost_row(std::size_t i) noexcept { return count(kL[i]) > 0; }
  static constexpr std::size_t cost_row(std::size_t i) noexcept {
    std::size_t place = 0;
    for (std::size_t r = 0; r < i; ++r) place += has_cost_row(r) ? 1 : 0;
    return place;
  }
  static constexpr std::size_t kCostRows = cost_row(kNz);

  /// Whether state i of the next stage is its own value and something: that 1 is not stored.
  static constexpr bool is_sum(std::size_t i) noexcept { return Pattern::kF[i][i] == Entry::kOne; }
  /// Whether state i of the next stage depends on states in another way, and its place among those that do.
  static constexpr bool has_state_row(std::size_t i) noexcept {
    for (std::size_t j = 0; j < kNx; ++j) {
      if (Pattern::kF[i][j] != Entry::kZero && !(i == j && is_sum(i))) return true;
    }
    return false;
  }
  static constexpr std::size_t state_row(std::size_t i) noexcept {
    std::size_t place = 0;
    for (std::size_t r = 0; r < i; ++r) place += has_state_row(r) ? 1 : 0;
    return place;
  }
  static constexpr std::size_t kStateRows = state_row(kNx);

  /// Entries of a row that belong to states.
  static constexpr std::size_t count(const std::array<std::size_t, kNz>& row) noexcept {
    std::size_t stored = 0;
    for (std::size_t j = 0; j < kNx; ++j) stored += row[j] != kNone ? 1 : 0;
    return stored;
  }
  static constexpr bool has_rate_bounds() noexcept {
    for (const int state : Pattern::kRateState) {
      if (state >= 0) return true;
    }
    return false;
  }
};

/// One linear-quadratic problem: the stages' Jacobians, costs and bounds, and the terminal cost. Stages are
/// written eight at a time by packs whose lanes are stages; sweeps read each as rows whose lanes are states.
template <class Pattern, std::size_t Capacity>
struct LqProblem {
  using Layout = solver::Layout<Pattern>;
  static constexpr std::size_t kNx = Layout::kNx;
  static constexpr std::size_t kNu = Layout::kNu;
  static constexpr std::size_t kLanes = Layout::kLanes;
  static constexpr std::size_t kStages = (Capacity + 7) / 8 * 8;  ///< room for whole packs

  struct alignas(64) Stage {
    double A[Layout::kStateRows + 1][kLanes];  ///< row state_row(i): ∂x⁺_i / ∂x, without the 1 of a sum
    double B[1 + kNu][kLanes];                 ///< columns of F over x⁺: the defect, then the inputs
    double L[Layout::kCostRows + 1][kLanes];   ///< row cost_row(i): L[i][j] for the states j
    double g[kNu];                             ///< L[u][1]
    double H[kNu][kNu];                        ///< L[u][u]
  };
  Stage stage[kStages]{};
  alignas(64) double low[kNu][kStages]{};  ///< bounds on δu; infinite where there are none
  alignas(64) double high[kNu][kStages]{};
  alignas(64) double rate_low[kNu][kStages]{};  ///< bounds on δu − δx of the rate state, where there is one
  alignas(64) double rate_high[kNu][kStages]{};
  alignas(64) double terminal[kNx + 1][kLanes]{};  ///< P_N; its last row is the gradient

  LqProblem() noexcept {
    for (Stage& s : stage) {
      for (std::size_t i = 0; i < kNx; ++i) {
        for (std::size_t j = 0; j < Layout::kNz; ++j) {
          if (Pattern::kF[i][j] == Entry::kOne && j != Layout::kOne && j != i) entry_of_f(s, i, j) = 1.0;
        }
      }
    }
  }

  /// Sets the Jacobians and defects of the eight stages from `k` (a multiple of 8) on; entries as numbered by
  /// Layout::kF.
  template <class Arch>
  [[gnu::always_inline]] void set_jacobian(std::size_t k,
                                           const std::array<Pack<Arch, 8>, Layout::kFCount>& entry) noexcept {
    unroll<kNx>([&](auto i) __attribute__((always_inline)) {
      if constexpr (Layout::has_state_row(i))
        write_row<state_entries(i)>(k, entry, [=](Stage& s) { return s.A[Layout::state_row(i)]; });
    });
    unroll<1 + kNu>([&](auto c) __attribute__((always_inline)) {
      write_row<column_entries(kNx + c)>(k, entry, [=](Stage& s) { return s.B[c]; });
    });
  }

  /// Sets the costs of the eight stages from `k` (a multiple of 8) on; entries as numbered by Layout::kL.
  template <class Arch>
  [[gnu::always_inline]] void set_cost(std::size_t k,
                                       const std::array<Pack<Arch, 8>, Layout::kLCount>& entry) noexcept {
    unroll<Layout::kNz>([&](auto i) __attribute__((always_inline)) {
      if constexpr (Layout::has_cost_row(i))
        write_row<cost_entries(i)>(k, entry, [=](Stage& s) { return s.L[Layout::cost_row(i)]; });
    });
    unroll<kNu>([&](auto m) __attribute__((always_inline)) {
      constexpr std::size_t kU = Layout::kHead + m;
      constexpr std::size_t kSlope = Layout::kL[kU][Layout::kOne];
      if constexpr (kSlope != Layout::kNone)
        scatter(k, entry[kSlope], [=](Stage& s) -> double& { return s.g[m]; });
      unroll<kNu>([&](auto l) __attribute__((always_inline)) {
        constexpr std::size_t kCurvature = Layout::kL[kU][Layout::kHead + l];
        if constexpr (kCurvature != Layout::kNone)
          scatter(k, entry[kCurvature], [=](Stage& s) -> double& { return s.H[m][l]; });
      });
    });
  }

  /// Single entries of stage k, for code that does not work on eight stages at once. Pre: the pattern has
  /// them.
  void set_jacobian(std::size_t k, std::size_t i, std::size_t j, double value) noexcept {
    entry_of_f(stage[k], i, j) = value;
  }
  void set_cost(std::size_t k, std::size_t i, std::size_t j, double value) noexcept {
    Stage& s = stage[k];
    if (j < kNx) s.L[Layout::cost_row(i)][j] = value;
    if (i < kNx) s.L[Layout::cost_row(j)][i] = value;
    const std::size_t first = i < j ? i : j;
    const std::size_t last = i < j ? j : i;
    if (first == Layout::kOne && last > Layout::kOne) s.g[last - Layout::kHead] = value;
    if (first > Layout::kOne)
      s.H[last - Layout::kHead][first - Layout::kHead] = s.H[first - Layout::kHead][last - Layout::kHead] =
          value;
  }

 private:
  static double& entry_of_f(Stage& s, std::size_t i, std::size_t j) noexcept {
    return j < kNx ? s.A[Layout::state_row(i)][j] : s.B[j - kNx][i];
  }

  /// Where the entries of one row come from: a number, or a constant.
  struct Source {
    std::array<std::size_t, kLanes> entry{};
    std::array<bool, kLanes> is_one{};
    std::size_t count = 0;
  };
  static constexpr Source state_entries(std::size_t i) noexcept {
    Source row = nothing();
    for (std::size_t j = 0; j < kNx; ++j)
      add(row, j, Layout::kF[i][j], Pattern::kF[i][j] == Entry::kOne && j != i);
    return row;
  }
  static constexpr Source column_entries(std::size_t j) noexcept {
    Source row = nothing();
    for (std::size_t i = 0; i < kNx; ++i) add(row, i, Layout::kF[i][j], Pattern::kF[i][j] == Entry::kOne);
    return row;
  }
  static constexpr Source cost_entries(std::size_t i) noexcept {
    Source row = nothing();
    for (std::size_t j = 0; j < kNx; ++j) add(row, j, Layout::kL[i][j], false);
    return row;
  }
  static constexpr Source nothing() noexcept {
    Source row;
    row.entry.fill(Layout::kNone);
    return row;
  }
  static constexpr void add(Source& row, std::size_t lane, std::size_t entry, bool is_one) noexcept {
    row.entry[lane] = entry;
    row.is_one[lane] = entry == Layout::kNone && is_one;
    row.count += entry != Layout::kNone ? 1 : 0;
  }

  template <class Arch, class Place>
  [[gnu::always_inline]] void scatter(std::size_t k, const Pack<Arch, 8>& value,
                                      const Place& place) noexcept {
    alignas(64) double by_stage[8];
    value.store(by_stage);
    for (std::size_t lane = 0; lane < 8; ++lane) place(stage[k + lane]) = by_stage[lane];
  }

  /// Rows of eight stages: whole by transposition, or entry by entry where they have few.
  template <auto Row, class Entries, class Place>
  [[gnu::always_inline]] void write_row(std::size_t k, const Entries& entry, const Place& place) noexcept {
    using Stages = typename Entries::value_type;
    if constexpr (Row.count > 3) {
      unroll<kLanes / 8>([&](auto block) __attribute__((always_inline)) {
        Stages rows[8];
        unroll<8>([&](auto lane) __attribute__((always_inline)) {
          constexpr std::size_t kJ = block * 8 + lane;
          if constexpr (Row.entry[kJ] != Layout::kNone) {
            rows[lane] = entry[Row.entry[kJ]];
          } else {
            rows[lane] = Stages(Row.is_one[kJ] ? 1.0 : 0.0);
          }
        });
        transpose(rows);
        for (std::size_t s = 0; s < 8; ++s) rows[s].store(place(stage[k + s]) + block * 8);
      });
    } else {
      unroll<kLanes>([&](auto lane) __attribute__((always_inline)) {
        if constexpr (Row.entry[lane] != Layout::kNone)
          scatter(k, entry[Row.entry[lane]], [&place, lane](Stage& s) -> double& { return place(s)[lane]; });
      });
    }
  }
};

}  // namespace chicane::solver
