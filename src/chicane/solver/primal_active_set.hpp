// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include "chicane/solver/lq_solver.hpp"
#include "chicane/solver/rate_set.hpp"

namespace chicane::solver {

/// The slow and certain way to the solution of a quadratic program with bounds on changes, for when
/// corrections all at once or one by one go in circles: from an admissible step, each turn goes as far as the
/// bounds allow towards the optimum of its working set and takes in the bound it meets, or lets go the one
/// that pulls hardest. The cost never rises (Nocedal, Wright, Numerical Optimization, 2nd ed., alg. 16.3).
template <class Solver>
class PrimalActiveSet {
 public:
  explicit PrimalActiveSet(Solver& qp) noexcept : qp_(qp) {}

  /// Leaves the optimal step in `qp`; after `max_turns` without it, an admissible one. True when optimal.
  bool solve(std::size_t horizon, int max_turns) noexcept {
    begin(horizon);
    for (int turn = 0; turn < max_turns; ++turn) {
      qp_.backward(horizon);
      qp_.forward(horizon, Solver::Repair::kNone);
      const Block block = first_block(horizon);
      for (std::size_t k = 0; k < horizon; ++k) {
        for (std::size_t m = 0; m < kNu; ++m) here_[k][m] += block.length * (qp_.du[k][m] - here_[k][m]);
      }
      if (block.finding != Finding::kNone) {
        Set(qp_.hold, block.input).repair(block.stage, block.finding, block.bounds, block.target);
      } else if (!let_go(horizon)) {
        return true;
      }
    }
    for (std::size_t k = 0; k < horizon; ++k) std::copy(here_[k], here_[k] + kNu, qp_.du[k]);
    qp_.simulate(horizon);
    return false;
  }

 private:
  static constexpr std::size_t kNu = Solver::kNu;
  using Set = RateSet<kNu>;
  using Finding = typename Set::Finding;

  /// Where a step first meets a bound outside the working set.
  struct Block {
    double length = 1.0;
    Finding finding = Finding::kNone;
    std::size_t stage = 0;
    std::size_t input = 0;
    InputBounds bounds{};
    double target = 0.0;  ///< an input beyond the bound
  };

  /// An admissible step, and the bounds it stands at.
  void begin(std::size_t horizon) noexcept {
    qp_.backward(horizon);
    qp_.forward(horizon, Solver::Repair::kClip);
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        const double u = here_[k][m] = qp_.du[k][m];
        const InputBounds bounds = qp_.bounds_at(k, m, k == 0 ? 0.0 : here_[k - 1][m]);
        Hold& hold = qp_.hold[k][m];
        hold = u >= bounds.own_high ? Hold::kHigh : Hold::kFree;
        if (u <= bounds.own_low) hold = Hold::kLow;
      }
    }
  }

  [[nodiscard]] Block first_block(std::size_t horizon) const noexcept {
    Block first;
    for (std::size_t k = 0; k < horizon; ++k) {
      for (std::size_t m = 0; m < kNu; ++m) {
        const InputBounds now = qp_.bounds_at(k, m, k == 0 ? 0.0 : here_[k - 1][m]);
        const InputBounds then = qp_.bounds_at(k, m, k == 0 ? 0.0 : qp_.du[k - 1][m]);
        const double from = here_[k][m];
        const double to = qp_.du[k][m];
        const Hold hold = qp_.hold[k][m];
        const auto meet = [&](Finding finding, double room_now, double room_then) {
          if (room_then >= -1e-12) return;
          const double length = std::max(room_now, 0.0) / (std::max(room_now, 0.0) - room_then);
          if (length < first.length) first = {length, finding, k, m, then, to};
        };
        if (hold != Hold::kLow && hold != Hold::kHigh) {
          meet(Finding::kBeyondOwn, now.own_high - from, then.own_high - to);
          meet(Finding::kBeyondOwn, from - now.own_low, to - then.own_low);
        }
        const bool is_tied = Set::follows(hold) || (k > 0 && Set::precedes(qp_.hold[k - 1][m]));
        if (!is_tied) {
          meet(Finding::kBeyondRate, now.rate_high - from, then.rate_high - to);
          meet(Finding::kBeyondRate, from - now.rate_low, to - then.rate_low);
        }
      }
    }
    return first;
  }

  /// Drops the bound with the most wrong multiplier. False when there is none.
  bool let_go(std::size_t horizon) noexcept {
    double worst = 1e-10;
    std::size_t stage = 0;
    std::size_t input = 0;
    bool found = false;
    for (std::size_t m = 0; m < kNu; ++m) {
      double carried = 0.0;
      for (std::size_t k = 0; k < horizon; ++k) {
        const Hold hold = qp_.hold[k][m];
        const double slope = qp_.slope(k, m) + (Set::is_fixed(hold) ? carried : 0.0);
        carried = Set::precedes(hold) ? slope : 0.0;
        if (hold == Hold::kFree || !(qp_.lq.high[m][k] > qp_.lq.low[m][k])) continue;
        const double inward = Set::rises(hold) ? slope : -slope;
        if (inward <= worst * (1.0 + qp_.feedback[k].H[m][m])) continue;
        worst = inward;
        stage = k;
        input = m;
        found = true;
      }
    }
    const InputBounds unused{};
    if (found) Set(qp_.hold, input).repair(stage, Finding::kPulledInside, unused, 0.0);
    return found;
  }

  Solver& qp_;
  double here_[Solver::Lq::kStages][kNu]{};
};

}  // namespace chicane::solver
