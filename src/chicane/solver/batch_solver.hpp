// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>

#include "chicane/base/instruction_set.hpp"
#include "chicane/solver/batch_lanes.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::solver {

/// Many independent problems of one kind, several at a time, one in each lane of the registers (sweeps over
/// parameters, many starting guesses).
///
/// `Problem` is a template over its numbers: Problem<double> is a structured problem without soft
/// constraints, and it consists of nothing but such numbers, so that Problem<Pack> is as many problems side
/// by side. Same method as OcpSolver's full steps (Gauss–Newton, primal-dual active set, exact adjoint as
/// measure); a lane that is done takes the next waiting problem, and one that does not get there in a few
/// turns is handed to `fallback`, usually an OcpSolver. Results agree with OcpSolver's within the tolerance;
/// which lane a problem runs in does not change its bits.
///
/// One object holds all memory; solve() allocates nothing. One thread.
template <template <class> class Problem, class Arch, int Capacity>
class BatchSolver {
 public:
  static constexpr std::size_t kLanes = Arch::kWidth > 4 ? 8 : 4;
  using One = Problem<double>;
  using V = Pack<Arch, kLanes>;
  using Many = Problem<V>;
  static constexpr std::size_t kNx = One::kNx;
  static constexpr std::size_t kNu = One::kNu;
  using State = std::array<double, kNx>;
  using Trajectory = solver::Trajectory<One::kNx, One::kNu, Capacity>;
  static_assert(sizeof(Many) == kLanes * sizeof(One), "a problem of a batch consists of its numbers alone");
  static_assert(One::kNc == 0, "no soft constraints in a batch");
  static_assert(!has_rate_bounds<One>, "no bounds on the changes of inputs in a batch");

  explicit BatchSolver(const SolverOptions& options = {}) noexcept : options_(options) {}

  /// Solves problem i from starts[i] with trajectories[i] as guess and result (as OcpSolver::solve) into
  /// reports[i]. All spans have the same length, all trajectories the same horizon in [1, Capacity].
  /// `fallback(problem, start, trajectory)` returns the report of a problem that a lane gave up.
  template <class Fallback>
  void solve(std::span<const One> problems, std::span<const State> starts, std::span<Trajectory> trajectories,
             std::span<SolveReport> reports, const Fallback& fallback) noexcept {
    if (problems.empty()) return;
    horizon_ = static_cast<std::size_t>(trajectories[0].horizon);
    std::size_t waiting = 0;
    std::size_t running = 0;
    unsigned fresh = kAll;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // Lanes without a problem repeat the first one: they must not hold anything odd.
      const bool has_problem = waiting < problems.size();
      take(lane, has_problem ? waiting : 0, problems, starts, trajectories);
      owner_[lane] = has_problem ? waiting++ : kNobody;
      running += has_problem ? 1 : 0;
    }
    while (running > 0) {
      if (fresh != 0) begin(fresh);
      measure();
      unsigned done = finished();
      step(done);
      for (fresh = 0; done != 0; done &= done - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(done));
        const std::size_t i = owner_[lane];
        hand_over(lane, problems[i], starts[i], trajectories[i], reports[i], fallback);
        owner_[lane] = kNobody;
        --running;
        if (waiting == problems.size()) continue;
        take(lane, waiting, problems, starts, trajectories);
        owner_[lane] = waiting++;
        ++running;
        fresh |= 1U << lane;
      }
    }
  }

 private:
  using Pattern = GaussNewtonPattern<One>;
  using Lq = LqLanes<V, Pattern, static_cast<std::size_t>(Capacity)>;
  using Layout = typename Lq::Layout;
  using Lanes = typename V::MaskType;
  static constexpr std::size_t kNobody = static_cast<std::size_t>(-1);
  static constexpr unsigned kAll = (1U << kLanes) - 1U;
  static constexpr int kMaxTurns = 12;   ///< of a lane before it is handed over
  static constexpr int kMaxSweeps = 24;  ///< likewise
  static constexpr double kDefectShare = 1e-7;

  /// Puts problem i into a lane.
  void take(std::size_t lane, std::size_t i, std::span<const One> problems, std::span<const State> starts,
            std::span<Trajectory> trajectories) noexcept {
    const auto* from = static_cast<const double*>(static_cast<const void*>(&problems[i]));
    auto* to = static_cast<double*>(static_cast<void*>(&many_));
    for (std::size_t n = 0; n < sizeof(One) / sizeof(double); ++n) to[n * kLanes + lane] = from[n];
    for (std::size_t j = 0; j < kNx; ++j) x_[0][j].set(lane, starts[i][j]);
    for (std::size_t k = 0; k < horizon_; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) u_[k][m].set(lane, trajectories[i].u[k][m]);
    }
    turns_[lane] = sweeps_[lane] = 0;
    is_lost_[lane] = false;
  }

  static Lanes lanes_of(unsigned bits) noexcept {
    double lanes[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = static_cast<double>(bits >> lane & 1U);
    return V::load_unaligned(lanes) > V(0.0);
  }

  /// Simulates the lanes that have just been filled, and forgets their working sets.
  void begin(unsigned filled) noexcept {
    const Lanes fresh = lanes_of(filled);
    for (std::size_t k = 0; k < horizon_; ++k) {
      const auto low = many_.input_lower(static_cast<int>(k));
      const auto high = many_.input_upper(static_cast<int>(k));
      for (std::size_t m = 0; m < kNu; ++m) {
        u_[k][m] = select(fresh, min(max(u_[k][m], V(low[m])), V(high[m])), u_[k][m]);
        lq_.stage[k].hold[m] = select(fresh, V(0.0), lq_.stage[k].hold[m]);
      }
      const auto next = to_array<V>(many_.dynamics(static_cast<int>(k), x_[k], u_[k]));
      for (std::size_t j = 0; j < kNx; ++j) x_[k + 1][j] = select(fresh, next[j], x_[k + 1][j]);
    }
    is_fresh_ = fresh;
  }

  /// Linearises all lanes (eq. 4–6) and measures their optimality (eq. 12, 13).
  void measure() noexcept {
    cost_ = defect_ = excess_ = stationarity_ = poison_ = V(0.0);
    for (std::size_t k = 0; k < horizon_; ++k) linearise(k);
    end_of_horizon();
    std::array<V, kNx> lambda = lq_.terminal_gradient;
    for (std::size_t k = horizon_; k-- > 0;) {
      std::array<V, kNu> slope;
      lq_.adjoint(k, lambda, slope);
      auto& s = lq_.stage[k];
      for (std::size_t m = 0; m < kNu; ++m) {
        const V projected = min(max(-slope[m], s.low[m]), s.high[m]);
        stationarity_ = max(abs(projected), stationarity_);
        poison_ = fused_multiply_add(V(0.0), slope[m], poison_);
        const Lanes at_low = is_fresh_ & (s.low[m] >= V(0.0)) & (slope[m] > V(0.0));
        const Lanes at_high = is_fresh_ & (s.high[m] <= V(0.0)) & (slope[m] < V(0.0));
        s.hold[m] = select(at_low, V(-1.0), select(at_high, V(1.0), s.hold[m]));
      }
    }
    is_fresh_ = V(0.0) < V(0.0);
  }

  [[gnu::always_inline]] void linearise(std::size_t k) noexcept {
    auto& s = lq_.stage[k];
    const int number = static_cast<int>(k);
    StateJets<One, V, 1> x;
    InputJets<One, V, 1> u;
    unroll<kNx>([&](auto i) __attribute__((always_inline)) { std::get<i>(x).v = x_[k][i]; });
    unroll<kNu>([&](auto m) __attribute__((always_inline)) { std::get<m>(u).v = u_[k][m]; });
    const auto next = many_.dynamics(number, x, u);
    const V allowed(kDefectShare * options_.tolerance);
    unroll<kNx>([&](auto i) __attribute__((always_inline)) {
      const auto& row = std::get<i>(next);
      const V defect = V(jet::value(row)) - x_[k + 1][i];
      s.F[Layout::kF[i][kNx]] = defect;
      defect_ = max(abs(defect), defect_);
      poison_ = fused_multiply_add(V(0.0), defect, poison_);
      excess_ = max(abs(defect) - allowed * (1.0 + abs(V(jet::value(row)))), excess_);
      unroll<kNx + kNu>([&](auto n) __attribute__((always_inline)) {
        constexpr std::size_t kEntry = Layout::kF[i][n < kNx ? n : n + 1];
        if constexpr (kEntry != Layout::kNone)
          s.F[kEntry] = jet::number<V>(jet::slope<static_cast<int>(n)>(row));
      });
    });
    add_squares(many_.residual(number, x, u), s.L);
    const auto low = many_.input_lower(number);
    const auto high = many_.input_upper(number);
    for (std::size_t m = 0; m < kNu; ++m) {
      s.low[m] = V(low[m]) - u_[k][m];
      s.high[m] = V(high[m]) - u_[k][m];
    }
  }

  /// ½‖r‖²: Gauss–Newton Hessian and gradient.
  template <class Residual, class Entries>
  [[gnu::always_inline]] void add_squares(const Residual& residual, Entries& L) noexcept {
    for (auto& entry : L) entry = V(0.0);
    unroll<std::tuple_size_v<Residual>>([&](auto row) __attribute__((always_inline)) {
      const auto& r = std::get<row>(residual);
      const V value = V(jet::value(r));
      cost_ = fused_multiply_add(0.5 * value, value, cost_);
      if constexpr (AnyJet<std::remove_cvref_t<decltype(r)>>) {
        unroll<kNx + kNu>([&](auto a) __attribute__((always_inline)) {
          constexpr std::size_t kA = a < kNx ? a : a + 1;
          constexpr int kVariable = static_cast<int>(a);
          if constexpr (contains(std::remove_cvref_t<decltype(r)>::kFirst, kVariable)) {
            const V slope = jet::number<V>(jet::slope<kVariable>(r));
            auto& g = L[Layout::kL[kA][kNx]];
            g = fused_multiply_add(value, slope, g);
            unroll<a + 1>([&](auto b) __attribute__((always_inline)) {
              constexpr std::size_t kB = b < kNx ? b : b + 1;
              if constexpr (contains(std::remove_cvref_t<decltype(r)>::kFirst, static_cast<int>(b))) {
                auto& entry = L[Layout::kL[kA][kB]];
                entry = fused_multiply_add(slope, jet::number<V>(jet::slope<static_cast<int>(b)>(r)), entry);
              }
            });
          }
        });
      }
    });
  }

  /// The terminal cost.
  void end_of_horizon() noexcept {
    StateJets<One, V, 1> x;
    unroll<kNx>([&](auto i) __attribute__((always_inline)) { std::get<i>(x).v = x_[horizon_][i]; });
    for (auto& row : lq_.terminal) row.fill(V(0.0));
    lq_.terminal_gradient.fill(V(0.0));
    const auto residual = many_.terminal_residual(x);
    unroll<std::tuple_size_v<decltype(residual)>>([&](auto row) __attribute__((always_inline)) {
      const auto& r = std::get<row>(residual);
      const V value = V(jet::value(r));
      cost_ = fused_multiply_add(0.5 * value, value, cost_);
      if constexpr (AnyJet<std::remove_cvref_t<decltype(r)>>) {
        unroll<kNx>([&](auto i) __attribute__((always_inline)) {
          const V slope = jet::number<V>(jet::slope<static_cast<int>(i)>(r));
          lq_.terminal_gradient[i] = fused_multiply_add(value, slope, lq_.terminal_gradient[i]);
          unroll<kNx - i>([&](auto n) __attribute__((always_inline)) {
            lq_.terminal[i][i + n] = fused_multiply_add(
                slope, jet::number<V>(jet::slope<static_cast<int>(i + n)>(r)), lq_.terminal[i][i + n]);
          });
        });
      }
    });
  }

  /// Lanes with a problem that is solved or given up, as bits.
  [[nodiscard]] unsigned finished() const noexcept {
    const Lanes optimal =
        (stationarity_ <= V(options_.tolerance)) & (excess_ <= V(0.0)) & is_finite(poison_ + cost_);
    const Lanes odd = !is_finite(poison_ + cost_);
    unsigned done = (optimal | odd).bits();
    unsigned owned = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (owner_[lane] != kNobody) owned |= 1U << lane;
      if (turns_[lane] >= kMaxTurns || sweeps_[lane] >= kMaxSweeps || is_lost_[lane]) done |= 1U << lane;
    }
    return done & owned;
  }

  /// The result of a lane, or the fallback's.
  template <class Fallback>
  void hand_over(std::size_t lane, const One& problem, const State& start, Trajectory& trajectory,
                 SolveReport& report, const Fallback& fallback) noexcept {
    const bool is_optimal = stationarity_[lane] <= options_.tolerance && excess_[lane] <= 0.0 &&
                            poison_[lane] == 0.0 && !is_lost_[lane];
    if (!is_optimal) {
      report = fallback(problem, start, trajectory);
      return;
    }
    for (std::size_t k = 0; k <= horizon_; ++k) {
      for (std::size_t j = 0; j < kNx; ++j) trajectory.x[k][j] = x_[k][j][lane];
    }
    for (std::size_t k = 0; k < horizon_; ++k) {
      const auto low = problem.input_lower(static_cast<int>(k));
      const auto high = problem.input_upper(static_cast<int>(k));
      for (std::size_t m = 0; m < kNu; ++m) {
        const double u = u_[k][m][lane];
        trajectory.u[k][m] = u < low[m] ? low[m] : (u > high[m] ? high[m] : u);
      }
    }
    report = SolveReport{};
    report.status = SolveStatus::kOptimal;
    report.iterations = turns_[lane];
    report.sweeps = sweeps_[lane];
    report.cost = cost_[lane];
    report.stationarity = stationarity_[lane];
    report.defect = defect_[lane];
  }

  /// One sweep. Lanes whose working set it does not contradict take the whole step; the others sweep again
  /// beside the next turn of the rest.
  void step(unsigned done) noexcept {
    const unsigned bad = (!lq_.backward(horizon_)).bits();
    const unsigned open = lq_.forward(horizon_).bits();
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if ((done >> lane & 1U) != 0) continue;
      ++sweeps_[lane];
      turns_[lane] += (open >> lane & 1U) != 0 ? 0 : 1;
      is_lost_[lane] = (bad >> lane & 1U) != 0;
    }
    const Lanes stays = lanes_of(open | done);
    for (std::size_t k = 0; k < horizon_; ++k) {
      const auto& s = lq_.stage[k];
      for (std::size_t j = 0; j < kNx; ++j) x_[k + 1][j] += select(stays, V(0.0), lq_.dx[k + 1][j]);
      for (std::size_t m = 0; m < kNu; ++m)
        u_[k][m] += select(stays, V(0.0), min(max(s.du[m], s.low[m]), s.high[m]));
    }
  }

  SolverOptions options_;
  std::size_t horizon_ = 0;
  std::size_t owner_[kLanes]{};  ///< number of the problem in each lane
  int turns_[kLanes]{};
  int sweeps_[kLanes]{};
  bool is_lost_[kLanes]{};
  Lanes is_fresh_;  ///< lanes whose working set is to be guessed
  V cost_;
  V defect_;
  V excess_;  ///< of defects over what is allowed
  V stationarity_;
  V poison_;  ///< zero, unless something is not a number
  Many many_;
  std::array<std::array<V, kNx>, Capacity + 1> x_;
  std::array<std::array<V, kNu>, Capacity> u_;
  Lq lq_;
};

}  // namespace chicane::solver
