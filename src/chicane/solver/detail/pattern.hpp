// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "chicane/base/compiler.hpp"
#include "chicane/base/pack.hpp"

namespace chicane::solver {

// Patterns of the linear-quadratic problem: which entries can differ from zero, where they are stored, and
// the storage itself.

/// One entry of a Jacobian, as known at compile time.
enum class Entry : std::uint8_t { kZero, kOne, kValue };

/// Pattern without zeros. A pattern is a type that names the entries of a linear-quadratic problem's stages
/// that can differ from zero, in z = (δx, 1, δu): those of F (δx⁺ = F z; column Nx, the defect, is always
/// stored) and of L (cost ½ zᵀ L z, symmetric; row and column Nx are the gradient, and the entry (Nx, Nx) is
/// never stored).
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
};

/// Whether code for a pattern is compact, `kIsCompact = true`: one sweep for all uses, and loops over dense
/// entries. It compiles faster and runs some percent slower.
template <class Pattern>
[[nodiscard]] constexpr bool is_compact() noexcept {
  if constexpr (requires { Pattern::kIsCompact; }) return Pattern::kIsCompact;
  return false;
}

/// Limit of variables in a stage for unrolled code; beyond it blocks and loops are used.
inline constexpr std::size_t kMostUnrolled = 24;

/// Numbers of the stored entries of a pattern.
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

  /// Number of stored entries of a row that belong to states.
  static constexpr std::size_t count(const std::array<std::size_t, kNz>& row) noexcept {
    std::size_t stored = 0;
    for (std::size_t j = 0; j < kNx; ++j) stored += row[j] != kNone ? 1 : 0;
    return stored;
  }

  /// Entries up to which a row is narrow. Sweeps read rows over the states as registers: wide rows are stored
  /// so, narrow ones are put together from numbers. Chosen.
  static constexpr std::size_t kNarrow = 2;
  static constexpr bool is_wide_cost(std::size_t i) noexcept { return count(kL[i]) > kNarrow; }
  /// Whether state i of the next stage is x_i plus a change: that 1 is not stored.
  static constexpr bool is_sum(std::size_t i) noexcept { return Pattern::kF[i][i] == Entry::kOne; }
  /// Whether F[i][j] is a 1 in a row over the states.
  static constexpr bool is_one(std::size_t i, std::size_t j) noexcept {
    return Pattern::kF[i][j] == Entry::kOne && j != i && j < kNx;
  }
  /// Whether state i of the next stage depends on states beyond the 1 of a sum.
  static constexpr bool has_state_row(std::size_t i) noexcept {
    for (std::size_t j = 0; j < kNx; ++j) {
      if (is_one(i, j) || kF[i][j] != kNone) return true;
    }
    return false;
  }
  static constexpr bool is_wide_state(std::size_t i) noexcept { return count(kF[i]) > kNarrow; }

  /// Place of wide row i of F among all wide rows.
  static constexpr std::size_t wide_state(std::size_t i) noexcept { return kWidePlace[i]; }
  /// Place of wide row i of L among all wide rows.
  static constexpr std::size_t wide_cost(std::size_t i) noexcept { return kWidePlace[kNx + i]; }
  static constexpr auto kWidePlace = [] {
    std::array<std::size_t, kNx + kNz + 1> places{};
    for (std::size_t r = 0; r < kNx + kNz; ++r)
      places[r + 1] = places[r] + ((r < kNx ? count(kF[r]) : count(kL[r - kNx])) > kNarrow ? 1 : 0);
    return places;
  }();
  static constexpr std::size_t kWideRows = wide_cost(kNz);

  /// Numbering of the entries that sweeps read as numbers; F[i][kOne], the defects, come first.
  struct Numbers {
    JacobianTable f{};
    CostTable l{};
    std::size_t count = 0;
  };
  static constexpr Numbers kNumber = [] {
    Numbers numbers;
    for (auto& row : numbers.f) row.fill(kNone);
    for (auto& row : numbers.l) row.fill(kNone);
    for (std::size_t i = 0; i < kNx; ++i) numbers.f[i][kOne] = numbers.count++;
    for (std::size_t i = 0; i < kNx; ++i) {
      for (std::size_t j = 0; j < kNz; ++j) {
        if (j != kOne && kF[i][j] != kNone && (j > kOne || !is_wide_state(i)))
          numbers.f[i][j] = numbers.count++;
      }
    }
    for (std::size_t i = 0; i < kNz; ++i) {
      for (std::size_t j = 0; j < kNz; ++j) {  // row i is read over states, or of inputs by number
        const bool is_read = j < kNx ? !is_wide_cost(i) : (i >= kOne && j >= kOne);
        if (kL[i][j] != kNone && is_read && numbers.l[i][j] == kNone)
          numbers.l[i][j] = numbers.l[j][i] = numbers.count++;
      }
    }
    return numbers;
  }();
  static constexpr std::size_t kNumbers = (kNumber.count + 7) / 8 * 8;

  /// Whether all entries of F and L are stored, and all rows over the states are wide.
  static constexpr bool is_full() noexcept {
    bool is_full = kNx > kNarrow && kFCount == kNx * kNz;
    for (std::size_t i = 0; i < kNz; ++i) {
      for (std::size_t j = 0; j < kNz; ++j)
        is_full = is_full && (Pattern::kL[i][j] || (i == kOne && j == kOne));
    }
    return is_full;
  }
  /// Whether a stage has too many variables for unrolled code.
  static constexpr bool is_large() noexcept { return kNx + kNu > kMostUnrolled; }
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
    double number[Layout::kNumbers];             ///< entries as numbered by Layout::kNumber
    double wide[Layout::kWideRows + 1][kLanes];  ///< wide rows over the states: of F, then of L

    [[nodiscard]] double defect(std::size_t i) const noexcept { return number[i]; }
  };
  Stage stage[kStages]{};                  ///< Jacobians and costs
  alignas(64) double low[kNu][kStages]{};  ///< bounds on δu; infinite where there are none
  alignas(64) double high[kNu][kStages]{};
  alignas(64) double terminal[kNx + 1][kLanes]{};  ///< P_N; its last row is the gradient

  LqProblem() noexcept {
    for (Stage& s : stage) {
      for (std::size_t i = 0; i < kNx; ++i) {
        for (std::size_t j = 0; j < kNx; ++j) {
          if (Layout::is_wide_state(i) && Layout::is_one(i, j)) s.wide[Layout::wide_state(i)][j] = 1.0;
        }
      }
    }
  }

  /// Sets Jacobians, defects and costs of the eight stages from `k` (a multiple of 8) on; entries as numbered
  /// by Layout::kF and Layout::kL. Any eight entries make eight stages' lines by one transposition.
  template <class Arch>
  CHICANE_INLINE void set(std::size_t k, const std::array<Pack<Arch, 8>, Layout::kFCount>& f,
                          const std::array<Pack<Arch, 8>, Layout::kLCount>& l) noexcept {
    unroll<Layout::kNumbers / 8>([&](auto line) CHICANE_INLINE {
      write<kSourcesOfNumbers[line]>(k, f, l, [=](Stage& s) { return s.number + line * 8; });
    });
    unroll<kNx>([&](auto i) CHICANE_INLINE {
      if constexpr (Layout::is_wide_state(i)) write_row<i, true>(k, f, l);
    });
    unroll<Layout::kNz>([&](auto i) CHICANE_INLINE {
      if constexpr (Layout::is_wide_cost(i)) write_row<i, false>(k, f, l);
    });
  }
  /// Sets the eight stages from `k` on like set(), by tables in a loop, which compiles faster.
  template <class Arch>
  [[gnu::noinline]] void set_by_tables(std::size_t k, const std::array<Pack<Arch, 8>, Layout::kFCount>& f,
                                       const std::array<Pack<Arch, 8>, Layout::kLCount>& l) noexcept {
    using Stages = Pack<Arch, 8>;
    const Stages constants[2] = {Stages(0.0), Stages(1.0)};
    const Stages* const from[3] = {f.data(), l.data(), constants};
    for (const Line& line : kLines) {
      Stages rows[8];
      for (std::size_t lane = 0; lane < 8; ++lane) rows[lane] = from[line.from[lane]][line.entry[lane]];
      transpose(rows);
      for (std::size_t s = 0; s < 8; ++s)
        rows[s].store((line.is_wide ? stage[k + s].wide[line.row] : stage[k + s].number) + line.begin);
    }
  }

  /// Sets F[i][j] of stage k. Pre: the pattern has the entry.
  void set_jacobian(std::size_t k, std::size_t i, std::size_t j, double value) noexcept {
    Stage& s = stage[k];
    if (const std::size_t n = Layout::kNumber.f[i][j]; n != Layout::kNone) s.number[n] = value;
    if (j < kNx && Layout::is_wide_state(i)) s.wide[Layout::wide_state(i)][j] = value;
  }
  /// Sets L[i][j] = L[j][i] of stage k. Pre: the pattern has the entry.
  void set_cost(std::size_t k, std::size_t i, std::size_t j, double value) noexcept {
    Stage& s = stage[k];
    if (const std::size_t n = Layout::kNumber.l[i][j]; n != Layout::kNone) s.number[n] = value;
    if (j < kNx && Layout::is_wide_cost(i)) s.wide[Layout::wide_cost(i)][j] = value;
    if (i < kNx && Layout::is_wide_cost(j)) s.wide[Layout::wide_cost(j)][i] = value;
  }
  /// L[i][j] of stage k; 0 if the pattern does not have the entry.
  [[nodiscard]] double cost(std::size_t k, std::size_t i, std::size_t j) const noexcept {
    const Stage& s = stage[k];
    if (const std::size_t n = Layout::kNumber.l[i][j]; n != Layout::kNone) return s.number[n];
    if (j < kNx && Layout::is_wide_cost(i)) return s.wide[Layout::wide_cost(i)][j];
    if (i < kNx && Layout::is_wide_cost(j)) return s.wide[Layout::wide_cost(j)][i];
    return 0.0;
  }

 private:
  /// Sources of a line of eight numbers: entries of F, of L, or constants.
  struct Sources {
    std::array<std::size_t, 8> f{};
    std::array<std::size_t, 8> l{};
    std::array<bool, 8> is_one{};
  };
  static constexpr Sources nothing() noexcept {
    Sources sources;
    sources.f.fill(Layout::kNone);
    sources.l.fill(Layout::kNone);
    return sources;
  }
  /// Sources of all lines, in one pass: line by line it takes the compiler 20 s for 60 variables.
  static constexpr auto kSourcesOfNumbers = [] {
    std::array<Sources, Layout::kNumbers / 8> lines{};
    lines.fill(nothing());
    for (std::size_t j = 0; j < Layout::kNz; ++j) {
      for (std::size_t i = 0; i < kNx; ++i) {
        if (const std::size_t n = Layout::kNumber.f[i][j]; n != Layout::kNone)
          lines[n / 8].f[n % 8] = Layout::kF[i][j];
      }
      for (std::size_t i = 0; i < Layout::kNz; ++i) {
        if (const std::size_t n = Layout::kNumber.l[i][j]; n != Layout::kNone)
          lines[n / 8].l[n % 8] = Layout::kL[i][j];
      }
    }
    return lines;
  }();
  static constexpr Sources sources_of_row(std::size_t i, bool of_f, std::size_t block) noexcept {
    Sources sources = nothing();
    for (std::size_t lane = 0; lane < 8 && block * 8 + lane < kNx; ++lane) {
      const std::size_t j = block * 8 + lane;
      if (of_f) {
        sources.f[lane] = Layout::kF[i][j];
        sources.is_one[lane] = Layout::is_one(i, j);
      } else {
        sources.l[lane] = Layout::kL[i][j];
      }
    }
    return sources;
  }

  /// All lines of a stage: eight numbers each, from entries of F (0), of L (1), or the constants 0 and 1 (2).
  struct Line {
    std::array<std::uint16_t, 8> entry{};
    std::array<std::uint8_t, 8> from{};
    bool is_wide = false;
    std::uint16_t row = 0;    ///< row of a wide line
    std::uint16_t begin = 0;  ///< first number of a wide line
  };
  static constexpr Line line_of(const Sources& of, bool is_wide, std::size_t row,
                                std::size_t begin) noexcept {
    Line line{.is_wide = is_wide,
              .row = static_cast<std::uint16_t>(row),
              .begin = static_cast<std::uint16_t>(begin)};
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const bool is_f = of.f[lane] != Layout::kNone;
      const bool is_l = !is_f && of.l[lane] != Layout::kNone;
      line.from[lane] = is_f ? 0 : (is_l ? 1 : 2);
      line.entry[lane] =
          static_cast<std::uint16_t>(is_f ? of.f[lane] : (is_l ? of.l[lane] : of.is_one[lane]));
    }
    return line;
  }
  static constexpr auto kLines = [] {
    constexpr std::size_t kNumberLines = Layout::kNumbers / 8;
    std::array<Line, kNumberLines + Layout::kWideRows*(kLanes / 8)> lines{};
    std::size_t at = 0;
    for (; at < kNumberLines; ++at) lines[at] = line_of(kSourcesOfNumbers[at], false, 0, 8 * at);
    const auto add = [&](std::size_t i, bool of_f, std::size_t row) {
      for (std::size_t block = 0; block < kLanes / 8; ++block)
        lines[at++] = line_of(sources_of_row(i, of_f, block), true, row, 8 * block);
    };
    for (std::size_t i = 0; i < kNx; ++i) {
      if (Layout::is_wide_state(i)) add(i, true, Layout::wide_state(i));
    }
    for (std::size_t i = 0; i < Layout::kNz; ++i) {
      if (Layout::is_wide_cost(i)) add(i, false, Layout::wide_cost(i));
    }
    return lines;
  }();

  /// Writes wide row I of F, or of L.
  template <std::size_t I, bool OfF, class F, class L>
  CHICANE_INLINE void write_row(std::size_t k, const F& f, const L& l) noexcept {
    constexpr std::size_t kRow = OfF ? Layout::wide_state(I) : Layout::wide_cost(I);
    unroll<kLanes / 8>([&](auto block) CHICANE_INLINE {
      write<sources_of_row(I, OfF, block)>(k, f, l, [=](Stage& s) { return s.wide[kRow] + block * 8; });
    });
  }
  template <auto Of, class F, class L, class Place>
  CHICANE_INLINE void write(std::size_t k, const F& f, const L& l, const Place& place) noexcept {
    using Stages = typename F::value_type;
    Stages rows[8];
    unroll<8>([&](auto lane) CHICANE_INLINE {
      if constexpr (Of.f[lane] != Layout::kNone) {
        rows[lane] = f[Of.f[lane]];
      } else if constexpr (Of.l[lane] != Layout::kNone) {
        rows[lane] = l[Of.l[lane]];
      } else {
        rows[lane] = Stages(Of.is_one[lane] ? 1.0 : 0.0);
      }
    });
    transpose(rows);
    for (std::size_t s = 0; s < 8; ++s) rows[s].store(place(stage[k + s]));
  }
};

}  // namespace chicane::solver
