// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

#include "chicane/base/compiler.hpp"
#include "chicane/solver/detail/evaluation.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/detail/pattern.hpp"
#include "chicane/solver/detail/stage_entries.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::solver {

/// Order in which the states of a whole horizon can be simulated, state after state instead of stage after
/// stage. An order exists if each state depends on itself only as a sum, x_i⁺ = x_i + g_i(other states, u),
/// and no two states depend on each other. The first states then follow from the inputs alone, at all stages,
/// the next ones from the first ones, and so on. Example: a car's speed sums its accelerations, its heading
/// sums its turns, and its position sums its motion.
template <class Pattern>
struct StageOrder {
  static constexpr std::size_t kNx = Pattern::kNx;

  /// Level of each state. 0: depends on inputs at most; n: depends on states of lower levels.
  static constexpr std::array<std::size_t, kNx> kLevel = [] {
    std::array<std::size_t, kNx> level{};
    for (std::size_t pass = 0; pass <= kNx; ++pass) {
      for (std::size_t i = 0; i < kNx; ++i) {
        for (std::size_t j = 0; j < kNx; ++j) {
          if (i != j && Pattern::kF[i][j] != Entry::kZero && level[i] <= level[j]) level[i] = level[j] + 1;
        }
      }
    }
    return level;
  }();
  static constexpr std::size_t kLevels = [] {
    std::size_t count = 0;
    for (const std::size_t level : kLevel) count = level >= count ? level + 1 : count;
    return count;
  }();
  /// Whether x_i⁺ is x_i plus a change.
  static constexpr bool is_sum(std::size_t i) noexcept { return Pattern::kF[i][i] == Entry::kOne; }
  /// Whether an order exists: in a cycle of states levels rise without end.
  static constexpr bool kExists = [] {
    for (std::size_t i = 0; i < kNx; ++i) {
      if (Pattern::kF[i][i] == Entry::kValue) return false;
    }
    return kLevels <= kNx;
  }();
};

/// Simulation of inputs: one state after the other with eight stages in lanes if the pattern permits it
/// (StageOrder), else stage after stage.
///
/// Both ways add in the same order, and give the same bits if x_i + … is the last operation of a function for
/// a state. A pattern does not show branches by select() on a state without a derivative; states of such a
/// function may be wrong, which the defects of the first linearisation show.
template <OcpProblem P, class Arch>
class RollOut {
 public:
  using V = Stages<Arch>;
  static constexpr std::size_t kNx = P::kNx;
  static constexpr std::size_t kNu = P::kNu;
  using Order = StageOrder<ProblemPattern<P>>;
  static constexpr bool kInLanes = StructuredProblem<P> && Order::kExists;

  /// Sets x_1 … x_N of `t` by its x_0 and inputs. True if every state is finite.
  template <class Point>
  static bool run(const P& problem, Point& t) noexcept {
    if constexpr (kInLanes) {
      unroll<Order::kLevels>([&](auto level) { simulate_level<level>(problem, t); });
    } else {
      simulate_stages(problem, t);
    }
    V all(0.0);  // stays 0 unless a number is not finite
    for (std::size_t k = 0; k <= t.horizon; k += 8) {
      const auto live = stage_number(StageLanes<V>{static_cast<int>(k)}) <= V(static_cast<double>(t.horizon));
      for (std::size_t i = 0; i < kNx; ++i) all += select(live, 0.0 * V::load(t.x[i] + k), V(0.0));
    }
    return sum(all) == 0.0;
  }

 private:
  using Evaluate = Evaluation<P, Arch>;
  /// Eight stages with a type for each level, which makes the call of each level a function of its own:
  /// called once, it is inlined, and unused results are removed.
  template <std::size_t>
  struct LanesOfLevel : StageLanes<V> {};

  template <class Point>
  static void simulate_stages(const P& problem, Point& t) noexcept {
    using One = typename Evaluate::One;
    auto x = t.template state<One>(0);
    for (std::size_t k = 0; k < t.horizon; ++k) {
      x = Evaluate::next(problem, k, x, t.template input<One>(k));
      for (std::size_t i = 0; i < kNx; ++i) t.x[i][k + 1] = Evaluate::number(x[i]);
    }
  }

  /// Simulates all stages of the states of one level, after those of lower levels. Results for other states
  /// are not used, and so never computed.
  template <std::size_t Level, class Point>
  static void simulate_level(const P& problem, Point& t) noexcept {
    double now[kNx];  // running value of each sum
    for (std::size_t i = 0; i < kNx; ++i) now[i] = t.x[i][0];
    for (std::size_t k = 0; k < t.horizon; k += 8) {
      const auto next = changes<Level>(problem, t, k);
      unroll<kNx>([&](auto i) CHICANE_INLINE {
        if constexpr (Order::kLevel[i] == Level && Order::is_sum(i)) {
          now[i] = running_sum(now[i], next[i], t.x[i] + k);
          t.x[i][k + 8] = now[i];
        } else if constexpr (Order::kLevel[i] == Level) {
          next[i].store_unaligned(t.x[i] + k + 1);
        }
      });
    }
  }
  /// Computes x⁺ of the eight stages from k on, for sums without their start.
  template <std::size_t Level, class Point>
  CHICANE_INLINE static auto changes(const P& problem, const Point& t, std::size_t k) noexcept {
    std::array<V, kNx> x;
    unroll<kNx>([&](auto i)
                    CHICANE_INLINE { x[i] = Order::kLevel[i] < Level ? V::load(t.x[i] + k) : V(kNothing); });
    std::array<V, kNu> u;
    unroll<kNu>([&](auto m) CHICANE_INLINE { u[m] = V::load(t.u[m] + k); });
    return to_array<V>(problem.dynamics(LanesOfLevel<Level>{{static_cast<int>(k)}}, x, u));
  }
  /// Writes start, start + c_0, start + c_0 + c_1, … to `to` and returns the sum of all. Adds one by one, so
  /// that the rounding equals a simulation's.
  CHICANE_INLINE static double running_sum(double start, const V& change, double* to) noexcept {
    alignas(64) double by_stage[8];
    change.store(by_stage);
    V sum(start);
    unroll<7>([&](auto lane) CHICANE_INLINE {
      sum += select(V::iota() > V(static_cast<double>(lane)), V(by_stage[lane]), V(kNothing));
    });
    sum.store(to);
    return sum[7] + by_stage[7];
  }

  static constexpr double kNothing =
      -0.0;  ///< neutral number: x + kNothing is x, also for zeros of both signs
};

}  // namespace chicane::solver
