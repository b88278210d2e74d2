// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#include "chicane/base/math_pack.hpp"
#include "chicane/solver/pattern.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::solver {

/// The pattern of a structured problem whose Hessians are Gauss and Newton's: less than with second
/// derivatives.
template <class P>
struct GaussNewtonPattern {
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  static constexpr std::size_t kNz = kNx + 1 + kNu;
  using X = StateJets<P, double, 1>;
  using U = InputJets<P, double, 1>;
  using Next =
      decltype(std::declval<const P&>().dynamics(0, std::declval<const X&>(), std::declval<const U&>()));
  using Residual =
      decltype(std::declval<const P&>().residual(0, std::declval<const X&>(), std::declval<const U&>()));

  static constexpr std::size_t in_z(int variable) noexcept {
    const auto i = static_cast<std::size_t>(variable);
    return i < kNx ? i : i + 1;
  }
  static constexpr std::array<std::array<Entry, kNz>, kNx> kF = [] {
    std::array<std::array<Entry, kNz>, kNx> f{};
    unroll<kNx>([&f](auto i) {
      using Row = std::tuple_element_t<i, Next>;
      for (int v = 0; v < static_cast<int>(kNx + kNu); ++v) {
        if (!contains(jet::Traits<Row>::kFirst, v)) continue;
        f[i][in_z(v)] = Entry::kValue;
        if constexpr (AnyJet<Row>) {
          if (contains(Row::kUnit, v)) f[i][in_z(v)] = Entry::kOne;
        }
      }
    });
    return f;
  }();
  static constexpr std::array<std::array<bool, kNz>, kNz> kL = [] {
    std::array<std::array<bool, kNz>, kNz> l{};
    unroll<std::tuple_size_v<Residual>>([&l](auto i) {
      using Row = std::tuple_element_t<i, Residual>;
      for (int a = 0; a < static_cast<int>(kNx + kNu); ++a) {
        if (!contains(jet::Traits<Row>::kFirst, a)) continue;
        l[in_z(a)][kNx] = l[kNx][in_z(a)] = true;
        for (int b = 0; b < static_cast<int>(kNx + kNu); ++b) {
          if (contains(jet::Traits<Row>::kFirst, b)) l[in_z(a)][in_z(b)] = true;
        }
      }
    });
    return l;
  }();
  static constexpr std::array<int, kNu> kRateState = [] {
    std::array<int, kNu> none{};
    none.fill(-1);
    return none;
  }();
};

/// The linear-quadratic problems of several problems at once, one in each lane of V, and their sweeps: the
/// recursion of docs/solver.md, eq. 9–11, number by number over the entries that the pattern has, with
/// working sets as masks. All loops are unrolled, all matrices small.
template <class V, class Pattern, std::size_t Capacity>
class LqLanes {
 public:
  using Layout = solver::Layout<Pattern>;
  using Lanes = typename V::MaskType;
  static constexpr std::size_t kNx = Layout::kNx;
  static constexpr std::size_t kNu = Layout::kNu;
  static constexpr std::size_t kOne = Layout::kOne;
  static constexpr std::size_t kHead = Layout::kHead;

  struct Stage {
    std::array<V, Layout::kFCount> F;  ///< as numbered by Layout::kF
    std::array<V, Layout::kLCount> L;  ///< as numbered by Layout::kL
    std::array<V, kNu> low, high;      ///< bounds on δu
    std::array<V, kNu> hold;           ///< working set: -1, 0 or 1
    std::array<V, kNu> du;
    std::array<std::array<V, kNx>, kNu> gain;  ///< δu = gain δx + constant
    std::array<V, kNu> constant;
    std::array<std::array<V, kNx>, kNu> Qux;
    std::array<std::array<V, kNu>, kNu> H;
    std::array<V, kNu> g;
  };
  std::array<Stage, Capacity> stage;
  std::array<std::array<V, kNx>, Capacity + 1> dx;
  std::array<std::array<V, kNx>, kNx> terminal;  ///< upper triangle of P_N
  std::array<V, kNx> terminal_gradient;

  /// Lanes whose input blocks are all positive definite.
  [[nodiscard]] Lanes backward(std::size_t horizon) noexcept {
    Lanes good = V(0.0) == V(0.0);
    auto P = terminal;
    auto p = terminal_gradient;
    for (std::size_t k = horizon; k-- > 0;) eliminate(stage[k], P, p, good);
    return good;
  }

  /// Lanes whose working set was contradicted, and is corrected.
  [[nodiscard]] Lanes forward(std::size_t horizon) noexcept {
    Lanes changed = V(0.0) < V(0.0);
    for (auto& value : dx[0]) value = V(0.0);
    for (std::size_t k = 0; k < horizon; ++k) {
      Stage& s = stage[k];
      const auto& x = dx[k];
      unroll<kNu>([&](auto m) __attribute__((always_inline)) {
        V u = s.constant[m];
        unroll<kNx>([&](auto i)
                        __attribute__((always_inline)) { u = fused_multiply_add(s.gain[m][i], x[i], u); });
        s.du[m] = u;
      });
      unroll<kNu>([&](auto m) __attribute__((always_inline)) {
        const V next = next_hold(s, m, x);
        changed = changed | !(next == s.hold[m]);
        s.hold[m] = next;
      });
      unroll<kNx>([&](auto i) __attribute__((always_inline)) {
        V sum = s.F[Layout::kF[i][kOne]];
        unroll<kNx>([&](auto j) __attribute__((always_inline)) { add_product<i, j>(s, x[j], sum); });
        unroll<kNu>([&](auto m)
                        __attribute__((always_inline)) { add_product<i, kHead + m>(s, s.du[m], sum); });
        dx[k + 1][i] = sum;
      });
    }
    return changed;
  }

  /// λ_k = g_x + Aᵀ λ_{k+1}; `slope` = g_u + Bᵀ λ_{k+1}.
  [[gnu::always_inline]] void adjoint(std::size_t k, std::array<V, kNx>& lambda,
                                      std::array<V, kNu>& slope) const noexcept {
    const Stage& s = stage[k];
    std::array<V, kNx> next;
    unroll<kNx + kNu>([&](auto n) __attribute__((always_inline)) {
      constexpr std::size_t kJ = n < kNx ? n : n + 1;
      V sum(0.0);
      if constexpr (Layout::kL[kJ][kOne] != Layout::kNone) sum = s.L[Layout::kL[kJ][kOne]];
      unroll<kNx>([&](auto i) __attribute__((always_inline)) { add_product<i, kJ>(s, lambda[i], sum); });
      if constexpr (n < kNx) {
        next[n] = sum;
      } else {
        slope[n - kNx] = sum;
      }
    });
    lambda = next;
  }

 private:
  using Square = std::array<std::array<V, kNx>, kNx>;

  /// sum += F[I][J] · value
  template <std::size_t I, std::size_t J>
  [[gnu::always_inline]] static void add_product(const Stage& s, const V& value, V& sum) noexcept {
    if constexpr (Layout::kF[I][J] != Layout::kNone) {
      sum = fused_multiply_add(s.F[Layout::kF[I][J]], value, sum);
    } else if constexpr (J != kOne && Pattern::kF[I][J] == Entry::kOne) {
      sum += value;
    }
  }
  static constexpr std::size_t column_size(std::size_t j) noexcept {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kNx; ++i) {
      count += Layout::kF[i][j] != Layout::kNone || Pattern::kF[i][j] == Entry::kOne ? 1 : 0;
    }
    return count;
  }

  /// Q_IJ = L_IJ + f_Iᵀ P f_J by the shorter one of the two columns of F.
  template <std::size_t I, std::size_t J, class W>
  [[gnu::always_inline]] static V entry_of_q(const Stage& s, const W& w) noexcept {
    constexpr bool kByI = column_size(I) <= column_size(J);
    constexpr std::size_t kShort = kByI ? I : J;
    constexpr std::size_t kLong = kByI ? J : I;
    V sum(0.0);
    if constexpr (Layout::kL[I][J] != Layout::kNone) sum = s.L[Layout::kL[I][J]];
    if constexpr (column_size(kShort) > 0)
      unroll<kNx>([&](auto r)
                      __attribute__((always_inline)) { add_product<r, kShort>(s, w[kLong][r], sum); });
    return sum;
  }

  [[gnu::always_inline]] static void eliminate(Stage& s, Square& P, std::array<V, kNx>& p,
                                               Lanes& good) noexcept {
    std::array<std::array<V, kNx>, Layout::kNz> w;  // columns of P F
    unroll<Layout::kNz>([&](auto j) __attribute__((always_inline)) {
      if constexpr (column_size(j) > 0) {
        unroll<kNx>([&](auto r) __attribute__((always_inline)) {
          V sum(0.0);
          if constexpr (j == kOne) sum = p[r];
          unroll<kNx>([&](auto i) __attribute__((always_inline)) {
            add_product<i, j>(s, P[r < i ? r : i][r < i ? i : r], sum);
          });
          w[j][r] = sum;
        });
      }
    });
    unroll<kNu>([&](auto m) __attribute__((always_inline)) {
      unroll<m + 1>([&](auto l) __attribute__((always_inline)) {
        s.H[m][l] = entry_of_q<kHead + l, kHead + m>(s, w);
        s.H[l][m] = s.H[m][l];
      });
      unroll<kNx>([&](auto i)
                      __attribute__((always_inline)) { s.Qux[m][i] = entry_of_q<i, kHead + m>(s, w); });
      s.g[m] = entry_of_q<kOne, kHead + m>(s, w);
    });
    good = good & solve_inputs(s);
    unroll<kNx>([&](auto i) __attribute__((always_inline)) {
      V q = entry_of_q<i, kOne>(s, w);
      unroll<kNu>([&](auto m) __attribute__((always_inline)) {
        q = fused_multiply_add(s.Qux[m][i], s.constant[m], q);
      });
      p[i] = q;
      unroll<kNx - i>([&](auto n) __attribute__((always_inline)) {
        constexpr std::size_t kJ = i + n;
        V sum = entry_of_q<i, kJ>(s, w);
        unroll<kNu>([&](auto m) __attribute__((always_inline)) {
          sum = fused_multiply_add(s.Qux[m][i], s.gain[m][kJ], sum);
        });
        P[i][kJ] = sum;
      });
    });
  }

  /// Gains and constants of the free inputs, bounds of the held ones.
  [[gnu::always_inline]] static Lanes solve_inputs(Stage& s) noexcept {
    std::array<Lanes, kNu> is_free;
    std::array<std::array<V, kNu>, kNu> A;
    std::array<V, kNu> g = s.g;
    unroll<kNu>([&](auto m) __attribute__((always_inline)) {
      is_free[m] = s.hold[m] == V(0.0);
      s.constant[m] = select(s.hold[m] < V(0.0), s.low[m], s.high[m]);
      const V b = select(is_free[m], V(0.0), s.constant[m]);
      unroll<kNu>([&](auto l)
                      __attribute__((always_inline)) { g[l] = fused_multiply_add(s.H[l][m], b, g[l]); });
    });
    unroll<kNu>([&](auto m) __attribute__((always_inline)) {
      unroll<kNu>([&](auto l) __attribute__((always_inline)) {
        A[m][l] = select(is_free[m] & is_free[l], s.H[m][l], V(m == l ? 1.0 : 0.0));
      });
    });
    const Lanes good = invert(A);
    unroll<kNu>([&](auto m) __attribute__((always_inline)) {
      std::array<V, kNu> row;
      unroll<kNu>([&](auto l)
                      __attribute__((always_inline)) { row[l] = select(is_free[l], -A[m][l], V(0.0)); });
      V value = row[0] * g[0];
      unroll<kNu - 1>([&](auto l) __attribute__((always_inline)) {
        value = fused_multiply_add(row[l + 1], g[l + 1], value);
      });
      s.constant[m] = select(is_free[m], value, s.constant[m]);
      unroll<kNx>([&](auto i) __attribute__((always_inline)) {
        V gain = row[0] * s.Qux[0][i];
        unroll<kNu - 1>([&](auto l) __attribute__((always_inline)) {
          gain = fused_multiply_add(row[l + 1], s.Qux[l + 1][i], gain);
        });
        s.gain[m][i] = select(is_free[m], gain, V(0.0));
      });
    });
    return good;
  }

  /// The inverse in place; lanes where all pivots are positive.
  [[gnu::always_inline]] static Lanes invert(std::array<std::array<V, kNu>, kNu>& A) noexcept {
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
      unroll<kNu>([&](auto p) __attribute__((always_inline)) {
        good = good & (A[p][p] > V(1e-12));
        const V pivot = 1.0 / A[p][p];
        unroll<kNu>([&](auto m) __attribute__((always_inline)) {
          if constexpr (m != p) {
            const V factor = A[m][p] * pivot;
            unroll<kNu>([&](auto l) __attribute__((always_inline)) {
              if constexpr (l != p) A[m][l] = fused_negative_multiply_add(factor, A[p][l], A[m][l]);
            });
            A[m][p] = -factor;
          }
        });
        unroll<kNu>([&](auto l) __attribute__((always_inline)) {
          if constexpr (l != p) A[p][l] *= pivot;
        });
        A[p][p] = pivot;
      });
      return good;
    }
  }

  /// The working-set rule (small_qp.hpp) in lanes.
  [[gnu::always_inline]] static V next_hold(const Stage& s, std::size_t m,
                                            const std::array<V, kNx>& x) noexcept {
    constexpr double kTolerance = 1e-10;
    const V now = s.hold[m];
    const V beyond = select(s.du[m] > s.high[m] + kTolerance, V(1.0),
                            select(s.du[m] < s.low[m] - kTolerance, V(-1.0), V(0.0)));
    const Lanes is_free = now == V(0.0);
    if (all(is_free)) return beyond;
    V slope = s.g[m];
    unroll<kNx>([&](auto i)
                    __attribute__((always_inline)) { slope = fused_multiply_add(s.Qux[m][i], x[i], slope); });
    unroll<kNu>([&](auto l) __attribute__((always_inline)) {
      slope = fused_multiply_add(s.H[m][l], s.du[l], slope);
    });
    const Lanes let_go = (now * slope > kTolerance * (1.0 + abs(s.H[m][m]))) & (s.high[m] > s.low[m]);
    return select(is_free, beyond, select(let_go, V(0.0), now));
  }
};

}  // namespace chicane::solver
