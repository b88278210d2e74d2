// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>

#include "chicane/base/inlining.hpp"
#include "chicane/base/instruction_set.hpp"
#include "chicane/solver/detail/batch_lanes.hpp"
#include "chicane/solver/detail/batch_room.hpp"
#include "chicane/solver/detail/batch_terms.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::solver {

/// Many independent problems of one kind, several at a time, one in each lane of the registers (sweeps over
/// parameters, many starting guesses): docs/solver_kernels.md, Batches.
///
/// `Problem` is a template over its numbers: Problem<double> is a structured problem that consists of nothing
/// but such numbers, so that Problem<Pack> is as many problems side by side; prices of soft constraints are
/// the same for all. Full steps as OcpSolver's, Gauss–Newton's first and Newton's near the solution, but the
/// working set follows from the iterate, so that each sweep is a step. A lane that is done takes the next
/// waiting problem; one that does not get there in a few turns, or has no convex model, is handed to
/// `fallback`, usually an OcpSolver. Results agree with OcpSolver's within the tolerance; which lane a
/// problem runs in, and beside which others, does not change its bits.
///
/// One object holds all memory; solve() allocates nothing and keeps nothing of what it is given. One thread
/// at a time; objects share nothing, so different threads may each use their own.
template <template <class> class Problem, class Arch, int Capacity>
class BatchSolver {
 public:
  static constexpr std::size_t kLanes = Arch::kWidth > 4 ? 8 : 4;
  using One = Problem<double>;
  using V = Pack<Arch, kLanes>;
  static constexpr std::size_t kNx = One::kNx;
  static constexpr std::size_t kNu = One::kNu;
  static constexpr std::size_t kNc = One::kNc;
  using State = std::array<double, kNx>;
  using Trajectory = solver::Trajectory<One::kNx, One::kNu, Capacity>;
  static_assert(!kHasRateBounds<One>, "no bounds on the changes of inputs in a batch");

  explicit BatchSolver(const SolverOptions& options = {}) noexcept : options_(options) {}

  /// Solves problem i from starts[i] with trajectories[i] as guess and result (as OcpSolver::solve) into
  /// reports[i]. All spans have the same length, all trajectories the same horizon in [1, Capacity].
  /// `fallback(problem, start, trajectory)` returns the report of a problem that a lane gave up; its
  /// trajectory still holds the guess.
  template <class Fallback>
  void solve(std::span<const One> problems, std::span<const State> starts, std::span<Trajectory> trajectories,
             std::span<SolveReport> reports, const Fallback& fallback) noexcept {
    if (problems.empty()) return;
    horizon_ = static_cast<std::size_t>(trajectories[0].horizon);
    std::size_t waiting = 0;  // number of the first problem that has not been called
    unsigned called = 0;      // lanes of the next room with a problem
    const auto call = [&](std::size_t lane, std::size_t i) {
      next_.put(lane, i, problems[i], starts[i], trajectories[i]);
    };
    const auto call_all = [&] {
      for (std::size_t lane = 0; lane < kLanes && waiting < problems.size(); ++lane) {
        if ((called >> lane & 1U) != 0) continue;
        call(lane, waiting++);
        called |= 1U << lane;
      }
      next_.simulate(horizon_, next_.start_mu());
    };
    // Lanes without a problem repeat the first one: they must not hold anything odd.
    for (std::size_t lane = 0; lane < kLanes; ++lane) call(lane, 0);
    call_all();
    enter(kAll);
    unsigned busy = called;
    called = 0;
    while (busy != 0) {
      look();
      const unsigned done = finished() & busy;
      for (unsigned rest = done; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const std::size_t i = now_.owner[lane];
        hand_over(lane, problems[i], starts[i], trajectories[i], reports[i], fallback);
      }
      busy &= ~done;
      step(busy & good_);
      if ((done & ~called) != 0 && waiting < problems.size()) call_all();
      enter(done & called);
      busy |= done & called;
      called &= ~done;
    }
  }

 private:
  using Room = BatchRoom<Problem, V, Capacity>;
  using Riccati = RiccatiLanes<V, One>;
  using Terms = BatchTerms<V, One>;
  using Layout = typename Riccati::Layout;
  using Lanes = typename V::MaskType;
  static constexpr int kOrder = has_hessians<One>() ? 2 : 1;
  static constexpr unsigned kAll = (1U << kLanes) - 1U;
  static constexpr int kMaxTurns = kNc > 0 ? 30 : 20;  ///< of a lane before it is handed over
  static constexpr double kDefectShare = 1e-7;         ///< of the tolerance, as OcpSolver's
  static constexpr double kNegligible = 1e-9;          ///< cut off an input
  static constexpr double kCutShare = 0.4;  ///< of the barrier that a step leaves which was cut, at least
  static constexpr double kNear =
      0.1;  ///< steps this short: exact curvature from here on, where it is convex

  /// What is measured on the way through the horizon.
  struct Sums {
    V squares{0.0};  ///< twice the cost
    V defect{0.0};
    V excess{0.0};  ///< of defects over their tolerance's relative part
    V stationarity{0.0};
    V complementarity{0.0};
    V violation{0.0};
    V poison{0.0};  ///< finite, unless something is not
  };

  static Lanes lanes_of(unsigned bits) noexcept {
    double lanes[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = static_cast<double>(bits >> lane & 1U);
    return V::load_unaligned(lanes) > V(0.0);
  }

  /// Problems of the next room take over lanes.
  void enter(unsigned entering) noexcept {
    if (entering == 0) return;
    const Lanes lanes = lanes_of(entering);
    now_.move_in(next_, lanes, horizon_);
    mu_ = select(lanes, V(next_.start_mu()), mu_);
    exact_ &= ~entering;
    convex_ |= entering;
    for (; entering != 0; entering &= entering - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(entering));
      turns_[lane] = 0;
      now_.owner[lane] = next_.owner[lane];
    }
  }

  /// Looks at all lanes from the end of the horizon: linearises (eq. 4–6, 22), runs the adjoint, measures
  /// optimality (eq. 12, 13), and eliminates (eq. 9–11), one stage after the other.
  CHICANE_FLATTEN void look() noexcept {
    Sums sums;  // in registers
    is_exact_ = lanes_of(exact_ & convex_);
    typename Riccati::Value value;
    StateJets<One, V, kOrder> end;
    unroll<kNx>([&](auto i) CHICANE_INLINE { std::get<i>(end).v = now_.x[horizon_][i]; });
    Terms::add_terminal(now_.many.terminal_residual(end), select(is_exact_, V(1.0), V(0.0)), value,
                        sums.squares);
    typename Riccati::State lambda = value.p;
    Lanes good = V(0.0) == V(0.0);
    for (std::size_t k = horizon_; k-- > 0;) look_at(k, lambda, value, good, sums);
    sums_ = sums;
    good_ = good.bits();
  }

  CHICANE_INLINE void look_at(std::size_t k, typename Riccati::State& lambda, typename Riccati::Value& value,
                              Lanes& good, Sums& sums) noexcept {
    auto& s = stage_[k];
    const int number = static_cast<int>(k);
    StateJets<One, V, kOrder> x;
    InputJets<One, V, kOrder> u;
    unroll<kNx>([&](auto i) CHICANE_INLINE { std::get<i>(x).v = now_.x[k][i]; });
    unroll<kNu>([&](auto m) CHICANE_INLINE { std::get<m>(u).v = now_.u[k][m]; });
    const auto next = now_.many.dynamics(number, x, u);
    const auto residual = now_.many.residual(number, x, u);
    const auto constraint = soft_constraints(number, x, u);
    collect(next, k, s, sums);
    typename Terms::Costs L;
    Terms::template clear<std::remove_const_t<decltype(residual)>>(L);
    Terms::add_squares(residual, L, sums.squares);
    const auto pull = add_soft(constraint, k, L, sums);
    const typename Riccati::State price = lambda;
    typename Riccati::Input slope;
    Riccati::adjoint(s.F, L, lambda, slope);
    unroll<kNc>([&](auto c) CHICANE_INLINE {
      Terms::template add_gradient<void, 0>(std::get<c>(constraint), pull[c], L);
    });
    if constexpr (kOrder == 2) {
      const auto add = [&](const auto& row, const V& weight) CHICANE_INLINE {
        Terms::add_curvature(row, select(is_exact_, weight, V(0.0)), L);
      };
      unroll<kNx>([&](auto i) CHICANE_INLINE { add(std::get<i>(next), price[i]); });
      unroll<std::tuple_size_v<decltype(residual)>>(
          [&](auto n) CHICANE_INLINE { add(std::get<n>(residual), V(jet::value(std::get<n>(residual)))); });
      unroll<kNc>([&](auto c) CHICANE_INLINE { add(std::get<c>(constraint), now_.soft[k][c].z); });
    }
    Riccati::eliminate(s, L, measure(k, slope, sums), value, good);
  }

  template <class X, class U>
  CHICANE_INLINE auto soft_constraints(int k, const X& x, const U& u) const noexcept {
    if constexpr (kNc > 0) {
      return now_.many.constraint(k, x, u);
    } else {
      return std::tuple<>{};
    }
  }

  /// Jacobians and defects.
  template <class Row>
  CHICANE_INLINE void collect(const Row& next, std::size_t k, typename Riccati::Stage& s,
                              Sums& sums) noexcept {
    const V allowed(kDefectShare * options_.tolerance);
    unroll<kNx>([&](auto i) CHICANE_INLINE {
      const V& x = now_.x[k + 1][i];
      const V defect = V(jet::value(std::get<i>(next))) - x;
      const V size = abs(defect);
      sums.defect = max(size, sums.defect);
      sums.excess = max(fused_negative_multiply_add(allowed, abs(x), size), sums.excess);
      sums.poison += defect;
      s.F[Layout::kF[i][kNx]] = defect;
      Terms::template set_jacobian<i>(std::get<i>(next), s.F);
    });
  }

  /// Soft constraints: multipliers as they are to the gradient, eliminated slacks to the Hessian (eq. 20,
  /// 21). Returns what the quadratic program's multipliers are beyond them.
  template <class Row>
  CHICANE_INLINE std::array<V, kNc> add_soft(const Row& constraint, std::size_t k, typename Terms::Costs& L,
                                             Sums& sums) noexcept {
    std::array<V, kNc> pull;
    unroll<kNc>([&](auto n) CHICANE_INLINE {
      const auto& c = std::get<n>(constraint);
      auto& soft = now_.soft[k][n];
      const SoftPenalty price = now_.price(n);
      soft.value = V(jet::value(c));
      const auto model = soft.model(price, mu_);
      pull[n] = model.slope - soft.z;
      Terms::template add_gradient<void, 0>(c, soft.z, L);
      Terms::template add_square<void, 0>(c, model.curvature, L);
      Terms::for_slopes(c, [&](auto i, const auto& slope) CHICANE_INLINE {
        soft_row_[k][n][static_cast<std::size_t>(i)] = jet::number<V>(slope);
      });
      sums.squares += 2.0 * soft.penalty(price);
      sums.complementarity = max(soft.residual(price, mu_), sums.complementarity);
      sums.violation = max(soft.value, sums.violation);
      sums.poison += soft.value;
    });
    return pull;
  }

  /// How far the inputs of stage k are from optimal; those that are free to move: not at a bound that the
  /// cost pulls them to.
  CHICANE_INLINE std::array<Lanes, kNu> measure(std::size_t k, const typename Riccati::Input& slope,
                                                Sums& sums) const noexcept {
    const auto low = now_.many.input_lower(static_cast<int>(k));
    const auto high = now_.many.input_upper(static_cast<int>(k));
    std::array<Lanes, kNu> is_free;
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      const V down = V(low[m]) - now_.u[k][m];
      const V up = V(high[m]) - now_.u[k][m];
      sums.stationarity = max(abs(min(max(-slope[m], down), up)), sums.stationarity);
      sums.poison += slope[m] + now_.u[k][m];
      is_free[m] = ((down < V(0.0)) | (slope[m] < V(0.0))) & ((up > V(0.0)) | (slope[m] > V(0.0)));
    });
    return is_free;
  }

  /// Lanes whose problem is solved or given up, as bits.
  [[nodiscard]] unsigned finished() const noexcept {
    unsigned done = optimal_lanes().bits() | (!is_finite(sums_.poison + sums_.squares)).bits();
    done |= ~good_ & ~(exact_ & convex_) & kAll;  // not even Gauss–Newton's model is convex
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (turns_[lane] >= std::min(kMaxTurns, options_.max_iterations)) done |= 1U << lane;
    }
    return done;
  }
  [[nodiscard]] Lanes optimal_lanes() const noexcept {
    const Lanes is_small = (sums_.stationarity <= V(options_.tolerance)) &
                           (sums_.excess <= V(kDefectShare * options_.tolerance)) &
                           is_finite(sums_.poison + sums_.squares);
    if constexpr (kNc == 0) return is_small;
    return is_small & (sums_.complementarity <= V(options_.tolerance)) & (mu_ <= V(options_.tolerance));
  }

  /// The result of a lane, or the fallback's.
  template <class Fallback>
  void hand_over(std::size_t lane, const One& problem, const State& start, Trajectory& trajectory,
                 SolveReport& report, const Fallback& fallback) const noexcept {
    if (!optimal_lanes()[lane]) {
      report = fallback(problem, start, trajectory);
      return;
    }
    for (std::size_t k = 0; k <= horizon_; ++k) {
      for (std::size_t j = 0; j < kNx; ++j) trajectory.x[k][j] = now_.x[k][j][lane];
    }
    for (std::size_t k = 0; k < horizon_; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) trajectory.u[k][m] = now_.u[k][m][lane];
    }
    report = SolveReport{};
    report.status = SolveStatus::kOptimal;
    report.iterations = report.sweeps = turns_[lane];
    report.cost = 0.5 * sums_.squares[lane];
    report.stationarity = sums_.stationarity[lane];
    report.defect = sums_.defect[lane];
    report.complementarity = sums_.complementarity[lane];
    report.violation = sums_.violation[lane];
    if constexpr (kNc > 0) find_worst(lane, report);
  }
  /// Where the largest violation is, and whether one is above its cap.
  void find_worst(std::size_t lane, SolveReport& report) const noexcept {
    WorstViolation worst;
    for (std::size_t k = 0; k < horizon_; ++k) {
      for (std::size_t c = 0; c < kNc; ++c)
        worst.consider(now_.soft[k][c].value[lane], now_.price(c).cap, k, c);
    }
    worst.tell(report);
    if (worst.is_above_a_cap()) report.status = SolveStatus::kInfeasible;
  }

  /// The step of the quadratic program in `moving` lanes. Lanes whose exact Hessian was indefinite stay where
  /// they are and do without from now on.
  void step(unsigned moving) noexcept {
    for (int& turns : turns_) ++turns;
    convex_ &= good_;
    const Lanes moves = lanes_of(moving);
    Bent bent;
    move(moves, bent);
    exact_ = options_.second_order ? (bent.longest <= V(kNear)).bits() : 0U;
  }

  /// What bounds do to a step.
  struct Bent {
    V longest{0.0};  ///< input of the step, before bounds
    V cut{0.0};      ///< largest part of an input that its bounds cut off
  };

  /// δu of stage k, no further than the bounds.
  CHICANE_INLINE typename Riccati::Input bounded_step(std::size_t k, const typename Riccati::State& dx,
                                                      Bent& bent) const noexcept {
    const auto low = now_.many.input_lower(static_cast<int>(k));
    const auto high = now_.many.input_upper(static_cast<int>(k));
    auto du = Riccati::input_step(stage_[k], dx);
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      const V free = du[m];
      bent.longest = max(abs(free), bent.longest);
      du[m] = min(max(free, V(low[m]) - now_.u[k][m]), V(high[m]) - now_.u[k][m]);
      if constexpr (kNc > 0) bent.cut = max(abs(free - du[m]), bent.cut);
    });
    return du;
  }
  /// u + length · δu, exactly at a bound where it comes to stand there.
  CHICANE_INLINE void move_input(std::size_t k, const Lanes& moves, const V& length,
                                 const typename Riccati::Input& du) noexcept {
    const auto low = now_.many.input_lower(static_cast<int>(k));
    const auto high = now_.many.input_upper(static_cast<int>(k));
    unroll<kNu>([&](auto m) CHICANE_INLINE {
      V& u = now_.u[k][m];
      u = select(moves, min(max(fused_multiply_add(length, du[m], u), V(low[m])), V(high[m])), u);
    });
  }

  /// The whole step; where there are slacks, as much of it as they allow.
  void move(const Lanes& moves, Bent& bent) noexcept {
    if constexpr (kNc > 0) return move_with_slacks(moves, bent);
    typename Riccati::State dx;
    dx.fill(V(0.0));
    for (std::size_t k = 0; k < horizon_; ++k) {
      const auto du = bounded_step(k, dx, bent);
      dx = Riccati::next_step(stage_[k], dx, du);
      move_input(k, moves, V(1.0), du);
      move_state(k + 1, moves, V(1.0), dx);
    }
  }
  CHICANE_INLINE void move_state(std::size_t k, const Lanes& moves, const V& length,
                                 const typename Riccati::State& dx) noexcept {
    unroll<kNx>([&](auto i) CHICANE_INLINE {
      V& x = now_.x[k][i];
      x = select(moves, fused_multiply_add(length, dx[i], x), x);
    });
  }

  /// The same with slacks (eq. 18–20), and then a lower barrier: as OcpSolver's for long moves, but not less
  /// than `kCutShare` of it where a bound cut the step.
  void move_with_slacks(const Lanes& moves, Bent& bent) noexcept {
    constexpr double kFraction = 0.995;
    V primal(0.0);  // how often the longest change goes into its value
    V dual(0.0);
    dx_[0].fill(V(0.0));
    for (std::size_t k = 0; k < horizon_; ++k) {
      du_[k] = bounded_step(k, dx_[k], bent);
      dx_[k + 1] = Riccati::next_step(stage_[k], dx_[k], du_[k]);
      each_slack(k, [&](const SoftConstraint<V>& soft, const SoftConstraint<V>& d) {
        primal = max(max(-d.s / soft.s, -d.t / soft.t), primal);
        dual = max(max(-d.z / soft.z, -d.n / soft.n), dual);
      });
    }
    const V length = min(V(1.0), kFraction / max(primal, V(1e-30)));
    const V dual_length = min(V(1.0), kFraction / max(dual, V(1e-30)));
    for (std::size_t k = 0; k < horizon_; ++k) {
      each_slack(k, [&](SoftConstraint<V>& soft, const SoftConstraint<V>& d) {
        soft.s = select(moves, fused_multiply_add(length, d.s, soft.s), soft.s);
        soft.t = select(moves, fused_multiply_add(length, d.t, soft.t), soft.t);
        soft.z = select(moves, fused_multiply_add(dual_length, d.z, soft.z), soft.z);
        soft.n = select(moves, fused_multiply_add(dual_length, d.n, soft.n), soft.n);
      });
      move_input(k, moves, length, du_[k]);
      move_state(k + 1, moves, length, dx_[k + 1]);
    }
    const V share = select(length > V(0.9), min(V(0.1), sqrt(mu_)), select(length > V(0.5), V(0.2), V(0.6)));
    const V kept = select(bent.cut > V(kNegligible), max(share, V(kCutShare)), share);
    mu_ = select(moves, max(V(options_.tolerance), kept * mu_), mu_);
  }
  /// visit(slacks, their Newton step) for the soft constraints of stage k.
  template <class Visit>
  CHICANE_INLINE void each_slack(std::size_t k, const Visit& visit) noexcept {
    unroll<kNc>([&](auto c) CHICANE_INLINE {
      using J = std::remove_cvref_t<std::tuple_element_t<c, ConstraintRow>>;
      V change(0.0);
      jet::repeat<kVariables>([&](auto i) CHICANE_INLINE {
        if constexpr (contains(jet::Traits<J>::kFirst, i)) {
          const V& dw = i < One::kNx ? dx_[k][i] : du_[k][i - One::kNx];
          change = fused_multiply_add(soft_row_[k][c][i], dw, change);
        }
      });
      auto& soft = now_.soft[k][c];
      visit(soft, soft.step(now_.price(c), mu_, change));
    });
  }

  static constexpr int kVariables = One::kNx + One::kNu;
  using ConstraintRow = typename ProblemPattern<One>::Constraint;
  static constexpr std::size_t kSoftStages = kNc > 0 ? Capacity : 0;  ///< of what only they need

  SolverOptions options_;
  std::size_t horizon_ = 0;
  int turns_[kLanes]{};
  unsigned exact_ = 0;   ///< lanes near their solution
  unsigned convex_ = 0;  ///< lanes whose exact Hessians have not been indefinite
  unsigned good_ = 0;    ///< lanes whose quadratic program has a solution
  Lanes is_exact_;       ///< Hessians of the present look
  V mu_{0.0};            ///< barrier of each lane
  Sums sums_;
  Room now_;   ///< what is being solved
  Room next_;  ///< what comes next, simulated
  std::array<typename Riccati::Stage, Capacity> stage_;
  std::array<typename Riccati::State, kSoftStages + 1> dx_;
  std::array<typename Riccati::Input, kSoftStages> du_;
  std::array<std::array<std::array<V, static_cast<std::size_t>(kVariables)>, kNc>, kSoftStages> soft_row_;
};

}  // namespace chicane::solver
