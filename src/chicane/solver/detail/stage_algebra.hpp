// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/base/compiler.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/pattern.hpp"

namespace chicane::solver {

/// Products of the backward sweep (docs/solver.md, eq. 9) with the states as lanes of registers. Each stored
/// entry of a pattern costs one multiply-add of whole registers, and zeros cost nothing.
template <class Arch, class Pattern, class Stage>
class StageAlgebra {
 public:
  using Layout = solver::Layout<Pattern>;
  static constexpr std::size_t kNx = Layout::kNx;
  static constexpr std::size_t kNu = Layout::kNu;
  static constexpr std::size_t kLanes = Layout::kLanes;
  using V = Pack<Arch, kNx <= 4 ? 4 : 8>;
  static constexpr std::size_t kBlocks = kNx <= 4 ? 1 : kLanes / 8;
  static constexpr std::size_t kBlock = V::kLanes;

  /// One vector over the states.
  struct Vector {
    V part[kBlocks];
    CHICANE_INLINE static Vector load(const double* from) noexcept {
      Vector v;
      unroll<kBlocks>([&](auto b) CHICANE_INLINE { v.part[b] = V::load(from + b * kBlock); });
      return v;
    }
    CHICANE_INLINE static Vector zero() noexcept {
      Vector v;
      unroll<kBlocks>([&](auto b) CHICANE_INLINE { v.part[b] = V(0.0); });
      return v;
    }
    CHICANE_INLINE void store(double* to) const noexcept {
      unroll<kBlocks>([&](auto b) CHICANE_INLINE { part[b].store(to + b * kBlock); });
    }
    CHICANE_INLINE void set(std::size_t i, double value) noexcept { part[i / kBlock].set(i % kBlock, value); }
    CHICANE_INLINE void add(const Vector& o) noexcept {
      unroll<kBlocks>([&](auto b) CHICANE_INLINE { part[b] += o.part[b]; });
    }
    CHICANE_INLINE void add(double factor, const Vector& o) noexcept {
      const V f(factor);
      unroll<kBlocks>([&](auto b) CHICANE_INLINE { part[b] = fused_multiply_add(f, o.part[b], part[b]); });
    }
    CHICANE_INLINE static Vector scaled(double factor, const Vector& o) noexcept {
      Vector v;
      unroll<kBlocks>([&](auto b) CHICANE_INLINE { v.part[b] = V(factor) * o.part[b]; });
      return v;
    }
  };
  /// The value function ½ (δx, 1)ᵀ P (δx, 1): columns of P, then its gradient.
  struct Value {
    Vector column[kNx + 1];
  };

  /// A list of indices known at compile time.
  struct Terms {
    std::array<std::size_t, (kNx > kNu ? kNx : kNu)> index{};
    std::size_t count = 0;
    constexpr void add(std::size_t i) noexcept { index[count++] = i; }
  };
  /// Rows of F with an entry in column j that is (or is not) a plain 1.
  static constexpr Terms rows_of(std::size_t j, bool ones) noexcept {
    Terms terms;
    for (std::size_t i = 0; i < kNx; ++i) {
      const bool is_stored = Layout::kF[i][j] != Layout::kNone;
      if (ones ? !is_stored && Pattern::kF[i][j] == Entry::kOne : is_stored) terms.add(i);
    }
    return terms;
  }
  /// Rows of F with more among the states than the 1 of a sum.
  static constexpr Terms state_rows() noexcept {
    Terms terms;
    for (std::size_t i = 0; i < kNx; ++i) {
      if (Layout::has_state_row(i)) terms.add(i);
    }
    return terms;
  }
  static constexpr bool has_column(std::size_t j) noexcept {
    return rows_of(j, true).count + rows_of(j, false).count > 0;
  }

  /// F[I][J].
  template <std::size_t I, std::size_t J>
  CHICANE_INLINE static double jacobian(const Stage& s) noexcept {
    constexpr std::size_t kNumber = Layout::kNumber.f[I][J];
    if constexpr (kNumber != Layout::kNone) {
      return s.number[kNumber];
    } else {
      constexpr std::size_t kRow = Layout::wide_state(I);
      return s.wide[kRow][J];
    }
  }
  /// L[I][J], I and J inputs or the constant; zero where the pattern has no such entry.
  template <std::size_t I, std::size_t J>
  CHICANE_INLINE static double cost(const Stage& s) noexcept {
    constexpr std::size_t kNumber = Layout::kNumber.l[I][J];
    if constexpr (kNumber != Layout::kNone) return s.number[kNumber];
    return 0.0;
  }
  /// Row I of F over the states, without the 1 of a sum.
  template <std::size_t I>
  CHICANE_INLINE static Vector state_row(const Stage& s) noexcept {
    if constexpr (Layout::is_wide_state(I)) {
      constexpr std::size_t kRow = Layout::wide_state(I);
      return Vector::load(s.wide[kRow]);
    } else {
      Vector row = Vector::zero();
      unroll<kNx>([&](auto j) CHICANE_INLINE {
        if constexpr (Layout::is_one(I, j)) row.set(j, 1.0);
        if constexpr (Layout::kF[I][j] != Layout::kNone) row.set(j, jacobian<I, j>(s));
      });
      return row;
    }
  }
  /// Row I of L over the states.
  template <std::size_t I>
  CHICANE_INLINE static Vector cost_row(const Stage& s) noexcept {
    if constexpr (Layout::is_wide_cost(I)) {
      constexpr std::size_t kRow = Layout::wide_cost(I);
      return Vector::load(s.wide[kRow]);
    } else {
      Vector row = Vector::zero();
      unroll<kNx>([&](auto j) CHICANE_INLINE {
        if constexpr (Layout::kL[I][j] != Layout::kNone) row.set(j, s.number[Layout::kNumber.l[I][j]]);
      });
      return row;
    }
  }

  /// start + Σ_t factor(t) · vector(t) over `Count` terms; in two sums side by side when they are many, which
  /// halves the wait for one to finish.
  template <std::size_t Count, class Factor, class Operand>
  CHICANE_INLINE static Vector combine(const Vector& start, const Factor& factor,
                                       const Operand& operand) noexcept {
    Vector sum = start;
    if constexpr (Count < 4) {
      unroll<Count>([&](auto t) CHICANE_INLINE { sum.add(factor(t), operand(t)); });
    } else {
      Vector other = Vector::scaled(factor(std::integral_constant<std::size_t, 0>{}),
                                    operand(std::integral_constant<std::size_t, 0>{}));
      unroll<Count - 1>([&](auto t) CHICANE_INLINE {
        constexpr std::integral_constant<std::size_t, t + 1> kTerm{};
        if constexpr (kTerm % 2 == 0) {
          other.add(factor(kTerm), operand(kTerm));
        } else {
          sum.add(factor(kTerm), operand(kTerm));
        }
      });
      sum.add(other);
    }
    return sum;
  }

  /// P F, column j.
  template <std::size_t J>
  CHICANE_INLINE static Vector times_jacobian(const Stage& s, const Value& P) noexcept {
    if constexpr (Layout::is_large()) {
      return times_jacobian_in_loops(s, P, J);
    } else {
      constexpr Terms kOnes = rows_of(J, true);
      constexpr Terms kValues = rows_of(J, false);
      const auto factor = [&](auto t) CHICANE_INLINE { return jacobian<kValues.index[t], J>(s); };
      const auto column = [&](auto t) CHICANE_INLINE { return P.column[kValues.index[t]]; };
      if constexpr (J == kNx) {
        return combine<kValues.count>(P.column[kNx], factor, column);
      } else if constexpr (kOnes.count + kValues.count == 0) {
        return Vector::zero();
      } else if constexpr (kOnes.count > 0) {
        Vector start = P.column[kOnes.index[0]];
        unroll<kOnes.count - 1>([&](auto t) CHICANE_INLINE { start.add(P.column[kOnes.index[t + 1]]); });
        return combine<kValues.count>(start, factor, column);
      } else {
        const Vector start =
            Vector::scaled(factor(std::integral_constant<std::size_t, 0>{}), P.column[kValues.index[0]]);
        const auto later_factor = [&](auto t) CHICANE_INLINE {
          return factor(std::integral_constant<std::size_t, t + 1>{});
        };
        const auto later_column = [&](auto t) CHICANE_INLINE {
          return column(std::integral_constant<std::size_t, t + 1>{});
        };
        return combine<kValues.count - 1>(start, later_factor, later_column);
      }
    }
  }

  /// P F, column j, for dense patterns, in a loop; j: the constant or an input.
  static Vector times_jacobian_in_loops(const Stage& s, const Value& P, std::size_t j) noexcept {
    Vector sum = j == kNx ? P.column[kNx] : Vector::zero();
    for (std::size_t i = 0; i < kNx; ++i) sum.add(s.number[Layout::kNumber.f[i][j]], P.column[i]);
    return sum;
  }

  /// 1 in the lanes of states that are sums (Layout::is_sum()), else 0.
  alignas(64) static constexpr std::array<double, kLanes> kSums = [] {
    std::array<double, kLanes> lanes{};
    for (std::size_t i = 0; i < kNx; ++i) lanes[i] = Layout::is_sum(i) ? 1.0 : 0.0;
    return lanes;
  }();
  static constexpr bool kHasSums = [] {
    for (const double lane : kSums) {
      if (lane > 0.0) return true;
    }
    return false;
  }();
  /// Adds the lanes of w that belong to sums.
  CHICANE_INLINE static void add_sums(Vector& sum, const Vector& w) noexcept {
    if constexpr (kHasSums) {
      unroll<kBlocks>([&](auto b) CHICANE_INLINE {
        const auto is_sum = V::load(kSums.data() + b * kBlock) > V(0.0);
        sum.part[b] = select(is_sum, sum.part[b] + w.part[b], sum.part[b]);
      });
    }
  }

  /// Row i of Q over the states: L + Aᵀ w for a column w of P F, in registers and in memory.
  template <std::size_t I>
  CHICANE_INLINE static Vector row_of_q(const Stage& s, const Vector& w, const double* w_in_memory) noexcept {
    if constexpr (Layout::is_large()) {
      Vector sum = cost_row<I>(s);
      for (std::size_t i = 0; i < kNx; ++i) sum.add(w_in_memory[i], Vector::load(s.wide[i]));
      return sum;
    } else {
      constexpr Terms kRows = state_rows();
      Vector start = cost_row<I>(s);
      add_sums(start, w);
      if constexpr (kRows.count == 0) {
        return start;
      } else {
        return combine<kRows.count>(
            start, [&](auto t) CHICANE_INLINE { return w_in_memory[kRows.index[t]]; },
            [&](auto t) CHICANE_INLINE { return state_row<kRows.index[t]>(s); });
      }
    }
  }
  /// Σ_m factor_m · v_m over the inputs.
  CHICANE_INLINE static Vector combination(const double (&factor)[kNu], const Vector (&v)[kNu]) noexcept {
    Vector sum = Vector::scaled(factor[0], v[0]);
    unroll<kNu - 1>([&](auto m) CHICANE_INLINE { sum.add(factor[m + 1], v[m + 1]); });
    return sum;
  }
  /// column − scale · Σ_m r_mj T_m, over the inputs whose row of Q can have an entry at state J.
  template <std::size_t J>
  CHICANE_INLINE static void eliminate_inputs(const Vector (&T)[kNu], double scale,
                                              const double (&r)[kNu][kLanes], Vector& column) noexcept {
    constexpr Terms kInputs = inputs_with(J);
    if constexpr (kInputs.count > 0) {
      Vector sum = Vector::scaled(r[kInputs.index[0]][J], T[kInputs.index[0]]);
      unroll<kInputs.count - 1>([&](auto n) CHICANE_INLINE {
        constexpr std::size_t m = kInputs.index[n + 1];
        sum.add(r[m][J], T[m]);
      });
      column.add(-scale, sum);
    }
  }
  static constexpr Terms inputs_with(std::size_t j) noexcept {
    Terms inputs;
    for (std::size_t m = 0; m < kNu; ++m) {
      if (has_column(j) || Layout::kL[Layout::kHead + m][j] != Layout::kNone) inputs.add(m);
    }
    return inputs;
  }

  /// Turns P of the states into Aᵀ P A + L, less the part that the inputs save.
  CHICANE_INLINE static void eliminate_states(const Stage& s, const Vector (&T)[kNu], double scale,
                                              const double (&r)[kNu][kLanes], Value& P) noexcept {
    Vector Wx[kNx];
    alignas(64) double wx[kNx][kLanes];
    unroll<kNx>([&](auto j) CHICANE_INLINE {
      if constexpr (has_column(j)) {
        Wx[j] = times_jacobian<j>(s, P);
        Wx[j].store(wx[j]);
      }
    });
    settle(wx);
    unroll<kNx>([&](auto j) CHICANE_INLINE {
      if constexpr (has_column(j)) {
        P.column[j] = row_of_q<j>(s, Wx[j], wx[j]);
      } else {
        P.column[j] = cost_row<j>(s);
      }
      eliminate_inputs<j>(T, scale, r, P.column[j]);
    });
  }

  /// eliminate_states() for dense patterns: column by column in a loop, with products in the same order.
  CHICANE_INLINE static void eliminate_full(const Stage& s, const Vector (&T)[kNu], double scale,
                                            const double (&r)[kNu][kLanes], Value& P) noexcept {
    alignas(64) double wx[kNx][kLanes];
    if constexpr (Layout::is_large()) {
      for (std::size_t j = 0; j < kNx; ++j) {
        Vector w = Vector::zero();
        for (std::size_t t = 0; t < kNx; ++t) w.add(s.wide[t][j], P.column[t]);
        w.store(wx[j]);
      }
      for (std::size_t j = 0; j < kNx; ++j) {
        Vector column = Vector::load(s.wide[kNx + j]);
        for (std::size_t t = 0; t < kNx; ++t) column.add(wx[j][t], Vector::load(s.wide[t]));
        for (std::size_t m = 0; m < kNu; ++m) column.add(-scale * r[m][j], T[m]);
        P.column[j] = column;
      }
    } else {
      for (std::size_t j = 0; j < kNx; ++j) {
        const Vector start = Vector::scaled(s.wide[0][j], P.column[0]);
        combine<kNx - 1>(
            start, [&](auto t) CHICANE_INLINE { return s.wide[t + 1][j]; },
            [&](auto t) CHICANE_INLINE { return P.column[t + 1]; })
            .store(wx[j]);
      }
      settle(wx);
      for (std::size_t j = 0; j < kNx; ++j) {
        Vector column = combine<kNx>(
            Vector::load(s.wide[kNx + j]), [&](auto t) CHICANE_INLINE { return wx[j][t]; },
            [&](auto t) CHICANE_INLINE { return Vector::load(s.wide[t]); });
        Vector sum = Vector::scaled(r[0][j], T[0]);
        unroll<kNu - 1>([&](auto m) CHICANE_INLINE { sum.add(r[m + 1][j], T[m + 1]); });
        column.add(-scale, sum);
        P.column[j] = column;
      }
    }
  }

  /// start + column J of F times w, number by number.
  template <std::size_t J>
  CHICANE_INLINE static double times_column(const Stage& s, const double* w, double start) noexcept {
    if constexpr (Layout::is_large()) {
      double sum = start;
      for (std::size_t i = 0; i < kNx; ++i)
        sum = fused_multiply_add<Arch>(J < kNx ? s.wide[i][J] : s.number[Layout::kNumber.f[i][J]], w[i], sum);
      return sum;
    } else {
      constexpr Terms kOnes = rows_of(J, true);
      constexpr Terms kValues = rows_of(J, false);
      double sum = start;
      unroll<kOnes.count>([&](auto t) CHICANE_INLINE { sum += w[kOnes.index[t]]; });
      if constexpr (kValues.count == 0) return sum;
      double other = jacobian<kValues.index[0], J>(s) * w[kValues.index[0]];
      unroll<kValues.count == 0 ? 0 : kValues.count - 1>([&](auto t) CHICANE_INLINE {
        constexpr std::size_t kI = kValues.index[t + 1];
        double& side = t % 2 == 0 ? sum : other;
        side = fused_multiply_add<Arch>(jacobian<kI, J>(s), w[kI], side);
      });
      return sum + other;
    }
  }

  /// start + row · x
  CHICANE_INLINE static double dot_row(const double* row, const double (&x)[kNx], double start) noexcept {
    constexpr std::size_t kParts = kNx < 4 ? 1 : (kNx < 8 ? 2 : 4);
    double sum[kParts] = {start};
    if constexpr (Layout::is_large()) {
      for (std::size_t i = 0; i < kNx; ++i)
        sum[i % kParts] = fused_multiply_add<Arch>(row[i], x[i], sum[i % kParts]);
      return (sum[0] + sum[1]) + (sum[2] + sum[3]);
    } else {
      unroll<kNx>([&](auto i) CHICANE_INLINE {
        double& side = sum[i % kParts];
        side = i > 0 && i < kParts ? row[i] * x[i] : fused_multiply_add<Arch>(row[i], x[i], side);
      });
      if constexpr (kParts == 4) return (sum[0] + sum[1]) + (sum[2] + sum[3]);
      if constexpr (kParts == 2) return sum[0] + sum[1];
      return sum[0];
    }
  }

  /// Replaces x by F z.
  CHICANE_INLINE static void advance(const Stage& s, double (&x)[kNx], const double (&u)[kNu]) noexcept {
    double next[kNx];
    if constexpr (Layout::is_large()) {
      for (std::size_t i = 0; i < kNx; ++i) {
        next[i] = dot_row(s.wide[i], x, s.defect(i));
        for (std::size_t m = 0; m < kNu; ++m)
          next[i] = fused_multiply_add<Arch>(s.number[Layout::kNumber.f[i][kNx + 1 + m]], u[m], next[i]);
      }
    } else {
      unroll<kNx>([&](auto i) CHICANE_INLINE {
        double sum = s.defect(i);
        double other = 0.0;
        unroll<kNx>([&](auto j) CHICANE_INLINE {
          if constexpr (Layout::kF[i][j] != Layout::kNone) {
            double& side = j % 2 == 0 ? sum : other;
            side = fused_multiply_add<Arch>(jacobian<i, j>(s), x[j], side);
          } else if constexpr (Pattern::kF[i][j] == Entry::kOne) {
            sum += x[j];
          }
        });
        sum += other;
        unroll<kNu>([&](auto m) CHICANE_INLINE {
          constexpr std::size_t kU = kNx + 1 + m;
          if constexpr (Layout::kF[i][kU] != Layout::kNone) {
            sum = fused_multiply_add<Arch>(jacobian<i, kU>(s), u[m], sum);
          } else if constexpr (Pattern::kF[i][kU] == Entry::kOne) {
            sum += u[m];
          }
        });
        next[i] = sum;
      });
    }
    for (std::size_t i = 0; i < kNx; ++i) x[i] = next[i];
  }

  /// Makes the compiler load numbers from memory, which is cheaper than taking them out of registers.
  template <class Memory>
  CHICANE_INLINE static void settle(Memory& memory) noexcept {
    asm volatile("" : "+m"(memory));  // NOLINT: no instruction
  }

  /// Averages P with its transpose: rounding errors that are not symmetric would grow like an uncontrolled
  /// system.
  CHICANE_INLINE static void make_symmetric(Value& P) noexcept {
    unroll<kBlocks>([&](auto a) CHICANE_INLINE {
      unroll<a + 1>([&](auto b) CHICANE_INLINE { average_blocks<a, b>(P); });
    });
  }
  /// make_symmetric() in a function that is not inlined, which compiles faster.
  [[gnu::noinline]] static void make_symmetric_apart(Value& P) noexcept {
    Value changed = P;
    make_symmetric(changed);
    P = changed;
  }

  /// Averages the block in columns A and rows B with the transpose of the block in columns B and rows A.
  template <std::size_t A, std::size_t B>
  CHICANE_INLINE static void average_blocks(Value& P) noexcept {
    V upper[kBlock];
    V lower[kBlock];
    unroll<kBlock>([&](auto i) CHICANE_INLINE {
      constexpr std::size_t kColumn = A * kBlock + i;
      constexpr std::size_t kRow = B * kBlock + i;
      upper[i] = kColumn < kNx ? P.column[kColumn < kNx ? kColumn : 0].part[B] : V(0.0);
      lower[i] = kRow < kNx ? P.column[kRow < kNx ? kRow : 0].part[A] : V(0.0);
    });
    transpose(lower);
    unroll<kBlock>([&](auto i) CHICANE_INLINE { upper[i] = 0.5 * (upper[i] + lower[i]); });
    unroll<kBlock>([&](auto i) CHICANE_INLINE {
      if constexpr (A * kBlock + i < kNx) P.column[A * kBlock + i].part[B] = upper[i];
    });
    if constexpr (A != B) {
      transpose(upper);
      unroll<kBlock>([&](auto i) CHICANE_INLINE {
        if constexpr (B * kBlock + i < kNx) P.column[B * kBlock + i].part[A] = upper[i];
      });
    }
  }
};

}  // namespace chicane::solver
