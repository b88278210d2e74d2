// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/detail/lq_solver.hpp"

namespace chicane::solver {

/// Solves the quadratic program of one iteration by corrections of its working set, else stage by stage
/// (docs/solver.md, "Bounds: primal-dual active set").
template <class Lq>
class WorkingSetQp {
 public:
  using Repair = typename Lq::Repair;

  /// A fresh problem: the next backward sweep chooses the working set.
  void choose(bool chooses) noexcept { chooses_ = chooses; }

  enum class Outcome {
    kSolved,
    kCircles,  ///< no step: the working set cycles
    kSpent     ///< nor here: the deadline came first
  };

  /// Leaves the step in `lq`; adds to `sweeps`. `is_exact`: the stages have exact Hessians, which
  /// `take_gauss_newton()` replaces where they are indefinite, and unsets. With `may_circle` nothing else is
  /// tried where the working set cycles.
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
  /// Sweeps that may correct the whole working set in vain.
  static constexpr int kChances = 5;

  /// Corrects all at once as long as that lowers the number of corrections, then one by one if there are few.
  /// The very first set solves the stages' own box problems.
  template <class TakeGaussNewton>
  Outcome correct(Lq& lq, std::size_t horizon, const bool& is_exact, const TakeGaussNewton& take_gauss_newton,
                  const Deadline& deadline, int& sweeps) noexcept {
    constexpr int kMaxSweeps = 20;
    int fewest = std::numeric_limits<int>::max();
    int chances = kChances;
    ++sweeps;
    double extra = lq.backward(horizon, 0.0, chooses_);
    chooses_ = false;
    for (int sweep = 1; sweep < kMaxSweeps; ++sweep) {
      if (extra > 0.0 && is_exact) {  // indefinite: Gauss–Newton is not
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

  bool chooses_ = false;
};

}  // namespace chicane::solver
