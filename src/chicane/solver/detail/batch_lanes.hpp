// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "chicane/base/inlining.hpp"
#include "chicane/base/math_pack.hpp"
#include "chicane/solver/detail/pattern.hpp"
#include "chicane/solver/detail/problem_pattern.hpp"

namespace chicane::solver {

/// Which entries of the cost to go of a structured problem can be other than zero, at any stage: the fixed
/// point of eq. 9–11 for patterns. States that no input sees keep their zeros.
template <StructuredProblem P>
struct ValuePattern {
  using Stage = ProblemPattern<P>;
  using Terminal = decltype(std::declval<const P&>().terminal_residual(typename Stage::X{}));
  static constexpr std::size_t kNx = Stage::kNx;
  static constexpr std::size_t kNu = Stage::kNu;
  static constexpr std::size_t kHead = kNx + 1;

  struct Tables {
    std::array<std::array<bool, kNx>, kNx> value{};           ///< P
    std::array<std::array<bool, kNx>, Stage::kNz> product{};  ///< [j][r]: (P F)_rj, without the defects
    std::array<bool, kNx> gain{};                             ///< δu depends on δx_i

    constexpr void multiply() noexcept {
      for (std::size_t j = 0; j < Stage::kNz; ++j) {
        for (std::size_t n = 0; n < kNx * kNx; ++n) {
          if (j != kNx && Stage::kF[n % kNx][j] != Entry::kZero && value[n / kNx][n % kNx])
            product[j][n / kNx] = true;
        }
      }
    }
    /// Q_ij = L_ij + f_iᵀ P f_j
    [[nodiscard]] constexpr bool has_q(std::size_t i, std::size_t j) const noexcept {
      bool is_there = Stage::kL[i][j];
      for (std::size_t r = 0; r < kNx; ++r)
        is_there = is_there || (Stage::kF[r][i] != Entry::kZero && product[j][r]);
      return is_there;
    }
    /// One step of the recursion; true when it brought something new.
    constexpr bool extend() noexcept {
      multiply();
      for (std::size_t n = 0; n < kNx * kNu; ++n)
        gain[n % kNx] = gain[n % kNx] || has_q(n % kNx, kHead + n / kNx);
      bool is_new = false;
      for (std::size_t n = 0; n < kNx * kNx; ++n) {
        const std::size_t i = n / kNx;
        const std::size_t j = n % kNx;
        if (value[i][j] || !(has_q(i, j) || has_q(j, i) || (gain[i] && gain[j]))) continue;
        value[i][j] = value[j][i] = is_new = true;
      }
      return is_new;
    }
  };
  static constexpr Tables kTables = [] {
    Tables tables;
    const Pairs pairs = detail::RowSets<Terminal>::squares() | detail::RowSets<Terminal>::second();
    for (std::size_t n = 0; n < kNx * kNx; ++n)
      tables.value[n / kNx][n % kNx] = pairs.contains(static_cast<int>(n / kNx), static_cast<int>(n % kNx));
    while (tables.extend()) {
    }
    tables.multiply();
    return tables;
  }();
};

/// Some stages of several linear-quadratic problems at once, one in each lane of V: the recursion of
/// docs/solver.md, eq. 9–11, number by number over the entries that there are. Everything is unrolled.
template <class V, StructuredProblem Problem>
class RiccatiLanes {
 public:
  using Pattern = ProblemPattern<Problem>;
  using Layout = solver::Layout<Pattern>;
  using Lanes = typename V::MaskType;
  static constexpr std::size_t kNx = Layout::kNx;
  static constexpr std::size_t kNu = Layout::kNu;
  static constexpr std::size_t kNz = Layout::kNz;
  static constexpr std::size_t kOne = Layout::kOne;
  static constexpr std::size_t kHead = Layout::kHead;
  using State = std::array<V, kNx>;
  using Input = std::array<V, kNu>;
  using Jacobians = std::array<V, Layout::kFCount>;  ///< as numbered by Layout::kF
  using Costs = std::array<V, Layout::kLCount>;      ///< as numbered by Layout::kL

  /// What the forward sweep needs of a stage.
  struct Stage {
    Jacobians F;
    std::array<State, kNu> gain;  ///< δu = gain δx + constant; entries that are never there are not set
    Input constant;
  };

  /// The cost to go, ½ δxᵀ P δx + pᵀ δx; the upper triangle of P.
  struct Value {
    std::array<State, kNx> P;
    State p;
  };

  /// λ_k = g_x + Aᵀ λ_{k+1}; `slope` = g_u + Bᵀ λ_{k+1}. `L` needs its gradients only.
  CHICANE_INLINE static void adjoint(const Jacobians& F, const Costs& L, State& lambda,
                                     Input& slope) noexcept {
    const State next = lambda;
    const auto price = [&](auto i) CHICANE_INLINE { return next[i]; };
    unroll<kNx>([&](auto j) CHICANE_INLINE {
      lambda[j] = jet::number<V>(column_times<j>(F, entry_of_l<j, kOne>(L), price));
    });
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      slope[m] = jet::number<V>(column_times<kHead + m>(F, entry_of_l<kHead + m, kOne>(L), price));
    });
  }

  /// Eliminates the inputs of a stage, those that are not free held where they are: gains and constants into
  /// `s`, the cost to go from stage k + 1 to that from stage k. Lanes whose input block is not positive
  /// definite are taken out of `good`.
  CHICANE_INLINE static void eliminate(Stage& s, const Costs& L, const std::array<Lanes, kNu>& is_free,
                                       Value& value, Lanes& good) noexcept {
    const Jacobians& F = s.F;
    std::array<State, kNz> w;  // columns of P F
    unroll<kNz>([&](auto j) CHICANE_INLINE {
      unroll<kNx>([&](auto r) CHICANE_INLINE {
        const auto row = [&](auto i) CHICANE_INLINE { return entry_of_p<r, i>(value); };
        if constexpr (j == kOne) w[j][r] = column_times<j>(F, value.p[r], row);
        if constexpr (kTables.product[j][r]) w[j][r] = column_times<j>(F, jet::Zero{}, row);
      });
    });
    std::array<Input, kNu> H;
    Input g;
    std::array<State, kNu> Qux;
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      unroll<m + 1>([&](auto l) CHICANE_INLINE {
        H[m][l] = H[l][m] = jet::number<V>(entry_of_q<kHead + l, kHead + m>(F, L, w));
      });
      unroll<kNx>([&](auto i) CHICANE_INLINE {
        if constexpr (kTables.gain[i]) Qux[m][i] = jet::number<V>(entry_of_q<i, kHead + m>(F, L, w));
      });
      g[m] = jet::number<V>(entry_of_q<kOne, kHead + m>(F, L, w));
    });
    good = good & solve_inputs(s, H, g, Qux, is_free);
    unroll<kNx>([&](auto i) CHICANE_INLINE {
      auto& q = value.p[i];
      q = jet::number<V>(entry_of_q<i, kOne>(F, L, w));
      if constexpr (kTables.gain[i]) {
        unroll<kNu>([&](auto m) CHICANE_INLINE { q = fused_multiply_add(Qux[m][i], s.constant[m], q); });
      }
      unroll<kNx - i>([&](auto n) CHICANE_INLINE {
        constexpr std::size_t kJ = i + n;
        if constexpr (kTables.value[i][kJ]) {
          const auto start = entry_of_q<i, kJ>(F, L, w);
          if constexpr (kTables.gain[i] && kTables.gain[kJ]) {
            V sum = fused(Qux[0][i], s.gain[0][kJ], start);
            unroll<kNu - 1>([&](auto m) CHICANE_INLINE {
              sum = fused_multiply_add(Qux[m + 1][i], s.gain[m + 1][kJ], sum);
            });
            value.P[i][kJ] = sum;
          } else {
            value.P[i][kJ] = jet::number<V>(start);
          }
        }
      });
    });
  }

  /// δu of a stage.
  CHICANE_INLINE static Input input_step(const Stage& s, const State& dx) noexcept {
    Input du;
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      du[m] = s.constant[m];
      unroll<kNx>([&](auto i) CHICANE_INLINE {
        if constexpr (kTables.gain[i]) du[m] = fused_multiply_add(s.gain[m][i], dx[i], du[m]);
      });
    });
    return du;
  }
  /// δx of the next stage.
  CHICANE_INLINE static State next_step(const Stage& s, const State& dx, const Input& du) noexcept {
    State next;
    unroll<kNx>([&](auto i) CHICANE_INLINE {
      V sum = s.F[Layout::kF[i][kOne]];
      unroll<kNx>([&](auto j) CHICANE_INLINE { sum = fused(entry_of_f<i, j>(s.F), dx[j], sum); });
      unroll<kNu>([&](auto m) CHICANE_INLINE { sum = fused(entry_of_f<i, kHead + m>(s.F), du[m], sum); });
      next[i] = sum;
    });
    return next;
  }

  template <std::size_t I, std::size_t J>
  CHICANE_INLINE static auto entry_of_f(const Jacobians& F) noexcept {
    if constexpr (Layout::kF[I][J] != Layout::kNone) {
      return F[Layout::kF[I][J]];
    } else if constexpr (Pattern::kF[I][J] == Entry::kOne) {
      return jet::One{};
    } else {
      return jet::Zero{};
    }
  }

 private:
  static constexpr auto kTables = ValuePattern<Problem>::kTables;

  template <std::size_t I, std::size_t J>
  CHICANE_INLINE static auto entry_of_l(const Costs& L) noexcept {
    if constexpr (Layout::kL[I][J] != Layout::kNone) {
      return L[Layout::kL[I][J]];
    } else {
      return jet::Zero{};
    }
  }
  template <std::size_t R, std::size_t I>
  CHICANE_INLINE static auto entry_of_p(const Value& value) noexcept {
    if constexpr (kTables.value[R][I]) {
      return value.P[R < I ? R : I][R < I ? I : R];
    } else {
      return jet::Zero{};
    }
  }

  /// sum + a · b
  template <class A, class B, class S>
  CHICANE_INLINE static auto fused(const A& a, const B& b, const S& sum) noexcept {
    if constexpr (jet::kIsZero<A> || jet::kIsZero<B>) {
      return sum;
    } else if constexpr (jet::kIsZero<S>) {
      return jet::times(a, b);
    } else if constexpr (jet::kIsOne<A>) {
      return sum + b;
    } else {
      return fused_multiply_add(a, b, sum);
    }
  }
  /// sum + Σ_i F_iJ · value(i)
  template <std::size_t J, std::size_t I = 0, class S, class F>
  CHICANE_INLINE static auto column_times(const Jacobians& jacobians, const S& sum, const F& value) noexcept {
    if constexpr (I == kNx) {
      return sum;
    } else {
      return column_times<J, I + 1>(
          jacobians, fused(entry_of_f<I, J>(jacobians), value(std::integral_constant<std::size_t, I>{}), sum),
          value);
    }
  }
  static constexpr std::size_t column_size(std::size_t j) noexcept {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kNx; ++i)
      count += Layout::kF[i][j] != Layout::kNone || Pattern::kF[i][j] == Entry::kOne ? 1 : 0;
    return count;
  }

  /// Q_IJ = L_IJ + f_Iᵀ P f_J by the shorter one of the two columns of F; the one of the defects, which also
  /// carries p, always last.
  template <std::size_t I, std::size_t J, class W>
  CHICANE_INLINE static auto entry_of_q(const Jacobians& F, const Costs& L, const W& w) noexcept {
    constexpr bool kByI = J == kOne || (I != kOne && column_size(I) <= column_size(J));
    constexpr std::size_t kShort = kByI ? I : J;
    constexpr std::size_t kLong = kByI ? J : I;
    return column_times<kShort>(F, entry_of_l<I, J>(L), [&](auto r) CHICANE_INLINE {
      if constexpr (kLong == kOne || kTables.product[kLong][r]) {
        return w[kLong][r];
      } else {
        return jet::Zero{};
      }
    });
  }

  /// Gains and constants of the free inputs; the others stay.
  CHICANE_INLINE static Lanes solve_inputs(Stage& s, const std::array<Input, kNu>& H, const Input& g,
                                           const std::array<State, kNu>& Qux,
                                           const std::array<Lanes, kNu>& is_free) noexcept {
    std::array<Input, kNu> A;
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      unroll<kNu>([&](auto l) CHICANE_INLINE {
        A[m][l] = select(is_free[m] & is_free[l], H[m][l], V(m == l ? 1.0 : 0.0));
      });
    });
    const Lanes good = invert(A);
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      Input row;
      unroll<kNu>([&](auto l) CHICANE_INLINE { row[l] = select(is_free[m] & is_free[l], -A[m][l], V(0.0)); });
      const auto times_row = [&](const auto& column) CHICANE_INLINE {
        V sum = row[0] * column(0);
        unroll<kNu - 1>([&](auto l)
                            CHICANE_INLINE { sum = fused_multiply_add(row[l + 1], column(l + 1), sum); });
        return sum;
      };
      s.constant[m] = times_row([&](std::size_t l) CHICANE_INLINE { return g[l]; });
      unroll<kNx>([&](auto i) CHICANE_INLINE {
        if constexpr (kTables.gain[i])
          s.gain[m][i] = times_row([&](std::size_t l) CHICANE_INLINE { return Qux[l][i]; });
      });
    });
    return good;
  }

  /// The inverse in place; lanes where all pivots are positive.
  CHICANE_INLINE static Lanes invert(std::array<Input, kNu>& A) noexcept {
    if constexpr (kNu == 2) {
      const V determinant = fused_negative_multiply_add(A[1][0], A[1][0], A[0][0] * A[1][1]);
      const V scale = 1.0 / determinant;
      const Lanes good = (A[1][1] > V(1e-12)) & (determinant > 1e-10 * A[0][0] * A[1][1]);
      const V first = A[1][1] * scale;
      A[1][1] = A[0][0] * scale;
      A[0][0] = first;
      A[0][1] = A[1][0] = -A[1][0] * scale;
      return good;
    } else {
      Lanes good = V(0.0) == V(0.0);
      unroll<kNu>([&](auto p) CHICANE_INLINE {
        good = good & (A[p][p] > V(1e-12));
        const V pivot = 1.0 / A[p][p];
        unroll<kNu>([&](auto m) CHICANE_INLINE {
          if constexpr (m != p) {
            const V factor = A[m][p] * pivot;
            unroll<kNu>([&](auto l) CHICANE_INLINE {
              if constexpr (l != p) A[m][l] = fused_negative_multiply_add(factor, A[p][l], A[m][l]);
            });
            A[m][p] = -factor;
          }
        });
        unroll<kNu>([&](auto l) CHICANE_INLINE {
          if constexpr (l != p) A[p][l] *= pivot;
        });
        A[p][p] = pivot;
      });
      return good;
    }
  }
};

}  // namespace chicane::solver
