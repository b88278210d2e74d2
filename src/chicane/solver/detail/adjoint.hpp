// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "chicane/base/inlining.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/stage_algebra.hpp"

namespace chicane::solver {

/// Gradients of the stage costs and what follows from them along the dynamics. Entry by entry, stage after
/// stage: a pack over stages is one load.
template <class Pattern, std::size_t Stages>
struct Adjoint {
  static constexpr std::size_t kNx = Pattern::kNx;
  static constexpr std::size_t kNu = Pattern::kNu;

  alignas(64) double gradient[kNx + kNu][Stages]{};  ///< in: of stage k by its states, then its inputs
  alignas(64) double terminal[kNx]{};                ///< in: of the terminal cost
  alignas(64) double price[kNx][Stages]{};           ///< out: λ_{k+1}, the price of state i after stage k
  alignas(64) double slope[kNu][Stages]{};           ///< out: dJ/du along the dynamics

  /// One pass backwards through the Jacobians of `lq`: λ_N = terminal, λ_k = gradient_x + Aᵀ λ_{k+1}, and
  /// slope = gradient_u + Bᵀ λ_{k+1} (eq. 12).
  template <class Arch, class Lq>
  void solve(const Lq& lq, std::size_t horizon) noexcept {
    using Algebra = StageAlgebra<Arch, Pattern, typename Lq::Stage>;
    double lambda[kNx];
    for (std::size_t i = 0; i < kNx; ++i) lambda[i] = terminal[i];
    for (std::size_t k = horizon; k-- > 0;) {
      const typename Lq::Stage& s = lq.stage[k];
      double g[kNx + kNu];
      unroll<kNx + kNu>([&](auto j) CHICANE_INLINE {
        constexpr std::size_t kColumn = j < kNx ? j : j + 1;
        g[j] = Algebra::template times_column<kColumn>(s, lambda, gradient[j][k]);
      });
      unroll<kNx>([&](auto i) CHICANE_INLINE {
        price[i][k] = lambda[i];
        lambda[i] = g[i];
      });
      unroll<kNu>([&](auto m) CHICANE_INLINE { slope[m][k] = g[kNx + m]; });
    }
  }
};

}  // namespace chicane::solver
