// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/detail/lq_solver.hpp"

namespace chicane::solver {

/// Solves the quadratic program of one iteration by corrections of its working set, or stage by stage if the
/// working set cycles (docs/solver.md, "Bounds: primal-dual active set").
template <class Lq>
class WorkingSetQp {
 public:
  using Repair = typename Lq::Repair;

  /// Lets the next backward sweep choose the working set, as for a fresh problem.
  void choose(bool chooses) noexcept { chooses_ = chooses; }

  enum class Outcome {
    kSolved,
    kCircles,  ///< no step: the working set cycles
    kSpent     ///< no step: the deadline is spent
  };

  /// Leaves the step in `lq`; adds to `sweeps`. `is_exact`: whether the stages have exact Hessians;
  /// take_gauss_newton() replaces indefinite ones and sets `is_exact` to false. With `may_circle` a cycle
  /// ends the solve; else the stages' own box problems give a step.
  template <class TakeGaussNewton>
  Outcome solve(Lq& lq, std::size_t horizon, const bool& is_exact, const TakeGaussNewton& take_gauss_newton,
                const Deadline& deadline, bool may_circle, int& sweeps) noexcept {
    const Outcome outcome = correct(lq, horizon, is_exact, take_gauss_newton, deadline, sweeps);
    if (outcome != Outcome::kCircles || may_circle) return outcome;
    ++sweeps;
    lq.backward(horizon, 0.0, true);
    lq.forward(horizon, Repair::kClip);
    return Outcome::kSolved;
  }

 private:
  /// Sweeps in succession that may correct the whole working set without progress; chosen.
  static constexpr int kChances = 5;

  /// Corrects the whole working set as long as that lowers the number of corrections, then input by input if
  /// few are left. The first working set solves the stages' own box problems.
  template <class TakeGaussNewton>
  Outcome correct(Lq& lq, std::size_t horizon, const bool& is_exact, const TakeGaussNewton& take_gauss_newton,
                  const Deadline& deadline, int& sweeps) noexcept {
    constexpr int kMaxSweeps = 20;  // chosen
    int fewest = std::numeric_limits<int>::max();
    int chances = kChances;
    ++sweeps;
    double extra = lq.backward(horizon, 0.0, chooses_);
    chooses_ = false;
    for (int sweep = 1; sweep < kMaxSweeps; ++sweep) {
      if (extra > 0.0 && is_exact) {  // exact Hessians are indefinite, Gauss–Newton's are not
        take_gauss_newton();
        ++sweeps;
        extra = lq.backward(horizon);
      }
      const int contradictions = lq.forward(horizon, chances > 0 ? Repair::kAll : Repair::kLast);
      if (contradictions == 0) return Outcome::kSolved;
      if (deadline.spent()) return Outcome::kSpent;
      if (chances == 0 && contradictions > kMaxSweeps - sweep) return Outcome::kCircles;
      chances = contradictions < fewest ? kChances : chances - 1;
      fewest = std::min(fewest, contradictions);
      ++sweeps;
      extra = lq.backward_again();
    }
    return Outcome::kCircles;
  }

  bool chooses_ = false;  ///< choose()
};

}  // namespace chicane::solver
