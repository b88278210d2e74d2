// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "chicane/base/compiler.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/pattern.hpp"
#include "chicane/solver/detail/small_qp.hpp"
#include "chicane/solver/detail/stage_algebra.hpp"

namespace chicane::solver {

/// Result of a backward sweep for a stage. row · δx + constant is the step δu of a free input, and the slope
/// d(cost to go)/dδu of a held one.
template <std::size_t Nu, std::size_t Lanes>
struct alignas(64) Feedback {
  double row[Nu][Lanes]{};  ///< part in proportion to δx
  double constant[Nu]{};    ///< constant part
  double H[Nu][Nu]{};       ///< curvature of the cost to go in the inputs, as factorised
  double g[Nu]{};           ///< slope at δu = 0
};

/// Solver of min Σ ½ zᵀLz + terminal cost s.t. δx₀ given, δx⁺ = F z and bounds on δu, for one horizon
/// (docs/solver.md, eq. 8–11). A backward sweep eliminates stage by stage with the inputs of the working set
/// held at their bounds; a forward sweep finds the step and corrects the working set. Repeating both until
/// nothing changes is the primal-dual active set method (Hintermüller, Ito, Kunisch 2003).
///
/// Sweeps are compiled for the pattern: states are lanes of registers, and each stored entry of F costs one
/// multiply-add of whole registers. No allocation; time per sweep O(N).
template <class Arch, class Pattern, std::size_t Capacity>
class LqSolver {
 public:
  using Layout = solver::Layout<Pattern>;
  using Lq = LqProblem<Pattern, Capacity>;
  static constexpr std::size_t kNx = Layout::kNx;
  static constexpr std::size_t kNu = Layout::kNu;
  static constexpr std::size_t kLanes = Layout::kLanes;

  Lq lq;                          ///< the problem
  Hold hold[Lq::kStages][kNu]{};  ///< working set
  using Feedback = solver::Feedback<kNu, kLanes>;
  Feedback feedback[Lq::kStages]{};
  alignas(64) double dx[Capacity + 1][kLanes]{};  ///< step of the states; that of the first state is an input
  double du[Capacity][kNu]{};                     ///< step of the inputs

  /// Factorises all stages with `shift` added to the input blocks. `choose`: takes the working set of each
  /// stage from its own small box problem, as control-limited differential dynamic programming does; the step
  /// then descends. Returns the largest extra shift that an indefinite input block needed; 0 if none did.
  double backward(std::size_t horizon, double shift = 0.0, bool choose = false) noexcept {
    std::copy(&lq.terminal[0][0], &lq.terminal[0][0] + (kNx + 1) * kLanes, &value_[horizon][0][0]);
    if constexpr (kIsCompact) return sweep(horizon, shift, choose, false);
    return choose ? sweep(horizon, shift, std::true_type{}, std::false_type{})
                  : sweep(horizon, shift, std::false_type{}, std::false_type{});
  }
  /// Backward sweep with `shift` added to the curvature of all states as well, the horizon's end included;
  /// ends at the first input block that is indefinite.
  double backward_shifted(std::size_t horizon, double shift) noexcept {
    std::copy(&lq.terminal[0][0], &lq.terminal[0][0] + (kNx + 1) * kLanes, &value_[horizon][0][0]);
    for (std::size_t i = 0; i < kNx; ++i) value_[horizon][i][i] += shift;
    if constexpr (kIsCompact) return sweep(horizon, shift, false, true);
    return sweep(horizon, shift, std::false_type{}, std::true_type{});
  }
  /// Factorises again after forward() has changed the working set, from the last changed stage on. Pre: the
  /// same problem.
  double backward_again(double shift = 0.0) noexcept {
    if constexpr (kIsCompact) return sweep(last_change_ + 1, shift, false, false);
    return sweep(last_change_ + 1, shift, std::false_type{}, std::false_type{});
  }

  /// Treatment of inputs that contradict the working set in the forward sweep.
  enum class Repair { kAll, kLast, kClip, kNone };

  /// Computes dx and du, and corrects the working set: all contradicting inputs at once, only the last one,
  /// or none; with kClip du is cut to its bounds. Returns how many inputs contradicted it.
  int forward(std::size_t horizon, Repair repair) noexcept {
    Contradictions found;
    double x[kNx];
    unroll<kNx>([&](auto i) CHICANE_INLINE { x[i] = dx[0][i]; });
    for (std::size_t k = 0; k < horizon; ++k) {
      double u[kNu];
      unroll<kNu>([&](auto m) CHICANE_INLINE {
        const double value = Algebra::dot_row(feedback[k].row[m], x, feedback[k].constant[m]);
        u[m] = input(k, m, value, repair, found);
        du[k][m] = u[m];
      });
      Algebra::advance(lq.stage[k], x, u);
      unroll<kNx>([&](auto i) CHICANE_INLINE { dx[k + 1][i] = x[i]; });
    }
    if (found.count == 0) return 0;
    last_change_ = found.stage;
    if (repair == Repair::kLast) hold[found.stage][found.input] = found.next;
    return found.count;
  }

  /// Computes the states that follow from the present du.
  void simulate(std::size_t horizon) noexcept {
    double x[kNx];
    unroll<kNx>([&](auto i) CHICANE_INLINE { x[i] = dx[0][i]; });
    for (std::size_t k = 0; k < horizon; ++k) {
      Algebra::advance(lq.stage[k], x, du[k]);
      unroll<kNx>([&](auto i) CHICANE_INLINE { dx[k + 1][i] = x[i]; });
    }
  }

  /// Multiplier of the dynamics that lead to state i of x_k, at the end of the step; after forward().
  [[nodiscard]] double multiplier(std::size_t k, std::size_t i) const noexcept {
    double sum = value_[k][kNx][i];
    for (std::size_t j = 0; j < kNx; ++j) sum += value_[k][j][i] * dx[k][j];
    return sum;
  }
  /// Slope of the cost to go by a held input, after forward().
  [[nodiscard]] double slope(std::size_t k, std::size_t m) const noexcept {
    double sum = feedback[k].constant[m];
    for (std::size_t i = 0; i < kNx; ++i) sum += feedback[k].row[m][i] * dx[k][i];
    return sum;
  }
  /// Gain of an input's own feedback on state i; 0 where the input is held.
  [[nodiscard]] double gain(std::size_t k, std::size_t m, std::size_t i) const noexcept {
    return hold[k][m] == Hold::kFree ? feedback[k].row[m][i] : 0.0;
  }
  /// Part of an input's step that does not depend on the state.
  [[nodiscard]] double constant(std::size_t k, std::size_t m) const noexcept {
    return hold[k][m] == Hold::kFree ? feedback[k].constant[m] : bound(k, m, hold[k][m]);
  }

 private:
  using Stage = typename Lq::Stage;
  using Algebra = StageAlgebra<Arch, Pattern, Stage>;
  using Vector = typename Algebra::Vector;
  using Value = typename Algebra::Value;
  using Block = InputBlock<Arch, kNu>;
  /// Stages between two averages of P with its transpose, which remove rounding errors; chosen.
  static constexpr std::size_t kSymmetryPeriod = 8;

  static constexpr bool kIsCompact = is_compact<Pattern>();
  /// Backward sweep from stage `from` on. `choose` and `shift_states` are types, with a sweep for each use,
  /// or bools of compact solvers, with one sweep for all uses.
  template <class Choose, class ShiftStates>
  double sweep(std::size_t from, double shift, Choose choose, ShiftStates shift_states) noexcept {
    Value P;
    load(from, P);
    double largest = 0.0;
    for (std::size_t k = from; k-- > 0;) {
      eliminate(k, P, shift, choose, largest);
      if (shift_states && largest > 0.0) return largest;  // not convex: needs a larger shift
      if constexpr (!Layout::is_large()) {
        if (k % kSymmetryPeriod == 0) {
          if constexpr (kIsCompact) Algebra::make_symmetric_apart(P);
          if constexpr (!kIsCompact) Algebra::make_symmetric(P);
        }
        unroll<kNx + 1>([&](auto i) CHICANE_INLINE { P.column[i].store(value_[k][i]); });
      } else {
        for (std::size_t i = 0; i <= kNx; ++i) P.column[i].store(value_[k][i]);
        for (std::size_t i = 0; i < kNx; ++i) {
          for (std::size_t j = 0; j < i; ++j)
            value_[k][i][j] = value_[k][j][i] = 0.5 * (value_[k][i][j] + value_[k][j][i]);
        }
        load(k, P);
      }
      if (shift_states && shift != 0.0) {
        for (std::size_t i = 0; i < kNx; ++i) value_[k][i][i] += shift;
        load(k, P);
      }
    }
    return largest;
  }
  /// Loads the value function of stage k.
  CHICANE_INLINE void load(std::size_t k, Value& P) const noexcept {
    if constexpr (Layout::is_large()) {
      for (std::size_t i = 0; i <= kNx; ++i) P.column[i] = Vector::load(value_[k][i]);
    } else {
      unroll<kNx + 1>([&](auto i) CHICANE_INLINE { P.column[i] = Vector::load(value_[k][i]); });
    }
  }

  /// Backward step over one stage: turns the value function P of stage k + 1 into that of stage k (eq. 9–11).
  template <class Choose>  // NOLINTNEXTLINE(readability-function-size): one stage, in registers
  CHICANE_INLINE void eliminate(std::size_t k, Value& P, double shift, Choose choose,
                                double& largest) noexcept {
    const Stage& s = lq.stage[k];
    Feedback& out = feedback[k];
    Vector W[1 + kNu];  // columns of P F: the defect's, then the inputs'
    alignas(64) double w[1 + kNu][kLanes];
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      W[1 + m] = Algebra::template times_jacobian<kNx + 1 + m>(s, P);
      W[1 + m].store(w[1 + m]);
    });
    W[0] = Algebra::template times_jacobian<kNx>(s, P);
    W[0].store(w[0]);
    Algebra::settle(w);
    // Curvature and slope of the cost to go in the inputs.
    Block block;
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      unroll<m + 1>([&](auto l) CHICANE_INLINE {
        const double own = Algebra::template cost<kNx + 1 + m, kNx + 1 + l>(s) + (m == l ? shift : 0.0);
        block.H[m][l] = Algebra::template times_column<kNx + 1 + m>(s, w[1 + l], own);
        block.H[l][m] = block.H[m][l];
      });
      block.g[m] =
          Algebra::template times_column<kNx + 1 + m>(s, w[0], Algebra::template cost<kNx + 1 + m, kNx>(s));
    });
    Vector R[kNu];  // rows of Q for the inputs, over the states
    alignas(64) double r[kNu][kLanes];
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      R[m] = Algebra::template row_of_q<kNx + 1 + m>(s, W[1 + m], w[1 + m]);
      R[m].store(r[m]);
    });
    Algebra::settle(r);
    Vector q = Algebra::template row_of_q<kNx>(s, W[0], w[0]);

    bool is_held[kNu];
    const bool any_held = settle_inputs(k, block, choose, is_held, largest);
    double b[kNu] = {};  // steps of held inputs
    double g[kNu];       // slopes at these steps
    unroll<kNu>([&](auto m) CHICANE_INLINE { g[m] = block.g[m]; });
    if (any_held) substitute_held(k, block, is_held, R, b, g, q);
    Vector T[kNu];
    unroll<kNu>([&](auto m) CHICANE_INLINE { T[m] = Algebra::combination(block.adjugate[m], R); });

    if constexpr (kIsCompact && Layout::is_full()) {
      Algebra::eliminate_full(s, T, block.scale, r, P);
    } else {
      Algebra::eliminate_states(s, T, block.scale, r, P);
    }
    P.column[kNx] = q;
    P.column[kNx].add(-block.scale, Algebra::combination(g, T));

    unroll<kNu>([&](auto m) CHICANE_INLINE {
      Vector::scaled(-block.scale, T[m]).store(out.row[m]);
      const double value = -block.scale * block.adjugate_times(m, g);
      out.constant[m] = any_held && is_held[m] ? b[m] : value;
      out.g[m] = block.g[m];
      unroll<kNu>([&](auto l) CHICANE_INLINE { out.H[m][l] = block.H[m][l]; });
    });
    if (any_held) {
      hold_inputs(k, block, is_held, r);
    }
  }

  /// Sets which inputs are held, by the working set or, with `choose`, anew; inverts the free block, shifted
  /// until it is positive definite. True if any input is held.
  template <class Choose>
  CHICANE_INLINE bool settle_inputs(std::size_t k, Block& block, Choose choose, bool (&is_held)[kNu],
                                    double& largest) noexcept {
    if (choose) {
      Block chosen = block;
      largest = std::max(largest, choose_hold(k, chosen));
      block = chosen;
    }
    bool any_held = false;
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      is_held[m] = hold[k][m] != Hold::kFree;
      any_held |= is_held[m];
    });
    const bool is_positive = any_held ? block.invert(is_held) : block.invert();
    if (!is_positive) [[unlikely]] {
      Block shifted = block;
      largest = std::max(largest, shifted.shift_and_invert(is_held));
      block = shifted;
    }
    return any_held;
  }

  /// Chooses the working set of stage k by its own box problem; returns the shift that the block needed.
  [[gnu::noinline]] double choose_hold(std::size_t k, Block& block) noexcept {
    SmallQp<kNu, Arch> box;
    for (std::size_t m = 0; m < kNu; ++m) {
      for (std::size_t l = 0; l < kNu; ++l) box.H[m][l] = block.H[m][l];
      box.g[m] = block.g[m];
      box.low[m] = lq.low[m][k];
      box.high[m] = lq.high[m][k];
    }
    const double extra = box.make_positive();
    box.solve();
    for (std::size_t m = 0; m < kNu; ++m) {
      block.H[m][m] = box.H[m][m];
      hold[k][m] = box.hold[m];
    }
    return extra;
  }

  /// Inserts held inputs: their steps b, the slopes g and the gradient q with them.
  CHICANE_INLINE void substitute_held(std::size_t k, const Block& block, const bool (&is_held)[kNu],
                                      const Vector (&R)[kNu], double (&b)[kNu], double (&g)[kNu],
                                      Vector& q) const noexcept {
    unroll<kNu>([&](auto h) CHICANE_INLINE {
      b[h] = is_held[h] ? bound(k, h, hold[k][h]) : 0.0;
      unroll<kNu>([&](auto m) CHICANE_INLINE { g[m] = fused_multiply_add<Arch>(block.H[m][h], b[h], g[m]); });
      q.add(b[h], R[h]);
    });
  }

  /// Stores the slopes of held inputs for the forward sweep.
  void hold_inputs(std::size_t k, const Block& block, const bool (&is_held)[kNu],
                   const double (&r)[kNu][kLanes]) noexcept {
    Vector slope[kNu];
    double constant[kNu];
    for (std::size_t h = 0; h < kNu; ++h) {
      slope[h] = Vector::load(r[h]);
      constant[h] = block.g[h];
      for (std::size_t m = 0; m < kNu; ++m) {
        slope[h].add(block.H[h][m], Vector::load(feedback[k].row[m]));
        constant[h] = fused_multiply_add<Arch>(block.H[h][m], feedback[k].constant[m], constant[h]);
      }
    }
    for (std::size_t h = 0; h < kNu; ++h) {
      if (!is_held[h]) continue;
      slope[h].store(feedback[k].row[h]);
      feedback[k].constant[h] = constant[h];
    }
  }

  // ---- working set

  /// Contradictions to the working set in a forward sweep: their number, and the last one.
  struct Contradictions {
    int count = 0;
    std::size_t stage = 0;    ///< stage of the last one
    std::size_t input = 0;    ///< input of the last one
    Hold next = Hold::kFree;  ///< new state of that input
    void add(std::size_t k, std::size_t m, Hold wanted) noexcept {
      ++count;
      stage = k;
      input = m;
      next = wanted;
    }
  };

  /// Step of an input in the forward sweep. `value` is the step of a free input, or the slope at a held one.
  CHICANE_INLINE double input(std::size_t k, std::size_t m, double value, Repair repair,
                              Contradictions& found) noexcept {
    const double low = lq.low[m][k], high = lq.high[m][k];
    const Hold now = hold[k][m];
    const double u = now == Hold::kFree ? value : bound(k, m, now);
    if (repair == Repair::kClip) return std::min(std::max(u, low), high);
    if (const Hold next = next_hold(now, u, value, low, high, feedback[k].H[m][m]); next != now)
        [[unlikely]] {
      if (repair == Repair::kAll) hold[k][m] = next;
      found.add(k, m, next);
    }
    return u;
  }

  [[nodiscard]] CHICANE_INLINE double bound(std::size_t k, std::size_t m, Hold at) const noexcept {
    return at == Hold::kHigh ? lq.high[m][k] : lq.low[m][k];
  }

  alignas(64) double value_[Capacity + 1][kNx + 1][kLanes]{};  ///< P of every stage, for backward_again()
  std::size_t last_change_ = 0;  ///< last stage whose working set forward() changed
};

}  // namespace chicane::solver
